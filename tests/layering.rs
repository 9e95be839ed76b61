//! Stages import leftward only, no modules import one another in a circle, the runtime knows
//! no generator, and files, functions and traits stay small.

use crate::imports::{self, Imports};
use crate::source::{self, File};

/// The stages, each with those it may import; `expr` and `diagnostic` serve all.
const STAGES: [(&str, &[&str]); 8] = [
    ("expr", &[]),
    ("diagnostic", &[]),
    ("syntax", &["diagnostic", "expr"]),
    ("model", &["diagnostic", "expr", "syntax"]),
    ("derive", &["diagnostic", "expr", "model"]),
    ("lint", &["diagnostic", "expr", "model", "derive"]),
    ("optimise", &["diagnostic", "expr", "model", "derive"]),
    (
        "emit",
        &["diagnostic", "expr", "model", "derive", "optimise"],
    ),
];

/// The sources of packages, in which modules import one another in no circle.
const PACKAGES: [&str; 9] = [
    "benches/instructions/src",
    "benches/work_precision/src",
    "capi/src",
    "cli",
    "codegen/src",
    "driver/src",
    "reference/src",
    "runtime/src",
    "wasm/src",
];

const FILE_LINES: usize = 500;
const FRONT_PAGE_LINES: usize = 120;
const FUNCTION_LINES: usize = 60;
const TRAIT_METHODS: usize = 9;

/// Complains of everything at once.
fn none(complaints: Vec<String>) {
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

/// Complains of the files of some kind.
fn none_is(files: &[File], of_kind: impl Fn(&File) -> bool) {
    let found = files.iter().filter(|file| of_kind(file));
    none(found.map(|file| file.path.clone()).collect());
}

/// The stage that a file of the compiler belongs to.
fn stage(file: &File) -> Option<&str> {
    let inside = file.path.strip_prefix("codegen/src/")?;
    let name = inside.split(['/', '.']).next()?;
    STAGES
        .iter()
        .map(|(stage, _)| *stage)
        .find(|stage| *stage == name)
}

/// What the modules of a package import from one another.
fn imports_within(sources: &str) -> Imports {
    let module = |file: File| {
        let inside = file.path.strip_prefix(sources).unwrap_or(&file.path);
        (
            imports::module_of(inside.trim_start_matches('/')),
            file.text,
        )
    };
    imports::imports(source::files(&[sources]).into_iter().map(module))
}

#[test]
fn stages_import_only_stages_to_their_left() {
    let stage = |module: &[String]| {
        let found = STAGES
            .iter()
            .find(|(stage, _)| module.first().is_some_and(|m| m == stage));
        found.copied()
    };
    let mut complaints = Vec::new();
    for (module, targets) in imports_within("codegen/src") {
        let Some((here, allowed)) = stage(&module) else {
            continue;
        };
        for (there, _) in targets.iter().filter_map(|target| stage(target)) {
            if there != here && !allowed.contains(&there) {
                complaints.push(format!("{}: `{here}` imports `{there}`", module.join("::")));
            }
        }
    }
    none(complaints);
}

#[test]
fn modules_import_one_another_in_no_circle() {
    let mut complaints = Vec::new();
    for sources in PACKAGES {
        let imports = imports_within(sources);
        assert!(!imports.is_empty(), "{sources} has no modules");
        let circles = imports::circles(&imports).concat();
        complaints.extend(circles.iter().map(|said| format!("{sources}: {said}")));
    }
    none(complaints);
}

#[test]
fn every_folder_of_the_compiler_is_a_stage() {
    let outside = |file: &File| {
        let inside = file.path.strip_prefix("codegen/src/").unwrap_or(&file.path);
        inside.contains('/') && stage(file).is_none()
    };
    let files = source::files(&["codegen/src"]);
    none_is(&files, outside);
}

#[test]
fn the_runtime_never_names_the_compiler() {
    let names = |file: &File| file.code.contains("bricard_codegen");
    let files = source::files(&["runtime/src"]);
    assert!(!files.is_empty());
    none_is(&files, names);
    let manifest = source::read("runtime/Cargo.toml");
    assert!(
        !manifest.contains("codegen"),
        "runtime/Cargo.toml depends on the compiler"
    );
}

#[test]
fn the_compiler_never_names_the_runtime_but_in_what_it_emits() {
    let names = |file: &File| {
        file.code.contains("use bricard_runtime") && !file.path.starts_with("codegen/src/emit/")
    };
    let files = source::files(&["codegen/src"]);
    none_is(&files, names);
}

#[test]
fn the_engine_of_expressions_knows_no_mechanics() {
    let words = [
        "mass",
        "coordinate",
        "velocity",
        "acceleration",
        "coriolis",
        "constraint",
        "multiplier",
        "kinetic",
        "potential",
        "mechanism",
    ];
    let mut complaints = Vec::new();
    for file in source::files(&["codegen/src/expr"]) {
        let code = file.code.to_lowercase();
        let found = words.iter().filter(|word| code.contains(**word));
        complaints.extend(found.map(|word| format!("{}: `{word}`", file.path)));
    }
    none(complaints);
}

#[test]
fn files_stay_small() {
    let mut complaints = Vec::new();
    for file in source::files(&source::EVERYWHERE) {
        let limit = if file.path.ends_with("lib.rs") {
            FRONT_PAGE_LINES
        } else {
            FILE_LINES
        };
        if file.lines > limit {
            complaints.push(format!(
                "{}: {} lines, at most {limit}",
                file.path, file.lines
            ));
        }
    }
    none(complaints);
}

#[test]
fn functions_stay_small() {
    let mut complaints = Vec::new();
    for file in source::files(&source::EVERYWHERE) {
        for block in file.blocks("fn ") {
            if block.lines > FUNCTION_LINES {
                let (name, lines) = (block.name, block.lines);
                complaints.push(format!("{}: `{name}` has {lines} lines", file.path));
            }
        }
    }
    none(complaints);
}

#[test]
fn traits_stay_small() {
    // `Real` is the one list of the functions of the language, which is longer.
    let listed = ["Real"];
    let mut complaints = Vec::new();
    for file in source::files(&source::EVERYWHERE) {
        for block in file.blocks("trait ") {
            let methods = block.text.matches("fn ").count();
            if methods > TRAIT_METHODS && !listed.contains(&block.name.as_str()) {
                let name = block.name;
                complaints.push(format!("{}: `{name}` has {methods} methods", file.path));
            }
        }
    }
    none(complaints);
}

#[test]
fn every_file_begins_by_saying_what_it_is() {
    let silent = |file: &File| !file.text.starts_with("//!");
    let files = source::files(&source::EVERYWHERE);
    none_is(&files, silent);
}

#[test]
fn nothing_is_left_for_later() {
    let words = ["todo!", "unimplemented!", "TODO", "FIXME", "XXX", "dbg!("];
    let mut complaints = Vec::new();
    for file in source::files(&source::EVERYWHERE) {
        let found = words.iter().filter(|word| file.text.contains(**word));
        complaints.extend(found.map(|word| format!("{}: `{word}`", file.path)));
    }
    none(complaints);
}
