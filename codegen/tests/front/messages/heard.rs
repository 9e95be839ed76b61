//! What the front end says about wrong descriptions.
//!
//! Out: everything that is said, each with what it is said about, as a reader would type
//!      it.

use super::super::with;
use super::statements::{DESCRIPTIONS, STATEMENTS};
use crate::symbolic::limits::chain;
use bricard_codegen::internals::diagnostic::{Diagnostic, Severity};
use bricard_codegen::internals::examine;
use bricard_codegen::{CompileSettings, Model};
use bricard_testkit::page::code;
use bricard_testkit::sentences::files;
use std::fs;
use std::path::Path;

/// Something that is said.
pub struct Heard {
    /// What it is said about, as Markdown.
    pub input: String,
    /// How much is said about it.
    pub n_findings: usize,
    pub is_warning: bool,
    pub message: String,
    /// What stands at places.
    pub labels: Vec<String>,
    pub help: Option<String>,
}

impl Heard {
    fn new(input: &str, n_findings: usize, finding: &Diagnostic) -> Self {
        let labels = [&finding.primary].into_iter().chain(&finding.secondary);
        let labels = labels.map(|label| label.text.clone());
        Self {
            input: input.to_string(),
            n_findings,
            is_warning: finding.severity == Severity::Warning,
            message: finding.message.clone(),
            labels: labels.filter(|text| !text.is_empty()).collect(),
            help: finding.help.clone(),
        }
    }

    /// Leaves out numbers that change with whatever makes equations shorter.
    fn without_numbers(&mut self) {
        for text in self.labels.iter_mut().chain([&mut self.message]) {
            let parts = text.split(|sign: char| sign.is_ascii_digit());
            let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
            *text = parts.join("…");
        }
    }

    /// All that is said.
    pub fn texts(&self) -> impl Iterator<Item = &String> {
        [&self.message]
            .into_iter()
            .chain(&self.labels)
            .chain(&self.help)
    }
}

/// Everything that is said about wrong descriptions.
#[derive(Default)]
pub struct Hearing(pub Vec<Heard>);

impl Hearing {
    /// What is said about all wrong descriptions.
    pub fn all() -> Self {
        let mut said = Self::default();
        said.folder();
        for statements in STATEMENTS {
            said.about(
                &code(statements),
                &with(statements),
                &CompileSettings::default(),
            );
        }
        for description in DESCRIPTIONS {
            let input = match description.starts_with("mechanism") {
                true => code(description),
                false => format!("{} alone", code(description)),
            };
            said.about(&input, description, &CompileSettings::default());
        }
        for (input, statements) in long() {
            said.about(input, &with(&statements), &CompileSettings::default());
        }
        let spaces = " ".repeat(1 << 25);
        said.about("a file of 32 MB", &spaces, &CompileSettings::default());
        for links in [8, 20] {
            let input = format!("a chain of {links} links with their positions in the world");
            let before = said.0.len();
            said.about(&input, &chain(links), &CompileSettings::default());
            said.0[before..].iter_mut().for_each(Heard::without_numbers);
        }
        said.set();
        said.tables();
        said.calls();
        said
    }

    /// Adds what is said about a description.
    fn about(&mut self, input: &str, source: &str, settings: &CompileSettings) {
        let findings = match examine(source, settings) {
            Ok((_, warnings)) => warnings,
            Err(errors) => errors,
        };
        let findings = findings.sorted();
        let heard = |finding: &&Diagnostic| Heard::new(input, findings.len(), finding);
        self.0.extend(findings.iter().map(heard));
    }

    /// The folder of wrong descriptions.
    fn folder(&mut self) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong");
        for path in files(&folder, "mech") {
            let source = fs::read_to_string(&path).expect("a description");
            let input = code(source.trim());
            self.about(&input, &source, &CompileSettings::beside(&path));
        }
    }
}

impl Hearing {
    /// What a build script sets.
    fn set(&mut self) {
        for (statements, value) in [
            ("", 1.0),
            ("const near = 1; force near on q;", 1.0),
            ("const k[2] = [1, 2]; force k[0] on q;", 1.0),
            ("const k = 1; force k on q;", f64::NAN),
        ] {
            let mut settings = CompileSettings::default();
            settings.constants = vec![("k".to_string(), value)];
            let input = match statements {
                "" => format!("`constant(\"k\", {value:?})` in a build script"),
                _ => format!("{}, `constant(\"k\", {value:?})`", code(statements)),
            };
            self.about(&input, &with(statements), &settings);
        }
    }

    /// Files of numbers.
    fn tables(&mut self) {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("messages");
        fs::create_dir_all(&folder).expect("a folder");
        let many: String = (0..100_001).map(|i| format!("{i},1\n")).collect();
        let plain = "table(\"data.csv\", t)";
        let named = "table(\"data.csv\", \"force\", t)";
        for (shown, data, table) in [
            ("", &b"0,1\n1,2\n"[..], "table(\"none.csv\", t)"),
            ("a byte that is no UTF-8", &b"0,\xff\n"[..], plain),
            ("`1,1` above `0,2`", &b"1,1\n0,2\n"[..], plain),
            ("`1,1`", &b"1,1\n"[..], plain),
            ("nothing", &b""[..], plain),
            ("100001 rows", many.as_bytes(), plain),
            ("`0,1` above `1,2`", &b"0,1\n1,2\n"[..], named),
            (
                "`time,push` above numbers",
                &b"time,push\n0,1\n1,2\n"[..],
                named,
            ),
            (
                "`time,x,forces` above numbers",
                &b"time,x,forces\n0,1,2\n1,2,3\n"[..],
                named,
            ),
            (
                "`time,force,force` above numbers",
                &b"time,force,force\n0,1,2\n1,2,3\n"[..],
                named,
            ),
            ("`0,1` above `1`", &b"0,1\n1\n"[..], plain),
            ("`0,1` above `1,x`", &b"0,1\n1,x\n"[..], plain),
            ("", &b"0,1\n1,2\n"[..], "table(\"data.csv\", x, t)"),
        ] {
            fs::write(folder.join("data.csv"), data).expect("a file");
            let settings = CompileSettings::beside(&folder.join("test.mech"));
            let force = format!("force {table} on q;");
            let input = match shown {
                "" => code(&force),
                _ => format!("{}, `data.csv` has {shown}", code(&force)),
            };
            self.about(&input, &with(&force), &settings);
        }
    }

    /// Models that a program makes.
    fn calls(&mut self) {
        let test = || Model::new("Test");
        for (input, model) in [
            ("Model::new(\"a name\")", Model::new("a name")),
            (".potential(\"q w\")", test().potential("q w")),
            (".coordinate(\"q\", \"m m\")", test().coordinate("q", "m m")),
            (".coordinate(\"q\", \"3\")", test().coordinate("q", "3")),
        ] {
            let error = model.text().err().map(|error| error.to_string());
            let error = error.expect("a text that can't be read");
            let said = error.split_once("error: ").map_or("", |(_, said)| said);
            let help = said
                .split_once("= help: ")
                .map(|(_, help)| help.to_string());
            self.0.push(Heard {
                input: format!("{} in Rust", code(input)),
                n_findings: 1,
                is_warning: false,
                message: said.lines().next().unwrap_or_default().to_string(),
                labels: Vec::new(),
                help,
            });
        }
    }
}

/// Statements of which there is too much, and what a reader is shown of them.
fn long() -> Vec<(&'static str, String)> {
    let chain =
        |count: usize, one: &dyn Fn(usize) -> String| -> String { (0..count).map(one).collect() };
    let functions = chain(300, &|i| format!("fn f{}(x) = f{i}(x);", i + 1));
    let lets = chain(300, &|i| format!("let p{} = p{i};", i + 1));
    let parts = chain(300, &|i| format!("part P{}() {{ let a = P{i}(); }}", i + 1));
    let given = chain(300, &|i| format!("let a{i} = P(a{}.y);", i + 1));
    vec![
        (
            "`output a = ((…(q)…));` with 101 brackets",
            format!("output a = {}q{};", "(".repeat(101), ")".repeat(101)),
        ),
        (
            "`potential -…-q;` with 500 signs",
            format!("potential {}q;", "-".repeat(500)),
        ),
        (
            "`output a = q.x.x…;` with 500 components",
            format!("output a = q{};", ".x".repeat(500)),
        ),
        (
            "`output a = q[0][0]…;` with 500 indices",
            format!("output a = q{};", "[0]".repeat(500)),
        ),
        (
            "`fn f1(x) = f0(x); fn f2(x) = f1(x); …` up to 300",
            format!("fn f0(x) = x; {functions} output a = f300(q);"),
        ),
        (
            "`let p1 = p0; let p2 = p1; …` up to 300",
            format!("{lets} let p0 = q; output a = p300;"),
        ),
        (
            "`part P1() { let a = P0(); } part P2() { let a = P1(); } …` up to 300",
            format!("part P0() {{ let a = 1; }} {parts} let a = P300();"),
        ),
        (
            "`let a0 = P(a1.y); let a1 = P(a2.y); …` up to 300",
            format!("part P(x) {{ let y = x; }} {given} let a300 = P(q);"),
        ),
    ]
}
