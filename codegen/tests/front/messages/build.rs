//! What a build script says of its files and folders.
//!
//! Out: each message with what brings it about, and the section of the page.

use bricard_codegen::{BuildError, Builder};
use bricard_testkit::page::{hold_section, prose, row};
use bricard_testkit::sentences::{Sentence, sentences};
use std::fs;
use std::path::{Path, PathBuf};

const RIGHT: &str = "mechanism Right { coord q; kinetic der(q)^2; }";

const INTRODUCTION: &str = "\
These are the errors of `compile`, `compile_dir` and the methods of `Builder`, which cargo \
prints as errors of the build; of what a description says, it prints what is \
[above](#descriptions), with the lines of the file. `…` stands for the words of the system.
";

/// What is done in an empty folder, in words and in Rust, and what is said then.
type Case = (
    &'static str,
    fn(&Path) -> Result<String, BuildError>,
    &'static str,
);

const CASES: [Case; 8] = [
    (
        "`compile(\"four_bar.mech\")` outside a build script",
        |folder| Builder::new().try_compile(&write(folder, "four_bar.mech", RIGHT)),
        "no output folder: call this from a build script, or name one with `out_dir`",
    ),
    (
        "`compile(\"four_bra.mech\")`, which is not there",
        |folder| building(folder).try_compile(&folder.join("four_bra.mech")),
        "four_bra.mech: …",
    ),
    (
        "`compile_dir(\"mechanism\")`, which is not there",
        |folder| building(folder).try_compile_dir(&folder.join("mechanism")),
        "mechanism: …",
    ),
    (
        "`out_dir(\"notes.txt\")`, a file",
        |folder| {
            let file = write(folder, "notes.txt", "");
            let right = write(folder, "four_bar.mech", RIGHT);
            Builder::new().out_dir(file).try_compile(&right)
        },
        "notes.txt/four_bar.rs: …",
    ),
    (
        "a description with a letter in Latin-1 in its second line",
        |folder| {
            let path = folder.join("four_bar.mech");
            fs::write(&path, b"// Gelenk\n// Stra\xdfe\n").expect("the folder is ours");
            building(folder).try_compile(&path)
        },
        "four_bar.mech: line 2 is not UTF-8 at column 8; save the file as UTF-8",
    ),
    (
        "`compile(\"4_bar.mech\")`",
        |folder| building(folder).try_compile(&write(folder, "4_bar.mech", RIGHT)),
        "4_bar.mech: the file's name becomes a module's: letters, digits and `_`, no keyword",
    ),
    (
        "`compile_dir` of a folder with both files",
        |folder| {
            write(folder, "four_bar.mech", RIGHT);
            write(folder, "FourBar.mech", RIGHT);
            building(folder).try_compile_dir(folder)
        },
        "FourBar.mech and four_bar.mech would both be the module `four_bar`; rename one of them",
    ),
    (
        "`compile_dir` of a folder in which one of the descriptions is wrong",
        |folder| {
            write(folder, "right.mech", RIGHT);
            write(folder, "wrong.mech", &RIGHT.replace("der(q)", "der(x)"));
            building(folder).try_compile_dir(folder)
        },
        "wrong.mech:1:40: error: `x` is not declared\n…",
    ),
];

/// A builder whose output lies beside the descriptions.
fn building(folder: &Path) -> Builder {
    Builder::new().out_dir(folder)
}

fn write(folder: &Path, file: &str, text: &str) -> PathBuf {
    let path = folder.join(file);
    fs::write(&path, text).expect("the folder is ours");
    path
}

/// What is said in a case, with paths from its folder.
fn said(number: usize, provoke: fn(&Path) -> Result<String, BuildError>) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("said/{number}"));
    let _nothing_there = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder can be made");
    let text = provoke(&folder).map_or_else(|error| error.to_string(), |_| String::new());
    let inside = format!("{}{}", folder.display(), std::path::MAIN_SEPARATOR);
    let text = text.replace(&inside, "");
    text.replace(&folder.display().to_string(), ".")
}

/// Whether a text is as expected, whatever stands for the words of the system.
fn agrees(text: &str, expected: &str) -> bool {
    match expected.split_once('…') {
        Some((before, "")) => text.len() > before.len() && text.starts_with(before),
        _ => text == expected,
    }
}

#[test]
fn what_a_build_script_says_of_its_folders_is_on_the_page() {
    let said: Vec<String> = CASES
        .iter()
        .enumerate()
        .map(|(number, (_, provoke, _))| said(number, *provoke))
        .collect();
    for (text, (how, _, expected)) in said.iter().zip(&CASES) {
        assert!(
            agrees(text, expected),
            "{how} says\n{text}\nand not\n{expected}"
        );
    }
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut silent = sentences(&sources, "build.rs");
    assert!(silent.iter().any(Sentence::is_whole));
    silent.retain(|sentence| sentence.is_whole() && !said.iter().any(|text| sentence.is_in(text)));
    let silent: Vec<String> = silent.into_iter().map(|sentence| sentence.place).collect();
    assert!(silent.is_empty(), "never said:\n{}", silent.join("\n"));

    let rows = CASES.map(|(how, _, said)| row(&[prose(said), how.to_string()]));
    let head = "\n| message | brought about by |\n|---|---|\n";
    let text = format!("{INTRODUCTION}{head}{}", rows.concat());
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/messages.md");
    hold_section(&page, "Build scripts", &text);
}
