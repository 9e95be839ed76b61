//! What the header declares, as Rust sees it.
//!
//! Out: structures with the layout that C gives them.
//!
//! `include/bricard.h` is the other half; the tests hold one against the other.

use crate::callback::{EventFunction, GoOnFunction, LawFunction, PassageFunction, TakeFunction};
use crate::status::Status;
use core::any::TypeId;
use core::ffi::{c_char, c_int, c_void};

/// The version of the interface: programs and libraries of different ones don't fit.
pub const ABI: u32 = 2;

/// The header.
pub const HEADER: &str = include_str!("../include/bricard.h");

/// A mechanism, as C knows it: its first member is the table of its functions.
#[derive(Debug)]
#[repr(C)]
pub struct Handle {
    pub(crate) interface: &'static Interface,
    /// Which mechanism it is. Tables may be there more than once and tell nothing.
    pub(crate) kind: TypeId,
}

/// A state to evaluate something at.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Point {
    /// Time (s).
    pub t: f64,
    /// Coordinates.
    pub q: *const f64,
    /// Velocities.
    pub v: *const f64,
    /// How many there are of each.
    pub n: usize,
}

/// How a motion is integrated.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Choices {
    /// `sizeof(bricard_options)`.
    pub size: usize,
    /// The integrator.
    pub method: c_int,
    /// The form of the equations of motion.
    pub form: c_int,
    /// What keeps the state on the constraints.
    pub stabilisation: c_int,
    /// Whether the energy is kept.
    pub keep_energy: c_int,
    /// Whether constraints, energy and passages are audited.
    pub audit: c_int,
    /// Whether singular positions are passed as published.
    pub published: c_int,
    /// Baumgarte's gain of the velocity level (1/s).
    pub alpha: f64,
    /// Baumgarte's gain of the position level (1/s).
    pub beta: f64,
    /// The fixed step (s); zero: steps follow the tolerances.
    pub step: f64,
    /// Accepted relative error of a step.
    pub rtol: f64,
    /// Accepted absolute error of a step.
    pub atol: f64,
    /// Steps after which a run is given up; zero: never.
    pub most_steps: u64,
}

/// What is recorded of a run, and who is told of it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Watch {
    /// `sizeof(bricard_watch)`.
    pub size: usize,
    /// Given back to the functions below.
    pub user: *mut c_void,
    /// Distance of the rows (s); zero: a row after each step.
    pub every: f64,
    /// What rows hold besides time, coordinates and velocities: bits.
    pub columns: u32,
    /// Rows within each step, where there is one after each step.
    pub inside: u32,
    /// Where rows go.
    pub rows: *mut f64,
    /// How many numbers there is room for.
    pub room: usize,
    /// Takes the rows when they are full, and the last ones.
    pub take: Option<TakeFunction>,
    /// Is told of events.
    pub event: Option<EventFunction>,
    /// Is told of passages through singular positions.
    pub passage: Option<PassageFunction>,
    /// Is asked now and then whether to go on.
    pub go_on: Option<GoOnFunction>,
    /// How many rows were written since they were taken last.
    pub written: usize,
}

/// What a run did.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Summary {
    /// `sizeof(bricard_summary)`.
    pub size: usize,
    /// Time that was reached (s).
    pub t: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Steps that were tried and thrown away.
    pub rejected: u64,
    /// Accelerations.
    pub evaluations: u64,
    /// Events.
    pub events: u64,
    /// Passages through singular positions.
    pub passages: u64,
    /// Starts at rest exactly in a singular position.
    pub undetermined: u64,
    /// The largest error of a constraint equation, in its unit.
    pub constraint_error: f64,
    /// The largest error of its rate, in its unit per second.
    pub velocity_error: f64,
    /// The largest error of the energy balance (J).
    pub energy_error: f64,
    /// What the power has supplied (J).
    pub energy_supplied: f64,
}

/// The functions of a mechanism. Each one may be called from any thread, but one at a time
/// for the same handle.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
#[allow(missing_docs, reason = "the header documents them")]
pub struct Interface {
    pub abi: u32,
    pub create: unsafe extern "C" fn(*mut *mut Handle) -> Status,
    pub clone: unsafe extern "C" fn(*mut Handle, *mut *mut Handle) -> Status,
    pub assign: unsafe extern "C" fn(*mut Handle, *mut Handle) -> Status,
    pub free: unsafe extern "C" fn(*mut *mut Handle),
    pub message: unsafe extern "C" fn(*mut Handle) -> *const c_char,
    pub failed_at: unsafe extern "C" fn(*mut Handle, *mut f64) -> Status,
    pub count: unsafe extern "C" fn(*mut Handle, c_int, *mut usize) -> Status,
    pub name: unsafe extern "C" fn(*mut Handle, c_int, usize) -> *const c_char,
    pub unit: unsafe extern "C" fn(*mut Handle, c_int, usize) -> *const c_char,
    pub docs: unsafe extern "C" fn(*mut Handle, c_int, usize) -> *const c_char,
    pub find: unsafe extern "C" fn(*mut Handle, c_int, *const c_char, *mut usize) -> Status,
    pub parameter: unsafe extern "C" fn(*mut Handle, usize, *mut f64) -> Status,
    pub set_parameter: unsafe extern "C" fn(*mut Handle, usize, f64) -> Status,
    pub hold_input: unsafe extern "C" fn(*mut Handle, usize, f64) -> Status,
    pub release_input: unsafe extern "C" fn(*mut Handle, usize) -> Status,
    pub drive_input:
        unsafe extern "C" fn(*mut Handle, usize, Option<LawFunction>, *mut c_void) -> Status,
    pub start: unsafe extern "C" fn(*mut Handle, usize, c_int, *mut f64, *mut c_int) -> Status,
    pub set_start: unsafe extern "C" fn(*mut Handle, usize, c_int, f64, c_int) -> Status,
    pub assemble: unsafe extern "C" fn(*mut Handle, f64) -> Status,
    pub state: unsafe extern "C" fn(*mut Handle, *mut f64, *mut f64, *mut f64, usize) -> Status,
    pub set_state: unsafe extern "C" fn(*mut Handle, f64, *const f64, *const f64, usize) -> Status,
    pub options: unsafe extern "C" fn(*mut Handle, *mut Choices) -> Status,
    pub set_options: unsafe extern "C" fn(*mut Handle, *const Choices) -> Status,
    pub run: unsafe extern "C" fn(*mut Handle, f64, *mut Watch, *mut Summary) -> Status,
    pub stop: unsafe extern "C" fn(*mut Handle) -> Status,
    pub step: unsafe extern "C" fn(*mut Handle, f64) -> Status,
    pub step_once: unsafe extern "C" fn(*mut Handle, f64) -> Status,
    pub size: unsafe extern "C" fn(*mut Handle, c_int, *mut usize) -> Status,
    pub row_size: unsafe extern "C" fn(*mut Handle, u32, *mut usize) -> Status,
    pub evaluate: unsafe extern "C" fn(*mut Handle, c_int, *const Point, *mut f64, usize) -> Status,
    pub draw:
        unsafe extern "C" fn(*mut Handle, *const Point, *mut f64, usize, *mut usize) -> Status,
    pub project: unsafe extern "C" fn(*mut Handle, f64, *mut f64, *mut f64, usize) -> Status,
    pub save: unsafe extern "C" fn(*mut Handle, *mut f64, usize) -> Status,
    pub load: unsafe extern "C" fn(*mut Handle, *const f64, usize) -> Status,
}
