//! Random mechanisms with planted singular positions, made at run time.
//!
//! In:  a seed.
//! Out: a scene as a [`Mechanism`] with constraints, and the same in independent
//!      coordinates without; all derivatives are exact.
//!
//! The kinetic energy is ½ |d/dt φ(q)|², of points of unit mass. With J = ∂φ/∂q and φ″
//! the second derivative of φ along the straight line with the velocity, M = JᵀJ and
//! p₁ = −Jᵀφ″ − ∂Π/∂q.

mod mechanism;
mod product;
mod smooth;
mod tree;
mod wave;

pub use mechanism::{Planted, Reduced, trial_structure};

use bricard_testkit::Random;
use product::Product;
use smooth::{MOST, Smooth};
use tree::Tree;

/// Points that a scene may have, and the potential.
const POINTS: usize = 4 * MOST + 1;

/// A random mechanism.
#[derive(Clone, Debug)]
pub enum Scene {
    /// Products of surfaces in random coordinates.
    Product(Box<Product>),
    /// Parallelograms in a tree.
    Tree(Tree),
}

/// Freedoms and rows of products.
const PRODUCTS: [(usize, usize); 8] = [
    (1, 1),
    (2, 1),
    (3, 1),
    (4, 1),
    (1, 2),
    (2, 2),
    (3, 2),
    (4, 2),
];
/// Parallelograms and other bodies of trees.
const TREES: [(usize, usize); 6] = [(1, 0), (1, 1), (1, 2), (1, 3), (2, 0), (2, 1)];

impl Scene {
    /// The products of a seed.
    pub fn product(random: &mut Random) -> Self {
        let (n, k) = random.of_these(&PRODUCTS);
        Self::Product(Box::new(Product::new(random, n, k)))
    }

    /// The tree of a seed.
    pub fn tree(random: &mut Random) -> Self {
        let (loops, others) = random.of_these(&TREES);
        Self::Tree(Tree::new(random, loops, others))
    }

    /// Coordinates, freedoms, rows.
    pub fn sizes(&self) -> (usize, usize, usize) {
        match self {
            Self::Product(scene) => scene.sizes,
            Self::Tree(scene) => scene.sizes(),
        }
    }

    fn lift<S: Smooth>(&self, x: &[S; MOST], t: S) -> [S; MOST] {
        match self {
            Self::Product(scene) => scene.lift(x, t),
            Self::Tree(scene) => scene.lift(x),
        }
    }

    fn rows<S: Smooth>(&self, q: &[S; MOST], t: S, out: &mut [S]) {
        match self {
            Self::Product(scene) => scene.rows(q, t, out),
            Self::Tree(scene) => scene.rows(q, out),
        }
    }

    /// How many points there are.
    fn count(&self) -> usize {
        match self {
            Self::Product(scene) => scene.sizes.0,
            Self::Tree(scene) => 4 * scene.sizes().0,
        }
    }

    fn points<S: Smooth>(&self, q: &[S; MOST], out: &mut [S]) {
        match self {
            Self::Product(scene) => scene.points(q, out),
            Self::Tree(scene) => scene.points(q, out),
        }
    }

    fn off(&self, q: &[f64; MOST], t: f64, out: &mut [f64]) {
        match self {
            Self::Product(scene) => {
                for (out, off) in out.iter_mut().zip(scene.off(q, t)) {
                    *out = off;
                }
            }
            Self::Tree(scene) => scene.off(q, out),
        }
    }

    fn crossings(&self, x: &[f64; MOST], out: &mut [f64]) {
        match self {
            Self::Product(scene) => scene.crossings(x, out),
            Self::Tree(scene) => scene.crossings(x, out),
        }
    }

    /// Whether nothing in it moves by a clock.
    pub fn conservative(&self) -> bool {
        match self {
            Self::Product(scene) => scene.conservative(),
            Self::Tree(_) => true,
        }
    }

    /// Independent coordinates and velocities to begin with.
    pub fn start(&self, random: &mut Random) -> ([f64; MOST], [f64; MOST]) {
        match self {
            Self::Product(scene) => scene.start(random),
            Self::Tree(scene) => scene.start(random),
        }
    }
}
