//! What tests of several packages need. It knows nothing of the packages.

mod random;
mod reduction;

pub use random::Random;
pub use reduction::{Motion, Reduction};
