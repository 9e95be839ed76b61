//! The recorded figures.
//!
//! In:  `benches/recorded.json`.
//! Out: what each kernel is known to cost, and what has become worse.

use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::PathBuf;

/// By how much a count may be worse than the recorded one.
const MORE: f64 = 0.03;

/// Instructions by kernel.
pub struct Recorded(Map<String, Value>);

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../recorded.json")
}

impl Recorded {
    /// Reads what is recorded; nothing if there is no file.
    ///
    /// # Errors
    ///
    /// A file that is not as this program writes it.
    pub fn read() -> Result<Self, Box<dyn Error>> {
        let Ok(text) = fs::read_to_string(path()) else {
            return Ok(Self(Map::new()));
        };
        let whole: Value = serde_json::from_str(&text)?;
        let figures = whole["instructions"]
            .as_object()
            .ok_or("recorded.json has no `instructions`")?;
        Ok(Self(figures.clone()))
    }

    /// What a kernel is known to cost.
    pub fn of(&self, kernel: &str) -> Option<f64> {
        self.0.get(kernel).and_then(Value::as_f64)
    }

    /// All of them.
    pub fn counts(&self) -> BTreeMap<String, f64> {
        let figure = |(kernel, value): (&String, &Value)| Some((kernel.clone(), value.as_f64()?));
        self.0.iter().filter_map(figure).collect()
    }

    /// Whether a count is worse than the recorded one by more than is allowed.
    pub fn is_worse(&self, kernel: &str, count: f64) -> bool {
        self.of(kernel)
            .is_some_and(|known| count > known * (1.0 + MORE))
    }

    /// Records a count.
    pub fn set(&mut self, kernel: &str, count: f64) {
        self.0
            .insert(kernel.to_string(), json!((count * 10.0).round() / 10.0));
    }

    /// Writes the file.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn write(self) -> Result<(), Box<dyn Error>> {
        let whole = json!({
            "what": "instructions of one call, x86-64-v3, by callgrind",
            "instructions": self.0,
        });
        fs::write(path(), format!("{whole:#}\n"))?;
        Ok(())
    }
}
