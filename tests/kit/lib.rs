//! What tests of several packages need, and the command that measures as they do. It knows
//! nothing of the packages.

pub mod callgrind;
pub mod page;
pub mod placement;
mod random;
mod reduction;
pub mod sentences;
mod variants;

pub use random::Random;
pub use reduction::{Motion, Reduction};
pub use variants::variants;
