//! The command line.
//!
//! In:  words.
//! Out: [`Arguments`], each value read, none checked against a mechanism yet.

use crate::formula::{self, Assignment, Choice, Setting};
use bricard_codegen::internals::diagnostic::nearest;
use bricard_runtime::{Form, Method, Stabilisation};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Widths of the columns of journals (mm).
const SINGLE: f64 = 88.0;
const DOUBLE: f64 = 180.0;
/// Widths that a picture may have in print (mm).
const WIDTHS: RangeInclusive<f64> = 60.0..=420.0;

/// Simulates closed-loop mechanisms straight through their singular positions.
#[derive(Debug, Parser)]
#[command(name = "bricard", version)]
pub struct Arguments {
    /// What to do.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the mechanisms of the library
    List,
    /// Print the equations of motion derived from a description
    Show(Show),
    /// Simulate a mechanism: rows of numbers to a file, a summary to the terminal
    #[command(alias = "run")]
    Simulate(Box<Simulate>),
    /// Run the experiments of Phong & Hoang (2012): figures, and numbers beside
    /// exact ones
    Reproduce(Reproduce),
    /// Measure run time against error, for all methods and forms of the equations
    #[command(name = "workprecision")]
    WorkPrecision(WorkPrecision),
    /// Solve the benchmark problems of the field and compare with their references
    Validate(Validate),
    /// Measure what the passage through a singular configuration costs in accuracy,
    /// wherever the stages of a step are placed
    #[command(alias = "landing")]
    Passage(Passage),
    /// Check a description without compiling it
    Check(Check),
    /// Simulate a description, and again each time its file is saved
    #[command(mut_arg("name", |name| name.value_name("FILE.mech").help("The file of a description")))]
    Watch(Box<Simulate>),
    /// Say where compiled descriptions are kept, and how large they are
    Cache(Cache),
    /// Export a mechanism: a Rust crate, a library for C and C++, a Python wheel, an FMU, or an npm package
    Export(Export),
    /// Print what makes a shell complete the command's words
    Completions(Completions),
    /// Write the manual's pages
    Man(Man),
    /// Begin a crate: a commented mechanism, its build script, a program that
    /// simulates it
    New(New),
    /// Write the gallery of the documentation
    #[command(hide = true)]
    Gallery(Gallery),
}

/// Arguments of `gallery`.
#[derive(Args, Debug)]
pub struct Gallery {
    /// The folder of the pictures; the page of all is written beside it
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Arguments of `show`.
#[derive(Args, Debug)]
pub struct Show {
    /// A mechanism of the library, or the file of a description (FILE.mech)
    #[arg(value_name = "NAME|FILE.mech")]
    pub subject: String,
    /// Print LaTeX instead of the notation of descriptions
    #[arg(long)]
    pub latex: bool,
    /// Leave out the dependent coordinates, which constraints give explicitly, as
    /// `Builder::eliminate` does
    #[arg(long)]
    pub eliminate: bool,
    /// Print the programs that the generated functions run, operation by operation
    #[arg(long, conflicts_with = "latex")]
    pub programs: bool,
}

/// Arguments of `check`.
#[derive(Args, Debug)]
pub struct Check {
    /// The description
    #[arg(value_name = "FILE.mech")]
    pub file: PathBuf,
    /// Print what is found as one JSON object, for editors
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `cache`.
#[derive(Args, Debug)]
pub struct Cache {
    /// Remove everything that was compiled
    #[arg(long)]
    pub clear: bool,
}

/// Arguments of `completions`.
#[derive(Args, Debug)]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    pub shell: ShellName,
}

/// Arguments of `man`.
#[derive(Args, Debug)]
pub struct Man {
    /// The folder that the pages go to
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
}

/// Arguments of `new`.
#[derive(Args, Debug)]
pub struct New {
    /// The name of the crate and of its folder
    pub name: String,
    /// Depend on the checkout of bricard in this folder [default: the one that this command
    /// was built from or is called in, if it is there, else the published packages]
    #[arg(long, value_name = "DIR")]
    pub path: Option<PathBuf>,
}

/// Arguments of `export`.
#[derive(Args, Debug)]
pub struct Export {
    /// A mechanism of the library, or the file of a description (FILE.mech)
    #[arg(value_name = "NAME|FILE.mech")]
    pub subject: String,
    /// What to write
    #[arg(long, value_enum)]
    pub to: Target,
    /// Where it goes [default: here, with the name of the mechanism's file]
    #[arg(long, value_name = "DIR|FILE.fmu")]
    pub out: Option<PathBuf>,
}

/// What a mechanism is exported to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Target {
    /// A crate of generated Rust, readable and without a build script
    Rust,
    /// A shared and a static library with headers, pkg-config and CMake files, an example,
    /// and the sources to build them elsewhere
    C,
    /// An FMU of FMI 2.0, for model exchange and co-simulation: the file NAME.fmu
    Fmi2,
    /// An FMU of FMI 3.0, likewise
    Fmi3,
    /// A wheel for Python, NAME-0.1.0-….whl, which needs no compiler where it is installed
    Python,
    /// A WebAssembly module in a package for npm, for browsers and Node, with an example
    Wasm,
    /// The shared library alone, which stays among what was compiled; its path is printed
    Library,
}

/// Arguments of `passage`.
#[derive(Args, Debug)]
pub struct Passage {
    /// Mechanisms that pass a singular position: names of `bricard list`, or files of
    /// descriptions
    #[arg(value_name = "NAME|FILE.mech", default_values = ["slider_crank", "slider_crank_driven", "double_four_bar"])]
    pub names: Vec<String>,
    /// Integrators, with commas between them
    #[arg(long, value_enum, value_delimiter = ',', default_values = ["rk4", "dp5", "dop853"])]
    pub methods: Vec<MethodName>,
}

/// Arguments of `workprecision`.
#[derive(Args, Debug)]
pub struct WorkPrecision {
    /// The mechanism: a name of `bricard list`, or the file of a description
    #[arg(value_name = "NAME|FILE.mech")]
    pub name: String,
    /// Time at which runs end, in seconds
    #[arg(long, value_name = "T", default_value = "8", allow_hyphen_values = true, value_parser = formula::number)]
    pub until: f64,
    /// Integrators, with commas between them [default: all]
    #[arg(long, value_enum, value_delimiter = ',')]
    pub methods: Vec<MethodName>,
    /// Forms of the equations of motion, with commas between them [default: all]
    #[arg(long, value_enum, value_delimiter = ',')]
    pub forms: Vec<FormName>,
    /// Change a parameter, hold an input at a value, or give it a formula
    #[arg(long, value_name = "NAME=VALUE", value_parser = formula::settings)]
    pub set: Vec<Choice<Setting>>,
    /// Hold a coordinate, or a velocity der(NAME), at a value at the start (NAME=VALUE), or
    /// guess it (NAME~VALUE)
    #[arg(long, value_name = "NAME=VALUE", value_parser = formula::starts)]
    pub start: Vec<Choice<Assignment>>,
    /// Draw time over error
    #[arg(long, value_name = "FILE.svg|.png|.pdf")]
    pub out: Option<PathBuf>,
    /// Write the numbers behind the drawing
    #[arg(long, value_name = "FILE.csv")]
    pub csv: Option<PathBuf>,
}

/// Arguments of `reproduce`.
#[derive(Args, Debug)]
pub struct Reproduce {
    /// Where the figures go
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// Arguments of `validate`.
#[derive(Args, Debug)]
pub struct Validate {
    /// Leave out the problems that take long
    #[arg(long)]
    pub quick: bool,
    /// Where the tables go
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
}

/// Arguments of `simulate`.
#[derive(Args, Debug)]
#[command(after_help = "\
Values are in SI units and may be formulas of constants: 80*deg, pi/4, 1/100.
Put quotes around what has brackets, stars or ~: --start 'der(q1)=80*deg'.

Columns of the CSV: t, the coordinates by name, their velocities as der(NAME), then \
what --columns asks for. Numbers read back to the same bits.

Exit status: 0; 1 if the run failed and 130 if Ctrl-C ended it (the rows computed so \
far are kept); 2 if the command line is wrong.")]
pub struct Simulate {
    /// The mechanism: a name of `bricard list`, or the file of a description
    #[arg(value_name = "NAME|FILE.mech")]
    pub name: String,
    /// Time at which to stop, in seconds
    #[arg(long, value_name = "T", default_value = "10", allow_hyphen_values = true, value_parser = formula::number)]
    pub until: f64,
    /// Fixed step, in seconds [default of rk4: 0.01]
    #[arg(long, value_name = "h", allow_hyphen_values = true, value_parser = formula::number, conflicts_with_all = ["rtol", "atol"])]
    pub step: Option<f64>,
    /// Relative error per step that an adaptive method may make [default: 1e-9]
    #[arg(long, aliases = ["tol", "tolerance"], value_name = "r", allow_hyphen_values = true, value_parser = formula::number)]
    pub rtol: Option<f64>,
    /// Absolute error per step that it may make [default: the value of --rtol]
    #[arg(long, value_name = "a", allow_hyphen_values = true, value_parser = formula::number)]
    pub atol: Option<f64>,
    /// Integrator [default: rk4 with --step, else dop853]
    #[arg(long, value_enum)]
    pub method: Option<MethodName>,
    /// Form of the equations of motion
    #[arg(long, value_enum, default_value_t = FormName::Reduced)]
    pub form: FormName,
    /// What keeps the state on the constraints: projection, none, or
    /// baumgarte:ALPHA:BETA (1/s)
    #[arg(long, value_name = "WAY", default_value = "projection", value_parser = stabilisation)]
    pub stabilisation: Stabilisation<f64>,
    /// Keep the energy of a conservative mechanism at what it is at the start, for
    /// long runs
    #[arg(long)]
    pub keep_energy: bool,
    /// Pass singular positions as published, by a decision on the rank alone (less
    /// accurate; for comparison)
    #[arg(long, alias = "no-branch-rows")]
    pub published: bool,
    /// Integrate across jumps and kinks of forces and points of splines, instead of ending
    /// steps where they are (less accurate; for forces that change sides more often than is
    /// worth a step)
    #[arg(long)]
    pub across_switches: bool,
    /// Distance of the rows in time, in seconds [default: a row after each step; by an adaptive
    /// method for a plot T/1000, or 0.05 s if that is less and the rows are for the plot alone, for
    /// a page or film 0.01 s, with 1001 rows at least and 6001 at most]
    #[arg(long, value_name = "dt", allow_hyphen_values = true, value_parser = formula::number)]
    pub every: Option<f64>,
    /// Change a parameter, or hold an input at a value; several values with commas between
    /// them give a run each, compared in one picture
    #[arg(long, value_name = "NAME=VALUE", value_parser = formula::settings)]
    pub set: Vec<Choice<Setting>>,
    /// Hold a coordinate, or a velocity der(NAME), at a value at the start (NAME=VALUE), or
    /// guess it (NAME~VALUE); several values as for --set
    #[arg(long, value_name = "NAME=VALUE", value_parser = formula::starts)]
    pub start: Vec<Choice<Assignment>>,
    /// Columns to add, with commas between them: energy, kinetic, potential,
    /// constraint_error, velocity_error, rank, reactions, accelerations, inputs, or outputs,
    /// inputs and multipliers by name
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = listed)]
    pub columns: Vec<String>,
    /// Where the rows go [default: standard output, or nowhere with --plot]
    #[arg(long, value_name = "FILE.csv|.parquet")]
    pub out: Option<PathBuf>,
    /// Where checkpoints of the run go; --resume goes on from them
    #[arg(long, value_name = "FILE")]
    pub checkpoint: Option<PathBuf>,
    /// Go on from a checkpoint, to the same bits as without the interruption; rows are
    /// added to those of --out
    #[arg(long, value_name = "FILE", conflicts_with = "plot")]
    pub resume: Option<PathBuf>,
    /// Draw coordinates and added columns over time; as .html, a page on which the mechanism
    /// moves
    #[arg(long, value_name = "FILE.html|.svg|.png|.pdf")]
    pub plot: Option<PathBuf>,
    /// What --plot draws over time, with commas between them: coordinates, velocities
    /// der(NAME), columns [default: all]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_parser = listed,
        requires = "plot",
        conflicts_with = "phase"
    )]
    pub curves: Vec<String>,
    /// Make --plot draw one quantity over another, instead of over time
    #[arg(long, value_name = "X,Y", value_parser = pair, requires = "plot")]
    pub phase: Option<[String; 2]>,
    /// Put the mechanism itself into the page of --plot, with sliders for its parameters,
    /// inputs and start that change the motion there
    #[arg(long, requires = "plot")]
    pub live: bool,
    /// Film the mechanism: a moving picture (.gif), or a strip of configurations
    #[arg(
        long,
        value_name = "FILE.gif|.svg|.png|.pdf",
        conflicts_with = "resume"
    )]
    pub film: Option<PathBuf>,
    /// Draw --plot or the strip of --film for print, so wide: single (88 mm), double
    /// (180 mm), or a length such as 120mm, 12cm, 5in
    #[arg(long, value_name = "WIDTH", allow_hyphen_values = true, value_parser = width)]
    pub width: Option<f64>,
    /// Say nothing but errors: no summary, no warnings, nothing of what is compiled
    #[arg(long)]
    pub quiet: bool,
    /// Print the summary as one JSON object to standard output
    #[arg(long)]
    pub json: bool,
}

/// The shells by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShellName {
    /// Bourne Again Shell
    Bash,
    /// Elvish
    Elvish,
    /// Fish
    Fish,
    /// PowerShell
    #[value(name = "powershell")]
    PowerShell,
    /// Z Shell
    Zsh,
}

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodName {
    /// Classical Runge–Kutta of order 4, always of fixed step
    Rk4,
    /// Dormand–Prince 5(4)
    Dp5,
    /// Dormand–Prince 8(5,3)
    Dop853,
    /// Radau IIA of order 5, implicit: for stiff mechanisms
    Radau5,
    /// Radau IIA of order 9, implicit: for stiff mechanisms, to many digits
    Radau9,
}

/// The forms of the equations of motion by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum FormName {
    /// Null space; passes singular positions
    Reduced,
    /// Least squares for accelerations and reactions at once; passes singular
    /// positions
    Full,
    /// Lagrange multipliers; ends at a singular position
    Multipliers,
    /// Independent and dependent coordinates; ends at a singular position
    Partitioning,
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Rk4 => Method::Rk4,
            MethodName::Dp5 => Method::Dp5,
            MethodName::Dop853 => Method::Dop853,
            MethodName::Radau5 => Method::Radau5,
            MethodName::Radau9 => Method::Radau9,
        }
    }
}

impl From<FormName> for Form {
    fn from(name: FormName) -> Self {
        match name {
            FormName::Reduced => Form::Reduced,
            FormName::Full => Form::Full,
            FormName::Multipliers => Form::Multipliers,
            FormName::Partitioning => Form::Partitioning,
        }
    }
}

/// Reads the names of two quantities.
fn pair(text: &str) -> Result<[String; 2], String> {
    let names: Vec<String> = text
        .split(',')
        .map(|name| name.trim().to_string())
        .collect();
    let refused = |_| "write two names with a comma between them, such as `q1,der(q1)`";
    let pair: [String; 2] = names.try_into().map_err(refused)?;
    match pair.iter().any(String::is_empty) {
        true => Err("a name is missing beside the comma".to_string()),
        false => Ok(pair),
    }
}

/// Reads a name in a list.
fn listed(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("a name is missing: write for example `energy,rank`".to_string()),
        _ => Ok(text.to_string()),
    }
}

/// What was probably meant by a word.
fn meant(word: &str, known: &[&str]) -> String {
    let nearest = nearest(word, known.iter().copied());
    nearest.map_or(String::new(), |word| format!("; did you mean `{word}`?"))
}

/// Reads the width of a picture in print (mm).
fn width(text: &str) -> Result<f64, String> {
    let units = [("mm", 1.0), ("cm", 10.0), ("in", 25.4), ("pt", 25.4 / 72.0)];
    let length = |(unit, size): &(&str, f64)| {
        let number: f64 = text.strip_suffix(unit)?.trim().parse().ok()?;
        Some(number * size)
    };
    let width = match text {
        "single" => Some(SINGLE),
        "double" => Some(DOUBLE),
        _ => units.iter().find_map(length),
    };
    let width = width.ok_or_else(|| {
        format!(
            "write `single` (88 mm), `double` (180 mm), or a length in mm, cm, in or pt, such as \
             `120mm`{}",
            meant(text, &["single", "double"])
        )
    })?;
    match WIDTHS.contains(&width) {
        true => Ok(width),
        false => Err(format!(
            "a picture is from {} to {} mm wide",
            WIDTHS.start(),
            WIDTHS.end()
        )),
    }
}

/// Reads `projection`, `none` or `baumgarte:ALPHA:BETA`.
fn stabilisation(text: &str) -> Result<Stabilisation<f64>, String> {
    let gain = |text: &str| match formula::number(text)? {
        gain if gain > 0.0 => Ok(gain),
        gain => Err(format!("a gain must be positive, not {gain}")),
    };
    match text.split(':').collect::<Vec<_>>()[..] {
        ["projection"] => Ok(Stabilisation::Projection),
        ["none"] => Ok(Stabilisation::None),
        ["baumgarte", alpha, beta] => Ok(Stabilisation::Baumgarte {
            alpha: gain(alpha)?,
            beta: gain(beta)?,
        }),
        _ => Err(format!(
            "write `projection`, `none` or `baumgarte:ALPHA:BETA`, such as `baumgarte:10:10`{}",
            meant(text, &["projection", "none"])
        )),
    }
}
