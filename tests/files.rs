//! The kinds of file that a run writes.

use crate::command::{bricard, check_refused, command, end, folder, start, wait_until, words};
use std::fs;
use std::path::Path;

/// Simulates the slider-crank for a second into a file of a folder of its own; the file's
/// bytes.
fn drawn(name: &str, options: &[&str]) -> Vec<u8> {
    let folder = folder(&name.replace('.', "_"));
    let path = folder.join(name);
    let text = path.to_string_lossy();
    let run = ["simulate", "slider_crank", "--until", "1"];
    let ran = bricard(&[&run[..], options, &[&text]].concat());
    assert_eq!(ran.status, Some(0), "{}", ran.err);
    assert_eq!(ran.out, "");
    let names = fs::read_dir(&folder).expect("a folder");
    assert_eq!(names.count(), 1, "something else was left behind");
    fs::read(&path).expect("a file")
}

#[test]
fn a_page_is_whole_and_needs_nothing_else() {
    let page = String::from_utf8(drawn("a<b.html", &["--plot"])).expect("text");
    let start = "<!DOCTYPE html>\n<html lang=\"en\">";
    assert!(page.starts_with(start) && page.ends_with("</html>\n"));
    assert!(page.contains("<title>SliderCrank</title>"));
    for elsewhere in ["src=\"http", "href=\"http", "@import", "url("] {
        assert!(!page.contains(elsewhere), "{elsewhere}");
    }
}

#[test]
fn pictures_are_of_the_kind_that_their_names_say() {
    let png = drawn("run.png", &["--plot"]);
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    let pdf = drawn("run.pdf", &["--plot"]);
    assert!(pdf.starts_with(b"%PDF-"));
    // Its letters are letters, of a font that it brings along.
    let has = |what: &[u8]| pdf.windows(what.len()).any(|part| part == what);
    assert!(has(b"/FontFile") && has(b"DejaVu"));
    let gif = drawn("film.gif", &["--film"]);
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(b";"));
    let frames = gif.windows(4).filter(|part| *part == b"\x21\xf9\x04\x04");
    let frames = frames.count();
    assert!(frames >= 25, "{frames} frames of a second");
    let strip = String::from_utf8(drawn("strip.svg", &["--film"])).expect("text");
    for caption in ["t = 0.00 s", "t = 0.40 s", "t = 1.00 s"] {
        assert!(strip.contains(caption), "no `{caption}`");
    }
    // Of few rows each is shown once, with its own time.
    let few = drawn("few.svg", &["--every", "0.3", "--film"]);
    let few = String::from_utf8(few).expect("text");
    let captions: Vec<&str> = few.split("t = ").skip(1).map(|x| &x[..6]).collect();
    assert_eq!(captions, ["0.00 s", "0.30 s", "0.60 s", "0.90 s", "1.00 s"]);
}

#[test]
fn a_picture_holds_the_chosen_curves_and_no_others() {
    let options = ["--curves", "q3,energy", "--plot"];
    let svg = String::from_utf8(drawn("chosen.svg", &options)).expect("text");
    for (name, there) in [("q3", true), ("energy [J]", true), ("angle [rad]", false)] {
        assert_eq!(svg.contains(name), there, "{name}");
    }
    let options = ["--phase", "q1,der(q1)", "--plot"];
    let svg = String::from_utf8(drawn("phase.svg", &options)).expect("text");
    assert!(svg.contains("q1 [rad]") && svg.contains("der(q1) [rad/s]"));
    assert!(!svg.contains("time t"));
}

/// Hundreds of oscillations in one picture: rows are close enough to show each, or their distance
/// is said to mislead; passages that would be a grey area are counted instead.
#[test]
fn a_picture_of_a_long_run_is_not_that_of_a_slow_motion() {
    let folder = folder("long_run");
    let [picture, rows] = ["run.svg", "run.csv"].map(|name| folder.join(name));
    let [picture, rows] = [&picture, &rows].map(|path| path.to_string_lossy().into_owned());
    let run = words("simulate double_four_bar --until 600 --rtol 1e-6");
    let alone = bricard(&[&run[..], &["--plot", &picture]].concat()).done();
    assert!(!alone.err.contains("warning"), "{}", alone.err);
    let drawn = fs::read_to_string(&picture).expect("a picture");
    assert!(drawn.contains(", not marked)"), "{drawn:.2000}");
    assert!(drawn.len() < 100_000, "{} bytes", drawn.len());
    let sparse = bricard(&[&run[..], &["--plot", &picture, "--out", &rows]].concat()).done();
    sparse.says(&["a row every 0.6 s, with"]);
    let count = fs::read_to_string(&rows).expect("rows").lines().count();
    assert_eq!(count, 1 + 1001);
}

#[test]
fn a_summary_as_json_says_what_was_done() {
    let path = folder("json").join("run.csv");
    let text = path.to_string_lossy();
    let run = words("simulate slider_crank --until 1 --json --quiet");
    let ran = bricard(&[&run[..], &["--out", &text]].concat());
    assert_eq!((ran.status, ran.err.as_str()), (Some(0), ""));
    let summary: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(summary["mechanism"], "SliderCrank");
    assert!(summary["steps"].as_u64() > Some(5));
    let passage = summary["passages"][0].as_f64().expect("a time");
    assert!((passage - 0.877).abs() < 1e-3, "{passage}");
    assert!(summary["error"].is_null());
    // Of a run that can't begin, too.
    let run = [&run[..], &["--set", "L1=7", "--out", &text]].concat();
    let ran = bricard(&run);
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    let summary: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(summary["steps"], 0);
    let error = summary["error"].as_str().expect("an error");
    assert!(ran.err.contains(error), "{error}");
}

#[test]
fn shells_and_the_manual_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ran = bricard(&["completions", shell]).done();
        assert!(ran.out.contains("simulate") && ran.out.contains("stabilisation"));
    }
    let folder = folder("manual");
    bricard(&["man", &folder.to_string_lossy()]).done();
    let page = fs::read_to_string(folder.join("bricard-simulate.1")).expect("a page");
    assert!(page.contains("stabilisation"));
}

#[cfg(unix)]
#[test]
fn rows_go_where_a_link_leads_also_to_a_file_that_is_not_there_yet() {
    use std::os::unix::fs::symlink;
    let folder = folder("links");
    let [rows, link, lost] = ["data.csv", "run.csv", "lost.csv"].map(|name| folder.join(name));
    symlink("data.csv", &link).expect("the folder is ours");
    symlink("nowhere/x.csv", &lost).expect("the folder is ours");
    let run = words("simulate slider_crank --until 1 --quiet --out");
    let to = |path: &Path| [&run[..], &[&*path.to_string_lossy()]].concat().join(" ");
    for _ in 0..2 {
        bricard(&words(&to(&link))).done();
        assert!(link.is_symlink() && !rows.is_symlink());
        let text = fs::read_to_string(&rows).expect("rows");
        assert!(text.starts_with("t,q1,") && text.lines().count() > 5);
    }
    let said = ["it is a link to ", "nowhere/x.csv, and there is no folder "];
    check_refused(&words(&to(&lost)), 1, &said);
    assert!(lost.is_symlink());
}

#[cfg(unix)]
#[test]
fn rows_go_through_a_pipe_that_has_a_name() {
    use std::process::Command;
    let folder = folder("pipes");
    let pipe = folder.join("pipe");
    let made = Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()));
    let reader = start(Command::new("cat").arg(&pipe));
    let run = words("simulate slider_crank --until 1 --quiet --out");
    let mut running = start(command().args(run).arg(&pipe));
    wait_until("the end of the rows", || {
        running.try_wait().is_ok_and(|status| status.is_some())
    });
    assert_eq!(end(running).status, Some(0));
    let rows = end(reader).out;
    assert!(
        rows.starts_with("t,q1,") && rows.lines().count() > 5,
        "{rows}"
    );
}
