//! Holds what the firmware reports against the same run on the machine at hand.
//!
//! In:  `double` or `single`, the firmware, and the lines that it wrote.
//! Out: a table of what it needs; an error if the two runs differ or a bound is broken.

mod report;

use bare_metal::{Loop, MOST_EVALUATIONS, REPORTED, SPEED, TICKS};
use bricard_runtime::Real;
use object::{Object, ObjectSection, SectionKind};
use report::{Report, State, Ticks};
use std::collections::BTreeMap;
use std::error::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fs;

/// How far apart the two runs may be, in coordinates (m, rad) and velocities.
const AGREEMENT: f64 = 1e-12;
/// How far the crank (rad) may be, after fifty radians, from where `f64` has it.
const PRECISION: f64 = 1e-2;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [precision, firmware, lines] = arguments.as_slice() else {
        return Err("usage: compare double|single FIRMWARE LINES".into());
    };
    let report = Report::read(&fs::read_to_string(lines)?)?;
    println!("{precision} precision");
    match precision.as_str() {
        "double" => compare::<f64>(&report)?,
        "single" => compare::<f32>(&report)?,
        other => return Err(format!("`{other}` is neither double nor single").into()),
    }
    let (code, data) = sizes(&fs::read(firmware)?)?;
    println!("  code and constants {code:>9} bytes, console and start-up included");
    println!("  static variables   {data:>9} bytes");
    println!(
        "  stack              {:>9} bytes, of which the loop's variables are {}",
        report.stack, report.variables
    );
    describe("tick, regular", &report.regular);
    describe("tick, beside", &report.beside);
    let most = &report.most;
    println!(
        "  tick, longest      {:>9} instructions; {} evaluations, {MOST_EVALUATIONS} are granted",
        most.instructions, most.evaluations
    );
    println!(
        "  evaluation         {:>9} instructions at most, with all work that comes with it",
        most.each
    );
    Ok(())
}

/// The mean of some ticks.
fn describe(name: &str, ticks: &Ticks) {
    println!(
        "  {name:<18} {:>9} instructions and {} evaluations, the mean of {} ticks",
        ticks.instructions / ticks.count.max(1),
        ticks.evaluations / ticks.count.max(1),
        ticks.count
    );
}

/// Bytes of code and constants, and of variables.
fn sizes(firmware: &[u8]) -> Result<(u64, u64), object::Error> {
    let (mut code, mut data) = (0, 0);
    for section in object::File::parse(firmware)?.sections() {
        match section.kind() {
            SectionKind::Text | SectionKind::ReadOnlyData => code += section.size(),
            SectionKind::Data | SectionKind::UninitializedData => data += section.size(),
            _ => {}
        }
    }
    Ok((code, data))
}

/// Makes the same run here.
///
/// # Errors
///
/// What the runs differ in.
fn compare<T: Real>(report: &Report) -> Result<(), Box<dyn Error>> {
    let (here, most) = run::<T>()?;
    let (exact, _) = run::<f64>()?;
    if report.states.keys().ne(here.keys()) {
        return Err("the firmware reports states at other ticks".into());
    }
    let (mut apart, mut off) = (0.0_f64, 0.0_f64);
    for (tick, there) in &report.states {
        for (there, here) in there.iter().zip(&here[tick]) {
            let distance = (there - here).abs();
            // A comparison with NaN is false, so that a distance that is NaN does not agree.
            let agrees = distance <= AGREEMENT;
            if !agrees {
                return Err(format!("tick {tick}: {there} there and {here} here").into());
            }
            apart = apart.max(distance);
        }
        off = off.max((there[0] - exact[tick][0]).abs());
    }
    if most != report.most.evaluations {
        let there = report.most.evaluations;
        return Err(format!("a tick takes {there} evaluations there and {most} here").into());
    }
    if off > PRECISION {
        return Err(format!("the crank is {off:e} rad off the run in f64").into());
    }
    let angle = here[&TICKS][0];
    let singular = ((angle + FRAC_PI_2) / PI).floor();
    println!("  the crank turns to {angle:.1} rad, through {singular} singular positions");
    let states = report.states.len();
    match apart > 0.0 {
        true => println!("  {states} states differ from those here by {apart:.0e}"),
        false => println!("  {states} states equal those here to the last bit"),
    }
    println!("  and the crank from that in f64 by {off:.0e} rad");
    Ok(())
}

/// All states and the most evaluations of a tick.
fn run<T: Real>() -> Result<(BTreeMap<u32, State>, u32), Box<dyn Error>> {
    let mut control = Loop::<T>::new(SPEED).ok_or("the engine can't be assembled")?;
    let mut states = BTreeMap::from([(0, control.state())]);
    let mut most = 0;
    for tick in 1..=TICKS {
        let evaluations = control.tick().map_err(|error| error.to_string())?;
        most = most.max(evaluations);
        if tick % REPORTED == 0 {
            states.insert(tick, control.state());
        }
    }
    Ok((states, most))
}
