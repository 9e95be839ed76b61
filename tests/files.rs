//! The kinds of file that a run writes.

use crate::command::{bricard, folder};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use std::fs::{self, File};

/// Names and rows of a CSV text.
fn of_csv(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut lines = text.lines().map(|line| line.split(','));
    let names = lines.next().into_iter().flatten().map(String::from);
    let numbers = |line: std::str::Split<'_, char>| {
        let number = |cell: &str| cell.parse().expect("a number");
        line.map(number).collect()
    };
    (names.collect(), lines.map(numbers).collect())
}

/// Names and rows of a Parquet file.
fn of_parquet(file: File) -> (Vec<String>, Vec<Vec<f64>>) {
    let reader = SerializedFileReader::new(file).expect("a Parquet file");
    let schema = reader.metadata().file_metadata().schema_descr_ptr();
    let names: Vec<String> = schema
        .columns()
        .iter()
        .map(|c| c.name().to_string())
        .collect();
    let rows = reader.get_row_iter(None).expect("rows").map(|row| {
        let row = row.expect("a row");
        let number = |i| row.get_double(i).expect("a double");
        (0..names.len()).map(number).collect()
    });
    (names.clone(), rows.collect())
}

#[test]
fn parquet_holds_the_same_names_and_bits_as_csv() {
    let folder = folder("parquet");
    let run = |file: &str| {
        let path = folder.join(file);
        let text = path.to_string_lossy();
        let options = ["--until", "2", "--columns", "energy,rank", "--out", &text];
        let ran = bricard(&[&["simulate", "double_four_bar"], &options[..]].concat());
        assert_eq!(ran.status, Some(0), "{}", ran.err);
        path
    };
    let csv = fs::read_to_string(run("run.csv")).expect("rows");
    let file = File::open(run("run.parquet")).expect("a file");
    let ((names, rows), (same_names, same_rows)) = (of_csv(&csv), of_parquet(file));
    assert_eq!(names, same_names);
    assert!(rows.len() > 10, "{} rows", rows.len());
    assert_eq!(rows, same_rows);
}

#[test]
fn a_run_that_fails_leaves_parquet_that_can_be_read() {
    let path = folder("parquet_kept").join("run.parquet");
    let text = path.to_string_lossy();
    let options = ["--form", "multipliers", "--step", "0.01", "--out", &text];
    let ran = bricard(&[&["simulate", "slider_crank"], &options[..]].concat());
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    let (_, rows) = of_parquet(File::open(&path).expect("a file"));
    assert!(
        ran.err.contains(&format!("the {} rows", rows.len())),
        "{}",
        ran.err
    );
}

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

#[test]
fn a_summary_as_json_says_what_was_done() {
    let path = folder("json").join("run.csv");
    let text = path.to_string_lossy();
    let run = [
        "simulate",
        "slider_crank",
        "--until",
        "1",
        "--json",
        "--quiet",
    ];
    let ran = bricard(&[&run[..], &["--out", &text]].concat());
    assert_eq!((ran.status, ran.err.as_str()), (Some(0), ""));
    let summary: serde_json::Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(summary["mechanism"], "SliderCrank");
    assert!(summary["steps"].as_u64() > Some(5));
    let passage = summary["passages"][0].as_f64().expect("a time");
    assert!((passage - 0.877).abs() < 1e-3, "{passage}");
    assert!(summary["error"].is_null());
}

#[test]
fn shells_and_the_manual_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let ran = bricard(&["completions", shell]);
        assert_eq!(ran.status, Some(0), "{}", ran.err);
        assert!(ran.out.contains("simulate") && ran.out.contains("stabilisation"));
    }
    let folder = folder("manual");
    let ran = bricard(&["man", &folder.to_string_lossy()]);
    assert_eq!(ran.status, Some(0), "{}", ran.err);
    let page = fs::read_to_string(folder.join("bricard-simulate.1")).expect("a page");
    assert!(page.contains("stabilisation"));
}
