//! Programs in C and C++, compiled with all warnings as errors, and run.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

/// What no warning may come of.
const WARNINGS: [&str; 4] = ["-Wall", "-Wextra", "-Werror", "-pedantic"];

/// A language, its compiler and its standard.
#[derive(Clone, Copy, Debug)]
pub enum Language {
    C,
    Cpp,
}

/// How a program finds the mechanisms.
#[derive(Clone, Copy, Debug)]
pub enum Linked {
    Shared,
    Static,
}

/// The folder of what cargo has built for this test.
fn built() -> PathBuf {
    let test = env::current_exe().expect("a test knows where it is");
    let folder = test.parent();
    folder.expect("it lies in target/*/deps").to_path_buf()
}

/// The folder of this package.
fn here() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Compiles a program of the folder `c`.
pub fn compile(name: &str, language: Language, linked: Linked) -> PathBuf {
    let source = here().join("c").join(name).with_extension("c");
    compile_file(&source, name, language, linked)
}

/// Compiles a program in C.
pub fn compile_text(name: &str, text: &str) -> PathBuf {
    let source = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let source = source.with_extension("c");
    fs::write(&source, text).expect("the folder is ours");
    compile_file(&source, name, Language::C, Linked::Shared)
}

fn compile_file(source: &Path, name: &str, language: Language, linked: Linked) -> PathBuf {
    let (compiler, standard, kind) = match language {
        Language::C => ("cc", "-std=c99", "c"),
        Language::Cpp => ("c++", "-std=c++17", "c++"),
    };
    let program = Path::new(env!("CARGO_TARGET_TMPDIR"))
        .join(format!("{name}-{language:?}-{linked:?}").to_lowercase());
    let built = built();
    let mut command = Command::new(compiler);
    command
        .args(WARNINGS)
        .args([standard, "-g", "-O1", "-x", kind])
        .arg(source)
        .args(["-x", "none", "-o"])
        .arg(&program)
        .arg("-I")
        .arg(here().join("../../capi/include"))
        .args(["-I", env!("HEADERS")]);
    match linked {
        Linked::Shared => command
            .arg("-L")
            .arg(&built)
            .arg("-lbricard_embedding")
            .arg(format!("-Wl,-rpath,{}", built.display())),
        Linked::Static => command
            .arg(built.join("libbricard_embedding.a"))
            .args(["-lpthread", "-ldl"]),
    };
    finished(command.arg("-lm"));
    program
}

/// Runs a command to its end, which has to be a good one; what it prints.
pub fn finished(command: &mut Command) -> String {
    // Cargo's own path leads to what an earlier `cargo build` left, too.
    let output = command.env_remove("LD_LIBRARY_PATH").output();
    let Output {
        status,
        stdout,
        stderr,
    } = output.unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let errors = String::from_utf8_lossy(&stderr);
    assert!(status.success(), "{command:?}: {status}\n{errors}");
    String::from_utf8(stdout).expect("programs print text")
}
