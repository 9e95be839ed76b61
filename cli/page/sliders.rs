//! What the sliders of a page need: the mechanism itself, and how it was run.
//!
//! In:  a WebAssembly module, a plan, changes.
//! Out: JSON. What sliders there are and how far they go is the page's business.

use crate::column::Column;
use crate::run::Plan;
use base64::{Engine, engine::general_purpose::STANDARD};
use bricard_driver::{Changes, Given, Scene};
use bricard_runtime::{Quantity, Stabilisation, StepControl, Structure};
use serde_json::{Map, Value, json};

/// Rows of a run in the page: more are not seen, and take time.
const ROWS: f64 = 6000.0;

/// A mechanism that a page can run anew.
pub struct Sliders<'a> {
    /// The mechanism as WebAssembly.
    pub module: &'a [u8],
    /// How it was run.
    pub plan: &'a Plan,
    /// What was changed of it.
    pub changes: &'a Changes,
}

impl Sliders<'_> {
    /// All of it, for the script of the page.
    pub fn json(&self, structure: &Structure, columns: &[Column], scene: &Scene) -> Value {
        let options = &self.plan.options;
        let settings = &options.settings;
        let stabilisation = match settings.stabilisation {
            Stabilisation::Projection => json!("projection"),
            Stabilisation::None => json!("none"),
            Stabilisation::Baumgarte { alpha, beta } => json!({ "alpha": alpha, "beta": beta }),
        };
        let steps = match options.step_control {
            StepControl::Fixed { step } => json!({ "step": step }),
            StepControl::Adaptive { relative, absolute } => {
                json!({ "rtol": relative, "atol": absolute })
            }
        };
        let parameters = structure.parameters.iter().zip(&scene.parameters);
        json!({
            "module": STANDARD.encode(self.module),
            "until": options.until,
            "every": self.every(),
            "columns": kinds(columns),
            "method": options.method.to_string(),
            "steps": steps,
            "settings": {
                "form": options.settings.form.to_string(),
                "stabilisation": stabilisation,
                "published": settings.published,
                "acrossSwitches": settings.across_switches,
                "keepEnergy": options.keep_energy,
            },
            "parameters": parameters.map(|(x, value)| quantity(x, Some(*value))).collect::<Vec<_>>(),
            "inputs": structure.inputs.iter().enumerate().map(|(i, x)| quantity(x, self.held(i))).collect::<Vec<_>>(),
            "units": units(structure),
            "held": self.given(structure, true),
            "guessed": self.given(structure, false),
        })
    }

    /// Distance of the rows (s).
    fn every(&self) -> f64 {
        let until = self.plan.options.until;
        let every = match (self.plan.every, self.plan.options.step_control) {
            (Some(every), _) => every,
            (None, StepControl::Fixed { step }) => step,
            (None, StepControl::Adaptive { .. }) => until.max(1.0),
        };
        every * (until / (every * ROWS)).ceil().max(1.0)
    }

    /// The value that an input is held at.
    fn held(&self, place: usize) -> Option<f64> {
        let mut inputs = self.changes.inputs.iter();
        let found = inputs.find(|(index, _)| *index == place);
        found.map(|(_, value)| *value)
    }

    /// What is given for the start, held or guessed, by name.
    fn given(&self, structure: &Structure, held: bool) -> Value {
        let wanted = self.changes.given.iter().filter(|given| given.held == held);
        let entry = |given: &Given| {
            let name = structure.coordinates.get(given.coordinate)?.name;
            // A state is the velocity of its integral.
            let of_freedom = given.coordinate < structure.freedoms().len();
            let name = match given.velocity && of_freedom {
                true => format!("der({name})"),
                false => name.to_string(),
            };
            Some((name, json!(given.value)))
        };
        Value::Object(wanted.filter_map(entry).collect::<Map<_, _>>())
    }
}

fn quantity(quantity: &Quantity, value: Option<f64>) -> Value {
    let Quantity { name, unit, docs } = quantity;
    json!({ "name": name, "unit": unit, "docs": docs.trim(), "value": value })
}

/// Units and documentation of what a start gives, by name.
fn units(structure: &Structure) -> Value {
    let (freedoms, states) = structure.coordinates.split_at(structure.freedoms().len());
    let rate = |x: &Quantity| {
        let unit = match x.unit {
            "" => String::new(),
            unit => format!("{unit}/s"),
        };
        let entry = json!({ "unit": unit, "docs": "" });
        (format!("der({})", x.name), entry)
    };
    let plain = freedoms.iter().chain(states);
    let plain = plain.map(|x| (x.name.to_string(), quantity(x, None)));
    Value::Object(plain.chain(freedoms.iter().map(rate)).collect())
}

/// The kinds of columns that a module writes, of those of a page.
fn kinds(columns: &[Column]) -> Vec<&'static str> {
    let mut kinds: Vec<&str> = columns.iter().map(|column| kind(*column)).collect();
    kinds.sort_unstable();
    kinds.dedup();
    kinds
}

fn kind(column: Column) -> &'static str {
    match column {
        Column::Energy | Column::Kinetic | Column::Potential => "energies",
        Column::ConstraintError | Column::VelocityError => "errors",
        Column::Rank => "rank",
        Column::Reaction(_) => "reactions",
        Column::Output(_) => "outputs",
        Column::Acceleration(_) => "accelerations",
        Column::Multiplier(_) => "multipliers",
        Column::Input(_) => "inputs",
    }
}
