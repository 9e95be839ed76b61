//! Interrupted runs go on to the same bits, and equal commands give equal bits.

use crate::command::{
    Ran, bricard, check_refused, command, folder, interrupt, start, wait_until, words,
};
use std::fs;
use std::path::Path;

/// A run with fixed steps, one that follows a tolerance through singular positions, and
/// one whose rows lie within steps.
const RUNS: [&[&str]; 3] = [
    &["double_pendulum", "--until", "60", "--step", "0.002"],
    &[
        "double_four_bar",
        "--until",
        "150",
        "--method",
        "dp5",
        "--rtol",
        "1e-10",
    ],
    &[
        "furuta_pendulum",
        "--until",
        "300",
        "--rtol",
        "1e-12",
        "--every",
        "0.01",
    ],
];

/// Bytes of rows after which a run is interrupted: several segments.
const ENOUGH: u64 = 600_000;

fn run(arguments: &[&str], csv: &Path, more: &[&str]) -> Vec<String> {
    let csv = csv.to_string_lossy().into_owned();
    let all = ["simulate"].iter().chain(arguments).chain(more);
    let mut all: Vec<String> = all.map(|word| word.to_string()).collect();
    all.extend(["--out".to_string(), csv]);
    all
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_goes_on_to_the_same_bytes() {
    let folder = folder("resume");
    let [whole, parts, file, other] = [
        "whole.csv",
        "parts.csv",
        "run.checkpoint",
        "whole.checkpoint",
    ]
    .map(|f| folder.join(f));
    let [file, other] = [file, other].map(|path| path.to_string_lossy().into_owned());
    for arguments in RUNS {
        let _none_left = fs::remove_file(&file);
        bricard(&run(arguments, &whole, &["--checkpoint", &other])).done();
        let kept = run(arguments, &parts, &["--checkpoint", &file]);
        interrupted(&kept, &parts).says(&["the run can be taken up again"]);
        let torn = fs::read(&parts).expect("rows are kept");
        check_damaged(arguments, &folder, &file);
        check_passed(arguments, &folder, &file);
        let rows = String::from_utf8_lossy(&torn);
        check_other_tables(arguments, &folder, &file, &rows);
        let on = run(arguments, &parts, &["--resume", &file]);
        bricard(&on).done();
        let [one, two] = [&whole, &parts].map(|path| fs::read(path).expect("rows"));
        assert!(
            torn.len() < one.len(),
            "{arguments:?} was over before it was interrupted"
        );
        assert!(one == two, "{arguments:?}: the bytes differ");
    }
}

/// A run doesn't go on from a checkpoint in which something was changed or lost.
fn check_damaged(arguments: &[&str], folder: &Path, file: &str) {
    let text = fs::read_to_string(file).expect("a checkpoint is kept");
    let [damaged, rows] = ["damaged.checkpoint", "damaged.csv"].map(|name| folder.join(name));
    let path = damaged.to_string_lossy().into_owned();
    let on = run(arguments, &rows, &["--resume", &path]);
    let half = &text[..text.len() / 2];
    let one_step_more = text.replacen("\"steps\": ", "\"steps\": 1", 1);
    for (text, said) in [(half, "no checkpoint"), (&one_step_more, "damaged")] {
        fs::write(&damaged, text).expect("a file can be written");
        check_refused(&on, 2, &["can't go on from", said]);
        assert!(!rows.exists(), "rows were written");
    }
}

/// Rows are added to the table of the run and to no other file, which stays as it is.
fn check_other_tables(arguments: &[&str], folder: &Path, file: &str, rows: &str) {
    let other = folder.join("other.csv");
    let on = run(arguments, &other, &["--resume", file]);
    let (header, values) = rows.split_once('\n').expect("lines");
    for (held, said) in [
        (None, "give the --out of the run that was interrupted"),
        (Some(rows[..rows.len() / 2].to_string()), "has lost rows"),
        (Some(values.repeat(2)), "does not hold the rows"),
        (
            Some(format!("{header}\n1{values}")),
            "does not hold the rows",
        ),
    ] {
        let _none_left = fs::remove_file(&other);
        if let Some(held) = &held {
            fs::write(&other, held).expect("a file can be written");
        }
        check_refused(&on, 2, &["can't go on from", said]);
        assert!(
            fs::read_to_string(&other).ok() == held,
            "{said}: it was touched"
        );
    }
}

/// A run doesn't go on to a time that it has passed.
fn check_passed(arguments: &[&str], folder: &Path, file: &str) {
    let mut early = arguments.to_vec();
    if let Some(until) = early.iter().position(|word| *word == "--until") {
        early[until + 1] = "0.5";
    }
    let rows = folder.join("early.csv");
    let on = run(&early, &rows, &["--resume", file]);
    check_refused(&on, 2, &["has come to t = ", "give a later --until"]);
    assert!(!rows.exists(), "rows were written");
}

/// Starts a run and presses Ctrl-C when some rows are written; what it says.
#[cfg(unix)]
fn interrupted(arguments: &[String], csv: &Path) -> Ran {
    let _none_left = fs::remove_file(csv);
    let child = start(command().args(arguments));
    wait_until("a segment", || {
        fs::metadata(csv).is_ok_and(|file| file.len() >= ENOUGH)
    });
    interrupt(child)
}

#[test]
fn checkpoints_with_fixed_steps_change_no_bit() {
    let folder = folder("checkpoint");
    let [plain, kept, file] = ["plain.csv", "kept.csv", "c"].map(|f| folder.join(f));
    let arguments = ["double_pendulum", "--until", "10", "--step", "0.002"];
    let file = file.to_string_lossy().into_owned();
    bricard(&run(&arguments, &plain, &[]));
    bricard(&run(&arguments, &kept, &["--checkpoint", &file]));
    let [one, two] = [plain, kept].map(|path| fs::read(path).expect("rows"));
    assert!(one == two);
}

/// What a finished run has left is enough for a later end, to the same bits.
#[test]
fn a_finished_run_can_be_prolonged_to_the_same_bytes() {
    let folder = folder("prolonged");
    let [whole, parts, file, other] =
        ["whole.csv", "parts.csv", "c", "d"].map(|name| folder.join(name));
    let [file, other] = [file, other].map(|path| path.to_string_lossy().into_owned());
    let until = |end| {
        [
            "furuta_pendulum",
            "--rtol",
            "1e-12",
            "--every",
            "0.03",
            "--until",
            end,
        ]
    };
    bricard(&run(&until("200"), &whole, &["--checkpoint", &other])).done();
    bricard(&run(&until("100.7"), &parts, &["--checkpoint", &file])).done();
    let other = ["--resume", &file, "--form", "full", "--set", "L=0.4"];
    let said = ["another run", "what differs: --set, --form\n"];
    check_refused(&run(&until("200"), &parts, &other), 2, &said);
    bricard(&run(&until("200"), &parts, &["--resume", &file])).done();
    let [one, two] = [whole, parts].map(|path| fs::read(path).expect("rows"));
    assert!(one == two, "the bytes differ");
    let short = ["slider_crank", "--until", "0.5"];
    let ran = bricard(&run(
        &short,
        &folder.join("short.csv"),
        &["--checkpoint", &file],
    ))
    .done();
    ran.says(&["no checkpoint was written"]);
}

#[test]
fn equal_commands_give_equal_bytes() {
    let arguments = words("simulate double_four_bar --until 8 --columns energy,reactions");
    let [one, two] = [(); 2].map(|()| bricard(&arguments).done());
    assert!(one.out.lines().count() > 100);
    assert_eq!(one.out, two.out);
}

#[test]
fn checkpoints_of_other_runs_are_refused() {
    let folder = folder("refused");
    let file = folder.join("c");
    let path = file.to_string_lossy().into_owned();
    let go_on = ["simulate", "pantograph", "--resume", &path];
    check_refused(&go_on, 1, &["could not read", "c:"]);
    for text in [&b""[..], b"rows", b"{}", b"[1,2]", b"\xff\xfe"] {
        fs::write(&file, text).expect("a file can be written");
        check_refused(&go_on, 2, &["can't go on from", "no checkpoint"]);
    }
    fs::write(&file, r#"{"format": 4, "run": "another"}"#).expect("a file can be written");
    check_refused(&go_on, 2, &["another run", "same mechanism and options"]);
}

/// What ends before the first checkpoint says so, and an old checkpoint is not offered.
#[test]
fn a_run_that_ends_before_its_first_checkpoint_says_so() {
    let folder = folder("resume-early");
    let file = folder.join("run.checkpoint").to_string_lossy().into_owned();
    let _none_left = fs::remove_file(&file);
    let rows = folder.join("rows.csv");
    // This form ends at the first singular position.
    let arguments: &[&str] = &["slider_crank", "--form", "multipliers", "--until", "5"];
    let ran = bricard(&run(arguments, &rows, &["--checkpoint", &file]));
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    ran.says(&["no checkpoint was written"]);
    check_refused(
        &run(arguments, &rows, &["--resume", &file]),
        1,
        &["there is no such file", "its first checkpoint"],
    );
}
