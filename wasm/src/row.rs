//! The rows of a run.
//!
//! In:  states.
//! Out: numbers: time, coordinates, velocities, states of the first order, and columns of
//!      the kinds that are wanted.

use bricard_runtime::{DynamicsError, Probe, State, Structure};

/// The kinds of columns that a row may have besides, as bits, in the order in which they
/// stand in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Columns(u32);

impl Columns {
    const OUTPUTS: u32 = 1;
    const INPUTS: u32 = 2;
    /// Accelerations, and the rates of states of the first order.
    const ACCELERATIONS: u32 = 4;
    const REACTIONS: u32 = 8;
    /// The multipliers of constraints that have a name.
    const MULTIPLIERS: u32 = 16;
    /// Kinetic and potential energy.
    const ENERGIES: u32 = 32;
    /// The largest errors of positions and of velocities.
    const ERRORS: u32 = 64;
    const RANK: u32 = 128;
    const ALL: u32 = 2 * Self::RANK - 1;

    /// The columns of some bits, if all of them mean something.
    pub fn of(bits: u32) -> Option<Self> {
        (bits & !Self::ALL == 0).then_some(Self(bits))
    }

    /// How many numbers a kind has.
    fn count(kind: u32, structure: &Structure) -> usize {
        match kind {
            Self::OUTPUTS => structure.outputs.len(),
            Self::INPUTS => structure.inputs.len(),
            Self::ACCELERATIONS => structure.coordinates.len(),
            Self::REACTIONS => structure.freedoms().len(),
            Self::MULTIPLIERS => structure.multipliers.len(),
            Self::ENERGIES | Self::ERRORS => 2,
            _ => 1,
        }
    }

    /// The kinds that are wanted.
    fn kinds(self) -> impl Iterator<Item = u32> {
        let bits = (0..Self::ALL.count_ones()).map(|place| 1 << place);
        bits.filter(move |kind| self.0 & kind != 0)
    }

    /// Numbers in a row.
    pub fn width(self, structure: &Structure) -> usize {
        let always = 1 + structure.freedoms().len() + structure.coordinates.len();
        let added = self.kinds().map(|kind| Self::count(kind, structure));
        always + added.sum::<usize>()
    }

    /// Writes a row, which is as long as [`width`](Self::width) says.
    ///
    /// # Errors
    ///
    /// A [`DynamicsError`] where accelerations or what depends on them can't be computed.
    pub fn write<const N: usize, const R: usize>(
        self,
        state: &State<f64, N>,
        probe: &mut dyn Probe<f64, N>,
        row: &mut [f64],
    ) -> Result<(), DynamicsError<f64>> {
        let structure = probe.structure();
        let (begin, mut rest) = row.split_at_mut(Self(0).width(structure));
        for (place, number) in begin.iter_mut().zip(numbers(state, structure)) {
            *place = number;
        }
        for kind in self.kinds() {
            let (places, behind) = rest.split_at_mut(Self::count(kind, structure));
            rest = behind;
            match kind {
                Self::OUTPUTS => probe.outputs(state, places, &mut [])?,
                Self::INPUTS => probe.outputs(state, &mut [], places)?,
                Self::ACCELERATIONS => {
                    places.copy_from_slice(probe.acceleration(state, &mut [])?.as_slice());
                }
                Self::REACTIONS => {
                    let reactions = probe.reaction(state)?;
                    places.copy_from_slice(&reactions.as_slice()[..places.len()]);
                }
                Self::MULTIPLIERS => multipliers::<N, R>(state, probe, places)?,
                Self::ENERGIES => {
                    let energy = probe.energy(state);
                    places.copy_from_slice(&[energy.kinetic, energy.potential]);
                }
                Self::ERRORS => {
                    let error = probe.constraint_error(state);
                    places.copy_from_slice(&[error.position, error.velocity]);
                }
                _ => places[0] = probe.rank(state)?.rank as f64,
            }
        }
        Ok(())
    }
}

/// Time, coordinates, velocities, states of the first order, without the integrals of these,
/// which are internal.
pub fn numbers<const N: usize>(
    state: &State<f64, N>,
    structure: &Structure,
) -> impl Iterator<Item = f64> {
    let q = state.q.iter().take(structure.freedoms().len());
    core::iter::once(state.t).chain(q.chain(state.v.iter()).copied())
}

/// The multipliers that have a name.
fn multipliers<const N: usize, const R: usize>(
    state: &State<f64, N>,
    probe: &mut dyn Probe<f64, N>,
    places: &mut [f64],
) -> Result<(), DynamicsError<f64>> {
    let structure = probe.structure();
    let mut known = [None; R];
    probe.acceleration(state, &mut known)?;
    for (place, multiplier) in places.iter_mut().zip(structure.multipliers) {
        let (t, row) = (state.t, multiplier.row);
        let shared = DynamicsError::SharedReaction { t, row, structure };
        *place = known.get(row).copied().flatten().ok_or(shared)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::Columns;

    #[test]
    fn bits_that_mean_nothing_are_refused() {
        assert_eq!(Columns::of(Columns::ALL), Some(Columns(Columns::ALL)));
        assert_eq!(Columns::of(Columns::ALL + 1), None);
    }
}
