//! Random mechanisms with planted singular positions.

use crate::planting::Planting;
use crate::trial::{Set, Trial};
use bricard_testkit::Random;
use std::sync::Arc;

fn planted(random: &mut Random, tree: bool) -> Trial {
    let planting = Arc::new(Planting::new(random, tree));
    Trial {
        planted: Some(planting),
        ..Trial::short("planted", "planted", Set::new())
    }
}

/// Products of surfaces in random coordinates.
pub fn products(random: &mut Random, _: usize) -> Trial {
    planted(random, false).until(0.8)
}

/// Parallelograms in random places of random trees.
pub fn trees(random: &mut Random, _: usize) -> Trial {
    planted(random, true).until(1.0)
}
