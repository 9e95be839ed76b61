//! How large coordinates are by nature.
//!
//! In:  the kinds of coordinates, a position.
//! Out: [`NaturalSizes`]: one for an angle, and for others the largest of their kind.

use crate::{Real, Structure};

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
}
