//! The header and the table of functions, name by name.

use bricard_capi::HEADER;

/// The names of a table, in order.
fn names(text: &str, begin: &str, end: &str, name: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let inside = text.split_once(begin).expect("it begins").1;
    let inside = inside.split_once(end).expect("it ends").0;
    inside
        .lines()
        .filter_map(|line| name(line.trim()))
        .collect()
}

#[test]
fn the_header_has_the_functions_of_the_table_in_its_order() {
    let in_c = |line: &str| {
        let name = line.split_once("(*")?.1.split_once(')')?.0;
        Some(name.to_string())
    };
    let begin = "typedef struct bricard_interface {";
    let header = names(HEADER, begin, "} bricard_interface;", in_c);
    let in_rust = |line: &str| {
        let line = line.strip_prefix("pub ")?;
        Some(line.split_once(':')?.0.to_string())
    };
    let table = include_str!("../../capi/src/abi.rs");
    let table = names(table, "pub struct Interface {", "\n}", in_rust);
    assert_eq!(table[0], "abi");
    assert_eq!(header, table[1..]);
    assert_eq!(header.len(), 34);
}

#[test]
fn the_header_says_which_version_it_is() {
    let version = format!("#define BRICARD_ABI {}u", bricard_capi::ABI);
    assert!(HEADER.contains(&version));
}

/// What no call answers: what would be a defect of the library, and what a header of another
/// version is told.
const NEVER: [&str; 2] = ["BRICARD_ERROR_PANIC", "BRICARD_ERROR_ABI"];

#[test]
fn every_status_is_the_answer_to_some_call_of_the_tests() {
    let status = |line: &str| Some(line.split_once(" = ")?.0.to_string());
    let all = names(
        HEADER,
        "typedef int32_t bricard_status;\nenum {",
        "};",
        status,
    );
    assert_eq!(all.len(), 16);
    let calls = [
        include_str!("c/misuse.c"),
        include_str!("c/motion.c"),
        include_str!("c/threads.c"),
    ];
    let is_answered = |name: &str| {
        let mut after = calls.iter().flat_map(|text| text.split(name).skip(1));
        after.any(|rest| !rest.starts_with('_'))
    };
    let silent: Vec<&String> = all.iter().filter(|name| !is_answered(name)).collect();
    assert_eq!(silent, NEVER);
}
