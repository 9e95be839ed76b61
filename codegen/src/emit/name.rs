//! Readable Rust names for what a description names.

use proc_macro2::{Ident, Span};
use std::collections::{BTreeMap, BTreeSet};

/// A word of the emitted code.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// Gives each thing a name of its own.
#[derive(Clone, Debug, Default)]
pub(super) struct Names {
    taken: BTreeSet<String>,
    /// The number that the next thing of a wish is tried with: all before are taken.
    next: BTreeMap<String, usize>,
}

impl Names {
    /// Names that are already in use.
    pub fn reserving(names: &[&str]) -> Self {
        Self {
            taken: names.iter().map(|name| name.to_string()).collect(),
            next: BTreeMap::new(),
        }
    }

    /// New names close to wishes. A wish that is spelt as Rust expects it is granted as it
    /// is, wherever it stands: of `L` and `l` the latter is `l`.
    pub fn all(&mut self, wishes: &[&str]) -> Vec<Ident> {
        let exact = |wish: &str| snake_case(wish) == wish;
        let granted: Vec<Option<Ident>> = wishes
            .iter()
            .map(|wish| exact(wish).then(|| self.unique(wish)))
            .collect();
        let both = wishes.iter().zip(granted);
        both.map(|(wish, granted)| granted.unwrap_or_else(|| self.unique(wish)))
            .collect()
    }

    /// A new name close to a wish; `_2`, `_3`, … is added where it is taken.
    pub fn unique(&mut self, wish: &str) -> Ident {
        let base = snake_case(wish);
        let next = self.next.entry(base.clone()).or_insert(1);
        loop {
            let name = match *next {
                1 => base.clone(),
                number => format!("{base}_{number}"),
            };
            *next += 1;
            if self.taken.insert(name.clone()) {
                return ident(&name);
            }
        }
    }
}

/// `theta[0]` → `theta_0`, `rodLength` → `rod_length`, `L1` → `l1`; a keyword gets
/// a trailing underscore.
pub fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    let mut previous_lower = false;
    for c in name.chars() {
        let separates = matches!(c, '[' | '.' | '_') || (c.is_uppercase() && previous_lower);
        // Two in a row are no snake case.
        if separates && !snake.ends_with('_') {
            snake.push('_');
        }
        previous_lower = c.is_lowercase();
        if !matches!(c, '[' | ']' | '.' | '_') {
            snake.extend(c.to_lowercase());
        }
    }
    if is_identifier(&snake) {
        snake
    } else {
        format!("{snake}_")
    }
}

/// Whether Rust takes a word for a name, in any edition: `syn` knows the keywords up to that of
/// 2021, and edition 2024 adds one.
fn is_identifier(word: &str) -> bool {
    word != "gen" && syn::parse_str::<Ident>(word).is_ok()
}

/// Types that stand beside a mechanism's in its module.
const NEIGHBOURS: &str = "\
    Canvas Condition ConnectedComponent ConstraintRow Correction Declared Default Described \
    Differentiated Direction Energy Event Initial Inputs Interface Linearised Mechanism \
    Multiplier None Option Parameters Partials Position Quantity Real Acceleration Result \
    SMatrix SVector Self Some Start StartEquations StartFault State Structure Switch T Table \
    Terms";

/// The static of a table.
pub(super) fn table_name(index: u32) -> Ident {
    ident(&format!("TABLE_{index}"))
}

/// `slider_crank` → `SliderCrank`; what is in camel case stays so. A name that one
/// of its neighbours has gets `Mechanism` in front.
pub fn camel_case(name: &str) -> String {
    let mut camel = String::new();
    for word in name.split('_').filter(|word| !word.is_empty()) {
        let mut letters = word.chars();
        camel.extend(letters.next().into_iter().flat_map(char::to_uppercase));
        camel.push_str(letters.as_str());
    }
    let is_taken = NEIGHBOURS.split(' ').any(|name| name == camel);
    if !is_taken && is_identifier(&camel) {
        camel
    } else {
        format!("Mechanism{camel}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_in_the_case_that_rust_expects() {
        assert_eq!(snake_case("theta[0]"), "theta_0");
        assert_eq!(snake_case("L01"), "l01");
        assert_eq!(snake_case("type"), "type_");
        assert_eq!(snake_case("gen"), "gen_");
        assert_eq!(snake_case("cos_type__sin_type_"), "cos_type_sin_type_");
        assert_eq!(camel_case("double_four_bar"), "DoubleFourBar");
        assert_eq!(camel_case("SliderCrank"), "SliderCrank");
    }

    #[test]
    fn names_that_differ_in_case_alone_stay_different() {
        let mut names = Names::default();
        assert_eq!(names.unique("L1").to_string(), "l1");
        assert_eq!(names.unique("l1").to_string(), "l1_2");
        let fields = Names::default().all(&["L", "M", "l", "m_"]);
        let fields: Vec<String> = fields.iter().map(Ident::to_string).collect();
        assert_eq!(fields, ["l_2", "m", "l", "m_"]);
    }
}
