//! The whole pipeline on one screen.

use crate::derive::{self, Equations};
use crate::diagnostic::Diagnostics;
use crate::emit::{self, EmitOptions, Provenance};
use crate::lint::Lints;
use crate::model::{self, Mechanism};
use crate::optimise::{self, Besides, Programs};
use crate::syntax::{self, Read};
use proc_macro2::TokenStream;
use std::path::{Path, PathBuf};

/// What to do differently from the defaults.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct CompileSettings {
    /// Constants with another value than the description gives them.
    pub constants: Vec<(String, f64)>,
    /// Parameters that become constants at their default.
    pub frozen: Vec<String>,
    /// Whether dependent coordinates, which constraints give explicitly, are eliminated.
    pub eliminate: bool,
    /// What to emit besides the necessary.
    pub options: EmitOptions,
    /// The folder of the description, in which files of tables are looked for.
    pub folder: Option<PathBuf>,
}

impl CompileSettings {
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
#[non_exhaustive]
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
    /// Whether programs in other languages can ask for derivatives.
    pub differentiated: bool,
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
    settings: &CompileSettings,
) -> Result<Compiled, Diagnostics> {
    let options = settings.options;
    let provenance = Provenance {
        module,
        file,
        source,
        frozen: &settings.frozen,
    };

    let tree: Read = syntax::read(source);
    let (mechanism, mut warnings): (Mechanism, Diagnostics) = lower(tree, settings)?;
    let (mut mechanism, equations): (Mechanism, Equations) =
        derive(mechanism, settings.eliminate, &mut warnings)?;
    let besides = Besides {
        coriolis_matrix: options.coriolis_matrix,
        partials: options.c_interface,
    };
    let programs: Programs = optimise::programs(&mut mechanism, &equations, besides);
    let code: TokenStream = emit::module(&mechanism, &equations, &programs, provenance, options);

    Ok(Compiled {
        c_header: emit::c_header(&mechanism, module),
        name: mechanism.name,
        coordinates: mechanism.coordinates.len(),
        constraints: mechanism.constraints.len(),
        code: emit::render(&code),
        differentiated: programs.partials.is_some(),
        files: mechanism.files,
        warnings,
    })
}

/// The front end alone: parses and checks a description.
///
/// # Errors
///
/// As [`compile_source`].
pub fn analyse(
    source: &str,
    settings: &CompileSettings,
) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    lower(syntax::read(source), settings)
}

/// [`analyse`] and everything else that can be said without generating code: also
/// what is legal but doubtful, found by evaluating the equations.
///
/// # Errors
///
/// As [`compile_source`].
pub fn examine(
    source: &str,
    settings: &CompileSettings,
) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    let (mechanism, mut warnings) = analyse(source, settings)?;
    let mut derived = mechanism.clone();
    let equations = derive::derive(&mut derived)?;
    let lints = Lints::of(&derived, &equations);
    warnings.append_elsewhere(lints.warnings());
    warnings.append_elsewhere(lints.redundancies());
    if let Some(warning) = derive::swell(&derived, &equations) {
        warnings.push(warning);
    }
    Ok((mechanism, warnings))
}

/// The equations of motion of a checked mechanism, as programs are made of them.
///
/// # Errors
///
/// They are too long.
pub fn equations_of_motion(mechanism: &mut Mechanism) -> Result<Equations, Diagnostics> {
    let mut equations = derive::derive(mechanism)?;
    equations.redundant = Lints::of(mechanism, &equations).redundant_rows();
    Ok(equations)
}

/// The mechanism of a syntax tree, with warnings. Where some statements can't be read, the
/// mistakes in the others are reported together with theirs.
fn lower(read: Read, settings: &CompileSettings) -> Result<(Mechanism, Diagnostics), Diagnostics> {
    let (tree, mut wrong) = read;
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
    if let Err(others) = lowered {
        wrong.append(others);
    }
    Err(wrong)
}

/// The equations of motion, of the mechanism that is left where coordinates are eliminated.
/// Warnings are about what the description declares.
fn derive(
    mut mechanism: Mechanism,
    eliminate: bool,
    warnings: &mut Diagnostics,
) -> Result<(Mechanism, Equations), Diagnostics> {
    let declared = eliminate.then(|| mechanism.clone());
    let mut equations = derive::derive(&mut mechanism);
    // What is too long as it was declared may be short enough without some coordinates.
    if let Ok(equations) = &mut equations {
        let lints = Lints::of(&mechanism, equations);
        warnings.append_elsewhere(lints.warnings());
        equations.redundant = lints.redundant_rows();
    }
    if let Some(declared) = declared {
        mechanism = derive::eliminate(declared)?;
        equations = equations_of_motion(&mut mechanism);
    }
    let equations = equations?;
    if let Some(warning) = derive::swell(&mechanism, &equations) {
        warnings.push(warning);
    }
    Ok((mechanism, equations))
}
