//! What benchmarks beside other solvers share.

mod clock;
mod reduced;
mod tsit45;

pub use clock::Repeated;
pub use reduced::Reduced;
pub use tsit45::tsit45;
