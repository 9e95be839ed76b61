//! A mechanism in a program of its own, as seen from the program that started it.
//!
//! In:  the program.
//! Out: an [`AnyMechanism`].
//!
//! The program ends with its [`Link`].

use crate::any::{AnyMechanism, Given, TimedRun};
use crate::scene::Scene;
use crate::segment::{Reached, Segment, Watch};
use crate::wire::{Reply, Request, Wire, receive, send};
use bricard_runtime::{Options, Structure};
use std::cell::RefCell;
use std::io::{self, BufReader, BufWriter, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A mechanism in a program of its own.
#[derive(Debug)]
pub struct Link {
    structure: &'static Structure,
    ends: RefCell<Ends>,
}

/// The two pipes, and the program behind them.
#[derive(Debug)]
pub(crate) struct Ends {
    to: BufWriter<ChildStdin>,
    from: BufReader<ChildStdout>,
    program: Child,
}

impl Link {
    /// Starts a program that [`serve`](crate::serve)s a mechanism.
    ///
    /// # Errors
    ///
    /// What the system says.
    pub fn start(program: Command) -> io::Result<Self> {
        let mut ends = Ends::start(program)?;
        match receive(&mut ends.from)? {
            Reply::Structure(structure) => Ok(Self {
                structure: Box::leak(Box::new(structure)),
                ends: RefCell::new(ends),
            }),
            _ => Err(io::Error::other(Ends::NONSENSE)),
        }
    }

    /// Tells what needs no answer. Where the program has gone, the next question says so.
    fn tell(&self, request: &Request) {
        let _gone = self.ends.borrow_mut().tell(request);
    }
}

impl Ends {
    /// What is said of an answer to another question.
    pub(crate) const NONSENSE: &str = "the compiled mechanism answers something else";

    /// Starts a program.
    pub(crate) fn start(mut program: Command) -> io::Result<Self> {
        apart(&mut program);
        let mut program = program
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (Some(to), Some(from)) = (program.stdin.take(), program.stdout.take()) else {
            return Err(io::Error::other("it has no standard input or output"));
        };
        Ok(Self {
            to: BufWriter::new(to),
            from: BufReader::with_capacity(1 << 16, from),
            program,
        })
    }

    /// Asks, and waits for the answer.
    pub(crate) fn ask<W: Wire>(&mut self, question: &impl Wire) -> Result<W, String> {
        let told = self.tell(question);
        told.and_then(|()| receive(&mut self.from))
            .map_err(|error| self.gone(&error))
    }

    fn tell(&mut self, request: &impl Wire) -> io::Result<()> {
        send(&mut self.to, request)?;
        self.to.flush()
    }

    /// What became of the program.
    fn gone(&mut self, error: &io::Error) -> String {
        match self.program.try_wait() {
            Ok(Some(status)) => format!("the compiled mechanism has ended: {status}"),
            _ => format!("the compiled mechanism does not answer: {error}"),
        }
    }
}

impl Drop for Ends {
    fn drop(&mut self) {
        let _ended = self.program.kill();
        let _status = self.program.wait();
    }
}

/// Keeps Ctrl-C at the terminal away from the program: whoever watches a run decides what
/// becomes of it.
fn apart(program: &mut Command) {
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        program.process_group(0);
    }
    #[cfg(windows)]
    {
        use std::os::windows::process::CommandExt;
        const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
        program.creation_flags(CREATE_NEW_PROCESS_GROUP);
    }
}

impl AnyMechanism for Link {
    fn structure(&self) -> &'static Structure {
        self.structure
    }

    fn set_parameter(&mut self, index: usize, value: f64) {
        self.tell(&Request::Parameter(index, value));
    }

    fn hold_input(&mut self, index: usize, value: f64) {
        self.tell(&Request::Input(index, value));
    }

    fn begin(&mut self, given: Given) {
        self.tell(&Request::Begin(given));
    }

    fn segment(&self, segment: &Segment, watch: &mut dyn Watch) -> Result<Reached, String> {
        let mut ends = self.ends.borrow_mut();
        let mut stopped = false;
        let told = ends.tell(&Request::Segment(segment.clone()));
        told.map_err(|error| ends.gone(&error))?;
        loop {
            let flow = match receive(&mut ends.from).map_err(|error| ends.gone(&error))? {
                // What was on its way when the run was broken off.
                Reply::Row(_) | Reply::At(..) if stopped => continue,
                Reply::Row(values) => watch.row(&values),
                Reply::At(t, steps) => watch.at(t, steps),
                Reply::Segment(reached) => return reached,
                _ => return Err(Ends::NONSENSE.to_string()),
            };
            if flow.is_break() {
                stopped = true;
                ends.tell(&Request::Stop)
                    .map_err(|error| ends.gone(&error))?;
            }
        }
    }

    fn timed_run(&self, from: Option<&[f64]>, options: &Options<f64>) -> Result<TimedRun, String> {
        match self
            .ends
            .borrow_mut()
            .ask(&Request::TimedRun(from.map(<[f64]>::to_vec), *options))?
        {
            Reply::TimedRun(timed) => timed,
            _ => Err(Ends::NONSENSE.to_string()),
        }
    }

    fn scene(&self, rows: &[Vec<f64>]) -> Result<Scene, String> {
        match self.ends.borrow_mut().ask(&Request::Scene(rows.to_vec()))? {
            Reply::Scene(scene) => scene,
            _ => Err(Ends::NONSENSE.to_string()),
        }
    }

    fn rank_at_start(&self) -> Result<usize, String> {
        match self.ends.borrow_mut().ask(&Request::RankAtStart)? {
            Reply::RankAtStart(rank) => rank,
            _ => Err(Ends::NONSENSE.to_string()),
        }
    }
}
