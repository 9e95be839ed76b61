//! Mechanisms exported to other programs: the folders are whole, and their examples say what
//! the command itself says.

use crate::built;
use crate::command::{Ran, command, folder, read};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The command in a folder, with the cache that the tests share.
fn bricard(folder: &Path, arguments: &[&str]) -> Ran {
    bricard_with(None, folder, arguments)
}

/// The command in a folder, with another `PATH` to look for the compiler in, if one is given.
fn bricard_with(path: Option<&Path>, folder: &Path, arguments: &[&str]) -> Ran {
    let mut command = command();
    command.current_dir(folder).args(arguments);
    command.envs(path.map(|path| ("PATH", path)));
    read(command.output().expect("the command starts"))
}

/// Runs a command to its end, which has to be a good one; what it prints.
fn finished(command: &mut Command) -> String {
    let output = command.output().expect("it starts");
    let Output {
        status,
        stdout,
        stderr,
    } = output;
    let errors = String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{command:?}: {status}\n{errors}");
    String::from_utf8(stdout).expect("text")
}

/// The last state that the command itself comes to, each number as examples print it: the
/// columns of coordinates and of states.
fn simulated(folder: &Path, mechanism: &str, columns: &[usize]) -> Vec<String> {
    let options = ["--until", "10", "--rtol", "1e-9", "--every", "0.5"];
    let ran = bricard(folder, &[&["simulate", mechanism], &options[..]].concat());
    let last: Vec<&str> = ran.out.lines().last().expect("rows").split(',').collect();
    let six = |column: &usize| {
        let number: f64 = last[*column].parse().expect("a number");
        format!("{number:.6}")
    };
    columns.iter().map(six).collect()
}

/// The columns of coordinates of the slider–crank.
const SLIDER_CRANK: [usize; 3] = [1, 2, 3];
/// Those of the coordinate and of the state of [`motor`].
const MOTOR: [usize; 2] = [1, 3];

/// A description with a state of the first order, in a folder of one test's own.
fn motor(folder: &Path) -> &'static str {
    let text = include_str!("embedding/motor.mech");
    fs::write(folder.join("motor.mech"), text).expect("the folder is ours");
    "motor.mech"
}

/// The state in the last row of an example, whose last line is a summary.
fn last_row(said: &str) -> Vec<String> {
    let row = said.lines().rev().nth(1).expect("rows");
    row.split_whitespace().skip(1).map(str::to_string).collect()
}

/// A folder with a `rustc` that is a script of the shell.
#[cfg(unix)]
fn toolchain(folder: &Path, script: &str) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let place = folder.join("toolchain");
    fs::create_dir_all(&place).expect("the folder is ours");
    let rustc = place.join("rustc");
    fs::write(&rustc, format!("#!/bin/sh\n{script}\n")).expect("the folder is ours");
    fs::set_permissions(&rustc, fs::Permissions::from_mode(0o755)).expect("the file is ours");
    place
}

// That the module moves as it should `examples/web/exported` finds out.
#[cfg(unix)]
#[test]
fn a_package_for_npm_is_whole_but_for_its_module_where_rust_can_not_compile_that() {
    let folder = folder("export_wasm");
    let idle = toolchain(&folder, "echo /nowhere");
    let wasm = ["export", "slider_crank", "--to", "wasm"];
    let ran = bricard_with(Some(&idle), &folder, &wasm);
    let made = folder.join("slider_crank");
    for file in [
        "index.js",
        "index.d.ts",
        "package.json",
        "README.md",
        "src/lib.rs",
    ] {
        assert!(made.join(file).is_file(), "{file}: {}", ran.err);
    }
    let needs = "rustup target add wasm32-unknown-unknown";
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    ran.says(&[needs]);
    assert!(!made.join("mechanism.wasm").exists());
}

/// A crate of Rust, in a folder of one test's own.
fn exported_crate(folder: &Path, mechanism: &str) -> PathBuf {
    bricard(folder, &["export", mechanism, "--to", "rust"]).done();
    let made = folder.join(mechanism.trim_end_matches(".mech"));
    assert!(!made.join("build.rs").exists());
    made
}

/// What the example of a crate of Rust says, compiled without cargo.
fn example_of(made: &Path, name: &str) -> String {
    let library = ["--crate-type", "lib", "--crate-name", name];
    finished(built::rustc(&made.join("src/lib.rs"), made).args(library));
    let example = made.join("examples/simulate.rs");
    finished(built::rustc(&example, made).args(["--extern", name]));
    finished(&mut Command::new(made.join("simulate")))
}

#[test]
fn the_example_of_a_crate_of_rust_moves_as_the_command_does() {
    let folder = folder("export_rust");
    let made = exported_crate(&folder, "slider_crank");
    let said = example_of(&made, "slider_crank");
    let wanted = simulated(&folder, "slider_crank", &SLIDER_CRANK);
    assert_eq!(last_row(&said), wanted, "{said}");
}

#[test]
fn examples_show_the_values_of_states() {
    let folder = folder("export_states");
    let wanted = simulated(&folder, motor(&folder), &MOTOR);
    let said = example_of(&exported_crate(&folder, "motor.mech"), "motor");
    let heads = said.lines().next().expect("names").split_whitespace();
    assert_eq!(heads.collect::<Vec<_>>(), ["t", "angle", "current"]);
    assert_eq!(last_row(&said), wanted, "{said}");
    bricard(
        &folder,
        &["export", "motor.mech", "--to", "c", "--out", "c"],
    )
    .done();
    let told = example_in_c(&folder.join("c"), "motor");
    assert_eq!(told.lines().next(), said.lines().next());
    assert_eq!(last_row(&told), wanted, "{told}");
    // Without constraints there is nothing to say of them.
    let summary = told.lines().last().expect("a summary");
    assert!(summary.ends_with(" steps"), "{summary}");
}

#[test]
#[ignore = "long: builds a crate with all that it depends on"]
fn a_crate_of_rust_builds_and_moves_as_the_command_does() {
    let folder = folder("export_cargo");
    let made = exported_crate(&folder, "slider_crank");
    let said = finished(
        built::run(&made)
            .args(["--example", "simulate"])
            .env("CARGO_PROFILE_DEV_OPT_LEVEL", "1"),
    );
    let wanted = simulated(&folder, "slider_crank", &SLIDER_CRANK);
    assert_eq!(last_row(&said), wanted, "{said}");
}

/// How strictly examples in C are compiled.
const STRICT: [&str; 5] = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"];

/// What the example of a folder for C says, with the shared library.
fn example_in_c(made: &Path, name: &str) -> String {
    finished(
        Command::new("cc")
            .args(STRICT)
            .args(["example.c", "-Iinclude", "-Llib"])
            .arg(format!("-lbricard_{name}"))
            .arg(format!("-Wl,-rpath,{}", made.join("lib").display()))
            .args(["-o", "shared"])
            .current_dir(made),
    );
    finished(&mut Command::new(made.join("shared")))
}

#[test]
fn a_folder_for_c_holds_libraries_and_an_example_that_moves_as_the_command_does() {
    let folder = folder("export_c");
    bricard(
        &folder,
        &["export", "slider_crank", "--to", "c", "--out", "c"],
    )
    .done();
    let made = folder.join("c");
    let wanted = simulated(&folder, "slider_crank", &SLIDER_CRANK);
    let said = example_in_c(&made, "slider_crank");
    assert_eq!(last_row(&said), wanted, "{said}");
    let config = made.join("lib/pkgconfig/bricard_slider_crank.pc");
    let config = fs::read_to_string(config).expect("it is there");
    let native = config.split_once("Libs.private:").expect("it is told").1;
    finished(
        Command::new("cc")
            .args(STRICT)
            .args(["example.c", "-Iinclude", "lib/libbricard_slider_crank.a"])
            .args(native.split_whitespace())
            .args(["-o", "static"])
            .current_dir(&made),
    );
    assert_eq!(
        finished(&mut Command::new(made.join("static"))),
        said,
        "the static library"
    );
    let cmake = "lib/cmake/bricard_slider_crank/bricard_slider_crank-config.cmake";
    let cmake = fs::read_to_string(made.join(cmake)).expect("it is there");
    assert!(
        cmake.contains("/lib/libbricard_slider_crank.a\""),
        "{cmake}"
    );
    // What was exported before is written anew; the library alone is there already.
    let again = bricard(
        &folder,
        &["export", "slider_crank", "--to", "c", "--out", "c"],
    );
    assert_eq!((again.status, &*again.err), (Some(0), ""));
    let library = bricard(&folder, &["export", "slider_crank", "--to", "library"]);
    assert!(Path::new(library.out.trim()).is_file(), "{}", library.out);
}

/// The files below a folder that have an ending, sorted.
fn files_of(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => files.extend(files_of(&path, ending)),
            false => files.extend(Some(path)),
        }
    }
    files.retain(|path| path.to_string_lossy().ends_with(ending));
    files.sort();
    files
}

#[test]
fn a_folder_holds_one_export_and_what_others_have_put_there() {
    let folder = folder("export_twice");
    for name in ["one", "two"] {
        let text = include_str!("embedding/motor.mech");
        fs::write(folder.join(format!("{name}.mech")), text).expect("the folder is ours");
    }
    let made = folder.join("made");
    let export = |name: &str, to| {
        let arguments = ["export", name, "--to", to, "--out", "made"];
        bricard(&folder, &arguments).done();
        files_of(&made, "")
    };
    let first = export("two.mech", "c");
    fs::remove_dir_all(&made).expect("the folder is ours");
    export("one.mech", "rust");
    let [notes, own] = ["notes.txt", "examples/own.rs"].map(|name| made.join(name));
    fs::write(&notes, "mine").expect("the folder is ours");
    assert_eq!(export("two.mech", "c").len(), first.len() + 1);
    export("one.mech", "rust");
    fs::write(&own, "mine").expect("the folder is ours");
    let mut others: Vec<PathBuf> = export("two.mech", "c");
    others.retain(|path| !first.contains(path));
    assert_eq!(others, [own, notes]);
    // A description that was exported can be exported again from where it is.
    bricard(
        &folder,
        &["export", "made/two.mech", "--to", "c", "--out", "made"],
    )
    .done();
    assert_eq!(files_of(&made, ".mech"), [made.join("two.mech")]);
}

#[test]
fn an_fmu_replaces_no_file_but_one_of_its_kind() {
    let folder = folder("export_fmu_twice");
    let fmu = folder.join("motor.fmu");
    let export = ["export", motor(&folder), "--to", "fmi2"];
    fs::write(&fmu, "mine").expect("the folder is ours");
    let ran = bricard(&folder, &export);
    assert_eq!(ran.status, Some(1));
    ran.says(&["motor.fmu is there already", "choose another name"]);
    assert_eq!(fs::read(&fmu).ok().as_deref(), Some(&b"mine"[..]));
    fs::remove_file(&fmu).expect("the folder is ours");
    for _ in 0..2 {
        bricard(&folder, &export).done();
    }
}

#[test]
fn an_exported_description_finds_the_files_that_it_reads() {
    let folder = folder("export_tables");
    let text = "mechanism Told { const m: kg = 2; coord x: m; kinetic 1/2*m*der(x)^2;
        force table(\"data/told.csv\", t) on x; }";
    fs::create_dir(folder.join("data")).expect("the folder is ours");
    fs::write(folder.join("told.mech"), text).expect("the folder is ours");
    fs::write(folder.join("data/told.csv"), "0,0\n1,2\n").expect("the folder is ours");
    for to in ["rust", "c"] {
        bricard(&folder, &["export", "told.mech", "--to", to, "--out", to]).done();
        let file = format!("{to}/told.mech");
        bricard(&folder, &["check", &file]).done();
        bricard(&folder, &["export", &file, "--to", to, "--out", to]).done();
    }
    bricard(&folder, &["export", "told.mech", "--to", "fmi3"]).done();
    let fmu = fs::read(folder.join("told.fmu")).expect("an FMU");
    let fmu = String::from_utf8_lossy(&fmu);
    for name in ["sources/told.mech", "sources/data/told.csv"] {
        assert!(fmu.contains(name), "{name}");
    }
}

#[test]
fn what_can_not_be_exported_is_refused_and_nothing_is_touched() {
    let folder = folder("export_refused");
    fs::write(folder.join("mine"), "mine").expect("the folder is ours");
    let here = folder.display().to_string();
    fs::write(
        folder.join("wrong.mech"),
        "mechanism A { coord q: rad; coord q: m; }",
    )
    .expect("the folder is ours");
    for (arguments, status, word) in [
        (
            &["slider_crank", "--to", "rust", "--out", &*here][..],
            1,
            "is there already",
        ),
        (
            &["slider_crank", "--to", "c", "--out", "mine"],
            1,
            "already",
        ),
        (
            &["slider_crunk", "--to", "c"],
            2,
            "did you mean `slider_crank`?",
        ),
        (
            &["none.mech", "--to", "rust"],
            1,
            "could not read none.mech",
        ),
        (&["wrong.mech", "--to", "rust"], 1, "`q` is declared twice"),
        (
            &["wrong.mech", "--to", "library"],
            1,
            "`q` is declared twice",
        ),
        (
            &["slider_crank", "--to", "library", "--out", "x"],
            2,
            "the library stays in the cache",
        ),
        (
            &["slider_crank", "--to", "fmi2", "--out", "x"],
            2,
            "write `--out NAME.fmu`",
        ),
        (
            &["slider_crank", "--to", "fmi3", "--out", "x"],
            2,
            "write `--out NAME.fmu`",
        ),
        (
            &["wrong.mech", "--to", "python"],
            1,
            "`q` is declared twice",
        ),
        (
            &["slider_crank", "--to", "cobol"],
            2,
            "rust, c, fmi2, fmi3, python, wasm, library",
        ),
    ] {
        let ran = bricard(&folder, &[&["export"], arguments].concat());
        assert_eq!(ran.status, Some(status), "{arguments:?}: {}", ran.err);
        assert!(ran.err.contains(word), "{arguments:?}: {}", ran.err);
    }
    let left = fs::read_dir(&folder).expect("it is there").count();
    assert_eq!(left, 2);
    let output = Command::new(env!("CARGO_BIN_EXE_bricard"))
        .current_dir(&folder)
        .env("PATH", "")
        .args(["export", "cart_pole", "--to", "c"])
        .output();
    let ran = read(output.expect("the command starts"));
    assert_eq!(ran.status, Some(1));
    ran.says(&["install it (rustup)"]);
    assert!(!folder.join("cart_pole").exists());
}

#[cfg(unix)]
#[test]
fn a_library_belongs_to_the_numbers_in_the_files_that_its_description_reads() {
    let folder = folder("export_data");
    let text = "mechanism Told { const m: kg = 2; coord x: m; kinetic 1/2*m*der(x)^2;
        force table(\"told.csv\", \"force\", t) on x; }";
    fs::write(folder.join("told.mech"), text).expect("the folder is ours");
    let path = std::env::var("PATH").expect("where rustc is");
    let exported = |force: u8, path: Option<&Path>| {
        let data = format!("time,force\n0,0\n1,{force}\n");
        fs::write(folder.join("told.csv"), data).expect("the folder is ours");
        let library = ["export", "told.mech", "--to", "library"];
        bricard_with(path, &folder, &library)
    };
    let first = exported(2, None).done();
    // A toolchain that says which it is and compiles nothing: what needs no compiler is there.
    let script = format!("[ \"$1\" = -vV ] && PATH='{path}' exec rustc -vV\nexit 1");
    let idle = toolchain(&folder, &script);
    let again = exported(2, Some(&idle));
    assert_eq!((again.status, again.out), (Some(0), first.out));
    let other = exported(3, Some(&idle));
    assert_eq!(other.status, Some(1), "{}", other.out);
    let said = "told.mech could not be compiled";
    other.says(&[said]);
}
