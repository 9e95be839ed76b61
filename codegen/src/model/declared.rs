//! What a description declares for its formulas to use: functions and parts.

use super::order::{Mention, collect};
use crate::diagnostic::{Label, Span};
use crate::syntax::ast::{Expr, Function, Let, Name};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;
use std::rc::Rc;

/// The functions of a description, by name.
#[derive(Debug, Default)]
pub struct Functions {
    /// Each with what it mentions.
    pub known: BTreeMap<String, Known>,
}

/// A function.
#[derive(Debug)]
pub struct Known {
    /// What is written; `None` if it takes part in a circle, or calls what does, which has
    /// been reported.
    pub item: Option<Rc<Function>>,
    /// The names around it that its formula mentions, also through other functions.
    pub mentions: Vec<String>,
    /// Whether it is called.
    pub used: bool,
}

impl Functions {
    /// Whether there is a function of a name.
    pub fn contains(&self, name: &str) -> bool {
        self.known.contains_key(name)
    }

    /// The names of the functions.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.known.keys().map(String::as_str)
    }

    /// The names that formulas mention, also through functions.
    pub fn mentions<'a>(&self, formulas: impl IntoIterator<Item = &'a Expr>) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        for formula in formulas {
            collect(formula, &mut |mention| match mention {
                Mention::Name(name) => names.push(name.to_string()),
                Mention::Call(name) => {
                    let inside = self.known.get(name).into_iter();
                    names.extend(inside.flat_map(|function| function.mentions.iter().cloned()));
                }
            });
        }
        names
    }
}

/// Where names are looked up: in the mechanism itself, or in a part of it.
#[derive(Debug, Default)]
pub struct Frame {
    /// What stands in front of its names: `left.`, `leg[2].`
    pub prefix: String,
    /// Where it is used, from outside inwards.
    pub uses: Vec<Label>,
    /// The names of the parts around, from outside inwards.
    pub parts: Vec<String>,
}

impl Frame {
    /// Whether it is that of a part that nothing uses, or of one inside.
    pub fn is_unread(&self) -> bool {
        self.parts.len() > self.uses.len()
    }
}

/// A quantity that waits for its value.
#[derive(Debug)]
pub struct Waiting {
    /// What is written.
    pub quantity: Rc<Let>,
    /// Where its formula is looked up.
    pub frame: Rc<Frame>,
    /// The index of the array of parts that it is an argument of.
    pub index: Option<(Name, i64)>,
    /// The part that it is an argument of.
    pub argument_of: Option<String>,
}

/// The parts of a description and the quantities in them.
#[derive(Debug, Default)]
pub struct Parts {
    /// The names behind `part`, and where they stand.
    pub declared: BTreeMap<String, Span>,
    /// What the parts that are used declare, by their names in full: `leg[2]`.
    pub used: BTreeMap<String, Vec<String>>,
    /// Quantities without a value yet, by their names in full.
    pub waiting: FxHashMap<String, Rc<Waiting>>,
    /// The quantities that are being evaluated.
    pub open: Vec<String>,
}

impl Parts {
    /// Whether there is a part of a name.
    pub fn known(&self, name: &str) -> bool {
        self.declared.contains_key(name)
    }
}
