//! Parquet files hold what CSV files do.

use crate::command::{bricard, check_refused, folder, words};
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
        bricard(&[&["simulate", "double_four_bar"], &options[..]].concat()).done();
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

#[test]
fn parquet_that_cannot_be_written_is_found_out_before_the_run() {
    let missing = words("simulate slider_crank --out /nonexistent/run.parquet");
    check_refused(&missing, 1, &["could not write /nonexistent/run.parquet"]);
}
