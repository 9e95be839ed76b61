//! The whole pipeline on one screen.

use crate::diagnostic::Diagnostics;
use crate::emit::{self, Options, Origin};
use crate::model::Mechanism;
use crate::{derive, doubt, model, optimise, parse};
use std::path::{Path, PathBuf};

/// What to do differently from the defaults.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Constants with another value than the description gives them.
    pub constants: Vec<(String, f64)>,
    /// Parameters that become constants at their default.
    pub frozen: Vec<String>,
    /// Whether dependent coordinates, which constraints give explicitly, are eliminated.
    pub eliminate: bool,
    /// What to emit besides the necessary.
    pub options: Options,
    /// The folder of the description, in which files of tables are looked for.
    pub folder: Option<PathBuf>,
}

impl Settings {
    /// The defaults, for a description in a file.
    pub fn beside(description: &Path) -> Self {
        Self {
            folder: description.parent().map(Path::to_path_buf),
            ..Self::default()
        }
    }
}

/// One description, compiled.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The name after `mechanism`.
    pub name: String,
    /// How many coordinates the generated code has.
    pub coordinates: usize,
    /// How many constraint equations.
    pub constraints: usize,
    /// The module, as Rust text.
    pub code: String,
    /// Its header, for programs in C.
    pub c_header: String,
    /// Files that the description reads.
    pub files: Vec<PathBuf>,
    /// What is doubtful in the description.
    pub warnings: Diagnostics,
}

/// Compiles a description; `module` names the module, `file` the description in
/// messages and documentation.
///
/// # Errors
///
/// Everything that is wrong in the description, as far as the first stage that
/// found something could see.
pub fn compile_source(
    source: &str,
    module: &str,
    file: &str,
    settings: &Settings,
) -> Result<Compiled, Diagnostics> {
    let (mut mechanism, mut warnings) = analyse(source, settings)?;
    warnings.append_elsewhere(doubt::doubts(mechanism.clone()));
    if settings.eliminate {
        mechanism = derive::eliminate(mechanism)?;
    }
    let equations = derive::derive(&mut mechanism)?;
    if let Some(warning) = derive::swell(&mechanism, &equations) {
        warnings.push(warning);
    }
    let origin = Origin {
        module,
        file,
        source,
        frozen: &settings.frozen,
    };
    let programs = optimise::programs(
        &mut mechanism,
        &equations,
        settings.options.coriolis_matrix,
    );
    let tokens = emit::module(&mechanism, &equations, &programs, origin, settings.options);
    let code = emit::render(&tokens);
    Ok(Compiled {
        c_header: emit::c_header(&mechanism, module),
        name: mechanism.name,
        coordinates: mechanism.coordinates.len(),
        constraints: mechanism.constraints.len(),
        code,
        files: mechanism.files,
        warnings,
    })
}

/// The front end alone: parses and checks a description.
///
/// # Errors
///
/// As [`compile_source`].
pub fn analyse(source: &str, settings: &Settings) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    let (tree, mut wrong) = parse::read(source);
    let Some(tree) = tree else {
        return Err(wrong);
    };
    let lowered = model::lower(
        &tree,
        &settings.constants,
        &settings.frozen,
        wrong.is_empty(),
        settings.folder.as_deref(),
    );
    if wrong.is_empty() {
        return lowered;
    }
    // The statements that could be read have mistakes of their own.
    if let Err(others) = lowered {
        wrong.append(others);
    }
    Err(wrong)
}

/// [`analyse`] and everything else that can be said without generating code: also
/// what is legal but doubtful, found by evaluating the equations.
///
/// # Errors
///
/// As [`compile_source`].
pub fn examine(source: &str, settings: &Settings) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    let (mechanism, mut warnings) = analyse(source, settings)?;
    warnings.append_elsewhere(doubt::doubts(mechanism.clone()));
    warnings.append_elsewhere(doubt::redundancies(mechanism.clone()));
    let mut derived = mechanism.clone();
    let equations = derive::derive(&mut derived)?;
    if let Some(warning) = derive::swell(&derived, &equations) {
        warnings.push(warning);
    }
    Ok((mechanism, warnings))
}
