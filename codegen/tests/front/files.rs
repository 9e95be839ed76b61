//! Tables from files beside the description.

use super::with;
use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, compile_source};
use std::fs;
use std::path::PathBuf;

/// What is said of a table of a file with this text.
fn said(test: &str, data: &str, table: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("files_{test}"));
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("data.csv"), data).expect("a file");
    let source = with(&format!("force {table} on q;"));
    let settings = CompileSettings::beside(&folder.join("test.mech"));
    match analyse(&source, &settings) {
        Ok((mechanism, _)) => {
            assert_eq!(mechanism.files, [folder.join("data.csv")]);
            String::new()
        }
        Err(errors) => errors.render("test.mech", &source),
    }
}

#[test]
fn rows_may_be_parted_by_commas_semicolons_and_blanks() {
    let table = "table(\"data.csv\", t)";
    for (i, data) in [
        "0,1\n2,3\n",
        "t;f\n0;1\r\n2;3",
        "# a comment\n\n0 1\n 2   3 # here\n",
        "\u{feff}\"time\",\"force\"\n0,\"1\"\n2e0,3",
        "0\t1\n2\t3\n",
    ]
    .into_iter()
    .enumerate()
    {
        assert_eq!(said(&format!("parted{i}"), data, table), "", "{data}");
    }
}

#[test]
fn columns_are_found_by_their_names() {
    let data = "time,x,force\n0,5,1\n2,6,3\n";
    for table in [
        "table(\"data.csv\", t)",
        "table(\"data.csv\", \"force\", t)",
        "spline(\"data.csv\", \"x\", \"force\", q)",
    ] {
        assert_eq!(said("named", data, table), "", "{table}");
    }
    let wrong = said("named", data, "table(\"data.csv\", \"forse\", t)");
    assert!(wrong.contains("has no column `forse`"), "{wrong}");
    assert!(wrong.contains("did you mean `force`?"), "{wrong}");
    let twice = "time,v,force,v\n0,5,1,7\n2,6,3,8\n";
    let wrong = said("twice", twice, "table(\"data.csv\", \"v\", t)");
    assert!(wrong.contains("has `v` in its columns 2 and 4"), "{wrong}");
    assert_eq!(
        said("other", twice, "table(\"data.csv\", \"force\", t)"),
        ""
    );
    let bare = said("bare", "0,1\n1,2\n", "table(\"data.csv\", \"force\", t)");
    assert!(bare.contains("has no row of names"), "{bare}");
}

#[test]
fn what_is_wrong_with_a_file_is_told_with_its_line_and_column() {
    let table = "table(\"data.csv\", t)";
    for (i, (data, words)) in [
        ("", "`data.csv` is empty"),
        ("t,f\n0,1\n", "has fewer than two rows of numbers"),
        ("0,1\n1,abc\n", "line 2, column 2: `abc` is not a number"),
        ("0,1\n1,NaN\n", "line 2, column 2: `NaN` is not a number"),
        ("0,1\n\n1\n", "line 3, has no column 2"),
        (
            "0,1\n1,2\n1,3\n",
            "line 3: 1 stands behind 1, and these numbers have to rise",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        let message = said(&format!("wrong{i}"), data, table);
        assert!(message.contains(words), "no `{words}` in\n{message}");
    }
    let other = said("other", "0,1\n1,2\n", "table(\"date.csv\", t)");
    assert!(
        other.contains("`date.csv` can't be read: there is no such file"),
        "{other}"
    );
    let words = said("words", "0,1\n1,2\n", "table(\"data.csv\", t, q)");
    assert!(
        words.contains("columns are named by quoted text"),
        "{words}"
    );
    let text = said("text", "0,1\n1,2\n", "3*\"data.csv\"");
    assert!(text.contains("quoted text has no meaning here"), "{text}");
}

/// A file of so many rows.
fn rows(count: usize) -> String {
    let row = |i: usize| format!("{i},{}\n", i * i % 17);
    (0..count).map(row).collect()
}

#[test]
fn the_points_of_a_long_table_are_data_and_not_choices() {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("files_long");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("data.csv"), rows(1000)).expect("a file");
    let settings = CompileSettings::beside(&folder.join("test.mech"));
    for (function, conditions) in [("table", 10), ("spline", 1)] {
        let source = with(&format!("force {function}(\"data.csv\", t) on q;"));
        let code = compile_source(&source, "long", "test.mech", &settings)
            .expect("a right description")
            .code;
        let statements = code.matches("let ").count() + code.matches(" if ").count();
        assert!(statements < 100, "{statements} statements");
        assert_eq!(code.matches("Condition {").count(), conditions);
        assert_eq!(code.matches("TABLE_0: Table").count(), 1);
    }
}

/// How many conditions statements come to, beside a file of a thousand rows.
fn conditions(name: &str, statements: &str) -> usize {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("data.csv"), rows(1000)).expect("a file");
    let settings = CompileSettings::beside(&folder.join("test.mech"));
    let compiled = compile_source(&with(statements), "room", "test.mech", &settings);
    let code = compiled.expect("a right description").code;
    code.matches("Condition {").count()
}

#[test]
fn splines_take_a_condition_each_as_long_as_there_is_room() {
    let few = "spline([[0, 1], [1, 2], [3, 0]], 2*t + 1)";
    for (place, count, statements) in [
        ("alone", 1, format!("force {few} on q;")),
        ("rate", 1, format!("force {few} + der({few}) on q;")),
        (
            "place",
            1,
            format!("force {} on q;", few.replace("*t", "*q")),
        ),
        (
            "parameter",
            0,
            format!("param p = 1; force {} on q;", few.replace("*t", "*p")),
        ),
        ("constraint", 1, format!("constraint q = {few};")),
        ("output", 0, format!("output o = {few};")),
    ] {
        assert_eq!(
            conditions(&format!("files_{place}"), &statements),
            count,
            "{statements}"
        );
    }
    let table = |i: usize| format!("force table(\"data.csv\", t + {i}) on q;\n");
    let tables: String = (0..12).map(table).collect();
    let spline = |i: usize| format!("force spline(\"data.csv\", t + {i}) on q;\n");
    let splines: String = (0..10).map(spline).collect();
    assert_eq!(conditions("files_full", &(tables + &splines)), 128);
}

#[test]
fn tables_for_which_there_is_no_room_are_refused() {
    let many: String = (0..13)
        .map(|i| format!("force table(\"data.csv\", t + {i}) on q;\n"))
        .collect();
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("files_many");
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("data.csv"), rows(1000)).expect("a file");
    let settings = CompileSettings::beside(&folder.join("test.mech"));
    let source = with(&many);
    let errors = compile_source(&source, "many", "test.mech", &settings)
        .expect_err("more conditions than there is room for");
    let message = errors.render("test.mech", &source);
    let words = "130 conditions decide the forces, and there is room for 128";
    assert!(message.contains(words), "{message}");
    let longest = said("longest", &rows(100_001), "table(\"data.csv\", t)");
    assert!(
        longest.contains("has 100001 rows, and there is room for 100000"),
        "{longest}"
    );
}
