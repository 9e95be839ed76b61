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
