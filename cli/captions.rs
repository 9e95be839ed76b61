//! Short descriptions of mechanisms: how large they are, what they are.
//!
//! In:  counts, documentation.
//! Out: text.

use bricard_codegen::internals::model::Mechanism;

/// A number of degrees of freedom in words.
pub fn freedom(n: usize) -> String {
    format!("{n} degree{} of freedom", if n == 1 { "" } else { "s" })
}

/// How many coordinates, states and constraint equations there are.
pub fn sizes(mechanism: &Mechanism) -> String {
    let states = match mechanism.states {
        0 => String::new(),
        n => format!(", {} of the first order", counted(n, "state")),
    };
    let coordinates = counted(mechanism.freedoms(), "coordinate");
    let equations = counted(mechanism.constraints.len(), "constraint equation");
    format!("{coordinates}{states}, {equations}")
}

/// A number of things in words.
pub fn counted(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}

/// The first sentence, on one line.
pub fn first_sentence(docs: &str) -> String {
    let lines = docs
        .lines()
        .map(str::trim)
        .skip_while(|line| line.is_empty());
    let paragraph: Vec<&str> = lines.take_while(|line| !line.is_empty()).collect();
    let paragraph = paragraph.join(" ");
    match paragraph.split_once(". ") {
        Some((first, _)) => format!("{first}."),
        None => paragraph,
    }
}

#[cfg(test)]
mod tests {
    use super::first_sentence;

    #[test]
    fn the_first_sentence_ends_at_its_full_stop() {
        assert_eq!(
            first_sentence("\n a linkage\n of bars. It moves.\n\nMore."),
            "a linkage of bars."
        );
        assert_eq!(first_sentence("a linkage"), "a linkage");
        assert_eq!(first_sentence(""), "");
    }
}
