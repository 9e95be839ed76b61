//! The table of scores.
//!
//! In:  a series, what its trials came to.
//! Out: one line of the table, and the trials that were not right, so that they can be
//!      run again.

use crate::judge::Score;
use crate::series::Series;
use crate::workers::Ran;
use std::collections::BTreeMap;

/// Trials that are shown of a series.
const SHOWN: usize = 5;
/// Characters of an error that are shown.
const WIDTH: usize = 90;

/// One line of the table.
#[derive(Clone, Debug)]
pub struct Line {
    /// The name of the series.
    pub name: &'static str,
    /// How many trials there were.
    pub runs: usize,
    /// How many were right.
    pub right: usize,
    /// How many ended in an error, all rows right.
    pub ended: usize,
    /// How many were wrong.
    pub wrong: usize,
    /// How many of those that reached their end counted passages wrongly.
    pub miscounted: usize,
    /// The worst error of a right one.
    pub error: f64,
    /// The most frequent error, or complaint.
    pub why: String,
}

/// Sums a series up.
pub fn line(series: &Series, ran: &[Ran]) -> Line {
    let count = |score| ran.iter().filter(|ran| ran.verdict.score == score).count();
    let right = ran.iter().filter(|ran| ran.verdict.score == Score::Right);
    let mut reasons: BTreeMap<String, usize> = BTreeMap::new();
    for ran in ran.iter().filter(|ran| !ran.verdict.why.is_empty()) {
        *reasons
            .entry(without_numbers(&ran.verdict.why))
            .or_default() += 1;
    }
    let most = reasons.into_iter().max_by_key(|(_, count)| *count);
    Line {
        name: series.name,
        runs: ran.len(),
        right: count(Score::Right),
        ended: count(Score::Ended),
        wrong: count(Score::Wrong),
        miscounted: ran.iter().filter(|ran| ran.verdict.miscounted()).count(),
        error: right.map(|ran| ran.verdict.error).fold(0.0, f64::max),
        why: most.map_or(String::new(), |(why, count)| format!("{count} × {why}")),
    }
}

/// A message with its numbers left out, so that like ones are counted together.
fn without_numbers(text: &str) -> String {
    let number = |word: &str| word.trim_end_matches([';', ',']).parse::<f64>().is_ok();
    let words = text
        .split(' ')
        .map(|word| if number(word) { "…" } else { word });
    let text = words.collect::<Vec<_>>().join(" ");
    text.chars().take(WIDTH).collect()
}

/// The head of the table.
const HEAD: &str = "case                     runs  right  ended  wrong  miscounted    error";

/// Prints lines, and below each the trials that were not right.
pub fn print(lines: &[(Line, Vec<Ran>)], shown: bool) {
    println!("{HEAD}");
    for (line, ran) in lines {
        let Line {
            name,
            runs,
            right,
            ended,
            wrong,
            miscounted,
            error,
            why,
        } = line;
        println!(
            "{name:<23} {runs:>5}  {right:>5}  {ended:>5}  {wrong:>5}  {miscounted:>10}  {error:>7.1e}  {why}"
        );
        let bad = |ran: &&Ran| ran.verdict.score != Score::Right || ran.verdict.miscounted();
        let mut bad: Vec<&Ran> = ran.iter().filter(bad).filter(|_| shown).collect();
        bad.sort_by_key(|ran| match ran.verdict.score {
            Score::Wrong => 0,
            Score::Ended => 1,
            Score::Right => 2,
        });
        for Ran { trial, verdict } in bad.into_iter().take(SHOWN) {
            println!("    {:?}: {trial}", verdict.score);
            let counts = verdict.passages.filter(|_| verdict.miscounted());
            let counts = counts.map(|(found, exact)| format!("{found} passages, not {exact}"));
            println!("        {} {}", verdict.why, counts.unwrap_or_default());
        }
    }
}
