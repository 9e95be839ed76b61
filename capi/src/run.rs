//! The functions of C for runs: options, who watches, when to stop.
//!
//! In:  structures of the header.
//! Out: a [`Status`].

use crate::Embedded;
use crate::abi::{Choices, Handle, Summary, Watch};
use crate::callback::Callback;
use crate::engine::Engine;
use crate::handle::Body;
use crate::pointer::{give, write};
use crate::status::Status;
use crate::watch::{Columns, Ended, Listeners, MOST_INSIDE, Sheet};
use bricard_runtime::{
    Audit, Form, Method, Options, Settings, Stabilisation, StepControl, Structure, Summary as Done,
};
use core::ffi::c_int;
use core::sync::atomic::Ordering;

/// The place of a choice in a list.
fn number<C: PartialEq>(list: &[C], choice: &C) -> c_int {
    let place = list.iter().position(|listed| listed == choice);
    place
        .and_then(|place| c_int::try_from(place).ok())
        .unwrap_or(-1)
}

/// The choice of a number in a list.
fn choice<C: Copy>(list: &[C], number: c_int) -> Option<C> {
    usize::try_from(number)
        .ok()
        .and_then(|number| list.get(number).copied())
}

/// Options as C reads them.
fn shown(options: &Options<f64>) -> Choices {
    let (step, rtol, atol) = match options.step_control {
        StepControl::Fixed { step } => (step, 0.0, 0.0),
        StepControl::Adaptive { relative, absolute } => (0.0, relative, absolute),
    };
    let (stabilisation, alpha, beta) = match options.settings.stabilisation {
        Stabilisation::Projection => (0, 0.0, 0.0),
        Stabilisation::None => (1, 0.0, 0.0),
        Stabilisation::Baumgarte { alpha, beta } => (2, alpha, beta),
    };
    Choices {
        size: size_of::<Choices>(),
        method: number(&Method::ALL, &options.method),
        form: number(&Form::ALL, &options.settings.form),
        stabilisation,
        keep_energy: options.keep_energy.into(),
        audit: (options.audit != Audit::NONE).into(),
        published: options.settings.published.into(),
        alpha,
        beta,
        step,
        rtol,
        atol,
        most_steps: options.most_steps.unwrap_or(0),
    }
}

/// The options that C wrote, or what is wrong with them.
fn chosen(choices: &Choices) -> Result<Options<f64>, &'static str> {
    if choices.size != size_of::<Choices>() {
        return Err("these options are of another size: begin with bricard_get_options");
    }
    let method = choice(&Method::ALL, choices.method).ok_or("there is no method of this number")?;
    let form = choice(&Form::ALL, choices.form).ok_or("there is no form of this number")?;
    let gains = [choices.alpha, choices.beta];
    let stabilisation = match choices.stabilisation {
        0 => Stabilisation::Projection,
        1 => Stabilisation::None,
        2 if gains.iter().all(|gain| gain.is_finite() && *gain > 0.0) => {
            let [alpha, beta] = gains;
            Stabilisation::Baumgarte { alpha, beta }
        }
        2 => return Err("the gains of Baumgarte's stabilisation must be positive"),
        _ => return Err("there is no stabilisation of this number"),
    };
    let step_control = match choices.step == 0.0 {
        true => StepControl::Adaptive {
            relative: choices.rtol,
            absolute: choices.atol,
        },
        false => StepControl::Fixed { step: choices.step },
    };
    let mut options = Options::new(0.0, method, step_control);
    options.settings = Settings {
        form,
        stabilisation,
        published: choices.published != 0,
        ..Settings::default()
    };
    options.keep_energy = choices.keep_energy != 0;
    options.audit = match choices.audit {
        0 => Audit::NONE,
        _ => Audit::ALL,
    };
    options.most_steps = (choices.most_steps > 0).then_some(choices.most_steps);
    Ok(options)
}

/// What is wrong with a watch; `None` if it can be used.
fn refusal(watch: &Watch, width: usize) -> Option<&'static str> {
    let room = watch.room / width.max(1);
    let no_rows = watch.room == 0 && watch.take.is_none();
    if watch.size != size_of::<Watch>() {
        Some("this watch is of another size: begin with bricard_watch_nothing")
    } else if !(watch.every >= 0.0 && watch.every.is_finite()) {
        Some("the distance of the rows must be a positive number of seconds, or zero")
    } else if watch.inside > MOST_INSIDE {
        Some("there are at most 32 rows within a step")
    } else if !no_rows && room == 0 {
        Some("there is no room for a row")
    } else {
        None
    }
}

/// Those who listen.
///
/// # Safety
///
/// The pointers in the watch are what the header says.
unsafe fn listeners<'a>(
    watch: &Watch,
    structure: &Structure,
    n: usize,
) -> Result<Listeners<'a>, (Status, &'static str)> {
    let argument = |reason| (Status::Argument, reason);
    let columns = Columns::of(watch.columns).ok_or(argument("there are no such columns"))?;
    let width = columns.width(structure, n);
    if let Some(reason) = refusal(watch, width) {
        return Err(argument(reason));
    }
    // SAFETY: as promised.
    let rows = unsafe { write(watch.rows, watch.room) };
    let rows = rows.map_err(|status| (status, "there is no place for the rows"))?;
    let user = watch.user;
    // SAFETY: as promised, for each of the functions.
    let (take, event, passage, go_on) = unsafe {
        (
            watch.take.map(|function| Callback::new(function, user)),
            watch.event.map(|function| Callback::new(function, user)),
            watch.passage.map(|function| Callback::new(function, user)),
            watch.go_on.map(|function| Callback::new(function, user)),
        )
    };
    let none = rows.is_empty() && take.is_none();
    Ok(Listeners {
        sheet: Sheet {
            columns,
            width,
            rows,
            written: 0,
            take,
            none,
        },
        every: (watch.every > 0.0).then_some(watch.every),
        inside: watch.inside,
        event,
        passage,
        go_on,
    })
}

/// A summary as C reads it.
fn told<const N: usize>(done: &Done<f64, N>) -> Summary {
    let error = done.constraint_error.unwrap_or_default();
    Summary {
        size: size_of::<Summary>(),
        t: done.end.t,
        steps: done.steps,
        rejected: done.rejected,
        evaluations: done.evaluations,
        events: done.events,
        passages: done.passages.unwrap_or(0),
        undetermined: done.counters.undetermined,
        constraint_error: error.position,
        velocity_error: error.velocity,
        energy_error: done.energy_error.unwrap_or(0.0),
        energy_supplied: done.energy_supplied.unwrap_or(0.0),
    }
}

fn ended(ended: Option<Ended>) -> Status {
    match ended {
        None => Status::Ok,
        Some(Ended::Stopped) => Status::Stopped,
        Some(Ended::Full) => Status::Full,
    }
}

impl<M: Embedded<N, R>, const N: usize, const R: usize> Body<M, N, R> {
    pub(crate) unsafe extern "C" fn options(handle: *mut Handle, out: *mut Choices) -> Status {
        // SAFETY: the header's promise, also for `out`.
        unsafe { Self::enter(handle, |engine| give(out, shown(engine.options()))) }
    }

    pub(crate) unsafe extern "C" fn set_options(
        handle: *mut Handle,
        choices: *const Choices,
    ) -> Status {
        // SAFETY: the header's promise, also for `choices`.
        unsafe {
            Self::enter(handle, |engine| {
                match chosen(choices.as_ref().ok_or(Status::Null)?) {
                    Ok(options) => engine.set_options(options),
                    Err(reason) => engine.refuse(Status::Argument, &reason),
                }
            })
        }
    }

    pub(crate) unsafe extern "C" fn run(
        handle: *mut Handle,
        until: f64,
        watch: *mut Watch,
        summary: *mut Summary,
    ) -> Status {
        // SAFETY: the header's promise.
        let Some(body) = (unsafe { Self::of(handle) }) else {
            return Status::Null;
        };
        let mut early = Status::Ok;
        let act = |engine: &mut Engine<M, N, R>| {
            // SAFETY: the header's promise for `watch`. It is read here and written at the end:
            // functions of the program may look at it meanwhile.
            let plan = unsafe { watch.as_ref() }.copied();
            let structure = engine.structure();
            let listening = match &plan {
                None => None,
                // SAFETY: the header's promise for what is in it.
                Some(plan) => match unsafe { listeners(plan, structure, N) } {
                    Ok(listening) => Some(listening),
                    Err((status, reason)) => return engine.refuse(status, &reason),
                },
            };
            let mut listening = listening;
            let (result, done) = engine.run(until, listening.as_mut(), &body.stop);
            body.stop.store(false, Ordering::Relaxed);
            if let Some(listening) = &listening {
                // SAFETY: as above; `listening` is only there if `watch` is.
                unsafe { (*watch).written = listening.sheet.written };
            }
            if let Some(done) = done
                && !summary.is_null()
            {
                // SAFETY: the header's promise for `summary`.
                unsafe { give(summary, told(&done))? };
            }
            early = ended(result?);
            Ok(())
        };
        match body.lend(act) {
            Status::Ok => early,
            status => status,
        }
    }

    pub(crate) unsafe extern "C" fn stop(handle: *mut Handle) -> Status {
        // SAFETY: the header's promise; the flag may be set while a call is at work.
        match unsafe { Self::of(handle) } {
            Some(body) => {
                body.stop.store(true, Ordering::Relaxed);
                Status::Ok
            }
            None => Status::Null,
        }
    }

    pub(crate) unsafe extern "C" fn row_size(
        handle: *mut Handle,
        columns: u32,
        out: *mut usize,
    ) -> Status {
        // SAFETY: the header's promise, also for `out`.
        unsafe {
            Self::enter(handle, |engine| match Columns::of(columns) {
                Some(columns) => give(out, columns.width(engine.structure(), N)),
                None => engine.refuse(Status::Argument, &"there are no such columns"),
            })
        }
    }
}
