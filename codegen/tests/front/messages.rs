//! Every text that the front end may say is said about some wrong description.
//!
//! The texts are the sentences among the literals of its sources; what is said about the
//! descriptions of `tests/wrong` and about those below has to show each of them.

use super::with;
use bricard_codegen::internals::examine;
use bricard_codegen::{Diagnostics, Model, Settings};
use proc_macro2::{TokenStream, TokenTree};
use std::fs;
use std::path::{Path, PathBuf};

/// The stages that find mistakes.
const STAGES: [&str; 4] = ["syntax", "model", "derive", "lint"];

/// Writes descriptions; says nothing.
const SILENT: [&str; 1] = ["syntax/print.rs"];

/// Fewer words than this are a part of a sentence that stands elsewhere.
const WORDS: usize = 3;

/// Texts that no short description brings about, and the test that has one which does, or
/// why there is none.
const ELSEWHERE: [(&str, &str); 6] = [
    (
        "this can't be read",
        "none: the scanner has taken out what the lexer refuses",
    ),
    ("energies written with the velocities", SWELLS),
    ("expressions: the code would take", SWELLS),
    ("the equations of motion have {size}", SWELLS),
    ("the generated code is long", SWELLS),
    ("about {:.0} % of it", SWELLS),
];

/// The tests of mechanisms whose equations swell.
const SWELLS: &str = "symbolic/limits.rs";

/// Statements that are wrong, beside the coordinates `q` and `w` without units.
const STATEMENTS: &[&str] = &[
    // The notation.
    "output a = if q < 1 || w < 1 then 1 else 2;",
    "output a = if q then 1 else 2;",
    "potential q == w;",
    "state;",
    "input;",
    "let = 3;",
    "fn;",
    "output;",
    "draw;",
    "draw line([0, 0], [1, 1]): m;",
    "fn f(x) = x: m;",
    "part;",
    "output a = q[];",
    "output a = q[1 2];",
    "output a = sum(q);",
    "output a = sum(3 in 0..2, q);",
    "output a = max(q w);",
    "fn f;",
    "fn 3(x) = x;",
    "fn f(3) = 1;",
    "part 3(x) { }",
    "part Rod;",
    "use 3;",
    "param m[;",
    "param m[3: kg = 1;",
    "const m[i 0..3] = 1;",
    "coord theta[;",
    "coord theta[3 4]: rad;",
    "der(z);",
    "fnn spring(x) = x;",
    "function f(x) = x;",
    "drawing line([0, 0], [1, 1]);",
    "lines([0, 0], [1, 1]);",
    "let n[;",
    "let n[i = 1;",
    "let n[i in 0..3 = 1;",
    "let n[3] = 1;",
    "potential q\rw;",
    "potential q\u{a0}+ w;",
    "potential q + \u{200b}w;",
    "potential q +\u{2003}w;",
    "potential q +\u{7}w;",
    "coord größe;",
    "coord x: ;",
    "param a: m^100 = 1;",
    "param a: m^x = 1;",
    // Shapes and functions.
    "potential 0^-1;",
    "output a = dot([1, 2], [1, 2, 3]);",
    "output a = det(q);",
    "output a = inv(q);",
    "output a = omega(q);",
    "output a = omega([1, 2]);",
    "output a = omega([[1, 2, 3], [4, 5, 6]]);",
    "output a = transpose(q);",
    "output a = cross([1, 2], q);",
    "output a = min([1, 2], q);",
    "output a = atan2([1, 2], q);",
    "output a = der(der(der(q)));",
    "output a = [1, [2, 3]];",
    "output a = [[1, 2], [3]];",
    "let R = [[1, 0], [0, 1]]; output a = R.x;",
    "output a = q[0];",
    "let n[i in 3..3] = 1;",
    "let n[i in 3..2] = 1;",
    "let n[i in 0..3] = n[i + 1]; output a = n[0];",
    "output a = \"x\";",
    "force table(\"data.csv\", \"x\") on q;",
    "output a = sum(i in 0..q, 1);",
    "output a = sum(i in 0..[1, 2], 1);",
    "output a = [1, 2]*[[1, 0], [0, 1]];",
    "output a = [[1, 0], [0, 1]]*[1, 2, 3];",
    "output a = [[1, 0, 0], [0, 1, 0]]*[1, 2];",
    "let R = rot([1, 2]);",
    "let R = rot([1, 2], q);",
    "let R = rot([0, 0, 0], q);",
    "let R = rot([0, 0, 1], [1, 2]);",
    "let R = rot();",
    "let R = quat();",
    "let R = quat([1, 2], 0, 0, 0);",
    "param l: m = 1; let R = quat(l, 0, 0, 0);",
    "param l: m = 1; output a = omega([[l, 0], [0, l]]);",
    "const deg = 1;",
    "potential 1e400*q;",
    "potential 1e300*1e300*q;",
    "potential ((q^1000)^1000)^2;",
    "output a = if q < 1 then 1 else [1, 2];",
    "param l: m = 1; output a = if q < 1 then 1 else l;",
    "output a = if [1, 2] < q then 1 else 2;",
    "output a = if q < [1, 2] then 1 else 2;",
    // Tables.
    "force table() on q;",
    "force table([[0, 1], [1, 2]], [1, 2]) on q;",
    "force table(\"data.csv\", x, t) on q;",
    "force table(\"data.csv\", t) on q;",
    "force table([[[1, 2], 1], [1, 2]], q) on w;",
    "force table([[0, [1, 2]], [1, 2]], q) on w;",
    "const l: m = 1; const s: s = 2; force table([[l, 1], [s, 2]], l) on w;",
    "param l: m = 1; param s: s = 1; force table([[0, l], [1, s]], q) on w;",
    "force spline([0, 1], q) on w;",
    // Functions and parts.
    "fn f(x) = x;",
    "fn Rod(x) = x;",
    "use parts; fn Rod(x) = x;",
    "use parts; part Rod(x) { }",
    "part Mine(x) { let y = x; }",
    // What may stand where.
    "state z; der(z) = q; kinetic z^2;",
    "state z; der(z) = q; potential z;",
    "state z; der(z) = q; kinetic der(z)^2;",
    "state z; der(z) = q; constraint q = z;",
    "state z; der(z) = q; force 1 on z;",
    "state z; der(z) = q; start { q + z = 1; }",
    "state z; der(z) = [1, 2];",
    "state z: m; der(z) = q;",
    "param l: m = 1; state z; der(z) = l;",
    "state z; der(z) = 1; der(z) = 2;",
    "der(q) = 1;",
    "der(q + w) = 1;",
    "input u = 0; force 1 on u;",
    "input u = 0; constraint q = u;",
    "input u = 0; start { q + u = 1; }",
    "force 1 on abs(q);",
    "force 1 on [1, 2];",
    "force 1 on [[1, 2], [3, 4]];",
    "constraint abs(q) = w;",
    "event e: [1, 2] rising;",
    "event e: der(der(q)) rising;",
    // The start and the picture.
    "coord k[2]; kinetic der(k[0])^2 + der(k[1])^2; start { k = 1; }",
    "start { q = [1, 2]; }",
    "let n[i in 0..2] = q; start { n = 1; }",
    "let R = [[q, 0], [0, 1]]; start { R = 1; }",
    "draw polygon([0, 0], [1, 1]);",
    "draw trace([0, 0], [1, 1]);",
    "let p[i in 0..2] = [i, 0]; draw circle(p, 1);",
    "draw circle(1);",
    "draw line(1, 2);",
];

/// Whole descriptions that are wrong.
const DESCRIPTIONS: &[&str] = &[
    "mechanism { }",
    "mechanism Test { coord q; coord w; kinetic der(w)^2 - der(q)^2; }",
];

/// A literal of the sources.
struct Template {
    place: String,
    /// What stands between its placeholders.
    fragments: Vec<String>,
}

impl Template {
    fn new(place: String, text: &str) -> Self {
        let mut fragments = Vec::new();
        let mut rest = text.replace("{{", "\u{1}").replace("}}", "\u{2}");
        while let Some((before, after)) = rest.split_once('{') {
            let after = after.split_once('}').map_or("", |(_, after)| after);
            fragments.push(before.to_string());
            rest = after.to_string();
        }
        fragments.push(rest);
        let plain = |text: &String| text.replace('\u{1}', "{").replace('\u{2}', "}");
        let fragments = fragments.iter().map(plain).collect();
        Self { place, fragments }
    }

    fn is_sentence(&self) -> bool {
        let words = self
            .fragments
            .iter()
            .flat_map(|text| text.split_whitespace());
        let is_word = |word: &&str| word.chars().any(char::is_alphabetic);
        words.filter(is_word).count() >= WORDS
    }

    /// Whether a text contains it, whatever its placeholders stand for.
    fn is_in(&self, text: &str) -> bool {
        let mut rest = text;
        self.fragments.iter().all(|fragment| {
            let found = rest.find(fragment.as_str());
            rest = found.map_or("", |at| &rest[at + fragment.len()..]);
            found.is_some()
        })
    }
}

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All files below a folder with an ending, in order.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let below = |path: PathBuf| match path.is_dir() {
        true => files(&path, ending),
        false => vec![path],
    };
    let all = paths.into_iter().flat_map(below);
    all.filter(|path| path.extension().is_some_and(|e| e == ending))
        .collect()
}

/// Shows the literals of tokens, but those of attributes.
fn literals(tokens: TokenStream, show: &mut dyn FnMut(usize, String)) {
    let mut is_attribute = false;
    for token in tokens {
        let follows = std::mem::take(&mut is_attribute);
        match token {
            TokenTree::Punct(sign) => {
                is_attribute = sign.as_char() == '#' || follows && sign.as_char() == '!';
            }
            TokenTree::Group(group) if !follows => literals(group.stream(), show),
            TokenTree::Literal(literal) => {
                if let Ok(text) = syn::parse_str::<syn::LitStr>(&literal.to_string()) {
                    show(literal.span().start().line, text.value());
                }
            }
            TokenTree::Group(_) | TokenTree::Ident(_) => {}
        }
    }
}

/// What the front end may say.
fn templates() -> Vec<Template> {
    let mut templates = Vec::new();
    for path in STAGES
        .iter()
        .flat_map(|stage| files(&sources().join(stage), "rs"))
    {
        let inside = path.strip_prefix(sources()).expect("a file of the sources");
        let name = inside.display().to_string();
        if SILENT.contains(&name.as_str()) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("a source");
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        let tokens: TokenStream = code.parse().expect("tokens");
        literals(tokens, &mut |line, text| {
            templates.push(Template::new(format!("{name}:{line}: {text}"), &text));
        });
    }
    templates.retain(Template::is_sentence);
    templates
}

/// Adds everything that is said in findings.
fn add(findings: &Diagnostics, said: &mut Vec<String>) {
    for finding in findings.sorted() {
        let labels = finding.secondary.iter().chain([&finding.primary]);
        said.push(finding.message.clone());
        said.extend(labels.map(|label| label.text.clone()));
        said.extend(finding.help.clone());
    }
}

/// Adds what is said about a description.
fn hear(source: &str, settings: &Settings, said: &mut Vec<String>) {
    match examine(source, settings) {
        Ok((_, warnings)) => add(&warnings, said),
        Err(errors) => add(&errors, said),
    }
}

/// What is said about all wrong descriptions.
fn said() -> Vec<String> {
    let mut said = Vec::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong");
    for path in files(&folder, "mech") {
        let source = fs::read_to_string(&path).expect("a description");
        hear(&source, &Settings::beside(&path), &mut said);
    }
    for statements in STATEMENTS {
        hear(&with(statements), &Settings::default(), &mut said);
    }
    for description in DESCRIPTIONS {
        hear(description, &Settings::default(), &mut said);
    }
    for statements in long() {
        hear(&with(&statements), &Settings::default(), &mut said);
    }
    hear(&" ".repeat(1 << 25), &Settings::default(), &mut said);
    set(&mut said);
    tables(&mut said);
    calls(&mut said);
    said
}

/// Statements of which there is too much.
fn long() -> Vec<String> {
    let chain =
        |count: usize, one: &dyn Fn(usize) -> String| -> String { (0..count).map(one).collect() };
    let functions = chain(300, &|i| format!("fn f{}(x) = f{i}(x);", i + 1));
    let lets = chain(300, &|i| format!("let p{} = p{i};", i + 1));
    let parts = chain(300, &|i| format!("part P{}() {{ let a = P{i}(); }}", i + 1));
    let given = chain(300, &|i| format!("let a{i} = P(a{}.y);", i + 1));
    vec![
        format!("potential {}q;", "-".repeat(500)),
        format!("output a = q{};", ".x".repeat(500)),
        format!("output a = q{};", "[0]".repeat(500)),
        "output a = sum(i in 0..1000, sum(j in 0..1000, sum(k in 0..1000, q)));".to_string(),
        format!("fn f0(x) = x; {functions} output a = f300(q);"),
        format!("{lets} let p0 = q; output a = p300;"),
        format!("part P0() {{ let a = 1; }} {parts} let a = P300();"),
        "part P() { let a = 1; } let a[i in 0..100000] = P();".to_string(),
        format!("part P(x) {{ let y = x; }} {given} let a300 = P(q);"),
        "force sum(i in 0..300, if q < i then 1 else 0) on q;".to_string(),
    ]
}

/// What is said of what a build script sets.
fn set(said: &mut Vec<String>) {
    for (statements, name, value) in [
        ("", "k", 1.0),
        ("const near = 1; force near on q;", "k", 1.0),
        ("const k[2] = [1, 2]; force k[0] on q;", "k", 1.0),
        ("const k = 1; force k on q;", "k", f64::NAN),
    ] {
        let mut settings = Settings::default();
        settings.constants = vec![(name.to_string(), value)];
        hear(&with(statements), &settings, said);
    }
}

/// What is said of files of numbers.
fn tables(said: &mut Vec<String>) {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("messages");
    fs::create_dir_all(&folder).expect("a folder");
    let many: String = (0..100_001).map(|i| format!("{i},1\n")).collect();
    let plain = "table(\"data.csv\", t)";
    let named = "table(\"data.csv\", \"force\", t)";
    for (data, table) in [
        (&b"0,1\n1,2\n"[..], "table(\"none.csv\", t)"),
        (&b"0,\xff\n"[..], plain),
        (&b"1,1\n0,2\n"[..], plain),
        (&b"1,1\n"[..], plain),
        (&b""[..], plain),
        (many.as_bytes(), plain),
        (&b"0,1\n1,2\n"[..], named),
        (&b"time,push\n0,1\n1,2\n"[..], named),
        (&b"time,x,forces\n0,1,2\n1,2,3\n"[..], named),
        (&b"0,1\n1\n"[..], plain),
        (&b"0,1\n1,x\n"[..], plain),
        (&b"0,1\n1,2\n"[..], "table(\"data.csv\", x, t)"),
    ] {
        fs::write(folder.join("data.csv"), data).expect("a file");
        let settings = Settings::beside(&folder.join("test.mech"));
        hear(&with(&format!("force {table} on q;")), &settings, said);
    }
}

/// What is said of models that a program makes.
fn calls(said: &mut Vec<String>) {
    for model in [
        Model::new("a name"),
        Model::new("Test").potential("q w"),
        Model::new("Test").coordinate("q", "m m"),
        Model::new("Test").coordinate("q", "3"),
    ] {
        said.extend(model.text().err().map(|error| error.to_string()));
    }
}

#[test]
fn every_text_of_the_front_end_is_said_about_some_description() {
    let said = said();
    let templates = templates();
    assert!(templates.len() > 400, "only {} texts", templates.len());
    let mut silent = Vec::new();
    for template in &templates {
        let heard = said.iter().any(|text| template.is_in(text));
        let elsewhere = ELSEWHERE
            .iter()
            .any(|(text, _)| template.place.contains(text));
        if heard == elsewhere {
            silent.push(template.place.as_str());
        }
    }
    assert!(
        silent.is_empty(),
        "never said, or said and listed:\n{}",
        silent.join("\n")
    );
}
