//! What is recorded besides coordinates, and states of the first order, against closed
//! forms.

// Its simulation of each pair of sizes is shared, where the compiler shares generic code.
use bricard as _;

mod bicycle;
mod columns;
mod files;
mod rows;
mod starts;
mod states;
