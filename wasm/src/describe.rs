//! What a mechanism has, as JSON.
//!
//! In:  its structure.
//! Out: `{"name": …, "docs": …, "coordinates": [{"name": …, "unit": …, "docs": …}, …], …}`;
//!      of events and of multipliers the names alone.

use bricard_runtime::{Quantity, Structure};
use core::fmt::{Result, Write};

/// Writes what a mechanism has.
pub fn describe(structure: &Structure, out: &mut dyn Write) -> Result {
    out.write_str("{\"name\":")?;
    string(structure.name, out)?;
    out.write_str(",\"docs\":")?;
    string(structure.docs, out)?;
    let (freedoms, states) = structure.coordinates.split_at(structure.freedoms().len());
    for (name, quantities) in [
        ("coordinates", freedoms),
        ("states", states),
        ("parameters", structure.parameters),
        ("inputs", structure.inputs),
        ("outputs", structure.outputs),
    ] {
        write!(out, ",\"{name}\":[")?;
        for (place, each) in quantities.iter().enumerate() {
            out.write_str(if place == 0 { "" } else { "," })?;
            quantity(each, out)?;
        }
        out.write_str("]")?;
    }
    let events = structure.events.iter().map(|event| event.name);
    names("events", events, out)?;
    let multipliers = structure.multipliers.iter().map(|row| row.quantity.name);
    names("multipliers", multipliers, out)?;
    out.write_str("}")
}

/// A list of names.
fn names<'a>(name: &str, all: impl Iterator<Item = &'a str>, out: &mut dyn Write) -> Result {
    write!(out, ",\"{name}\":[")?;
    for (place, each) in all.enumerate() {
        out.write_str(if place == 0 { "" } else { "," })?;
        string(each, out)?;
    }
    out.write_str("]")
}

fn quantity(quantity: &Quantity, out: &mut dyn Write) -> Result {
    out.write_str("{\"name\":")?;
    string(quantity.name, out)?;
    out.write_str(",\"unit\":")?;
    string(quantity.unit, out)?;
    out.write_str(",\"docs\":")?;
    string(quantity.docs, out)?;
    out.write_str("}")
}

/// A text between quotes, with what JSON doesn't take as it is.
fn string(text: &str, out: &mut dyn Write) -> Result {
    out.write_char('"')?;
    for letter in text.chars() {
        match letter {
            '"' | '\\' => {
                out.write_char('\\')?;
                out.write_char(letter)?;
            }
            letter if letter < ' ' => write!(out, "\\u{:04x}", u32::from(letter))?,
            letter => out.write_char(letter)?,
        }
    }
    out.write_char('"')
}

#[cfg(test)]
mod tests {
    use super::describe;
    use crate::Text;
    use bricard_runtime::{Quantity, Structure};

    #[test]
    fn what_json_does_not_take_as_it_is_is_escaped() {
        const LENGTH: Quantity = Quantity {
            name: "L[0]",
            unit: "m",
            docs: "the \"long\" one\n\\ ℓ",
        };
        let structure = Structure {
            name: "Bar",
            parameters: &[LENGTH, LENGTH],
            ..Structure::PLAIN
        };
        let mut text = Text::new();
        describe(&structure, &mut text).expect("there is room");
        let length = r#"{"name":"L[0]","unit":"m","docs":"the \"long\" one\u000a\\ ℓ"}"#;
        let rest = r#","inputs":[],"outputs":[],"events":[],"multipliers":[]}"#;
        let begin = r#"{"name":"Bar","docs":"","coordinates":[],"states":[],"parameters":["#;
        let wanted = [begin, length, ",", length, "]", rest];
        let mut told = core::str::from_utf8(text.bytes()).expect("text");
        for part in wanted {
            told = told.strip_prefix(part).expect(part);
        }
        assert_eq!(told, "");
    }

    #[test]
    fn a_description_without_room_is_refused() {
        let long = "ℓ".repeat(Text::ROOM);
        let structure = Structure {
            docs: Box::leak(long.into_boxed_str()),
            ..Structure::PLAIN
        };
        assert!(describe(&structure, &mut Text::new()).is_err());
    }
}
