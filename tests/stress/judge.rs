//! Runs a case and judges what it comes to.

use crate::case::{Case, Wanted};
use bricard_runtime::{
    Initial, Interface, Mechanism, Method, Options, State, Summary, Visitor, Whole, assemble,
    simulate,
};

/// What a run came to: its summary, or the message of its error.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The coordinates at the end.
    pub end: Vec<f64>,
    /// The size of the energy.
    pub energy: f64,
    /// Its error (J).
    pub energy_error: f64,
}

/// Runs a mechanism as a case says.
struct Attempt<'a> {
    case: &'a Case,
    options: Options<f64>,
}

impl Visitor<f64> for Attempt<'_> {
    type Output = Result<Ran, String>;

    fn visit<M, const N: usize, const R: usize>(self, mut mechanism: M) -> Self::Output
    where
        M: Mechanism<f64, N, R> + Interface<f64, N> + Clone + 'static,
    {
        let structure = mechanism.structure();
        for (name, value) in self.case.set {
            let place = structure.parameters.iter().position(|p| p.name == *name);
            let place = place.ok_or_else(|| format!("no parameter {name}"))?;
            mechanism.set_parameter(place, *value);
        }
        for (place, value) in self.case.inputs {
            mechanism.set_input(*place, Some(*value));
        }
        // By a pointer, so that a run is compiled once for each pair of sizes.
        let mechanism: &dyn Whole<f64, N, R> = &mechanism;
        let state = start(mechanism, self.case.hold)?;
        let before = mechanism.energy(&state);
        let ran = simulate(mechanism, &state, &self.options, &mut []);
        let Summary {
            end, energy_error, ..
        } = ran.map_err(|failure| failure.error.to_string())?;
        let after = mechanism.energy(&end);
        let size = |energy: bricard_runtime::Energy<f64>| energy.kinetic + energy.potential.abs();
        Ok(Ran {
            end: end.q.iter().copied().collect(),
            energy: size(before).max(size(after)),
            energy_error: energy_error.unwrap_or(0.0),
        })
    }
}

/// The start of a mechanism with other values held.
pub fn start<const N: usize, const R: usize>(
    mechanism: &dyn Whole<f64, N, R>,
    hold: &[(&str, f64)],
) -> Result<State<f64, N>, String> {
    let coordinates = mechanism.structure().coordinates;
    let mut start = mechanism.start();
    for (name, value) in hold {
        let bare = name
            .strip_prefix("der(")
            .and_then(|name| name.strip_suffix(')'));
        let entries = if bare.is_some() {
            &mut start.v
        } else {
            &mut start.q
        };
        let wanted = bare.unwrap_or(name);
        let place = coordinates.iter().position(|c| c.name == wanted);
        let place = place.ok_or_else(|| format!("no coordinate {wanted}"))?;
        entries[place] = Initial {
            value: *value,
            held: true,
        };
    }
    assemble(mechanism, &start, 0.0).map_err(|error| error.to_string())
}

/// Runs a case by a method.
pub fn run(case: &Case, options: Options<f64>) -> Result<Ran, String> {
    let visited = bricard_stress::visit(case.mechanism, Attempt { case, options });
    visited.unwrap_or_else(|| panic!("{} is in no catalogue", case.mechanism))
}

/// What the table says of a case that did as it should; what went wrong of one that
/// did not.
pub fn judge(case: &Case) -> Result<String, String> {
    let ran = run(case, case.options());
    let complain = |text: String| Err(format!("{}, {}: {text}", case.mechanism, case.what));
    match (case.wanted, ran) {
        (Wanted::Refused { words }, Err(message)) => {
            match words.iter().find(|words| !message.contains(**words)) {
                None => Ok(format!("error: {message}")),
                Some(missing) => complain(format!("`{message}` does not say `{missing}`")),
            }
        }
        (Wanted::Refused { .. }, Ok(ran)) => complain(format!("no error but {ran:?}")),
        (_, Err(message)) => complain(message),
        (Wanted::Balanced { energy }, Ok(ran)) => match balanced(&ran, energy) {
            Ok(()) => Ok(format!("right: energy to {energy:.0e} of itself")),
            Err(text) => complain(text),
        },
        (Wanted::Right { energy, end }, Ok(ran)) => {
            match balanced(&ran, energy).and_then(|()| compared(case, &ran, end)) {
                Ok(()) => Ok(format!(
                    "right: energy to {energy:.0e} of itself, end to {end:.0e}"
                )),
                Err(text) => complain(text),
            }
        }
    }
}

/// Energies smaller than this are as good as none (J).
const SMALLEST_ENERGY: f64 = 1e-6;

fn balanced(ran: &Ran, energy: f64) -> Result<(), String> {
    match ran.energy_error <= energy * ran.energy.max(SMALLEST_ENERGY) {
        true => Ok(()),
        false => Err(format!(
            "energy off by {:.1e} of {:.1e} J",
            ran.energy_error, ran.energy
        )),
    }
}

/// Holds the end against that of an implicit method, which shares no coefficients.
fn compared(case: &Case, ran: &Ran, bound: f64) -> Result<(), String> {
    let other = run(case, case.options_by(Method::Radau9, case.tolerance * 0.1))?;
    for (a, b) in ran.end.iter().zip(&other.end) {
        let off = (a - b).abs() / (1.0 + b.abs());
        if off.is_nan() || off > bound {
            return Err(format!(
                "ends at {:?}, by another method at {:?}",
                ran.end, other.end
            ));
        }
    }
    Ok(())
}
