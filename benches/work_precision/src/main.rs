//! Run time against error on the paper's mechanisms, beside diffsol and rapier, and a
//! scan of start angles.
//!
//! `work_precision [OUT [ANGLES]]` prints Markdown and draws a diagram for each
//! mechanism into the folder OUT (`target/work_precision`), with ANGLES (200) start
//! angles around the paper's. What the loops cost beside the motion in one coordinate follows,
//! and forty loops in a row, by the change of energy.

mod index_one;
mod joints;
mod ours;
mod plot;
mod problem;
mod reduced;
mod row;
mod run;
mod scan;
mod work;

use problem::Problem;
use run::Solver;
use scan::{Scan, Starts};
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use work::Point;

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let out = words
        .next()
        .map_or_else(|| PathBuf::from("target/work_precision"), PathBuf::from);
    let angles = words.next().map_or(Ok(200), |word| word.parse())?;
    fs::create_dir_all(&out)?;
    for problem in Problem::ALL {
        println!("## {}\n", problem.title());
        work_table(problem, &out)?;
        scan_table(problem, angles)?;
    }
    reduced::table()?;
    row::table()
}

/// Methods that the problem can be given to.
fn methods(problem: Problem) -> impl Iterator<Item = Solver> {
    let driven = problem == Problem::Driven;
    Solver::ALL
        .into_iter()
        .filter(move |method| !(driven && matches!(method, Solver::Rapier(_))))
}

fn work_table(problem: Problem, out: &Path) -> Result<(), Box<dyn Error>> {
    let exact = problem.exact(problem.nominal());
    println!("| method | setting | error of q₁ (rad) | processor time (ms) |\n|---|---|--:|--:|");
    let mut drawn = Vec::new();
    for method in methods(problem) {
        eprintln!("{}: {}", problem.title(), method.title());
        let mut right: Vec<Point> = Vec::new();
        for (setting, result) in work::points(problem, method, exact) {
            let named = format!("| {} | {} |", method.title(), method.setting(setting));
            match result {
                Ok(point) if point.off_branch => {
                    println!("{named} left the branch | {:.3} |", 1e3 * point.seconds)
                }
                Ok(point) => {
                    println!("{named} {:.1e} | {:.3} |", point.error, 1e3 * point.seconds);
                    right.push(point);
                }
                Err(reason) => println!(
                    "{named} stopped: {} | – |",
                    reason.lines().next().unwrap_or_default()
                ),
            }
        }
        drawn.push((method.title(), right));
    }
    let path = out.join(format!("{}.svg", problem.name()));
    plot::draw(&path, problem.title(), &drawn)?;
    println!("\ndiagram: {}\n", path.display());
    Ok(())
}

fn scan_table(problem: Problem, angles: u32) -> Result<(), Box<dyn Error>> {
    let starts = Starts::new(problem, angles);
    println!("{angles} start angles, the paper's ± 0.05 rad:\n");
    println!(
        "| method | setting | left the branch or stopped | median error | worst | worst / median |\n|---|---|--:|--:|--:|--:|"
    );
    for method in methods(problem) {
        for setting in method.scanned() {
            eprintln!(
                "{}: {} {}, {angles} start angles",
                problem.title(),
                method.title(),
                method.setting(setting)
            );
            let scan = Scan::new(problem, method, setting, &starts);
            let number = |value: Option<f64>| {
                value.map_or("–".to_string(), |value| format!("{value:.1e}"))
            };
            let ratio = scan
                .worst()
                .zip(scan.median())
                .map_or("–".to_string(), |(worst, median)| {
                    format!("{:.1}", worst / median)
                });
            let cells = [number(scan.median()), number(scan.worst()), ratio].join(" | ");
            println!(
                "| {} | {} | {} | {cells} |",
                method.title(),
                method.setting(setting),
                scan.failed
            );
        }
    }
    println!();
    Ok(())
}
