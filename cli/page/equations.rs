//! The equations of motion as MathML.
//!
//! In:  a description.
//! Out: JSON: of each array what it is, and its entries that are not zero.

use crate::show::equations;
use pulldown_latex::config::{DisplayMode, RenderConfig};
use pulldown_latex::{Parser, Storage, push_mathml};
use serde_json::{Value, json};
use std::path::Path;

/// Letters of LaTeX that a page has room for.
const MOST: usize = 15_000;

/// The equations of motion of the description in a file; none if it is not known.
///
/// `M q̈ + C q̇ + h = Q + Gᵀ λ`, `G q̈ = p₂`.
pub fn mathml(description: Option<(&Path, &str)>) -> Vec<Value> {
    let arrays = description.and_then(|(file, source)| equations(file, source, MOST as u64));
    let mut room = MOST;
    let mut all = Vec::new();
    for (title, entries) in arrays.unwrap_or_default() {
        let count = entries.as_ref().map_or(0, Vec::len);
        let lines = entries.map(|mut entries| {
            entries.retain(|[_, value]| value != "0");
            entries
        });
        let length = |lines: &[[String; 2]]| lines.iter().flatten().map(String::len).sum::<usize>();
        let shown = lines.filter(|lines| length(lines) <= room);
        let long = shown.is_none();
        let shown = shown.unwrap_or_default();
        room -= length(&shown);
        all.push(json!({
            "title": title,
            "zeros": count - shown.len(),
            "long": long,
            "lines": shown.iter().filter_map(formula).collect::<Vec<_>>(),
        }));
    }
    all
}

/// An entry and its value.
fn formula([entry, value]: &[String; 2]) -> Option<String> {
    let storage = Storage::new();
    let text = format!("{entry} = {value}");
    let config = RenderConfig {
        display_mode: DisplayMode::Block,
        xml: true,
        ..RenderConfig::default()
    };
    let mut mathml = String::new();
    push_mathml(&mut mathml, Parser::new(&text, &storage), config).ok()?;
    // What is no LaTeX is written as a message in red.
    (!mathml.contains("<merror")).then_some(mathml)
}

#[cfg(test)]
mod tests {
    use super::{formula, mathml};
    use roxmltree::Document;
    use std::path::Path;

    /// Elements of MathML that take a certain number of others.
    const CHILDREN: [(&str, usize); 6] = [
        ("msup", 2),
        ("msub", 2),
        ("msubsup", 3),
        ("mfrac", 2),
        ("mover", 2),
        ("munder", 2),
    ];

    #[test]
    fn formulas_of_the_library_are_mathml() {
        for name in ["slider_crank", "rssr", "driven_pivot"] {
            let description = bricard::source(name).map(|source| (Path::new(name), source));
            let all = description
                .and_then(|(file, source)| crate::show::equations(file, source, u64::MAX));
            let all = all.unwrap_or_default();
            let lines = all.iter().filter_map(|(_, lines)| lines.as_ref()).flatten();
            let nonzero = lines.filter(|[_, e]| e != "0");
            let arrays = mathml(description);
            let lines = arrays.iter().flat_map(|array| array["lines"].as_array());
            let lines: Vec<_> = lines.flatten().filter_map(|line| line.as_str()).collect();
            assert_eq!(lines.len(), nonzero.count(), "{name}: {arrays:?}");
            assert!(lines.len() > 5, "{name}");
            for line in lines {
                assert!(
                    line.starts_with("<math") && !line.contains("merror"),
                    "{line}"
                );
            }
        }
    }

    #[test]
    fn elements_of_mathml_have_as_many_others_as_they_take() {
        for name in bricard::NAMES {
            let description = bricard::source(name).map(|source| (Path::new(name), source));
            let arrays = mathml(description);
            let lines = arrays.iter().flat_map(|array| array["lines"].as_array());
            for line in lines.flatten().filter_map(|line| line.as_str()) {
                let document = Document::parse(line).expect("it is XML");
                for node in document.descendants() {
                    let kind = node.tag_name().name();
                    let wanted = CHILDREN.iter().find(|(known, _)| *known == kind);
                    let count = node.children().filter(|child| child.is_element()).count();
                    assert!(
                        wanted.is_none_or(|(_, wanted)| count == *wanted),
                        "{name}: `{kind}` has {count} in {line}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_formula_says_what_it_says() {
        let entry = [
            "M_{1,1}".to_string(),
            r"\tfrac{1}{4}\,m_{1}\,{L}^{2}".to_string(),
        ];
        let mathml = formula(&entry).expect("it is LaTeX");
        assert!(
            mathml.contains("<mfrac") && mathml.contains("<msup>"),
            "{mathml}"
        );
    }
}
