//! A mechanism behind standard input and output.
//!
//! In:  requests on standard input.
//! Out: replies on standard output.

use crate::any::{AnyMechanism, erase_type};
use crate::segment::Watch;
use crate::wire::{Reply, Request, Wire, receive, row, send};
use bricard_runtime::Whole;
use std::io::{self, BufWriter, Stdout, Write};
use std::mem;
use std::ops::ControlFlow;
use std::process::{self, ExitCode};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How often whoever waits hears of a run.
const PERIOD: Duration = Duration::from_millis(50);
/// Steps between looks at the clock.
const STEPS_BETWEEN_LOOKS: u64 = 16;

/// The stack of a program, in bytes: some systems give it less to begin with.
const STACK: usize = 8 << 20;

/// Whether the run should end.
static WANTED: AtomicBool = AtomicBool::new(false);

/// Answers what is asked about a mechanism until nobody asks any more: the whole of a
/// program's `main`.
pub fn serve<const N: usize, const R: usize>(make: fn() -> Box<dyn Whole<f64, N, R>>) -> ExitCode {
    // `row` is named here so that it is compiled with the mechanism, and optimised; the rest
    // of this package need not be fast.
    with_room(move || match answer(erase_type(make()), row) {
        Ok(()) => ExitCode::SUCCESS,
        // Nobody is there to be told.
        Err(_) => ExitCode::FAILURE,
    })
}

/// Does something on a stack of usual size. For matrices that don't fit, the runtime has room
/// of its own.
pub fn with_room(work: impl FnOnce() -> ExitCode + Send + 'static) -> ExitCode {
    let thread = thread::Builder::new().stack_size(STACK).spawn(work);
    let done = thread.map(thread::JoinHandle::join);
    match done {
        Ok(Ok(code)) => code,
        // The panic has said why.
        Ok(Err(_)) => ExitCode::FAILURE,
        Err(refused) => {
            eprintln!("a program needs {} MiB of memory: {refused}", STACK >> 20);
            ExitCode::FAILURE
        }
    }
}

fn answer(mut mechanism: Box<dyn AnyMechanism>, row: WriteRow) -> io::Result<()> {
    let requests = listen(|request| {
        if *request == Request::Stop {
            WANTED.store(true, Ordering::Relaxed);
        }
    });
    let mut out = Out::new(row);
    out.send(&Reply::Structure(*mechanism.structure()))?;
    for request in requests {
        let reply = match request {
            Request::Parameter(index, value) => {
                mechanism.set_parameter(index, value);
                continue;
            }
            Request::Input(index, value) => {
                mechanism.hold_input(index, value);
                continue;
            }
            Request::Begin(given) => {
                mechanism.begin(given);
                continue;
            }
            Request::Stop => continue,
            Request::Segment(segment) => Reply::Segment(mechanism.segment(&segment, &mut out)),
            Request::TimedRun(from, options) => {
                Reply::TimedRun(mechanism.timed_run(from.as_deref(), &options))
            }
            Request::Scene(rows) => Reply::Scene(mechanism.scene(&rows)),
            Request::RankAtStart => Reply::RankAtStart(mechanism.rank_at_start()),
        };
        out.send(&reply)?;
    }
    Ok(())
}

/// Reads requests as they come, also during a computation, and takes note of each at once.
/// When the other end has gone, the program ends.
pub(crate) fn listen<W>(note: impl Fn(&W) + Send + 'static) -> Receiver<W>
where
    W: Wire + Send + 'static,
{
    let (sender, requests) = channel();
    thread::spawn(move || {
        let mut input = io::stdin().lock();
        while let Ok(request) = receive(&mut input) {
            note(&request);
            if sender.send(request).is_err() {
                break;
            }
        }
        process::exit(0);
    });
    requests
}

/// Writes the message of a row instead of what was there.
type WriteRow = fn(&[f64], &mut Vec<u8>);

/// Standard output, of which rows fill large pieces.
struct Out {
    out: BufWriter<Stdout>,
    row: WriteRow,
    /// The latest row.
    bytes: Vec<u8>,
    told: Instant,
    /// Steps that nobody has heard of.
    steps: u64,
}

impl Out {
    fn new(row: WriteRow) -> Self {
        Self {
            out: BufWriter::with_capacity(1 << 16, io::stdout()),
            row,
            bytes: Vec::new(),
            told: Instant::now(),
            steps: 0,
        }
    }

    fn send(&mut self, reply: &Reply) -> io::Result<()> {
        send(&mut self.out, reply)?;
        self.out.flush()?;
        self.told = Instant::now();
        Ok(())
    }
}

fn flow(sent: io::Result<()>) -> ControlFlow<()> {
    match sent {
        Ok(()) if !WANTED.load(Ordering::Relaxed) => ControlFlow::Continue(()),
        _ => ControlFlow::Break(()),
    }
}

impl Watch for Out {
    fn row(&mut self, values: &[f64]) -> ControlFlow<()> {
        (self.row)(values, &mut self.bytes);
        flow(self.out.write_all(&self.bytes))
    }

    fn at(&mut self, t: f64, steps: u64) -> ControlFlow<()> {
        self.steps += steps;
        if !self.steps.is_multiple_of(STEPS_BETWEEN_LOOKS) || self.told.elapsed() < PERIOD {
            return flow(Ok(()));
        }
        let steps = mem::take(&mut self.steps);
        flow(self.send(&Reply::At(t, steps)))
    }
}
