//! What a build script calls, and what it says.

use bricard_codegen::{BuildError, Builder, Model};
use std::fs;
use std::path::{Path, PathBuf};

const RIGHT: &str = "mechanism Right { coord q; kinetic der(q)^2; }";

/// An empty folder of one test's own.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join("build")
        .join(test);
    let _nothing_there = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder can be made");
    folder
}

fn write(folder: &Path, file: &str, text: &str) -> PathBuf {
    let path = folder.join(file);
    fs::write(&path, text).expect("the folder is ours");
    path
}

#[test]
fn a_main_that_returns_the_error_prints_the_message() {
    let folder = folder("debug");
    let wrong = write(&folder, "wrong.mech", &RIGHT.replace("der(q)", "der(x)"));
    let error = Builder::new()
        .out_dir(&folder)
        .try_compile(&wrong)
        .expect_err("there is no `x`");
    let said = format!("{error:?}");
    assert_eq!(said, error.to_string());
    assert!(
        said.contains("wrong.mech:1:40: error: `x` is not declared"),
        "{said}"
    );
    assert!(said.contains("\n  |"), "no source line in\n{said}");
}

#[test]
fn files_of_one_module_are_refused_by_their_names() {
    for other in ["a__b.mech", "a_B.mech"] {
        let folder = folder("same");
        write(&folder, "a_b.mech", RIGHT);
        write(&folder, other, RIGHT);
        let error = Builder::new()
            .out_dir(&folder)
            .try_compile_dir(&folder)
            .expect_err("one module can't be two");
        assert!(matches!(error, BuildError::SameModule(..)), "{error}");
        let said = error.to_string();
        for part in ["a_b.mech", other, "would both be the module `a_b`"] {
            assert!(said.contains(part), "no `{part}` in {said}");
        }
    }
}

#[test]
fn every_wrong_file_of_a_folder_is_reported() {
    let folder = folder("all");
    for name in ["one.mech", "two.mech"] {
        write(&folder, name, &RIGHT.replace("coord q;", ""));
    }
    write(&folder, "right.mech", RIGHT);
    let error = Builder::new().out_dir(&folder).try_compile_dir(&folder);
    let said = error.expect_err("two are wrong").to_string();
    assert!(said.contains("one.mech:1:"), "{said}");
    assert!(said.contains("two.mech:1:"), "{said}");
}

#[test]
fn a_model_built_by_calls_is_compiled_and_its_text_kept_beside_the_code() {
    let folder = folder("model");
    let builder = Builder::new().out_dir(&folder);
    let model = Model::new("Mass")
        .parameter("m", "kg", 2)
        .coordinate("x", "m")
        .kinetic("1/2*m*der(x)^2");
    let warnings = builder.try_compile_model(&model, "mass");
    assert!(matches!(warnings.as_deref(), Ok("")), "{warnings:?}");
    let code = fs::read_to_string(folder.join("mass.rs")).expect("the code");
    assert!(code.contains("pub mod mass"), "{code}");
    let text = fs::read_to_string(folder.join("mass.mech")).expect("the description");
    assert_eq!(Ok(text), model.text().map_err(|error| error.to_string()));
    let wrong = model.potential("x^");
    let error = builder.try_compile_model(&wrong, "mass");
    let said = error.expect_err("a power of nothing").to_string();
    assert!(said.contains("expected a formula"), "{said}");
    let error = builder.try_compile_model(&Model::new("Mass"), "no name");
    assert!(matches!(error, Err(BuildError::Name(_))), "{error:?}");
}
