//! Chains as bricard compiles them.

use crate::{Failed, UNTIL};
use bricard_runtime::{
    Acceleration, Method, Settings, State, StepControl, Stepper, Whole, assemble,
};

macro_rules! chains {
    ($($(#[$when:meta])* $place:ident: $folder:literal / $file:literal;)*) => {
        $(
            $(#[$when])*
            #[expect(dead_code, reason = "a run asks for less than a description gives")]
            pub mod $place {
                include!(concat!(env!("OUT_DIR"), "/", $folder, "/", $file, ".rs"));
            }
        )*
    };
}

chains! {
    open_10: "bodies_10" / "open_chain";
    closed_10: "bodies_10" / "closed_chain";
    open_50: "bodies_50" / "open_chain";
    closed_50: "bodies_50" / "closed_chain";
    #[cfg(feature = "long")]
    open_100: "bodies_100" / "open_chain";
    #[cfg(feature = "long")]
    closed_100: "bodies_100" / "closed_chain";
    #[cfg(feature = "long")]
    open_200: "bodies_200" / "open_chain";
    #[cfg(feature = "long")]
    closed_200: "bodies_200" / "closed_chain";
}

/// The start on the constraints.
///
/// # Errors
///
/// A start that can't be assembled.
pub fn start<const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
) -> Result<State<f64, N>, Failed> {
    Ok(assemble(chain, &chain.start(), 0.0).map_err(|error| error.to_string())?)
}

/// The angles of the rods after a time.
///
/// # Errors
///
/// A run that stops.
pub fn run<const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
    start: &State<f64, N>,
    (method, tolerance): (Method, f64),
    until: f64,
) -> Result<Vec<f64>, Failed> {
    let control = StepControl::Adaptive {
        relative: tolerance,
        absolute: tolerance,
    };
    let mut stepper = Box::new(Stepper::<f64, N, R>::new(
        method,
        control,
        Settings::default(),
    )?);
    let mut state = *start;
    stepper.step(chain, &mut state, until)?;
    Ok(state.q.as_slice()[N / 3 * 2..].to_vec())
}

/// The whole run.
///
/// # Errors
///
/// A run that stops.
pub fn whole<const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
    start: &State<f64, N>,
    method: Method,
    tolerance: f64,
) -> Result<Vec<f64>, Failed> {
    run(chain, start, (method, tolerance), UNTIL)
}

/// One acceleration by emitted code.
///
/// # Errors
///
/// No such code.
pub fn acceleration<const N: usize, const R: usize>(
    chain: &dyn Whole<f64, N, R>,
    state: &State<f64, N>,
    room: &mut Acceleration<f64, N, R>,
) -> Result<f64, Failed> {
    match chain.acceleration(state, room) {
        true => Ok(room.acceleration[0]),
        false => Err("there is no emitted solve".into()),
    }
}
