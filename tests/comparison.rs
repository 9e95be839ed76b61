//! Several runs that differ in one value: each is the run that it would be alone, and all are
//! in one table, in one picture.

use crate::command::{bricard, check_refused, folder, words};
use std::fs;

/// The lengths that are compared.
const LENGTHS: [&str; 3] = ["0.4", "0.5", "0.6"];

#[test]
fn the_rows_of_each_run_are_those_of_the_run_alone_behind_its_value() {
    let folder = folder("comparison_rows");
    let path = |name: &str| folder.join(name).display().to_string();
    let run = ["simulate", "slider_crank", "--until", "1", "--out"];
    let all = [
        &run[..],
        &[&path("all.csv"), "--set", "L1=0.4,0.5,0.6", "--json"],
    ];
    let all = bricard(&all.concat()).done();
    let mut wanted = String::new();
    for (i, length) in LENGTHS.iter().enumerate() {
        let set = format!("L1={length}");
        bricard(&[&run[..], &[&path("one.csv"), "--set", &set]].concat()).done();
        let rows = fs::read_to_string(path("one.csv")).expect("the rows are written");
        let (header, rows) = rows.split_once('\n').expect("a header");
        if i == 0 {
            wanted += &format!("set(L1),{header}\n");
        }
        rows.lines()
            .for_each(|row| wanted += &format!("{length},{row}\n"));
        assert!(
            all.err.contains(&format!("L1 = {length}\nsteps")),
            "{}",
            all.err
        );
    }
    let rows = fs::read_to_string(path("all.csv")).expect("the rows are written");
    assert!(
        rows == wanted,
        "the table differs from the tables of the runs"
    );
    let runs: serde_json::Value = serde_json::from_str(&all.out).expect("an array");
    assert_eq!(runs.as_array().map(Vec::len), Some(3));
    assert_eq!(runs[1]["set"]["L1"], 0.5);
    assert_eq!(runs[1]["passages"].as_array().map(Vec::len), Some(1));
}

#[test]
fn a_picture_of_several_runs_has_a_curve_for_each_with_its_value() {
    let folder = folder("comparison_pictures");
    let path = |name: &str| folder.join(name).display().to_string();
    let run = ["simulate", "slider_crank", "--until", "1", "--quiet"];
    let starts = ["--start", "q1=30*deg,60*deg", "--plot"];
    for (file, more) in [
        ("a.svg", ["--curves", "q1,energy"]),
        ("b.svg", ["--phase", "q1,der(q1)"]),
        ("c.html", ["--curves", "q1"]),
    ] {
        let ran = bricard(&[&run[..], &starts, &[&path(file)], &more].concat());
        assert_eq!((ran.status, ran.err.as_str()), (Some(0), ""), "{file}");
    }
    let names = ["q1 = 0.5236", "q1 = 1.047"];
    let read = |name: &str| fs::read_to_string(path(name)).expect("the picture is written");
    for (file, times) in [("a.svg", 2), ("b.svg", 1)] {
        let svg = read(file);
        for name in names {
            assert_eq!(svg.matches(name).count(), times, "{name} in {file}");
        }
    }
    let page = read("c.html");
    let start = page.find("id=\"run\">").expect("the data") + 9;
    let data = page[start..].split("</script>").next().unwrap_or_default();
    let data: serde_json::Value = serde_json::from_str(data).expect("it is JSON");
    assert_eq!(data["moving"], names[0]);
    let series = data["panels"][0]["series"].as_array().expect("curves");
    let found: Vec<_> = series
        .iter()
        .map(|series| series["name"].as_str())
        .collect();
    assert_eq!(found, names.map(Some));
}

#[test]
fn a_run_that_fails_is_named_and_the_others_go_on() {
    let folder = folder("comparison_failure");
    let out = folder.join("rows.csv").display().to_string();
    let run = words("simulate slider_crank --form multipliers --until 2");
    let ran = bricard(&[&run[..], &["--set", "L1=0.5,0.4", "--out", &out]].concat());
    assert_eq!(ran.status, Some(1));
    ran.says(&[
        "1 of 2 runs ended early",
        "L1 = 0.5: at t = 0.87",
        "were written",
    ]);
    let rows = fs::read_to_string(out).expect("the rows are kept");
    assert!(
        rows.lines().any(|row| row.starts_with("0.4,2,")),
        "the second run"
    );
}

#[test]
fn lists_are_refused_where_they_make_no_sense() {
    let run = ["simulate", "slider_crank", "--set", "L1=0.4,0.5"];
    let cases: [(&[&str], &str); 4] = [
        (&["--start", "q1=1,2"], "`--set L1` and `--start q1`"),
        (&["--checkpoint", "c.txt"], "--checkpoint is of one run"),
        (&["--set", "L1=0.4"], "two values"),
        (&["--set", "L2=1,,2"], "missing beside a comma"),
    ];
    for (more, said) in cases {
        check_refused(&[&run[..], more].concat(), 2, &[said]);
    }
    let many = words("simulate slider_crank --plot x.svg --set L1=1,2,3,4,5,6,7,8");
    check_refused(&many, 2, &["seven runs", "asks for 8"]);
    let watch = ["watch", "x.mech", "--set", "L1=0.4,0.5"];
    check_refused(&watch, 2, &["`watch` shows one run"]);
}

#[test]
fn a_picture_for_print_has_its_width_and_its_letters_with_it() {
    let folder = folder("comparison_print");
    let path = |name: &str| folder.join(name).display().to_string();
    let run = words("simulate slider_crank --until 1 --quiet --plot");
    for (width, wanted) in [("single", "88.00mm"), ("12cm", "120.00mm")] {
        bricard(&[&run[..], &[&path("x.svg"), "--width", width]].concat()).done();
        let svg = fs::read_to_string(path("x.svg")).expect("it is written");
        assert!(svg.starts_with("<svg ") && svg.contains(&format!("width=\"{wanted}\"")));
        assert!(!svg.contains("<text"), "letters are outlines");
    }
    bricard(&[&run[..], &[&path("x.pdf"), "--width", "single"]].concat()).done();
    let pdf = fs::read(path("x.pdf")).expect("it is written");
    let pdf = String::from_utf8_lossy(&pdf);
    // 88 mm in points.
    assert!(pdf.contains("MediaBox [0 0 249.4"), "the width of the page");
    assert!(
        pdf.contains("/FontFile2") && pdf.contains("+DejaVuSans"),
        "the letters"
    );
    bricard(&[&run[..], &[&path("x.png"), "--width", "single"]].concat()).done();
    let png = fs::read(path("x.png")).expect("it is written");
    let pixels = u32::from_be_bytes([png[16], png[17], png[18], png[19]]);
    // 88 mm at 600 dots per inch.
    assert!(pixels.abs_diff(2079) <= 7, "{pixels}");
}

#[test]
fn a_width_that_nothing_has_is_refused() {
    let run = ["simulate", "slider_crank", "--width"];
    let cases: [(&[&str], &str); 5] = [
        (&["single"], "add `--plot run.pdf`"),
        (&["single", "--plot", "x.html"], "what moves"),
        (&["single", "--film", "x.gif"], "what moves"),
        (&["singel", "--plot", "x.svg"], "did you mean `single`?"),
        (&["8mm", "--plot", "x.svg"], "from 60 to 420 mm"),
    ];
    for (more, said) in cases {
        check_refused(&[&run[..], more].concat(), 2, &[said]);
    }
}
