//! The kinds of an error, as its source declares them.

use std::fs;
use std::path::Path;

/// The names of the variants of an enumeration in a source file.
///
/// # Panics
///
/// If the file is no Rust, or declares no such enumeration.
pub fn variants(source: &Path, name: &str) -> Vec<String> {
    let text = fs::read_to_string(source).expect("a source");
    let file = syn::parse_file(&text).expect("it is Rust");
    let declared = file.items.into_iter().find_map(|item| match item {
        syn::Item::Enum(item) if item.ident == name => Some(item.variants),
        _ => None,
    });
    let declared = declared.expect("it is declared there");
    declared.iter().map(|v| v.ident.to_string()).collect()
}
