//! Counting instructions.
//!
//! In:  a kernel's name.
//! Out: instructions of one call in the steady state.
//!
//! The program runs itself under callgrind twice, with different numbers of rounds: the
//! difference is free of everything that is done once.

use crate::kernels;
use bricard_testkit::callgrind::collected;
use std::error::Error;

/// Rounds of the two runs.
const ROUNDS: [u64; 2] = [2, 10];

/// Instructions of one call of a kernel, the call itself and the loop around it taken
/// off; `None` if this valgrind does not know an instruction of it.
///
/// # Errors
///
/// A kernel that fails, valgrind without a count.
pub fn instructions(name: &str) -> Result<Option<f64>, Box<dyn Error>> {
    let around = match kernels::calls(name) {
        1 => Some(0.0),
        _ => per_call("slider_crank/call")?,
    };
    Ok(per_call(name)?
        .zip(around)
        .map(|(all, around)| all - around))
}

fn per_call(name: &str) -> Result<Option<f64>, Box<dyn Error>> {
    let [few, many] = if kernels::calls(name) == 1 {
        [1, 2]
    } else {
        ROUNDS
    };
    let calls = ((many - few) * kernels::calls(name)) as f64;
    let of = |rounds: u64| collected(&["kernel", name, &rounds.to_string()]);
    let counted = of(many)?.zip(of(few)?);
    Ok(counted.map(|(more, less)| (more - less) / calls))
}
