//! The files of a new crate.

use std::path::Path;

/// `Cargo.toml`; the dependencies come from a registry, or from a checkout.
pub fn manifest(name: &str, workspace: Option<&Path>) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let dependency = |package: &str| match workspace {
        // The debug format escapes like TOML's basic strings do.
        Some(folder) => format!("{{ path = {:?} }}", folder.join(package)),
        None => format!("\"{version}\""),
    };
    let (runtime, codegen) = (dependency("runtime"), dependency("codegen"));
    format!(
        "[package]
name = \"{name}\"
version = \"0.1.0\"
edition = \"2024\"

[dependencies]
bricard-runtime = {runtime}

[build-dependencies]
bricard-codegen = {codegen}

# Simulations are number crunching: some optimisation pays off in debug builds too.
[profile.dev]
opt-level = 1

[workspace]
"
    )
}

/// `build.rs`
pub fn build_script(module: &str) -> String {
    format!(
        "//! Compiles the mechanism. What is wrong with it is shown as errors of the build.

fn main() -> Result<(), bricard_codegen::BuildError> {{
    bricard_codegen::compile(\"mechanisms/{module}.mech\")
}}
"
    )
}

/// `src/main.rs`
pub fn program(module: &str, kind: &str) -> String {
    PROGRAM.replace("KIND", kind).replace("MODULE", module)
}

/// The description.
pub fn description(kind: &str) -> String {
    DESCRIPTION.replace("KIND", kind)
}

const PROGRAM: &str = r#"//! Simulates the mechanism of `mechanisms/MODULE.mech` for ten seconds.

use bricard_runtime::{Interface, Options, Recorder, assemble, simulate};
use std::error::Error;

// The module that the build script has made of the description.
bricard_runtime::include_mechanism!("MODULE");

fn main() -> Result<(), Box<dyn Error>> {
    // Parameters have the values of the description; this changes one.
    let mut mechanism = MODULE::KIND::<f64>::default();
    mechanism.parameters.spring = 30.0;

    // The guesses of `start` are moved until the constraints hold.
    let start = assemble(&mechanism, &mechanism.start(), 0.0)?;

    // Ten seconds by the Dormand–Prince method of order 8, to nine digits per step;
    // a row each half second.
    let options = Options::dop853(10.0, 1e-9);
    let mut recorder = Recorder::new(0.5)?;
    let summary = simulate(&mechanism, &start, &options, &mut [&mut recorder])?;

    println!("{:>6} {:>9} {:>9} {:>9}", "t", "crank", "rod", "slider");
    for state in recorder.rows() {
        let [crank, rod, slider] = state.q.into();
        println!("{:6.2} {crank:9.4} {rod:9.4} {slider:9.4}", state.t);
    }
    println!(
        "{} steps; the energy is off by {:.1e} J",
        summary.steps,
        summary.energy_error.unwrap_or_default()
    );
    Ok(())
}
"#;

const DESCRIPTION: &str = r#"/// A crank that turns against a spring: change it to what you want to simulate.
///
/// Doc comments like this one reach the generated code.
mechanism KIND {
    // Constants are folded into the code. Units behind `:` are checked, and may be
    // left out.
    const g: m/s^2 = 9.81;

    // Parameters are fields of the generated struct: a program can change them.
    /// length of the crank
    param r: m = 0.2;
    /// length of the connecting rod
    param L: m = 0.5;
    /// inertia of crank and flywheel
    param J: kg*m^2 = 0.05;
    /// mass of the connecting rod, spread evenly
    param m: kg = 0.5;
    /// mass of the slider
    param M: kg = 1;
    /// stiffness of the spring at the slider
    param spring: N/m = 40;

    // As many coordinates as are convenient; constraints say what ties them.
    /// angle of the crank, from the x axis
    coord crank: rad;
    /// angle of the rod, from the x axis
    coord rod: rad;
    /// position of the slider on the x axis
    coord slider: m;

    // Inputs have a law, which a program can replace.
    /// torque on the crank
    input torque: N*m = 0;

    // Names for what occurs more than once: numbers, points, matrices.
    let pin = r*[cos(crank), sin(crank)];
    let along = L*[cos(rod), sin(rod)];
    let centre = pin + along/2;

    // Energies add up. `der` is the derivative in time.
    kinetic 1/2*J*der(crank)^2;
    kinetic 1/2*m*norm2(der(centre)) + 1/24*m*L^2*der(rod)^2;
    kinetic 1/2*M*der(slider)^2;
    potential m*g*centre.y;
    potential 1/2*spring*(slider - L)^2;

    // The rod ends in the slider: one equation for each component.
    constraint pin + along = [slider, 0];

    force torque on crank;

    // `=` is held, `~` a guess that is near enough.
    start { crank = 30*deg; der(crank) = 12; rod ~ -10*deg; slider ~ 0.7; }

    // What to record, what to look for, and the picture.
    output work: W = torque*der(crank);
    event dead_centre: sin(crank) crossing;
    draw line([0, 0], pin, [slider, 0]);
    draw circle([slider, 0], 0.03);
}
"#;
