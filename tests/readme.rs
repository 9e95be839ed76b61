//! The front page shows programs that are compiled and run as they stand there.

const README: &str = include_str!("../README.md");

/// The files of the program on the front page, and what its blocks are written in.
const FIRST: [(&str, &str); 3] = [
    (
        include_str!("../examples/first/mechanisms/engine.mech"),
        "text",
    ),
    (include_str!("../examples/first/build.rs"), "rust"),
    (include_str!("../examples/first/src/main.rs"), "rust"),
];

#[test]
fn the_program_on_the_front_page_is_the_one_that_is_run() {
    for (file, language) in FIRST {
        // Files of Rust begin by saying what they are.
        let shown = match file.split_once("\n\n") {
            Some((head, rest)) if head.starts_with("//! ") => rest,
            _ => file,
        };
        let block = format!("```{language}\n{shown}```\n");
        assert!(README.contains(&block), "the front page lacks\n{block}");
    }
}
