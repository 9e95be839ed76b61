//! A Taylor series method beside DOP853, on the exact reductions of the paper's examples:
//! what an integrator of that kind could win.
//!
//! For each problem the cheapest setting of either method that ends within 1e-12 of the
//! exact angle, relative where it is more than one; instructions by callgrind.

mod series;

use beside::Reduced;
use bricard_runtime::{Method, StepControl};
use bricard_testkit::Reduction;
use bricard_testkit::callgrind::counted;
use std::error::Error;
use std::f64::consts::FRAC_PI_4;
use std::hint::black_box;

type Failed = Box<dyn Error>;

/// Error at the end.
const WANTED: f64 = 1e-12;
/// Times a run is made, so that what is done once drops out.
const ROUNDS: [u32; 2] = [1, 5];

/// A motion from rest, and its end by collocation of order 20 with 34 digits.
struct Problem {
    name: &'static str,
    reduction: Reduction,
    start: f64,
    span: f64,
    end: f64,
}

const PROBLEMS: [Problem; 3] = [
    Problem {
        name: "slider–crank",
        reduction: Reduction::SLIDER_CRANK,
        start: FRAC_PI_4,
        span: 8.0,
        end: -1.962_686_419_093_815_3,
    },
    Problem {
        name: "driven slider–crank",
        reduction: Reduction::SLIDER_CRANK_DRIVEN,
        start: FRAC_PI_4,
        span: 20.0,
        end: 89.830_891_650_147_32,
    },
    Problem {
        name: "double four-bar",
        reduction: Reduction::DOUBLE_FOUR_BAR,
        start: 80.0 * std::f64::consts::PI / 180.0,
        span: 8.0,
        end: -1.528_710_001_192_138_2,
    },
];

/// How a motion is computed.
#[derive(Clone, Copy, Debug)]
struct Setting {
    /// The order of a Taylor series; zero for DOP853.
    order: usize,
    tolerance: f64,
}

fn end(problem: &Problem, setting: Setting) -> Result<f64, Failed> {
    let Setting { order, tolerance } = setting;
    if order > 0 {
        let start = (problem.start, 0.0);
        let ((angle, _), _) =
            series::after(&problem.reduction, start, problem.span, (tolerance, order));
        return Ok(angle);
    }
    let control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    Reduced(problem.reduction).after(problem.span, problem.start, (Method::Dop853, control))
}

fn collected(index: usize, setting: Setting, rounds: u32) -> Result<f64, Failed> {
    let Setting { order, tolerance } = setting;
    counted(&[
        &index.to_string(),
        &order.to_string(),
        &tolerance.to_string(),
        &rounds.to_string(),
    ])
}

/// The fewest instructions of some settings that are accurate enough.
fn cheapest(
    index: usize,
    settings: impl Iterator<Item = Setting>,
) -> Result<Option<(Setting, f64, f64)>, Failed> {
    let problem = &PROBLEMS[index];
    let mut best: Option<(Setting, f64, f64)> = None;
    for setting in settings {
        let error = (end(problem, setting)? - problem.end).abs() / problem.end.abs().max(1.0);
        if error > WANTED {
            continue;
        }
        let [few, many] = ROUNDS;
        let more = collected(index, setting, many)? - collected(index, setting, few)?;
        let count = more / f64::from(many - few);
        if best.is_none_or(|(_, _, least)| count < least) {
            best = Some((setting, error, count));
        }
    }
    Ok(best)
}

fn table() -> Result<(), Failed> {
    println!("| problem | method | order, tolerance | error | instructions |");
    println!("|---|---|---|--:|--:|");
    for (index, problem) in PROBLEMS.iter().enumerate() {
        let tolerances = || (0..14).map(|k| 4e-11 * 0.5_f64.powi(k));
        let runge_kutta = tolerances().map(|tolerance| Setting {
            order: 0,
            tolerance,
        });
        let orders = [14, 18, 22, 26, 30];
        let taylor = orders.into_iter().flat_map(|order| {
            let small = (0..7).map(|k| 1e-10 * 0.1_f64.powi(k));
            small.map(move |tolerance| Setting { order, tolerance })
        });
        let ours = cheapest(index, runge_kutta)?;
        let series = cheapest(index, taylor)?;
        for (method, found) in [("DOP853", ours), ("Taylor", series)] {
            match found {
                Some((Setting { order, tolerance }, error, count)) => println!(
                    "| {} | {method} | {order}, {tolerance:.1e} | {error:.1e} | {count:.0} |",
                    problem.name
                ),
                None => println!("| {} | {method} | – | – | – |", problem.name),
            }
        }
    }
    Ok(())
}

fn main() -> Result<(), Failed> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let [index, order, tolerance, rounds] = words[..] else {
        return table();
    };
    let problem = PROBLEMS
        .get(index.parse::<usize>()?)
        .ok_or("there is no such problem")?;
    let setting = Setting {
        order: order.parse()?,
        tolerance: tolerance.parse()?,
    };
    for _ in 0..rounds.parse()? {
        black_box(end(problem, setting)?);
    }
    Ok(())
}
