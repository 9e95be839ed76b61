//! Inputs by formula: `--set 'torque=3*sin(t)'`.
//!
//! In:  a mechanism's name or file, formulas for inputs.
//! Out: the mechanism with these laws in place of its own: its description is written
//!      anew and compiled, so that a law may use all that one in a file may, runs as fast, and
//!      gets the same messages.

use crate::compiled;
use crate::description::Description;
use crate::error::CommandError;
use crate::formula::Setting;
use crate::mechanism::{description, find};
use bricard_codegen::internals::diagnostic::Span;
use bricard_codegen::internals::syntax::{Model, parse};
use bricard_driver::AnyMechanism;

/// An input by its name, and its formula.
type Law<'a> = (&'a str, &'a str);

/// Finds a mechanism whose inputs follow the formulas among settings, and the settings
/// that are left.
///
/// # Errors
///
/// As [`find`]; [`CommandError::InvalidSetting`], what is wrong with a formula.
pub fn find_with(
    name: &str,
    set: &[Setting],
) -> Result<(Box<dyn AnyMechanism>, Vec<Setting>), CommandError> {
    let Some((Description { file, source }, left)) = with_laws(name, set)? else {
        return Ok((find(name)?, set.to_vec()));
    };
    let laws = set.iter().filter_map(law);
    let opened = compiled::open_text(&file, &source).map_err(|error| match error {
        CommandError::Description(said) => {
            let given = laws.map(|(name, law)| format!("`--set '{name}={law}'`"));
            let given: Vec<String> = given.collect();
            CommandError::Description(format!("with {}\n{said}", given.join(", ")))
        }
        error => error,
    })?;
    Ok((Box::new(opened), left))
}

/// The description of a mechanism with the formulas among settings in it.
///
/// # Errors
///
/// As [`find_with`].
pub fn described_with(name: &str, set: &[Setting]) -> Result<Description, CommandError> {
    match with_laws(name, set)? {
        Some((description, _)) => Ok(description),
        None => description(name),
    }
}

/// A description with the formulas among settings in it, and the settings that are left;
/// none if no formula is the law of one of its inputs.
fn with_laws(
    name: &str,
    set: &[Setting],
) -> Result<Option<(Description, Vec<Setting>)>, CommandError> {
    let laws: Vec<Law> = set.iter().filter_map(law).collect();
    if laws.is_empty() {
        return Ok(None);
    }
    let Description { file, source } = description(name)?;
    // What is wrong with a description is told when it is compiled.
    let (source, left) = match parse(&source) {
        Ok(model) => match replaced(&source, &model, &laws, set)? {
            Some(replaced) => replaced,
            None => return Ok(None),
        },
        Err(_) => (source, Vec::new()),
    };
    Ok(Some((Description { file, source }, left)))
}

fn law(setting: &Setting) -> Option<Law<'_>> {
    match setting {
        Setting::Law { name, text, .. } => Some((name, text)),
        Setting::Number(_) => None,
    }
}

/// A description with other laws, and the settings that are left: those of what is no
/// input of the mechanism itself are wrong, which is found when they are looked up. None
/// if no law is one of the mechanism's.
fn replaced(
    text: &str,
    model: &Model,
    laws: &[Law],
    set: &[Setting],
) -> Result<Option<(String, Vec<Setting>)>, CommandError> {
    let mut places: Vec<(Span, &str)> = Vec::new();
    let mut left = set.to_vec();
    for (name, law) in laws {
        match model.law_of(name) {
            Some(span) => {
                places.push((span, law));
                left.retain(|setting| setting.name() != *name);
            }
            None => whole(model, name)?,
        }
    }
    places.sort_by_key(|(span, _)| std::cmp::Reverse(span.range().start));
    if places.is_empty() {
        return Ok(None);
    }
    let mut text = text.to_string();
    for (span, law) in places {
        text.replace_range(span.range(), law);
    }
    Ok(Some((text, left)))
}

/// Refuses a law for an element or a component of an input, and for one inside a part.
fn whole(model: &Model, name: &str) -> Result<(), CommandError> {
    let first = name.split(['.', '[']).next().unwrap_or(name);
    let reason = match model.law_of(first) {
        _ if first == name => return Ok(()),
        Some(_) => format!("the law of `{first}` is given as a whole: write `{first}=[…]`"),
        None => "an input inside a part is held at a number here; a law stands in the part: write \
                 one that has it, or a force in its place"
            .to_string(),
    };
    let name = name.to_string();
    Err(CommandError::InvalidSetting { name, reason })
}
