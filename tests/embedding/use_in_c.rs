//! What the C programs check by themselves.

use crate::program::{Language, Linked, compile, compile_text, finished};
use bricard_testkit::callgrind::is_there;
use std::process::Command;

#[test]
fn misuse_is_refused_in_words_in_c_and_in_cpp() {
    for language in [Language::C, Language::Cpp] {
        finished(&mut Command::new(compile(
            "misuse",
            language,
            Linked::Shared,
        )));
    }
}

#[test]
fn shared_and_static_library_c_and_cpp_move_alike() {
    let said = |language, linked| {
        let program = compile("motion", language, linked);
        finished(&mut Command::new(program))
    };
    let wanted = said(Language::Cpp, Linked::Shared);
    assert!(wanted.lines().count() > 100);
    assert_eq!(said(Language::C, Linked::Static), wanted);
}

#[test]
fn four_threads_move_four_mechanisms_alike() {
    let program = compile("threads", Language::C, Linked::Shared);
    finished(&mut Command::new(program));
}

/// The chapter's controller, with an engine of the same names.
#[test]
fn the_controller_of_the_chapter_holds_its_speed() {
    let page = include_str!("../../docs/embedding.md");
    let block = page.split("```c\n").nth(1).expect("a program");
    let text = block.split("```").next().expect("it ends");
    let text = text.replace("crank.h", "engine.h");
    let text = text
        .replace("CRANK_", "ENGINE_")
        .replace("crank_create", "engine_create");
    let program = compile_text("controller", &text);
    let said = finished(&mut Command::new(program));
    let revolutions = said.strip_prefix("5000 ticks, ").expect("all ticks");
    let revolutions = revolutions.split(' ').next().unwrap_or_default();
    let revolutions: f64 = revolutions.parse().expect("a number");
    // Five seconds at ten radians a second, from standing still.
    assert!((7.0..8.2).contains(&revolutions), "{said}");
}

/// Valgrind is asked where it is installed.
fn valgrind_finds_nothing_in(name: &str) {
    if !is_there() {
        return;
    }
    let program = compile(name, Language::C, Linked::Shared);
    let mut valgrind = Command::new("valgrind");
    valgrind
        .args(["--error-exitcode=9", "--leak-check=full", "--quiet"])
        .args(["--show-leak-kinds=definite,indirect,possible"])
        .arg(program);
    finished(&mut valgrind);
}

#[test]
fn valgrind_finds_nothing_where_calls_are_wrong() {
    valgrind_finds_nothing_in("misuse");
}

#[test]
fn valgrind_finds_nothing_where_a_mechanism_moves() {
    valgrind_finds_nothing_in("motion");
}
