//! Steps across a kink of a constraint, where no smooth motion goes on.
//!
//! In:  the end of a trial step before and after its projection.
//! Out: a refusal if the projection moved it farther than the error of the step can be.
//!
//! Where the gradient of a constraint jumps, as that of a length does that becomes zero, the
//! velocities that it allows jump, too. A projection would take what is not allowed away, and the
//! energy with it. In shorter steps errors vanish faster than steps do, and jumps do not vanish.

use crate::dynamics::Core;
use crate::tolerance::{critical, regular, round_off};
use crate::{DynamicsError, Mechanism, Real, Singularity, State};

/// A projection that moves positions by more than this part of what the step moved them was not
/// made necessary by its error.
const JUMP: f64 = 0.1;
/// Nor was one that moves a state by so many tolerances.
const TOLERANCES: f64 = 1e4;

/// The largest entries of coordinates that constraints tie to one another.
#[derive(Clone, Copy)]
struct Peaks<T> {
    /// Coordinates and velocities.
    size: T,
    speed: T,
    /// What the step changed of both.
    step: T,
    change: T,
    /// What the projection changed of both.
    moved: T,
    corrected: T,
}

/// What a projection changed that is no error.
enum Leap {
    Position,
    Velocity,
}

impl<T: Real, const N: usize, const R: usize> Core<T, N, R> {
    /// Refuses a projection that moves a state farther than the error of its step can be. The
    /// first step may begin off the constraints, and a step of fixed length may be longer than
    /// what a law of time does in it.
    #[inline(never)]
    pub(crate) fn verify_smooth(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        placed: &State<T, N>,
    ) -> Result<(), DynamicsError<T>> {
        let structure = mechanism.structure();
        if self.session.tolerance.is_none() && !structure.scleronomic {
            return Ok(());
        }
        let base = self.session.base.as_ref();
        // What is projected where the step begins was not moved by it.
        let Some(base) = base.filter(|base| state.t > base.t && !self.session.begins) else {
            return Ok(());
        };
        let components = structure.components;
        let states = [base, state, placed];
        let leap = match components.is_empty() {
            true => self.leap(peaks(states, 0..N), state.t - base.t),
            false => components.iter().find_map(|component| {
                let coordinates = component.coordinates.iter().copied();
                self.leap(peaks(states, coordinates), state.t - base.t)
            }),
        };
        match leap {
            Some(leap) => Err(self.kink(mechanism, state, &leap)),
            None => Ok(()),
        }
    }

    /// What a projection changed by more than an error. Comparisons with NaN are false: what is
    /// not finite is refused elsewhere.
    fn leap(&self, peaks: Peaks<T>, length: T) -> Option<Leap> {
        let tolerances = self.session.tolerance.map(|x| x * T::from_f64(TOLERANCES));
        // Steps of fixed length have no bound on their error.
        let most = |part: T, size: T| match tolerances {
            Some(tolerances) => part.min(tolerances * (T::one() + size)),
            None => part,
        };
        let size = peaks.size.max(self.coordinate_scale.size);
        let noise = round_off::<T>() * critical() * size;
        if peaks.moved > most(peaks.step * T::from_f64(JUMP), peaks.size) + noise {
            return Some(Leap::Position);
        }
        let allowed = most(peaks.change, peaks.speed) + regular::<T>() * peaks.speed;
        let excess = peaks.corrected - allowed;
        (excess * length > noise).then_some(Leap::Velocity)
    }

    /// The error of a state that a constraint does not allow where a step ends.
    #[cold]
    #[inline(never)]
    fn kink(
        &mut self,
        mechanism: &dyn Mechanism<T, N, R>,
        state: &State<T, N>,
        leap: &Leap,
    ) -> DynamicsError<T> {
        mechanism.position(state, &mut self.position);
        let (_, row) = match leap {
            Leap::Position => self.residual(&self.position.residual),
            Leap::Velocity => self.residual(&self.position.speed(&state.v)),
        };
        DynamicsError::SingularConfiguration {
            t: state.t,
            kind: Singularity::Kink,
            row,
            structure: mechanism.structure(),
        }
    }
}

/// The largest entries of some coordinates.
fn peaks<T: Real, const N: usize>(
    [base, state, placed]: [&State<T, N>; 3],
    coordinates: impl Iterator<Item = usize>,
) -> Peaks<T> {
    let mut peaks = Peaks {
        size: T::zero(),
        speed: T::zero(),
        step: T::zero(),
        change: T::zero(),
        moved: T::zero(),
        corrected: T::zero(),
    };
    for i in coordinates {
        peaks.size = peaks.size.max(placed.q[i].abs());
        peaks.speed = peaks.speed.max(placed.v[i].abs());
        peaks.step = peaks.step.max((state.q[i] - base.q[i]).abs());
        peaks.change = peaks.change.max((state.v[i] - base.v[i]).abs());
        peaks.moved = peaks.moved.max((placed.q[i] - state.q[i]).abs());
        peaks.corrected = peaks.corrected.max((placed.v[i] - state.v[i]).abs());
    }
    peaks
}
