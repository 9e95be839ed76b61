//! The text of a page.
//!
//! In:  a title, JSON.
//! Out: the template with all that goes into it.

use serde_json::Value;

/// The page, with `{{NAME}}` where something has to go.
const TEMPLATE: &str = include_str!("assets/page.html");
/// What goes into all pages. Only `run` differs from one to the next.
const PARTS: [(&str, &str); 3] = [
    (
        "style",
        concat!(
            include_str!("assets/vendor/uPlot.min.css"),
            include_str!("assets/page.css"),
        ),
    ),
    ("uPlot", include_str!("assets/vendor/uPlot.iife.min.js")),
    (
        "script",
        concat!(
            include_str!("assets/text.js"),
            include_str!("assets/scene.js"),
            include_str!("assets/view.js"),
            include_str!("assets/curves.js"),
            include_str!("assets/player.js"),
            include_str!("assets/page.js"),
        ),
    ),
];

/// The text of a page.
pub fn page(title: &str, data: &Value) -> String {
    let mut text = String::new();
    let mut rest = TEMPLATE;
    while let Some((before, name, after)) = marker(rest) {
        text.push_str(before);
        match name {
            "title" => text.push_str(&escaped(title)),
            // What would end the element, or begin a comment in it, begins with this.
            "run" => text.push_str(&data.to_string().replace('<', "\\u003c")),
            _ => text.extend(
                PARTS
                    .iter()
                    .filter(|part| part.0 == name)
                    .map(|part| part.1),
            ),
        }
        rest = after;
    }
    text + rest
}

/// The first `{{NAME}}` of a text, and what is before and after it.
fn marker(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once("{{")?;
    let (name, after) = rest.split_once("}}")?;
    Some((before, name, after))
}

fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;");
    text.replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{PARTS, TEMPLATE, marker, page};
    use serde_json::json;

    #[test]
    fn every_marker_of_the_page_has_something_to_go_there() {
        let mut rest = TEMPLATE;
        let mut found = 0;
        while let Some((_, name, after)) = marker(rest) {
            let known = PARTS.iter().any(|part| part.0 == name);
            assert!(known || ["title", "run"].contains(&name), "{name}");
            found += 1;
            rest = after;
        }
        assert_eq!(found, PARTS.len() + 2);
    }

    #[test]
    fn no_part_ends_the_element_that_it_stands_in() {
        for (name, part) in PARTS {
            assert!(
                !part.contains("</script") && !part.contains("</style"),
                "{name}"
            );
        }
    }

    #[test]
    fn what_a_description_says_never_becomes_markup() {
        let hostile = "</script><script>alert('1')</script><!-- {{script}} \"ä\u{2028}";
        let text = page(hostile, &json!({ "docs": hostile }));
        let count = |what: &str| text.matches(what).count();
        let plain = page("x", &json!({}));
        assert_eq!(count("</script"), plain.matches("</script").count());
        assert_eq!(count("<script"), plain.matches("<script").count());
        assert_eq!(count("<!--"), plain.matches("<!--").count());
        assert!(text.contains("{{script}}"));
    }
}
