//! Runs the control loop on a Cortex-M4 and reports what it came to, line by line.
//!
//! In:  the loop of the crate `bare_metal`.
//! Out: lines of words on the debugger's console: what is counted, and states as bits.
#![no_std]
#![forbid(unsafe_code)]

mod clock;

use bare_metal::{Loop, REPORTED, SPEED, TICKS};
use bricard_runtime::Real;
use clock::Clock;
use core::panic::PanicInfo;
use cortex_m_semihosting::debug::{EXIT_FAILURE, EXIT_SUCCESS, exit};
use cortex_m_semihosting::{heprintln, hprintln};

/// What the ticks of a run took.
#[derive(Default)]
struct Work {
    /// Ticks, evaluations and instructions away from singular positions.
    regular: [u64; 3],
    /// Ticks, evaluations and instructions next to singular positions.
    beside: [u64; 3],
    /// The most evaluations of a tick.
    most_evaluations: u32,
    /// The most instructions of a tick.
    most_instructions: u32,
    /// The most instructions of a tick for each of its evaluations.
    most_each: u32,
}

impl Work {
    fn add(&mut self, evaluations: u32, instructions: u32, is_beside: bool) {
        let sums = match is_beside {
            true => &mut self.beside,
            false => &mut self.regular,
        };
        let one = [1, u64::from(evaluations), u64::from(instructions)];
        for (sum, one) in sums.iter_mut().zip(one) {
            *sum += one;
        }
        self.most_evaluations = self.most_evaluations.max(evaluations);
        self.most_instructions = self.most_instructions.max(instructions);
        self.most_each = self
            .most_each
            .max(instructions.div_ceil(evaluations.max(1)));
    }
}

/// The whole program.
pub fn run<T: Real>() -> ! {
    let Some(mut clock) = Clock::new() else {
        fail("the clock is in use already");
    };
    cortex_m_stack::repaint_stack();
    let idle = cortex_m_stack::current_stack_in_use();
    let work = control::<T>(&mut clock);
    let deepest = cortex_m_stack::stack_size() - cortex_m_stack::stack_painted();
    hprintln!("stack {}", deepest - idle);
    hprintln!("variables {}", size_of::<Loop<T>>());
    for (name, [ticks, evaluations, instructions]) in
        [("regular", work.regular), ("beside", work.beside)]
    {
        hprintln!("{name} {ticks} {evaluations} {instructions}");
    }
    hprintln!(
        "most {} {} {}",
        work.most_evaluations,
        work.most_instructions,
        work.most_each
    );
    exit(EXIT_SUCCESS);
    fail("the debugger doesn't end the program");
}

/// The control loop; states are reported twenty times a second, outside what is counted.
#[inline(never)]
fn control<T: Real>(clock: &mut Clock) -> Work {
    let Some(mut control) = Loop::<T>::new(SPEED) else {
        fail("the engine can't be assembled");
    };
    let mut work = Work::default();
    report(0, &control);
    for tick in 1..=TICKS {
        let before = control.beside();
        let (result, instructions) = clock.count(|| control.tick());
        match result {
            Ok(evaluations) => work.add(evaluations, instructions, control.beside() > before),
            Err(_) => {
                report(tick, &control);
                fail("a tick failed");
            }
        }
        if tick % REPORTED == 0 {
            report(tick, &control);
        }
    }
    work
}

fn report<T: Real>(tick: u32, control: &Loop<T>) {
    let [q1, q2, q3, v1, v2, v3] = control.state().map(f64::to_bits);
    hprintln!("state {tick} {q1:016x} {q2:016x} {q3:016x} {v1:016x} {v2:016x} {v3:016x}");
}

fn fail(why: &str) -> ! {
    heprintln!("{why}");
    loop {
        exit(EXIT_FAILURE);
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    heprintln!("{info}");
    fail("a panic");
}
