//! Prints the table of scores.
//!
//! `cargo run --release -p bricard-singular -- [--runs N] [--seed S] [--only NAME]
//! [--index I] [--rtol R]... [--method M] [--brief]`

use bricard_runtime::Method;
use bricard_singular::{SERIES, Series, find, line, print, run_all};
use std::process::ExitCode;
use std::time::Instant;

/// What was asked for.
struct Asked {
    runs: Option<usize>,
    index: Option<usize>,
    seed: u64,
    only: Vec<String>,
    tolerances: Vec<f64>,
    method: Option<Method>,
    brief: bool,
}

fn main() -> ExitCode {
    match asked() {
        Ok(asked) => {
            show(&asked);
            ExitCode::SUCCESS
        }
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}

fn asked() -> Result<Asked, String> {
    let mut asked = Asked {
        runs: None,
        index: None,
        seed: 1,
        only: Vec::new(),
        tolerances: Vec::new(),
        method: None,
        brief: false,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(flag) = arguments.next() {
        if flag == "--brief" {
            asked.brief = true;
            continue;
        }
        let value = arguments.next().ok_or(format!("{flag} needs a value"))?;
        let wrong = |what: &str| format!("{flag} {value}: not {what}");
        match flag.as_str() {
            "--runs" => asked.runs = Some(value.parse().map_err(|_| wrong("a number"))?),
            "--index" => asked.index = Some(value.parse().map_err(|_| wrong("a number"))?),
            "--seed" => asked.seed = value.parse().map_err(|_| wrong("a number"))?,
            "--rtol" => asked
                .tolerances
                .push(value.parse().map_err(|_| wrong("a number"))?),
            "--method" => {
                let wrong = wrong("dp5, dop853, radau5 or radau9");
                asked.method = Some(method(&value).ok_or(wrong)?);
            }
            "--only" => asked.only.push(value),
            _ => {
                return Err(format!(
                    "{flag}: --runs N, --index I, --seed S, --only NAME, --rtol R, --method M, --brief"
                ));
            }
        }
    }
    Ok(asked)
}

/// The method of a name that chooses its steps by their error.
fn method(name: &str) -> Option<Method> {
    let all = [Method::Dp5, Method::Dop853, Method::Radau5, Method::Radau9];
    all.into_iter().find(|method| method.to_string() == name)
}

fn show(asked: &Asked) {
    let wanted = |series: &&Series| {
        // A whole name means that series alone, a part of one all that have it.
        let fits = |name: &String| match find(name) {
            Some(found) => found.name == series.name,
            None => series.name.contains(name.as_str()),
        };
        asked.only.is_empty() || asked.only.iter().any(fits)
    };
    println!("seed {}", asked.seed);
    let mut lines = Vec::new();
    for series in SERIES.iter().filter(wanted) {
        let begun = Instant::now();
        let first = 0..asked.runs.unwrap_or(series.runs);
        let runs = asked.index.map_or(first, |index| index..index + 1);
        let mut trials = series.trials(asked.seed, runs, &asked.tolerances);
        for trial in &mut trials {
            if let Some(method) = asked.method {
                (trial.method, trial.step) = (method, None);
            }
        }
        let ran = run_all(trials);
        eprintln!("{}: {:.1} s", series.name, begun.elapsed().as_secs_f64());
        lines.push((line(series, &ran), ran));
    }
    print(&lines, !asked.brief);
}
