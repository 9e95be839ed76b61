//! What a person who writes mechanisms is given: `list`, `check --json`, `new`.

use crate::built;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn run(command: &mut Command) -> (Option<i32>, String, String) {
    let output = command.output().expect("the command starts");
    let Output { status, .. } = output;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (status.code(), text(&output.stdout), text(&output.stderr))
}

fn bricard(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bricard"));
    run(command.current_dir(folder).args(arguments))
}

/// An empty folder of one test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let folder = folder.join("authoring").join(test);
    let _nothing_there = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

#[test]
fn the_benchmark_problems_are_listed_and_shown_by_name_too() {
    let folder = folder("list");
    let (status, list, _) = bricard(&folder, &["list"]);
    assert_eq!(status, Some(0));
    let (library, benchmarks) = list
        .split_once("benchmark problems")
        .expect("two tables, the second with a heading");
    for name in bricard_benchmarks::NAMES {
        let begins = |line: &str| line.split_whitespace().next() == Some(name);
        assert!(benchmarks.lines().any(begins), "{name}\n{benchmarks}");
        assert!(!library.lines().any(begins), "{name}\n{library}");
    }
    let (status, shown, said) = bricard(&folder, &["show", "pendulum"]);
    assert_eq!(status, Some(0), "{said}");
    assert!(shown.contains("M[1,1]") || shown.contains("M["), "{shown}");
    let (status, _, said) = bricard(&folder, &["show", "pendulumm"]);
    assert_eq!(status, Some(2));
    assert!(said.contains("did you mean `pendulum`?"), "{said}");
}

/// Checks a description with `--json`.
fn checked(test: &str, source: &str) -> (Option<i32>, Value, String) {
    let folder = folder(test);
    fs::write(folder.join("a.mech"), source).expect("the folder is ours");
    let (status, out, said) = bricard(&folder, &["check", "a.mech", "--json"]);
    let report = serde_json::from_str(&out).unwrap_or_else(|error| panic!("{error}: {out}"));
    (status, report, said)
}

#[test]
fn every_message_of_check_is_there_as_json() {
    let source = "mechanism A {\n    coord q: rad;\n    coord q: m;\n    kinetic derr(q)^2;\n}\n";
    let (status, report, said) = checked("wrong", source);
    assert_eq!((status, said.as_str()), (Some(1), ""));
    assert_eq!(report["mechanism"], Value::Null);
    let twice = json!({
        "file": "a.mech",
        "line": 3,
        "column": 11,
        "end": { "line": 3, "column": 12 },
        "severity": "error",
        "message": "`q` is declared twice",
        "label": "declared again here",
        "labels": [{
            "line": 2,
            "column": 11,
            "end": { "line": 2, "column": 12 },
            "text": "declared here",
        }],
        "help": "choose another name for one of them",
    });
    let messages = report["messages"].as_array().expect("a list");
    assert_eq!(messages.len(), 2, "{report:#}");
    assert_eq!(messages[0], twice);
    assert_eq!(messages[1]["message"], "unknown function `derr`");
    assert_eq!(messages[1]["help"], "did you mean `der`?");
}

#[test]
fn what_is_in_order_is_said_to_be_so_with_its_warnings() {
    let source = "mechanism A { param a = 1; coord q; kinetic der(q)^2; }";
    let (status, report, said) = checked("right", source);
    assert_eq!((status, said.as_str()), (Some(0), ""));
    let mechanism =
        json!({ "name": "A", "coordinates": 1, "states": 0, "constraint_equations": 0 });
    assert_eq!(report["mechanism"], mechanism);
    assert_eq!(report["messages"][0]["severity"], "warning");
    assert_eq!(report["messages"][0]["message"], "`a` is never used");
}

#[test]
fn a_file_that_cannot_be_read_is_a_message_as_json() {
    let nothing = folder("none");
    let read = || {
        let (status, out, said) = bricard(&nothing, &["check", "a.mech", "--json"]);
        assert_eq!((status, said.as_str()), (Some(1), ""));
        let report: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(report["mechanism"], Value::Null);
        report["messages"][0].clone()
    };
    let missing = read();
    let said = missing["message"].as_str().unwrap_or("");
    assert!(said.contains("could not read a.mech"), "{missing:#}");
    assert_eq!(
        (&missing["line"], &missing["column"]),
        (&json!(1), &json!(1))
    );
    let latin = b"\xef\xbb\xbfmechanism A {\n    // \xc3\xb6 gr\xfc\xdfe\n}\n";
    fs::write(nothing.join("a.mech"), latin).expect("the folder is ours");
    let encoded = json!({
        "file": "a.mech",
        "line": 2,
        "column": 12,
        "end": { "line": 2, "column": 13 },
        "severity": "error",
        "message": "this is not UTF-8",
        "label": "",
        "labels": [],
        "help": "save the file as UTF-8",
    });
    assert_eq!(read(), encoded);
}

/// A new crate, in a folder of one test's own.
fn new(test: &str, name: &str) -> PathBuf {
    let folder = folder(test);
    let (status, said, error) = bricard(&folder, &["new", name]);
    assert_eq!(status, Some(0), "{error}");
    let description = format!("mechanisms/{}.mech", name.replace('-', "_"));
    assert!(said.contains(&description), "{said}");
    assert!(said.contains(env!("CARGO_MANIFEST_DIR")), "{said}");
    folder.join(name)
}

/// Runs the program of a new crate, which has to say what it should and nothing else.
fn simulates(program: &mut Command) {
    let (status, out, error) = run(program);
    assert_eq!(status, Some(0), "{error}");
    assert_eq!(error, "", "the build of a new crate warns");
    assert_eq!(out.lines().count(), 1 + 21 + 1, "{out}");
    assert!(out.contains("crank") && out.contains("J"), "{out}");
}

/// Compiles the program of a new crate without cargo, as its build script does.
fn compiled(made: &Path, module: &str) -> PathBuf {
    let description = made.join("mechanisms").join(module).with_extension("mech");
    let path = description.to_string_lossy();
    let (status, _, error) = bricard(made, &["check", &path]);
    assert_eq!((status, &*error), (Some(0), ""));
    let builder = bricard_codegen::Builder::new().out_dir(made);
    builder.compile(&description).expect("it is in order");
    let main = made.join("src/main.rs");
    let (status, _, error) = run(built::rustc(&main, made).env("OUT_DIR", made));
    assert_eq!((status, &*error), (Some(0), ""), "{module}");
    made.join("main")
}

#[test]
fn the_program_of_a_new_crate_simulates_its_mechanism() {
    let made = new("program", "my-engine");
    simulates(&mut Command::new(compiled(&made, "my_engine")));
}

/// The names of what the program uses.
#[test]
fn a_new_crate_may_be_called_as_what_its_program_uses() {
    for name in [
        "recorder",
        "options",
        "error",
        "interface",
        "simulate",
        "state",
    ] {
        compiled(&new(&format!("called_{name}"), name), name);
    }
}

#[test]
#[ignore = "long: builds a crate with all that it depends on"]
fn a_new_crate_builds_without_a_network_and_simulates() {
    simulates(&mut built::run(&new("new", "my-engine")));
}

#[test]
fn what_is_there_already_and_what_is_no_name_is_refused() {
    let folder = folder("refused");
    let mine = folder.join("mine");
    fs::create_dir(&mine).expect("the folder is ours");
    let (status, _, said) = bricard(&folder, &["new", "mine"]);
    assert_eq!(status, Some(1));
    assert!(said.contains("mine is there already"), "{said}");
    assert!(fs::read_dir(&mine).expect("it is there").next().is_none());
    let names = [
        "Engine",
        "2nd",
        "",
        "a b",
        "../up",
        "a/b",
        "type",
        "std",
        "f64",
        "test",
        "a__b",
        "a-",
        "a--b",
        "bricard_runtime",
        "größe",
    ];
    for name in names {
        let (status, _, said) = bricard(&folder, &["new", "--", name]);
        assert_eq!(status, Some(2), "{name}: {said}");
        assert!(said.contains("a crate can't be called"), "{name}: {said}");
        assert!(name.is_empty() || !folder.join(name).exists(), "{name}");
    }
    let (status, _, said) = bricard(&folder, &["new", "engine", "--path", "nowhere"]);
    assert_eq!(status, Some(2));
    assert!(said.contains("nowhere is no checkout of bricard"), "{said}");
    assert!(!folder.join("engine").exists());
}
