//! What the sources of the front end may say.
//!
//! Out: the literals of its stages that are sentences or parts of such, with the places
//!      where they stand.

use proc_macro2::{TokenStream, TokenTree};
use std::fs;
use std::path::{Path, PathBuf};

/// The stages that find mistakes.
pub const STAGES: [&str; 4] = ["syntax", "model", "derive", "lint"];

/// Writes descriptions; says nothing.
const SILENT: [&str; 1] = ["syntax/print.rs"];

/// Fewer words than this are a part of a sentence that stands elsewhere.
const WORDS: usize = 3;

/// A literal of the sources.
pub struct Template {
    /// The stage that says it.
    pub stage: &'static str,
    /// Where it stands, and what it is.
    pub place: String,
    /// What stands between its placeholders.
    fragments: Vec<String>,
}

impl Template {
    fn new(stage: &'static str, place: String, text: &str) -> Self {
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
        Self {
            stage,
            place,
            fragments,
        }
    }

    fn words(&self) -> usize {
        let words = self
            .fragments
            .iter()
            .flat_map(|text| text.split_whitespace());
        let is_word = |word: &&str| word.chars().any(char::is_alphabetic);
        words.filter(is_word).count()
    }

    /// Whether it says something by itself.
    pub fn is_sentence(&self) -> bool {
        self.words() >= WORDS
    }

    /// How much of a text that contains it comes from it.
    pub fn length(&self) -> usize {
        self.fragments.iter().map(String::len).sum()
    }

    /// Whether a text contains it, whatever its placeholders stand for.
    pub fn is_in(&self, text: &str) -> bool {
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
pub fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
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

/// What the front end may say, parts of sentences too.
pub fn templates() -> Vec<Template> {
    let mut templates = Vec::new();
    for stage in STAGES {
        for path in files(&sources().join(stage), "rs") {
            let inside = path.strip_prefix(sources()).expect("a file of the sources");
            let name = inside.display().to_string();
            if SILENT.contains(&name.as_str()) {
                continue;
            }
            let text = fs::read_to_string(&path).expect("a source");
            let code = text.split("#[cfg(test)]").next().unwrap_or_default();
            let tokens: TokenStream = code.parse().expect("tokens");
            literals(tokens, &mut |line, text| {
                let place = format!("{name}:{line}: {text}");
                templates.push(Template::new(stage, place, &text));
            });
        }
    }
    templates.retain(|template| template.words() > 0);
    templates
}
