//! Equations of the `start` block: formulas that have a value at the start.
//!
//! In:  a mechanism with such equations, its start.
//! Out: the start moved onto them and the constraints, or which of them does not hold.
//!
//! They are further rows of the constraints while positions are assembled, and others while
//! velocities are: a position that is given says nothing about velocities.

use super::room::Room;
use super::{AssemblyError, StartFault, given, held, position, velocity};
use crate::stack::with_room;
use crate::{Energy, Mechanism, Position, Real, Start, State, Structure, Terms};
use nalgebra::{SMatrix, SVector};

/// What a mechanism with such equations provides.
///
/// Errors are those of the equations in their order, slopes their derivatives by the
/// coordinates, one equation after the other; as many of them as there is room for.
pub trait StartEquations<T: Real, const N: usize> {
    /// What the equations for positions are off by.
    fn position_errors(&self, state: &State<T, N>, values: &mut [T]);
    /// Their derivatives by the coordinates.
    fn position_slopes(&self, state: &State<T, N>, values: &mut [T]);
    /// What the equations for velocities would be off by at rest.
    fn velocity_errors(&self, state: &State<T, N>, values: &mut [T]);
    /// Their derivatives by the velocities.
    fn velocity_slopes(&self, state: &State<T, N>, values: &mut [T]);
}

/// Moves a start onto the equations of a mechanism, of which `structures` lists the
/// constraints with those for positions, `P`, and with those for velocities, `V`.
///
/// # Errors
///
/// [`StartFault`] if they don't hold together with the held values.
pub fn meet<T, M, const N: usize, const R: usize, const P: usize, const V: usize>(
    mechanism: &M,
    structures: [&'static Structure; 2],
    start: &mut Start<T, N>,
    t: T,
) -> Result<(), StartFault<T, N>>
where
    T: Real,
    M: Mechanism<T, N, R> + StartEquations<T, N>,
{
    with_room::<T, _, N, P>(|| {
        moved::<T, M, N, R, P, V>(mechanism, (structures, Some(R)), start, t)
    })
}

/// Moves the guesses of a start onto equations that are guesses, and those that are held, together
/// `P` for positions and `V` for velocities; whether they can be met. Constraints are met
/// afterwards, from there.
pub fn guess<T, M, const N: usize, const R: usize, const P: usize, const V: usize>(
    mechanism: &M,
    structure: &'static Structure,
    start: &mut Start<T, N>,
    t: T,
) -> bool
where
    T: Real,
    M: Mechanism<T, N, R> + StartEquations<T, N>,
{
    let mut moved_to = *start;
    let plan = ([structure, structure], None);
    let met = with_room::<T, _, N, P>(|| {
        moved::<T, M, N, R, P, V>(mechanism, plan, &mut moved_to, t).is_ok()
    });
    let turns = T::from_f64(core::f64::consts::TAU);
    let pairs = moved_to.q.iter().zip(&start.q);
    // A guess that was moved by more than a turn has lost its way.
    let near = pairs.fold(true, |near, (to, from)| {
        near & ((to.value - from.value).abs() <= turns * (T::one() + from.value.abs()))
    });
    if met && near {
        *start = moved_to;
    }
    met && near
}

/// Moves a start onto the equations and `own` constraints, if there are any.
fn moved<T, M, const N: usize, const R: usize, const P: usize, const V: usize>(
    mechanism: &M,
    (structures, own): ([&'static Structure; 2], Option<usize>),
    start: &mut Start<T, N>,
    t: T,
) -> Result<(), StartFault<T, N>>
where
    T: Real,
    M: Mechanism<T, N, R> + StartEquations<T, N>,
{
    let mut state = given(start, t);
    let [positions, velocities] = structures;
    if P > 0 {
        let rows = Further::<M, R> {
            mechanism,
            structure: positions,
            own,
            velocities: false,
        };
        Room::<T, N, P>::new()
            .assemble(position::positions(), &rows, &mut state, &held(&start.q))
            .map_err(|error| fault(error, t, positions))?;
    }
    if V > 0 {
        let rows = Further::<M, R> {
            mechanism,
            structure: velocities,
            own,
            velocities: true,
        };
        Room::<T, N, V>::new()
            .assemble(velocity::velocities(), &rows, &mut state, &held(&start.v))
            .map_err(|error| fault(error, t, velocities))?;
    }
    for i in 0..N {
        (start.q[i].value, start.v[i].value) = (state.q[i], state.v[i]);
    }
    Ok(())
}

/// A mechanism with further rows behind its `R` constraints, or in their place.
struct Further<'a, M, const R: usize> {
    mechanism: &'a M,
    structure: &'static Structure,
    /// How many constraints take part: all of them, or none. Without constraints, no coordinate is
    /// heavier than another.
    own: Option<usize>,
    /// Whether the further rows are those for velocities.
    velocities: bool,
}

impl<M, const R: usize> Further<'_, M, R> {
    /// The constraints in front of the further rows.
    fn rows(&self) -> usize {
        self.own.unwrap_or(0)
    }

    fn mass<T: Real, const N: usize>(&self, terms: &Terms<T, N, R>) -> SMatrix<T, N, N> {
        match self.own {
            Some(_) => terms.mass,
            None => SMatrix::identity(),
        }
    }
}

impl<T, M, const N: usize, const R: usize, const S: usize> Mechanism<T, N, S> for Further<'_, M, R>
where
    T: Real,
    M: Mechanism<T, N, R> + StartEquations<T, N>,
{
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    /// The terms of the mechanism: the further rows hold at the start and not afterwards.
    fn terms(&self, state: &State<T, N>, out: &mut Terms<T, N, S>) {
        let mut own = Terms::<T, N, R>::default();
        self.mechanism.terms(state, &mut own);
        (out.mass, out.force) = (self.mass(&own), own.force);
        for k in 0..self.rows().min(S) {
            out.bias[k] = own.bias[k];
            (0..N).for_each(|j| out.jacobian[(k, j)] = own.jacobian[(k, j)]);
        }
    }

    fn position(&self, state: &State<T, N>, out: &mut Position<T, N, S>) {
        let mut terms = Terms::<T, N, R>::default();
        self.mechanism.terms(state, &mut terms);
        let mut own = Position::<T, N, R>::default();
        self.mechanism.position(state, &mut own);
        out.mass = self.mass(&terms);
        let (mut errors, mut slopes) = (SVector::<T, S>::zeros(), SMatrix::<T, N, S>::zeros());
        let further = errors
            .as_mut_slice()
            .get_mut(self.rows()..)
            .unwrap_or_default();
        let further_slopes = slopes
            .as_mut_slice()
            .get_mut(self.rows() * N..)
            .unwrap_or_default();
        if self.velocities {
            self.mechanism.velocity_errors(state, further);
            self.mechanism.velocity_slopes(state, further_slopes);
        } else {
            self.mechanism.position_errors(state, further);
            self.mechanism.position_slopes(state, further_slopes);
        }
        out.jacobian = slopes.transpose();
        for k in 0..self.rows().min(S) {
            (0..N).for_each(|j| out.jacobian[(k, j)] = own.jacobian[(k, j)]);
            (out.residual[k], out.drift[k]) = (own.residual[k], own.drift[k]);
        }
        for k in self.rows()..S {
            let place = match self.velocities {
                true => &mut out.drift,
                false => &mut out.residual,
            };
            place[k] = errors[k];
        }
    }

    fn energy(&self, state: &State<T, N>) -> Energy<T> {
        self.mechanism.energy(state)
    }
}

fn fault<T: Real, const N: usize, const S: usize>(
    error: AssemblyError<T, N, S>,
    t: T,
    structure: &'static Structure,
) -> StartFault<T, N> {
    let (residual, velocities, conflicting) = match error {
        AssemblyError::Positions {
            residual,
            conflicting,
            ..
        } => (Some(residual), false, conflicting),
        AssemblyError::Velocities {
            residual,
            conflicting,
            ..
        } => (Some(residual), true, conflicting),
        AssemblyError::NoBranch { held, .. } => (Some(SVector::zeros()), true, held),
        _ => (None, false, [false; N]),
    };
    let farthest = residual.map(|rows| {
        let far = |a: usize, b: usize| if rows[b].abs() > rows[a].abs() { b } else { a };
        let row = (0..S).reduce(far).unwrap_or(0);
        (row, rows.get(row).copied().unwrap_or(T::zero()))
    });
    StartFault {
        t,
        structure,
        farthest,
        velocities,
        conflicting,
    }
}
