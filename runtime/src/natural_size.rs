//! How large and how heavy coordinates are by nature.
//!
//! In:  the kinds of coordinates, a position, the mass matrix there.
//! Out: [`NaturalSizes`]: one for an angle, and for others the largest of their kind;
//!      [`LeastInertia`], below which they have none to speak of.

use crate::{Real, Structure};

/// The square root of the least inertia of a coordinate, relative to the largest of its kind. A
/// body that is not turned has Euler parameters that are massless to round-off;
/// their entries would dominate the rows that contain them, and all others be round-off.
const LIGHTEST: f64 = 1e-3;

/// What a coordinate measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// An angle, in radians.
    Angle,
    /// A ratio: an Euler parameter.
    Ratio,
    /// A length, or anything else that has a unit.
    Length,
    /// What has no unit, and no sine is taken of.
    Unknown,
}

impl Kind {
    /// How many there are.
    pub(crate) const COUNT: usize = 4;
}

impl Structure {
    /// The kind of a coordinate; none where nothing is known of it.
    pub(crate) fn kind(&self, coordinate: usize) -> Option<Kind> {
        let quantity = self.coordinates.get(coordinate)?;
        Some(match quantity.unit {
            "rad" | "deg" => Kind::Angle,
            _ if self.unitless_angles.contains(&coordinate) => Kind::Angle,
            "1" => Kind::Ratio,
            "" => Kind::Unknown,
            _ => Kind::Length,
        })
    }
}

/// The sizes of coordinates by nature, at a position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NaturalSizes<T> {
    /// Those of each kind; zero where all of them are zero.
    sizes: [T; Kind::COUNT],
}

impl<T: Real> NaturalSizes<T> {
    /// Measures them.
    pub(crate) fn measure(structure: &Structure, q: &[T]) -> Self {
        let mut sizes = [T::zero(); Kind::COUNT];
        for (coordinate, q) in q.iter().enumerate() {
            if let Some(kind) = structure.kind(coordinate) {
                sizes[kind as usize] = sizes[kind as usize].max(q.abs());
            }
        }
        // Functions of an angle change over an angle of one, however small it is.
        sizes[Kind::Angle as usize] = T::one();
        Self { sizes }
    }

    /// That of a kind, if anything tells it.
    pub(crate) fn of(&self, kind: Kind) -> Option<T> {
        let size = self.sizes[kind as usize];
        (size > T::zero()).then_some(size)
    }

    /// Writes those of all coordinates, one where nothing tells them.
    pub(crate) fn write_all(structure: &Structure, q: &[T], sizes: &mut [T]) {
        let natural = Self::measure(structure, q);
        for (coordinate, size) in sizes.iter_mut().enumerate() {
            let kind = structure.kind(coordinate);
            *size = kind.and_then(|kind| natural.of(kind)).unwrap_or(T::one());
        }
    }
}

/// The inertia below which coordinates of each kind have none to speak of.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeastInertia<T>([T; Kind::COUNT]);

impl<T: Real> LeastInertia<T> {
    /// Measures it by a mass matrix of `n` coordinates.
    pub(crate) fn measure(structure: &Structure, mass: &[T], n: usize) -> Self {
        let mut largest = [T::zero(); Kind::COUNT];
        for (coordinate, inertia) in mass.iter().step_by(n + 1).enumerate() {
            let largest = &mut largest[Self::place(structure, coordinate)];
            *largest = largest.max(*inertia);
        }
        Self(largest.map(|largest| largest * T::from_f64(LIGHTEST * LIGHTEST)))
    }

    /// That of the kind of a coordinate.
    pub(crate) fn of(&self, structure: &Structure, coordinate: usize) -> T {
        self.0[Self::place(structure, coordinate)]
    }

    fn place(structure: &Structure, coordinate: usize) -> usize {
        structure.kind(coordinate).unwrap_or(Kind::Angle) as usize
    }
}
