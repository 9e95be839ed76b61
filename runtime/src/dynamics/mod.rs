//! Accelerations and reactions of constrained mechanisms.

mod settings;

pub use settings::{Counters, Form, Settings, Stabilisation};
