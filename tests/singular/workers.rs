//! Runs many trials at once, each with a limit of its own.
//!
//! In:  trials.
//! Out: their verdicts, in order.
//!
//! A run that hangs between two steps can't be told to stop: its thread is left behind,
//! and the verdict says so.

use crate::judge::{Verdict, judge};
use crate::trial::Trial;
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// What a run may take (s), besides a quarter of its own seconds.
const PATIENCE: f64 = 30.0;

/// A trial and what it came to.
#[derive(Clone, Debug)]
pub struct Ran {
    /// The trial.
    pub trial: Trial,
    /// What it came to.
    pub verdict: Verdict,
}

/// Runs trials on as many threads as there are processors.
pub fn run_all(trials: Vec<Trial>) -> Vec<Ran> {
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let count = trials.len();
    let queue = Mutex::new(trials.into_iter().enumerate());
    let done: Mutex<Vec<Option<Ran>>> = Mutex::new(vec![None; count]);
    thread::scope(|scope| {
        for _ in 0..workers.min(count) {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().expect("no worker panics").next();
                    let Some((place, trial)) = next else { break };
                    let verdict = guarded(&trial);
                    let ran = Ran { trial, verdict };
                    done.lock().expect("no worker panics")[place] = Some(ran);
                }
            });
        }
    });
    let done = done.into_inner().expect("no worker panics");
    done.into_iter().flatten().collect()
}

/// Runs a trial in a thread of its own, and leaves it behind if it doesn't end.
fn guarded(trial: &Trial) -> Verdict {
    let (sender, receiver) = channel();
    let own = trial.clone();
    thread::spawn(move || {
        // Nobody listens any more if it took too long.
        let _: Result<(), _> = sender.send(judge(&own));
    });
    let patience = Duration::from_secs_f64(PATIENCE + trial.until / 4.0);
    match receiver.recv_timeout(patience) {
        Ok(verdict) => verdict,
        Err(RecvTimeoutError::Timeout) => {
            Verdict::lost(format!("did not end within {} s", patience.as_secs()))
        }
        Err(RecvTimeoutError::Disconnected) => Verdict::lost("panicked".to_string()),
    }
}
