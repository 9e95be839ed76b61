//! Consistent initial states from held values and guesses.
//!
//! In:  a mechanism, the [`Start`] of its description, the time.
//! Out: a state on the constraints, positions and velocities, to round-off.
//!
//! Equations of the `start` block that are no values of coordinates are met first, together
//! with the constraints ([`meet`]); what that gives is the guess of the rest.
//!
//! Held values stay as they are. The others change as little as they can, each
//! weighed with the square root of its inertia, so that the answer does not
//! depend on units: the branch nearest to the guesses is found. Where the guesses are no help
//! at all, because all derivatives vanish there, as at the fulcrum of a pendulum, a fixed
//! small disturbance decides.
//!
//! Not here: keeping a state on the constraints during a run
//! ([`crate::projection`]).

mod decomposition;
mod draft;
mod equations;
mod error;
mod fault;
mod inertia;
mod memory;
mod position;
mod room;
mod scales;
mod vanishing_gradient;
mod velocity;

pub use equations::{StartEquations, guess, meet};
pub use error::AssemblyError;
pub use fault::StartFault;

use room::Room;

use crate::dynamics::{Held, refine_start};
use crate::linalg::{Breakdown, Workspace, column};
use crate::stack::with_room;
use crate::{Initial, Mechanism, Position, Real, Start, State, Terms};
use nalgebra::SMatrix;

/// Finds the state at time `t` (s) that keeps the held values of `start` and is
/// near its guesses.
///
/// At a singular position the velocities of the branches do not mix: the
/// velocity found belongs to one branch, the nearest to the guesses and held
/// values. At rest there no branch is chosen.
///
/// # Errors
///
/// - [`AssemblyError::NotFinite`] if a value of `start`, or a constraint at the
///   guess or the mass matrix, is infinite or NaN.
/// - [`AssemblyError::Positions`] and [`AssemblyError::Velocities`] if the held
///   values contradict the constraints; with the error of each constraint.
/// - [`AssemblyError::Vanishing`] if a constraint loses its gradient where it holds, and
///   can't be crossed there, such as a sum of squares that is zero.
/// - [`AssemblyError::Start`] if equations of the `start` block don't hold with them.
/// - [`AssemblyError::NegativeInertia`] if the kinetic energy is negative for some
///   velocities.
pub fn assemble<T, M, const N: usize, const R: usize>(
    mechanism: &M,
    start: &Start<T, N>,
    t: T,
) -> Result<State<T, N>, AssemblyError<T, N, R>>
where
    T: Real,
    M: Mechanism<T, N, R> + ?Sized,
{
    consistent(&mechanism, start, t)
}

/// Assembles any mechanism of these sizes: compiled once for all of them.
fn consistent<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    start: &Start<T, N>,
    t: T,
) -> Result<State<T, N>, AssemblyError<T, N, R>> {
    if !given(start, t).is_finite() {
        return Err(AssemblyError::NotFinite { t });
    }
    with_room::<T, _, N, R>(|| {
        let mut met = *start;
        mechanism.begin(&mut met, t).map_err(AssemblyError::Start)?;
        let mut state = given(&met, t);
        if R > 0 {
            let given = state;
            constrain(mechanism, &mut state, start)
                .map_err(|fault| explained(mechanism, &given, fault))?;
        }
        check_inertia(mechanism, &state)?;
        Ok(state)
    })
}

/// Why a state can't be moved onto the constraints: an inertia that is infinite lets nothing move.
#[cold]
#[inline(never)]
fn explained<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
    fault: AssemblyError<T, N, R>,
) -> AssemblyError<T, N, R> {
    let mut at = Position::default();
    mechanism.position(state, &mut at);
    match at.mass.iter().all(|entry| entry.is_finite()) {
        true => fault,
        false => AssemblyError::NotFinite { t: state.t },
    }
}

/// The state of the values of a start.
fn given<T: Real, const N: usize>(start: &Start<T, N>, t: T) -> State<T, N> {
    let mut state = State {
        t,
        ..State::default()
    };
    for i in 0..N {
        (state.q[i], state.v[i]) = (start.q[i].value, start.v[i].value);
    }
    state
}

/// Which of these values are held.
fn held<T: Real, const N: usize>(values: &[Initial<T>; N]) -> [bool; N] {
    column(|i| values[i].held)
}

/// Moves what is not held onto the constraints; beside a singular configuration, onto the
/// sheet that has what is held. Neither this nor what follows is inlined: both need large
/// matrices on the stack, and not at the same time.
#[inline(never)]
fn constrain<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    start: &Start<T, N>,
) -> Result<(), AssemblyError<T, N, R>> {
    let held = Held {
        q: held(&start.q),
        v: held(&start.v),
    };
    let given = state.v;
    let (assembled, near_singular) = assemble_in_room(mechanism, state, &held);
    if !near_singular {
        return assembled;
    }
    let refined = match assembled {
        Ok(()) => refine_start(mechanism, state, &held, true),
        // What contradicts the constraints at a position that is off its sheet by round-off
        // may not do so on it.
        Err(
            AssemblyError::Velocities { .. }
            | AssemblyError::NoBranch { .. }
            | AssemblyError::ManyBranches { .. },
        ) => {
            state.v = given;
            refine_start(mechanism, state, &held, false)
        }
        Err(_) => false,
    };
    match refined {
        true => Ok(()),
        false => assembled,
    }
}

/// Moves what is not held onto the constraints, and tells whether these nearly depend on one
/// another there.
#[inline(never)]
fn assemble_in_room<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &mut State<T, N>,
    held: &Held<N>,
) -> (Result<(), AssemblyError<T, N, R>>, bool) {
    let mut room = Room::new();
    let assembled = room
        .assemble(position::positions(), mechanism, state, &held.q)
        .and_then(|()| room.assemble(velocity::velocities(), mechanism, state, &held.v));
    (assembled, room.near_singular)
}

/// Refuses a kinetic energy that is negative for some velocities, whether or not the constraints
/// allow these velocities at this position.
#[inline(never)]
fn check_inertia<T: Real, const N: usize, const R: usize>(
    mechanism: &dyn Mechanism<T, N, R>,
    state: &State<T, N>,
) -> Result<(), AssemblyError<T, N, R>> {
    // Without constraints no function for positions is generated.
    let negative = if R > 0 {
        let mut at = Position::default();
        mechanism.position(state, &mut at);
        negative(&at.mass)
    } else {
        let mut at = Terms::default();
        mechanism.terms(state, &mut at);
        negative(&at.mass)
    };
    match negative {
        Ok(None) => Ok(()),
        Ok(Some(coordinate)) => Err(AssemblyError::NegativeInertia {
            t: state.t,
            structure: mechanism.structure(),
            coordinate,
        }),
        Err(Breakdown) => Err(AssemblyError::NotFinite { t: state.t }),
    }
}

/// The coordinate that makes the kinetic energy negative, if it can be.
#[inline(never)]
fn negative<T: Real, const N: usize>(mass: &SMatrix<T, N, N>) -> Result<Option<usize>, Breakdown> {
    let mut matrices = [[[T::zero(); N]; N]; inertia::MATRICES];
    let mut vectors = [[T::zero(); N]; inertia::VECTORS];
    let mut done = [0; N];
    let workspace = Workspace::new(
        matrices.as_flattened_mut().as_flattened_mut(),
        vectors.as_flattened_mut(),
        &mut done,
    );
    inertia::negating()(mass.as_slice(), N, &workspace)
}
