//! What a build script calls.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), bricard_codegen::BuildError> {
//!     bricard_codegen::compile("mechanisms/four_bar.mech")
//! }
//! ```
//!
//! and in the crate `bricard_runtime::include_mechanism!("four_bar");`.

use crate::compile::{CompileSettings, Compiled, compile_source};
use crate::emit;
use crate::read::read_text;
use crate::syntax::{Model, ModelError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{env, fmt, fs, io};

/// Compiles one description into `OUT_DIR`, tells cargo what to watch, and shows
/// what is wrong as errors of the build.
///
/// # Errors
///
/// See [`BuildError`]; cargo has been told already.
pub fn compile(description: impl AsRef<Path>) -> Result<(), BuildError> {
    Builder::new().compile(description)
}

/// Compiles every `*.mech` of a folder into one file, `OUT_DIR/mechanisms.rs`, with
/// a catalogue: `NAMES`, `visit`, `source`.
///
/// # Errors
///
/// See [`BuildError`]; cargo has been told already.
pub fn compile_dir(folder: impl AsRef<Path>) -> Result<(), BuildError> {
    Builder::new().compile_dir(folder)
}

/// Compilation with other than the default settings.
#[derive(Clone, Debug, Default)]
pub struct Builder {
    settings: CompileSettings,
    out_dir: Option<PathBuf>,
}

/// Why nothing was generated.
///
/// Its `Debug` is its message too: that is what a `main` that returns it prints.
#[non_exhaustive]
pub enum BuildError {
    /// A file could not be read or written.
    File(PathBuf, io::Error),
    /// The output folder was neither given nor set by cargo.
    NoOutDir,
    /// The name of a description is no module name.
    Name(PathBuf),
    /// Two descriptions of a folder would be one module, of this name.
    SameModule([PathBuf; 2], String),
    /// The description is wrong: the rendered messages.
    Description(String),
    /// The calls that built a model gave texts that are no formulas or names.
    Model(ModelError),
}

impl Builder {
    /// The default settings.
    pub fn new() -> Self {
        Self::default()
    }

    /// Gives a constant another value than the description does.
    pub fn constant(mut self, name: &str, value: impl Into<f64>) -> Self {
        self.settings
            .constants
            .push((name.to_string(), value.into()));
        self
    }

    /// Makes a parameter a constant at its default value: it is folded, and the
    /// documentation of the generated module lists it.
    pub fn freeze(mut self, parameter: &str) -> Self {
        self.settings.frozen.push(parameter.to_string());
        self
    }

    /// Whether to generate the Coriolis matrix `C` as a function of its own. The
    /// simulation needs only the product `C q̇`.
    pub fn coriolis_matrix(mut self, wanted: bool) -> Self {
        self.settings.options.coriolis_matrix = wanted;
        self
    }

    /// Declares that no motion of the mechanism passes a singular configuration. A run
    /// that comes to one all the same ends with an error.
    pub fn regular(mut self, declared: bool) -> Self {
        self.settings.options.assumed_regular = declared;
        self
    }

    /// Eliminates dependent coordinates, those that constraints give explicitly
    /// (`q3 = L1*cos(q1) + …`),
    /// with those constraints. The state has the others; `Interface::described` gives all
    /// that were declared back, with their velocities, accelerations and reactions.
    ///
    /// A coordinate goes if a holonomic constraint is linear in it with a number for its
    /// coefficient, the start holds neither its value nor its velocity, and its guess is
    /// not the only one that tells where the coordinates in its formula are.
    pub fn eliminate(mut self, wanted: bool) -> Self {
        self.settings.eliminate = wanted;
        self
    }

    /// Whether to generate what makes the mechanism known to C: the function by which a
    /// library hands it out, which wants the package `bricard-capi`, and a header beside the
    /// code, `OUT_DIR/NAME.h`, which goes with that package's `bricard.h`.
    pub fn c_interface(mut self, wanted: bool) -> Self {
        self.settings.options.c_interface = wanted;
        self
    }

    /// The number of operations, 8,000 unless it is given, above which repeated patterns of a
    /// function, such as the bodies of a chain or the loops of a row, are emitted as loops
    /// instead of being unrolled. Loops are compiled in a fraction of the time. From 3,000
    /// operations on they also run faster; where processors may fuse products with sums
    /// (`target-cpu`), from 8,000 on. Functions that no step of a run calls have loops from
    /// 1,000 operations on at the latest.
    pub fn unrolled(mut self, operations: usize) -> Self {
        self.settings.options.unrolled = Some(operations);
        self
    }

    /// The number of operations, 20,000 unless it is given, above which a function without
    /// loops is split into several, called one after the other. That compiles faster and runs
    /// slower, since values that one of them computes and another one reads go through memory.
    pub fn straight_line(mut self, operations: usize) -> Self {
        self.settings.options.straight_line = Some(operations);
        self
    }

    /// Writes to another folder than `OUT_DIR`.
    pub fn out_dir(mut self, folder: impl Into<PathBuf>) -> Self {
        self.out_dir = Some(folder.into());
        self
    }

    /// As [`compile`], with these settings.
    ///
    /// # Errors
    ///
    /// See [`BuildError`]; cargo has been told already.
    pub fn compile(&self, description: impl AsRef<Path>) -> Result<(), BuildError> {
        let description = description.as_ref();
        println!("cargo::rerun-if-changed={}", description.display());
        let read = |files: Vec<PathBuf>| {
            for file in files {
                println!("cargo::rerun-if-changed={}", file.display());
            }
        };
        tell(self.compile_one(description).map(|(warnings, files)| {
            read(files);
            warnings
        }))
    }

    /// As [`compile_dir`], with these settings.
    ///
    /// # Errors
    ///
    /// See [`BuildError`]; cargo has been told already.
    pub fn compile_dir(&self, folder: impl AsRef<Path>) -> Result<(), BuildError> {
        let folder = folder.as_ref();
        println!("cargo::rerun-if-changed={}", folder.display());
        tell(self.try_compile_dir(folder))
    }

    /// As [`compile`], of a model built by calls. `module` names the file and the
    /// module. The description is written beside the code, as `module.mech`: the
    /// messages show its lines.
    ///
    /// # Errors
    ///
    /// See [`BuildError`]; cargo has been told already.
    pub fn compile_model(&self, model: &Model, module: &str) -> Result<(), BuildError> {
        tell(self.try_compile_model(model, module))
    }

    /// Compiles a model built by calls without a word to cargo; returns the rendered
    /// warnings.
    ///
    /// # Errors
    ///
    /// See [`BuildError`].
    pub fn try_compile_model(&self, model: &Model, module: &str) -> Result<String, BuildError> {
        let file = format!("{module}.mech");
        stem(Path::new(&file))?;
        let source = model.text().map_err(BuildError::Model)?;
        self.write(&file, &source)?;
        let (compiled, warnings) = text(&source, module, &file, &self.settings)?;
        self.write_module(module, &compiled)?;
        Ok(warnings)
    }

    /// Compiles one description without a word to cargo; returns the rendered
    /// warnings.
    ///
    /// # Errors
    ///
    /// See [`BuildError`].
    pub fn try_compile(&self, description: &Path) -> Result<String, BuildError> {
        self.compile_one(description).map(|(warnings, _)| warnings)
    }

    /// The warnings of a description, and the files that it reads.
    fn compile_one(&self, description: &Path) -> Result<(String, Vec<PathBuf>), BuildError> {
        let stem = stem(description)?;
        let (compiled, warnings) = self.one(description, &stem)?;
        self.write_module(&stem, &compiled)?;
        Ok((warnings, compiled.files))
    }

    /// Compiles a folder without a word to cargo; returns the rendered warnings.
    ///
    /// # Errors
    ///
    /// See [`BuildError`]; all wrong descriptions are reported.
    pub fn try_compile_dir(&self, folder: &Path) -> Result<String, BuildError> {
        let (mut code, mut names) = (String::new(), Vec::new());
        let (mut warnings, mut errors) = (String::new(), String::new());
        let descriptions = descriptions(folder)?;
        apart(&descriptions)?;
        for description in descriptions {
            let stem = stem(&description)?;
            match self.one(&description, &stem) {
                Ok((compiled, warning)) => {
                    code.push_str(&compiled.code);
                    self.write_header(&stem, &compiled)?;
                    names.push((stem, compiled.name));
                    warnings.push_str(&warning);
                }
                Err(BuildError::Description(message)) => errors.push_str(&message),
                Err(error) => return Err(error),
            }
        }
        if !errors.is_empty() {
            return Err(BuildError::Description(errors));
        }
        code.push_str(&emit::render(&emit::catalogue(&names)));
        self.write("mechanisms.rs", &code)?;
        Ok(warnings)
    }

    fn one(&self, description: &Path, stem: &str) -> Result<(Compiled, String), BuildError> {
        let shown = description.display().to_string();
        let file_error = |error| BuildError::File(description.to_path_buf(), error);
        let source = read_text(description).map_err(file_error)?;
        let folder = description.parent().map(Path::to_path_buf);
        let settings = CompileSettings {
            folder,
            ..self.settings.clone()
        };
        text(&source, stem, &shown, &settings)
    }

    /// Writes the code of one mechanism, and its header if one is wanted.
    fn write_module(&self, stem: &str, compiled: &Compiled) -> Result<(), BuildError> {
        self.write(&format!("{stem}.rs"), &compiled.code)?;
        self.write_header(stem, compiled)
    }

    fn write_header(&self, stem: &str, compiled: &Compiled) -> Result<(), BuildError> {
        match self.settings.options.c_interface {
            true => self.write(&format!("{stem}.h"), &compiled.c_header),
            false => Ok(()),
        }
    }

    fn write(&self, name: &str, code: &str) -> Result<(), BuildError> {
        let folder = self
            .out_dir
            .clone()
            .or_else(|| env::var_os("OUT_DIR").map(PathBuf::from));
        let path = folder.ok_or(BuildError::NoOutDir)?.join(name);
        emit::write_if_changed(&path, code).map_err(|error| BuildError::File(path, error))
    }
}

fn text(
    source: &str,
    stem: &str,
    file: &str,
    settings: &CompileSettings,
) -> Result<(Compiled, String), BuildError> {
    let compiled = compile_source(source, stem, file, settings)
        .map_err(|errors| BuildError::Description(errors.render(file, source)))?;
    let warnings = compiled.warnings.render(file, source);
    Ok((compiled, warnings))
}

/// Tells cargo of warnings or errors: one line for each line of a rendered message,
/// which is what cargo shows whole and aligned.
fn tell(result: Result<String, BuildError>) -> Result<(), BuildError> {
    match &result {
        Ok(warnings) => warnings
            .lines()
            .for_each(|line| println!("cargo::warning={line}")),
        Err(error) => error
            .to_string()
            .lines()
            .for_each(|line| println!("cargo::error={line}")),
    }
    result.map(|_| ())
}

/// The `*.mech` files of a folder, in alphabetical order.
fn descriptions(folder: &Path) -> Result<Vec<PathBuf>, BuildError> {
    let failed = |error| BuildError::File(folder.to_path_buf(), error);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path
            .extension()
            .is_some_and(|extension| extension == "mech")
        {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Refuses descriptions whose modules would have one name: `a_b` and `a__b`.
fn apart(descriptions: &[PathBuf]) -> Result<(), BuildError> {
    let mut modules = BTreeMap::new();
    for description in descriptions {
        let module = emit::module_name(&stem(description)?);
        if let Some(other) = modules.insert(module.clone(), description) {
            let both = [other.clone(), description.clone()];
            return Err(BuildError::SameModule(both, module));
        }
    }
    Ok(())
}

fn stem(description: &Path) -> Result<String, BuildError> {
    let stem = description.file_stem().and_then(|stem| stem.to_str());
    let name = stem.filter(|stem| syn::parse_str::<syn::Ident>(stem).is_ok());
    name.map(str::to_string)
        .ok_or_else(|| BuildError::Name(description.to_path_buf()))
}

impl fmt::Display for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BuildError::File(path, error) => write!(f, "{}: {error}", path.display()),
            BuildError::NoOutDir => f.write_str(
                "no output folder: call this from a build script, or name one with `out_dir`",
            ),
            BuildError::Name(path) => write!(
                f,
                "{}: the file's name becomes a module's: letters, digits and `_`, no keyword",
                path.display()
            ),
            BuildError::SameModule([first, second], module) => write!(
                f,
                "{} and {} would both be the module `{module}`; rename one of them",
                first.display(),
                second.display()
            ),
            BuildError::Description(message) => f.write_str(message.trim_end()),
            BuildError::Model(error) => error.fmt(f),
        }
    }
}

impl fmt::Debug for BuildError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for BuildError {}
