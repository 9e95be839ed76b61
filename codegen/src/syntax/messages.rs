//! What is said in several places, in the same words.
//!
//! Out: sentences of messages, about how the language is written and what to do.

/// What is said beside a place where a name was declared.
pub const DECLARED: &str = "declared here";
/// What is said beside the first of two things that exclude each other.
pub const GIVEN: &str = "given here";
pub const RENAME: &str = "choose another name";
pub const RENAME_ONE: &str = "choose another name for one of them";
pub const REMOVE: &str = "remove it";
pub const REMOVE_ONE: &str = "remove one of them";
/// What to do about too many levels.
pub const NAME_INSIDE: &str = "give what is inside a name of its own with `let`";

/// What was expected.
pub const FORMULA: &str = "a formula";
pub const AXIS: &str = "`x`, `y` or `z` behind the dot";

pub const NO_ELEMENTS: &str = "a number has no elements";
pub const NO_ASSIGNMENT: &str = "`:=` is not used here";
pub const NO_DOUBLE_STAR: &str = "`**` is not an operator";
pub const NO_QUOTES: &str = "quoted text has no meaning here";
pub const NO_UNIT_BEHIND: &str = "a unit can't stand behind a number";

/// How something is written.
pub const NAMES: &str = "names are made of the letters a–z and A–Z, digits and `_`";
pub const NUMBERS: &str = "numbers are written like `12`, `0.5` or `1e-3`";
pub const LARGE_AND_SMALL: &str = "numbers lie between 1e-308 and 1e308";
pub const CHOICE: &str = "a choice is written `if a < b then x else y`";
pub const AND: &str = "conditions are joined with `and`: `if a < b and c < d then x else y`";
pub const FOR: &str = "repetition is written `for i in 0..K { … }`";
pub const POINT: &str = "a point or vector is written `[x, y]`";
pub const COMPONENT: &str = "a component is written `.x`, `.y` or `.z`, or with an index: `[0]`";

/// Says that a name behind a dot is none of a component.
pub fn no_axis(found: &str) -> String {
    format!("expected {AXIS}, found `{found}`")
}

/// Asks for the name that was probably meant.
pub fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}
