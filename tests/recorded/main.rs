//! What is recorded besides coordinates, and states of the first order, against closed
//! forms.

mod columns;
mod rows;
mod states;
