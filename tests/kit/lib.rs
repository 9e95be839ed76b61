//! What tests of several packages need. It knows nothing of mechanisms.

mod random;

pub use random::Random;
