//! Which vectors of a list depend on those before them.

/// A vector whose part outside a span is smaller than this, relative to its length,
/// lies in it. Positions are consistent to about 1e-12, so round-off stays far below.
pub const INSIDE: f64 = 1e-6;

/// An orthonormal basis that grows, and how each of its vectors is made of the
/// vectors that were added.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    vectors: Vec<Vec<f64>>,
    recipes: Vec<Vec<f64>>,
    added: usize,
}

impl Basis {
    /// Adds a vector. If it depends on those added before: its coefficients in
    /// them, for vectors of length one.
    pub fn add(&mut self, vector: &[f64]) -> Option<Vec<f64>> {
        let place = self.added;
        self.added += 1;
        let length = norm(vector);
        let mut recipe = vec![0.0; self.added];
        if length == 0.0 {
            return Some(recipe);
        }
        let mut rest: Vec<f64> = vector.iter().map(|x| x / length).collect();
        // The second pass removes what the first one left by round-off.
        for _ in 0..2 {
            for (unit, made) in self.vectors.iter().zip(&self.recipes) {
                let along = dot(unit, &rest);
                subtract(&mut rest, along, unit);
                subtract(&mut recipe, along, made);
            }
        }
        let remaining = norm(&rest);
        if remaining <= INSIDE {
            return Some(recipe.iter().map(|x| -x).collect());
        }
        recipe[place] = 1.0;
        self.vectors
            .push(rest.iter().map(|x| x / remaining).collect());
        self.recipes
            .push(recipe.iter().map(|x| x / remaining).collect());
        None
    }

    /// How many vectors it has.
    pub fn size(&self) -> usize {
        self.vectors.len()
    }

    /// The part of a unit vector that lies outside the span.
    pub fn outside(&self, axis: usize, dimension: usize) -> Vec<f64> {
        let mut rest = vec![0.0; dimension];
        if let Some(entry) = rest.get_mut(axis) {
            *entry = 1.0;
        }
        for _ in 0..2 {
            for unit in &self.vectors {
                let along = dot(unit, &rest);
                subtract(&mut rest, along, unit);
            }
        }
        rest
    }
}

/// The Euclidean length.
pub fn norm(vector: &[f64]) -> f64 {
    dot(vector, vector).sqrt()
}

/// The scalar product.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

/// `from -= factor · vector`.
pub fn subtract(from: &mut [f64], factor: f64, vector: &[f64]) {
    for (x, y) in from.iter_mut().zip(vector) {
        *x -= factor * y;
    }
}

#[cfg(test)]
mod tests {
    use super::Basis;

    #[test]
    fn a_dependent_vector_is_recognised_with_its_coefficients() {
        let mut basis = Basis::default();
        assert_eq!(basis.add(&[2.0, 0.0, 0.0]), None);
        assert_eq!(basis.add(&[3.0, 4.0, 0.0]), None);
        let made = basis.add(&[0.0, 5.0, 0.0]).expect("a dependent vector");
        assert!((made[0] + 0.75).abs() < 1e-15 && (made[1] - 1.25).abs() < 1e-15);
        assert_eq!(basis.add(&[0.0, 0.0, 1.0]), None);
    }
}
