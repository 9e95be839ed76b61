//! Equations and generated code against the files in `golden/`, and what emitted
//! text may not contain.
//!
//! A mechanism is under watch if it has a folder there. `BRICARD_BLESS=1` rewrites
//! the files; the difference is then reviewed like code.

use crate::source::root;
use bricard_codegen::{CompileSettings, compile_source};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;
use std::{env, fs};

/// What the library is compiled with.
fn settings() -> CompileSettings {
    let mut settings = CompileSettings::default();
    settings.options.coriolis_matrix = true;
    settings
}

/// The code of a mechanism of the library, which many tests read and one generates.
fn generated(name: &str) -> &'static str {
    static ALL: LazyLock<BTreeMap<&str, String>> = LazyLock::new(|| {
        let all = bricard::NAMES.iter();
        all.map(|name| (*name, generate(name))).collect()
    });
    ALL.get(name).expect("a name of the catalogue")
}

fn generate(name: &str) -> String {
    let source = bricard::source(name).expect("a name of the catalogue");
    code(name, source)
}

fn code(name: &str, source: &str) -> String {
    let file = format!("mechanisms/{name}.mech");
    let compiled = compile_source(source, name, &file, &settings());
    compiled
        .unwrap_or_else(|errors| panic!("{}", errors.render(&file, source)))
        .code
}

fn equations(name: &str) -> String {
    let show = Command::new(env!("CARGO_BIN_EXE_bricard"))
        .args(["show", name])
        .current_dir(root())
        .output()
        .expect("the command runs");
    String::from_utf8(show.stdout).expect("the command prints text")
}

/// The mechanisms that have golden files.
fn watched() -> Vec<String> {
    let folders = fs::read_dir(root().join("tests/golden")).expect("the folder of golden files");
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    let mut names: Vec<String> = folders.flatten().map(name).collect();
    names.sort();
    names
}

/// Compares a text with its golden file, or rewrites the file. Says what differs.
fn compared(name: &str, file: &str, text: &str) -> Option<String> {
    let path = root().join("tests/golden").join(name).join(file);
    if env::var_os("BRICARD_BLESS").is_some() {
        fs::write(&path, text).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        return None;
    }
    let golden = fs::read_to_string(&path).unwrap_or_default();
    let golden = golden.as_str();
    if golden == text {
        return None;
    }
    let line = golden
        .lines()
        .zip(text.lines())
        .take_while(|(old, new)| old == new)
        .count();
    let [old, new] = [golden, text].map(|text| text.lines().nth(line).unwrap_or("(the end)"));
    let shown = Path::new("tests/golden")
        .join(name)
        .join(file)
        .display()
        .to_string();
    Some(format!(
        "{shown}:{}:\n  golden: {old}\n  now:    {new}",
        line + 1
    ))
}

#[test]
fn equations_and_generated_code_are_those_of_the_golden_files() {
    let mut different = Vec::new();
    for name in watched() {
        assert!(
            bricard::NAMES.contains(&name.as_str()),
            "tests/golden/{name}: no such mechanism"
        );
        different.extend(compared(&name, "equations.txt", &equations(&name)));
        different.extend(compared(&name, "generated.rs", generated(&name)));
    }
    assert!(
        different.is_empty(),
        "\n{}\nBRICARD_BLESS=1 cargo test golden   rewrites the files; review the difference.",
        different.join("\n")
    );
}

#[test]
fn what_is_compiled_is_what_is_generated() {
    for name in bricard::NAMES {
        // The build script works in the folder of the descriptions.
        let (there, here) = (format!("./{name}.mech"), format!("mechanisms/{name}.mech"));
        assert!(
            bricard::COMPILED.contains(&generated(name).replace(&here, &there)),
            "{name} is compiled from other text"
        );
    }
}

#[test]
fn generated_twice_is_the_same_byte_for_byte() {
    for name in watched() {
        assert_eq!(generated(&name), generate(&name), "{name}");
    }
}

#[test]
fn emitted_modules_are_rust_and_switch_nothing_off_but_what_numbers_and_loops_are_like() {
    let alike = "#[allow(clippy::approx_constant, clippy::needless_range_loop)]";
    let forbidden = [
        "allow(", "expect(", "unwrap()", "panic!", "unsafe", "vec!", "Vec<", "Box<", "String",
        "#![", "dbg!", "println!",
    ];
    for name in bricard::NAMES {
        let code = generated(name);
        let parsed = syn::parse_file(code);
        assert!(parsed.is_ok(), "{name}: {:?}", parsed.err());
        // The description is quoted whole, and may say what it likes.
        let own: String = code
            .lines()
            .filter(|line| !line.contains("const SOURCE") && *line != alike)
            .collect();
        let found: Vec<&&str> = forbidden
            .iter()
            .filter(|word| own.contains(**word))
            .collect();
        assert!(found.is_empty(), "{name} contains {found:?}");
    }
}

#[test]
fn emitted_modules_import_the_runtime_and_nothing_else() {
    for name in bricard::NAMES {
        let code = generated(name);
        let uses = code
            .lines()
            .map(str::trim)
            .filter(|line| line.starts_with("use "));
        for line in uses {
            assert!(line.starts_with("use bricard_runtime::"), "{name}: {line}");
        }
    }
}

#[test]
fn emitted_functions_say_what_they_cost() {
    for name in bricard::NAMES {
        let code = generated(name);
        let computing = code.matches("sin_cos()").count().min(1);
        assert!(code.matches("Costs ").count() >= 3 * computing, "{name}");
    }
}

/// The lines of the generated code outside of documentation.
fn statements(code: &str) -> String {
    let outside = |line: &&str| !line.trim_start().starts_with("//") && !line.contains("SOURCE");
    code.lines().filter(outside).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_mechanism_without_constraints_has_no_constraint_machinery() {
    for name in ["cart_pole", "double_pendulum"] {
        let code = statements(generated(name));
        let words = ["jacobian", "Position", "Correction", "residual", "drift"];
        let found: Vec<&&str> = words.iter().filter(|word| code.contains(**word)).collect();
        assert!(found.is_empty(), "{name} contains {found:?}");
    }
}

#[test]
fn time_is_read_only_where_the_description_has_it() {
    for name in [
        "cart_pole",
        "double_four_bar",
        "double_pendulum",
        "slider_crank",
    ] {
        assert!(!generated(name).contains("state.t"), "{name}");
    }
    assert!(generated("driven_pivot").contains("state.t"));
}

#[test]
fn a_constant_mass_matrix_brings_no_coriolis_functions() {
    let source = "mechanism Pair {
        param m: kg = 2;
        param k: N/m = 5;
        param l: m = 0.3;
        coord x: m;
        coord y: m;
        kinetic 1/2*m*(der(x)^2 + der(y)^2) + 1/3*m*der(x)*der(y);
        potential 1/2*k*(x - y)^2*(1 + x^2/l^2);
    }";
    let code = statements(&code("pair", source));
    assert!(code.contains("constant_mass: true"));
    assert!(!code.contains("coriolis"));
    assert!(!code.contains("sin_cos"));
}

#[test]
fn a_frozen_parameter_is_no_field_any_more() {
    let source = bricard::source("slider_crank").expect("a name of the catalogue");
    let mut settings = settings();
    settings.frozen = vec!["L1".to_string(), "m3".to_string()];
    let compiled = compile_source(source, "slider_crank", "x.mech", &settings);
    let code = compiled.expect("the description is right").code;
    assert!(!code.contains("pub l1: T") && !code.contains("pub m3: T"));
    assert!(code.contains("pub l2: T"));
    assert!(code.contains("frozen at their defaults: `L1`, `m3`"));
}
