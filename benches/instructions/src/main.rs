//! Instruction counts of generated code, beside hand-written code and recorded figures.
//!
//! `short` (the default) checks against `benches/recorded.json`, `long` counts
//! everything, `size` measures straight lines beside loops; `--record` replaces the recorded
//! figures, `table` writes them to `docs/instructions.md`.

mod callgrind;
mod kernel;
mod kernels;
mod page;
mod peers;
mod recorded;
mod report;
mod size;

use bricard_testkit::callgrind::is_there;
use recorded::Recorded;
use report::Counts;
use std::error::Error;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words[..] {
        ["kernel", name, rounds] => {
            let rounds = rounds.parse()?;
            let name = name.to_string();
            on_a_large_stack(move || {
                kernel::run(&name, rounds).map_err(|error| error.to_string())
            })?;
            Ok(ExitCode::SUCCESS)
        }
        ["size"] => {
            print!("{}", size::table()?);
            Ok(ExitCode::SUCCESS)
        }
        ["size", "--record"] => {
            page::record_forms(&size::table()?)?;
            Ok(ExitCode::SUCCESS)
        }
        [] | ["short"] => measure(kernels::SHORT.to_vec(), false),
        ["short", "--record"] => measure(kernels::SHORT.to_vec(), true),
        ["long", ..] if !cfg!(feature = "long") => Err("build it with `--features long`".into()),
        ["long"] => measure([kernels::SHORT, kernels::LONG].concat(), false),
        ["long", "--record"] => measure([kernels::SHORT, kernels::LONG].concat(), true),
        ["table"] => {
            page::write(&Recorded::read()?)?;
            Ok(ExitCode::SUCCESS)
        }
        ["count", ref kernels @ .., "--record"] => measure(kernels.to_vec(), true),
        ["count", ref kernels @ ..] => measure(kernels.to_vec(), false),
        _ => Err(
            "write `short`, `long`, or `count KERNEL…`, each with `--record` or without, `size`, or `table`"
                .into(),
        ),
    }
}

/// The matrices of long rows do not fit into the stack that a program begins with.
const STACK: usize = 1 << 28;

fn on_a_large_stack(
    work: impl FnOnce() -> Result<(), String> + Send + 'static,
) -> Result<(), Box<dyn Error>> {
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(work)?;
    let result = thread.join().map_err(|_| "the kernel panicked")?;
    Ok(result?)
}

fn measure(kernels: Vec<&str>, record: bool) -> Result<ExitCode, Box<dyn Error>> {
    if !is_there() {
        println!(
            "skipped: instructions are counted by valgrind, which is not installed (apt-get install valgrind)"
        );
        return Ok(ExitCode::SUCCESS);
    }
    let mut recorded = Recorded::read()?;
    let (mut counts, mut worse) = (Counts::new(), Vec::new());
    for kernel in kernels {
        eprintln!("counting {kernel}");
        match callgrind::instructions(kernel)? {
            Some(count) => {
                if recorded.is_worse(kernel, count) {
                    worse.push(format!(
                        "{kernel}: {count:.1}, recorded {:.1}",
                        recorded.of(kernel).unwrap_or(0.0)
                    ));
                }
                counts.insert(kernel.to_string(), count);
            }
            None => println!("{kernel}: this valgrind does not know an instruction of it\n"),
        }
    }
    print!(
        "{}{}{}",
        report::counts(&counts, Some(&recorded)),
        report::peers(&counts),
        report::growth(&counts)
    );
    if record {
        counts
            .iter()
            .for_each(|(kernel, count)| recorded.set(kernel, *count));
        page::write(&recorded)?;
        recorded.write()?;
        return Ok(ExitCode::SUCCESS);
    }
    if !page::is_current(&recorded)? {
        worse.push("docs/instructions.md says something else than recorded.json: `table`".into());
    }
    if worse.is_empty() {
        return Ok(ExitCode::SUCCESS);
    }
    println!("\nnot as recorded, by more than 3 %:\n{}", worse.join("\n"));
    println!("if that is meant, record it in the same commit: `short --record`, `long --record`");
    Ok(ExitCode::FAILURE)
}
