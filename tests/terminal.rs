//! The command at a terminal: nothing but its name, names that are nearly right, readers that
//! leave, colours.

use crate::command::{bricard, check_refused, folder};
use std::fs;
use std::process::{Command, Stdio};

#[test]
fn the_name_alone_tells_three_commands_to_begin_with() {
    let ran = bricard::<&str>(&[]);
    assert_eq!((ran.status, ran.err.as_str()), (Some(0), ""));
    let shown = ran
        .out
        .lines()
        .filter(|line| line.starts_with("  bricard "));
    assert_eq!(shown.count(), 3, "{}", ran.out);
    for line in ran
        .out
        .lines()
        .filter(|line| line.starts_with("  bricard "))
    {
        let word = line.split_whitespace().nth(1).unwrap_or_default();
        let help = bricard(&[word, "--help"]);
        assert_eq!(help.status, Some(0), "{line}");
    }
}

#[test]
fn every_name_that_is_nearly_right_is_answered_with_the_right_one() {
    let run = "simulate slider_crank";
    let cases = [
        ("simulat slider_crank", "simulate"),
        ("simulate slider_cranck", "slider_crank"),
        ("show slider_cranck", "slider_crank"),
        ("export slider_cranck --to c", "slider_crank"),
        ("workprecision slider_cranck", "slider_crank"),
        ("landing slider_cranck", "slider_crank"),
        ("run slider_cranck", "slider_crank"),
        ("export slider_crank --to rst", "rust"),
        ("completions bsh", "bash"),
        (&format!("{run} --methd rk4"), "--method"),
        (&format!("{run} --method dop835"), "dop853"),
        (&format!("{run} --form reducd"), "reduced"),
        (&format!("{run} --stabilisation projektion"), "projection"),
        (&format!("{run} --width singel --plot x.svg"), "single"),
        (&format!("{run} --columns enrgy"), "energy"),
        (&format!("{run} --plot x.svg --curves enrgy"), "energy"),
        (
            &format!("{run} --plot x.svg --phase q1,der(q11)"),
            "der(q1)",
        ),
        (&format!("{run} --set l1=1"), "L1"),
        (&format!("{run} --set l1=1,2"), "L1"),
        (&format!("{run} --start q11=1"), "q1"),
        (&format!("{run} --start der(q11)=1"), "der(q1)"),
    ];
    for (line, meant) in cases {
        let words: Vec<&str> = line.split(' ').collect();
        let ran = bricard(&words);
        assert_eq!(ran.status, Some(2), "{line}: {}", ran.err);
        let said = ran.err.replace(['`', '\''], "");
        let is_meant = said.contains(&format!("did you mean {meant}?"))
            || said.contains(&format!("exists: {meant}\n"));
        assert!(is_meant, "{line}: no `{meant}` in\n{}", ran.err);
    }
}

#[test]
fn a_file_that_is_not_there_is_answered_with_one_that_is_called_nearly_so() {
    let folder = folder("terminal_files");
    let there = folder.join("crane.mech");
    fs::write(&there, "mechanism Crane { coord q; kinetic der(q)^2; }").expect("it is ours");
    let wrong = folder.join("crain.mech").display().to_string();
    let meant = format!("did you mean `{}`?", there.display());
    for command in ["check", "simulate", "show"] {
        check_refused(&[command, &wrong], 1, &[&meant]);
    }
}

#[test]
fn whatever_prints_ends_quietly_when_its_reader_leaves() {
    for words in [
        &["list"][..],
        &["--help"],
        &["show", "andrews"],
        &["completions", "bash"],
        &["simulate", "slider_crank", "--quiet"],
        &["simulate", "slider_crank", "--quiet", "--set", "L1=0.4,0.5"],
    ] {
        let started = Command::new(env!("CARGO_BIN_EXE_bricard"))
            .args(words)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut child = started.expect("the command starts");
        drop(child.stdout.take());
        let ended = child.wait_with_output().expect("it ends");
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(
            (ended.status.code(), said.as_str()),
            (Some(0), ""),
            "{words:?}"
        );
    }
}

#[test]
fn colours_are_for_terminals_alone() {
    for words in [&["simulate", "nothing"][..], &["simulat"]] {
        let ran = bricard(words);
        assert!(ran.err.starts_with("error:"), "{}", ran.err);
        // CLICOLOR_FORCE plays the terminal.
        for (forced, quiet, coloured) in [("1", "", true), ("1", "1", false)] {
            let output = Command::new(env!("CARGO_BIN_EXE_bricard"))
                .args(words)
                .env("CLICOLOR_FORCE", forced)
                .env("NO_COLOR", quiet)
                .output();
            let said = output.expect("the command starts").stderr;
            assert_eq!(
                said.contains(&0x1b),
                coloured,
                "{words:?}, NO_COLOR={quiet}"
            );
        }
    }
}
