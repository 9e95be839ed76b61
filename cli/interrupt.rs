//! Ctrl-C: a wish to end the run, not the program.
//!
//! Out: whether it was pressed since [`listen`] was called. Pressed twice, it ends the
//!      program at once.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

/// Exit status of a program that Ctrl-C ended, as shells have it.
pub const INTERRUPTED: u8 = 130;

static WANTED: AtomicBool = AtomicBool::new(false);

/// Takes Ctrl-C over. Where the system refuses, it ends the program as always.
pub fn listen() {
    let _refused = ctrlc::set_handler(|| {
        if WANTED.swap(true, Ordering::Relaxed) {
            process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// Whether the run should end.
pub fn is_wanted() -> bool {
    WANTED.load(Ordering::Relaxed)
}
