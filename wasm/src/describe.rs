//! What a mechanism has, as JSON.
//!
//! In:  its structure.
//! Out: `{"name": …, "docs": …, "coordinates": [{"name": …, "unit": …, "docs": …}, …], …}`.

use bricard_runtime::{Quantity, Structure};
use core::fmt::{Result, Write};

/// Writes what a mechanism has.
pub fn describe(structure: &Structure, out: &mut dyn Write) -> Result {
    out.write_str("{\"name\":")?;
    string(structure.name, out)?;
    out.write_str(",\"docs\":")?;
    string(structure.docs, out)?;
    for (name, quantities) in [
        ("coordinates", structure.coordinates),
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
    out.write_str("}")
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
