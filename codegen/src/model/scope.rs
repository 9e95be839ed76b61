//! Names and what they mean.
//!
//! All symbols share one namespace, without shadowing: a name that is in use
//! can't be declared again. Functions and units have namespaces of their own.

use super::value::{Bare, Value};
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::ast::Name;
use crate::syntax::messages::{DECLARED, RENAME, RENAME_ONE};
use rustc_hash::{FxHashMap, FxHashSet};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `const`
    Constant,
    /// `param`
    Parameter,
    /// `coord`
    Coordinate,
    /// `state`
    State,
    /// `input`
    Input,
    /// `let`
    Quantity,
    /// The index of a repetition.
    Index,
    /// An argument of a function.
    Argument,
    /// A part, `let left = Leg(…)`, whose names have `left.` in front.
    Part,
}

impl Kind {
    /// The kind in words.
    pub fn words(self) -> &'static str {
        match self {
            Kind::Constant => "a constant",
            Kind::Parameter => "a parameter",
            Kind::Coordinate => "a coordinate",
            Kind::State => "a state",
            Kind::Input => "an input",
            Kind::Quantity => "a quantity",
            Kind::Index => "an index",
            Kind::Argument => "an argument",
            Kind::Part => "a part",
        }
    }
}

/// A declared name.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The name and where it is declared.
    pub name: Name,
    /// What it stands for.
    pub kind: Kind,
    /// Its value, once it is known and if it is right.
    pub value: Option<Value>,
    /// Whether a formula mentions it.
    pub used: bool,
    /// The number without unit that it is made with, if there is one.
    pub bare: Option<Bare>,
}

/// Names that mean something everywhere.
pub const BUILT_IN: [(&str, &str); 3] = [
    ("t", "the time"),
    ("pi", "the number π"),
    ("deg", "the factor π/180"),
];

/// The names that mean something everywhere.
pub fn built_in() -> impl Iterator<Item = &'static str> {
    BUILT_IN.iter().map(|(name, _)| *name)
}

/// The names in force.
#[derive(Debug, Default)]
pub struct Scope {
    entries: Vec<Entry>,
    index: FxHashMap<String, usize>,
    /// What stands in front of the names of the function or part that is being looked at:
    /// its own names hide those of the mechanism around it.
    prefix: String,
    /// The number of names that are declared outside loops and functions.
    outermost: usize,
    /// Names that statements with mistakes may have declared.
    pub unreadable: FxHashSet<String>,
    /// Names of outputs, which no formula can use.
    pub outputs: FxHashSet<String>,
}

impl Scope {
    /// A name as it is called everywhere: with what stands in front of it.
    pub fn full(&self, name: &str) -> String {
        format!("{}{name}", self.prefix)
    }

    /// The place of a name: of the part that is being looked at, else of the mechanism.
    fn place(&self, name: &str) -> Option<usize> {
        if !self.prefix.is_empty()
            && let Some(own) = self.index.get(&self.full(name))
        {
            return Some(*own);
        }
        self.index.get(name).copied()
    }

    /// Declares a name without a value.
    pub fn declare(&mut self, name: &Name, kind: Kind) -> Result<(), Box<Diagnostic>> {
        if let Some((_, meaning)) = BUILT_IN.iter().find(|(known, _)| *known == name.text) {
            let message = format!("`{}` is {meaning} already", name.text);
            let error = Diagnostic::error(name.span, message);
            return Err(Box::new(error.help(RENAME)));
        }
        let full = Name {
            text: self.full(&name.text),
            span: name.span,
        };
        if let Some(first) = self.index.get(&full.text).map(|&i| &self.entries[i]) {
            return Err(Box::new(
                twice(name, first.name.span).labelled("declared again here"),
            ));
        }
        self.index.insert(full.text.clone(), self.entries.len());
        self.entries.push(Entry {
            name: full,
            kind,
            value: None,
            used: false,
            bare: None,
        });
        Ok(())
    }

    /// What a name stands for.
    pub fn get(&self, name: &str) -> Option<&Entry> {
        self.place(name).map(|i| &self.entries[i])
    }

    /// What a name stands for, noting that it is used. In full, it is that of a part.
    pub fn look_up(&mut self, name: &str, full: bool) -> Option<&Entry> {
        let place = match full {
            true => self.index.get(name).copied(),
            false => self.place(name),
        };
        let entry = &mut self.entries[place?];
        entry.used = true;
        Some(entry)
    }

    /// Gives a declared name, in full, its value and the number without unit in it.
    pub fn define(&mut self, full: &str, value: Option<Value>, bare: Option<Bare>) {
        if let Some(&i) = self.index.get(full) {
            (self.entries[i].value, self.entries[i].bare) = (value, bare);
        }
    }

    /// Gives a declared name its value.
    pub fn set(&mut self, name: &str, value: Option<Value>) {
        if let Some(i) = self.place(name) {
            self.entries[i].value = value;
        }
    }

    /// Says of a name that nothing is known of it but that it is declared.
    pub fn make_unknown(&mut self, name: &str) {
        if let Some(i) = self.place(name) {
            (self.entries[i].kind, self.entries[i].value) = (Kind::Argument, None);
        }
    }

    /// Remembers the number without unit that a quantity is made with.
    pub fn set_bare(&mut self, name: &str, bare: Option<Bare>) {
        if let Some(i) = self.place(name) {
            self.entries[i].bare = bare;
        }
    }

    /// A mark to return to with [`Scope::close`].
    pub fn open(&self) -> usize {
        self.entries.len()
    }

    /// Forgets the names declared since a mark and returns them.
    pub fn close(&mut self, mark: usize) -> Vec<Entry> {
        let gone = self.entries.split_off(mark);
        for entry in &gone {
            self.index.remove(&entry.name.text);
        }
        gone
    }

    /// Says that the names declared so far stand outside loops and functions.
    pub fn set_outermost(&mut self) {
        self.outermost = self.entries.len();
    }

    /// Looks from elsewhere: with another prefix, and without the names of the loops and
    /// functions around. Returns what [`Scope::come_back`] needs.
    pub fn look_from(&mut self, prefix: &str) -> (String, Vec<Entry>) {
        let hidden = self.close(self.outermost.min(self.entries.len()));
        (std::mem::replace(&mut self.prefix, prefix.into()), hidden)
    }

    /// Ends what [`Scope::look_from`] began.
    pub fn come_back(&mut self, (prefix, hidden): (String, Vec<Entry>)) {
        self.close(self.outermost.min(self.entries.len()));
        self.prefix = prefix;
        for entry in hidden {
            self.index
                .insert(entry.name.text.clone(), self.entries.len());
            self.entries.push(entry);
        }
    }

    /// The declared names, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.name.text.as_str())
    }
}

/// The finding that a name is declared twice.
pub fn twice(name: &Name, first: Span) -> Diagnostic {
    Diagnostic::error(name.span, format!("`{}` is declared twice", name.text))
        .also(first, DECLARED)
        .help(RENAME_ONE)
}
