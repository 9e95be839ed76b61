//! Everything that is built may be used under licences that ask for no more than being named,
//! and comes from the public registry.

use serde_json::Value;
use std::process::Command;

/// Licences that ask for no more than being named, if that.
const PERMISSIVE: [&str; 9] = [
    "MIT",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "Unicode-3.0",
    "Zlib",
];

/// The registry that packages may come from, as Cargo names it.
const REGISTRY: &str = "registry+";

/// What Cargo knows about the packages of this workspace on this machine.
fn packages() -> Vec<Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked", "--offline"])
        .args(["--filter-platform", host().as_str()])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let metadata: Value = serde_json::from_slice(&output.stdout).expect("cargo writes JSON");
    metadata["packages"].as_array().expect("packages").clone()
}

/// The platform that this test runs on.
fn host() -> String {
    let output = Command::new("rustc").arg("-vV").output();
    let text = String::from_utf8(output.expect("rustc runs").stdout).expect("text");
    let line = text.lines().find_map(|line| line.strip_prefix("host: "));
    line.expect("rustc names its host").to_string()
}

/// Whether a licence expression can be met by permissive licences alone.
fn is_permissive(expression: &str) -> bool {
    let plain = expression.replace(['(', ')'], "").replace('/', " OR ");
    plain.split(" AND ").all(|part| {
        part.split(" OR ")
            .any(|licence| PERMISSIVE.contains(&licence.trim()))
    })
}

#[test]
fn every_package_has_a_permissive_licence() {
    for package in packages() {
        let (name, licence) = (&package["name"], package["license"].as_str());
        assert!(
            licence.is_some_and(is_permissive),
            "{name} is under {licence:?}"
        );
    }
}

#[test]
fn every_package_comes_from_here_or_the_registry() {
    for package in packages() {
        let (name, source) = (&package["name"], package["source"].as_str());
        assert!(
            source.is_none_or(|source| source.starts_with(REGISTRY)),
            "{name} comes from {source:?}"
        );
    }
}

#[test]
fn licences_that_ask_for_more_are_recognised() {
    assert!(!is_permissive("GPL-3.0-only"));
    assert!(!is_permissive("MIT AND GPL-3.0-only"));
    assert!(is_permissive("GPL-3.0-only OR MIT"));
    assert!(is_permissive("(MIT OR Apache-2.0) AND Unicode-3.0"));
}
