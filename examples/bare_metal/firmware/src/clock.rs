//! Counts instructions.
//!
//! In:  QEMU with `-icount shift=3`, which lets 8 ns of the board's time pass with each
//!      instruction, and the processor's timer, which goes down by one every 40 ns.
//! Out: the instructions of a function, to within five.
//!
//! The timer alone doesn't say what its ticks are: a loop whose instructions are known
//! tells. On a real board the same code would count cycles.

use cortex_m::Peripherals;
use cortex_m::asm::delay;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;

/// Where the timer begins anew.
const TOP: u32 = 0x00ff_ffff;
/// Instructions of the loop that tells what a tick is: two in each turn.
const KNOWN: u32 = 100_000;

/// A timer that was compared with instructions.
pub struct Clock {
    timer: SYST,
    /// Ticks of `KNOWN` instructions.
    ticks: u32,
    /// Ticks of nothing.
    nothing: u32,
}

impl Clock {
    /// None if someone has the timer already.
    pub fn new() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(TOP);
        timer.clear_current();
        timer.enable_counter();
        let mut clock = Self {
            timer,
            ticks: KNOWN,
            nothing: 0,
        };
        clock.nothing = clock.ticks(|| ()).1;
        clock.ticks = clock.ticks(|| delay(KNOWN)).1 - clock.nothing;
        Some(clock)
    }

    /// What a function returns, and the ticks it took.
    fn ticks<V>(&mut self, function: impl FnOnce() -> V) -> (V, u32) {
        self.timer.clear_current();
        let before = SYST::get_current();
        let value = function();
        let after = SYST::get_current();
        assert!(
            !self.timer.has_wrapped(),
            "a tick of the loop is too long for the timer"
        );
        (value, before.wrapping_sub(after) & TOP)
    }

    /// What a function returns, and the instructions it took.
    pub fn count<V>(&mut self, function: impl FnOnce() -> V) -> (V, u32) {
        let (value, ticks) = self.ticks(function);
        let ticks = u64::from(ticks.saturating_sub(self.nothing));
        let instructions = ticks * u64::from(KNOWN) / u64::from(self.ticks);
        (value, u32::try_from(instructions).unwrap_or(u32::MAX))
    }
}
