//! `bricard show`: the equations of motion, as derived from a description.
//!
//! In:  a mechanism of the library, or the file of a description.
//! Out: every entry of M, C, C q̇, h, Q, g, G, b and p₂ on a line of its own, zeros
//!      included; what a program for them costs; degrees of freedom. Or those programs.
//!
//! The text can be read by a computer algebra system once `^` is replaced by its
//! power and `der(q1)` by a symbol.

mod cost;
mod names;
mod parts;
mod sections;
mod skipped;

use crate::arguments::Show;
use crate::captions::{first_sentence, freedom, sizes};
use crate::description::{Description, wrong};
use crate::error::CommandError;
use crate::mechanism::{description, freedom_at_start};
use crate::output::print;
use bricard_codegen::CompileSettings;
use bricard_codegen::internals::expr::Symbol;
use bricard_codegen::internals::model::{Described, Mechanism};
use bricard_codegen::internals::optimise::{Besides, Programs, cost as operations, programs};
use bricard_codegen::internals::{analyse, derive, equations_of_motion};
use std::path::Path;

/// Prints the equations of motion.
pub fn show(arguments: &Show) -> Result<(), CommandError> {
    let Description { file, source } = description(&arguments.subject)?;
    let wrong = wrong(&file, &source);
    let (mut mechanism, _warnings) =
        analyse(&source, &CompileSettings::beside(&file)).map_err(&wrong)?;
    if arguments.eliminate {
        mechanism = derive::eliminate(mechanism).map_err(&wrong)?;
    }
    let equations = equations_of_motion(&mut mechanism).map_err(&wrong)?;
    if arguments.programs {
        let programs = programs(&mut mechanism, &equations, Besides::default());
        return print(&listing(&mechanism, &programs));
    }
    let sections = sections::sections(&mut mechanism, &equations);
    let programs = programs(&mut mechanism, &equations, Besides::default());
    let costs = cost::costs(&programs);
    let skipped = skipped::skipped(&mechanism, &equations, &programs);
    // The rank at the start is that of all constraints.
    let whole = mechanism.described.is_empty();
    let start = freedom_at_start(&arguments.subject).filter(|_| whole);
    let heading = heading(&mechanism, &file, start);
    // The names are the mechanism's, so its graph has to stand apart to be added to.
    let mut graph = std::mem::take(&mut mechanism.graph);
    print(&if arguments.latex {
        let names = |symbol: Symbol| names::latex(&mechanism.symbol_text(symbol));
        let comment = heading
            .lines()
            .chain(costs.lines())
            .chain(skipped.lines())
            .map(|line| format!("% {line}\n"));
        let body = sections::latex(&mut graph, &sections, &names);
        format!("{}\n{body}", comment.collect::<String>())
    } else {
        let names = |symbol: Symbol| mechanism.symbol_text(symbol);
        let body = sections::text(&mut graph, &sections, &names);
        format!("{heading}\n{body}{costs}{skipped}")
    })
}

/// The programs, each with what it costs.
fn listing(mechanism: &Mechanism, programs: &Programs) -> String {
    let names = |symbol: Symbol| mechanism.symbol_text(symbol);
    let named = programs.named().into_iter();
    let texts = named.map(|(name, program)| {
        let cost = operations(program);
        format!("{name}: {cost}\n{}", program.text(&names))
    });
    texts.collect::<Vec<_>>().join("\n")
}

/// Of an array of the equations of motion what it is, and its entries with their values, in
/// LaTeX; of one with more terms and factors than are wanted nothing else.
pub type Array = (&'static str, Option<Vec<[String; 2]>>);

/// The equations of motion of the description in a file; `None` if it is wrong.
pub fn equations(file: &Path, source: &str, most: u64) -> Option<Vec<Array>> {
    let (mut mechanism, _warnings) = analyse(source, &CompileSettings::beside(file)).ok()?;
    let equations = derive::derive(&mut mechanism).ok()?;
    let sections = sections::sections(&mut mechanism, &equations);
    let mut graph = std::mem::take(&mut mechanism.graph);
    let names = |symbol: Symbol| names::latex(&mechanism.symbol_text(symbol));
    let mut all = Vec::new();
    for section in &sections {
        let fits = section.length(&graph) <= most;
        let lines = fits.then(|| section.lines(&mut graph, &names));
        all.push((section.title(), lines));
    }
    Some(all)
}

/// Whose equations they are; with the rank of the constraints and the number of degrees of
/// freedom at the start, as far as they are known.
fn heading(mechanism: &Mechanism, file: &Path, start: Option<String>) -> String {
    let (n, r) = (mechanism.freedoms(), mechanism.constraints.len());
    let mut lines = vec![
        format!("{}: {}", mechanism.name, first_sentence(&mechanism.docs)),
        format!("from {}", file.display()),
        sizes(mechanism),
    ];
    lines.push(match start {
        Some(start) => start,
        None if r == 0 => freedom(n),
        None => format!(
            "{} if the constraint equations are independent",
            freedom(n.saturating_sub(r))
        ),
    });
    lines.push(String::new());
    for (i, coordinate) in mechanism.coordinates.iter().enumerate() {
        let (name, unit) = (&coordinate.name, &coordinate.unit);
        let what = match (i < n, unit.as_str()) {
            (true, "") => name.clone(),
            (true, unit) => format!("{name} ({unit})"),
            (false, "") => format!("the integral of {name}"),
            (false, unit) => format!("the integral of {name} (in {unit})"),
        };
        let docs = first_sentence(&coordinate.docs);
        lines.push(format!("q[{}] is {what}  {docs}", i + 1).trim_end().into());
    }
    for (i, constraint) in mechanism.constraints.iter().enumerate() {
        lines.push(format!(
            "g[{}] is line {}: {}",
            i + 1,
            constraint.span.start.line,
            constraint.text
        ));
    }
    lines.extend(mechanism.described.iter().filter_map(given));
    lines.join("\n") + "\n"
}

/// Where a coordinate that was eliminated comes from.
fn given(coordinate: &Described) -> Option<String> {
    let row = coordinate.given_by.as_ref()?;
    let name = &coordinate.quantity.name;
    let line = row.span.start.line;
    Some(format!("{name} is given by line {line}: {}", row.text))
}
