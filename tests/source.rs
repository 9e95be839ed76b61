//! The project's own source text, without comments, literals and test modules.

use std::path::{Path, PathBuf};
use std::{fs, iter};

/// The folders that hold what is shipped.
pub const EVERYWHERE: [&str; 7] = [
    "capi/src",
    "codegen/src",
    "runtime/src",
    "driver/src",
    "reference/src",
    "cli",
    "mechanisms",
];

/// A source file.
pub struct File {
    /// Its path from the root of the workspace.
    pub path: String,
    /// The whole text.
    pub text: String,
    /// The text without comments, literals and the test module at its end.
    pub code: String,
    /// How many lines the text has.
    pub lines: usize,
}

/// A braced item.
pub struct Block {
    pub name: String,
    pub text: String,
    pub lines: usize,
}

/// Every Rust file of some folders, in order.
pub fn files(folders: &[&str]) -> Vec<File> {
    folders
        .iter()
        .flat_map(|folder| below(&root().join(folder)))
        .map(|path| file(&path))
        .collect()
}

/// The text of a file of the workspace.
pub fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The root of the workspace.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{folder:?}: {error}"));
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    let rust = |path: &PathBuf| path.extension().is_some_and(|extension| extension == "rs");
    let inside = |path: PathBuf| match path.is_dir() {
        true => below(&path),
        false => iter::once(path).filter(rust).collect(),
    };
    paths.into_iter().flat_map(inside).collect()
}

fn file(path: &Path) -> File {
    let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
    let shown = path
        .strip_prefix(root())
        .unwrap_or(path)
        .display()
        .to_string();
    let bare = stripped(&text);
    let code = bare
        .split("#[cfg(test)]\nmod tests")
        .next()
        .unwrap_or_default()
        .to_string();
    File {
        path: shown,
        lines: text.lines().count(),
        code,
        text,
    }
}

impl File {
    /// The items of a kind that have a body, found by counting braces.
    pub fn blocks(&self, keyword: &str) -> Vec<Block> {
        let starts = self.code.match_indices(keyword).map(|(at, _)| at);
        starts
            .filter(|&at| self.stands_alone(at))
            .filter_map(|at| self.block(at, keyword))
            .collect()
    }

    fn stands_alone(&self, at: usize) -> bool {
        let before = self.code[..at].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && c != '_')
    }

    fn block(&self, at: usize, keyword: &str) -> Option<Block> {
        let rest = &self.code[at..];
        let name = |c: &char| c.is_alphanumeric() || *c == '_';
        let name: String = rest[keyword.len()..].chars().take_while(name).collect();
        let open = rest.find('{')?;
        // A declaration without a body, or a function type, ends before any brace.
        if name.is_empty() || rest[..open].contains(';') {
            return None;
        }
        let mut depth = 0;
        for (i, c) in rest.char_indices().skip_while(|(i, _)| *i < open) {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                let text = rest[..=i].to_string();
                return Some(Block {
                    name,
                    lines: text.lines().count(),
                    text,
                });
            }
        }
        None
    }
}

/// The text with comments left out and the insides of literals blanked; lines stay.
fn stripped(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let taken = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            'r' if rest.starts_with("r#\"") => rest.find("\"#").map_or(rest.len(), |end| end + 2),
            '"' => string_length(rest),
            '\'' => char_length(rest),
            _ => {
                code.push(c);
                c.len_utf8()
            }
        };
        if c == '"' || c == '\'' {
            code.extend(rest[..taken].chars().filter(|c| *c == '\n' || *c == '\''));
        }
        rest = &rest[taken..];
    }
    code
}

fn string_length(rest: &str) -> usize {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            '"' if !escaped => return i + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    rest.len()
}

/// The length of a character literal, or one for a lifetime's mark.
fn char_length(rest: &str) -> usize {
    let mut inside = rest[1..].chars();
    let literal = match inside.next() {
        Some('\\') => rest[2..].find('\'').map(|end| end + 3),
        Some(c) if inside.next() == Some('\'') => Some(2 + c.len_utf8()),
        _ => None,
    };
    // An escaped quote, `'\''`, has its closing mark one further.
    literal.map_or(1, |length| length + usize::from(rest.starts_with("'\\''")))
}
