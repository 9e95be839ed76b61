//! What is recorded besides coordinates, and states of the first order, against closed
//! forms.

mod bicycle;
mod columns;
mod files;
mod rows;
mod starts;
mod states;
