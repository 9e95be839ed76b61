//! A mechanism as a WebAssembly module.
//!
//! In:  a generated mechanism.
//! Out: the functions of a module, by [`module!`], which `js/index.js` calls.
//!
//! ```text
//! JavaScript ── numbers ──> exported functions ──> Session ──> the runtime
//!            <── reads numbers and text in the module's memory
//! ```
//!
//! A module holds one mechanism: for two, it is instantiated twice. So there are no handles
//! and nothing is shared. Only numbers go in; arrays and texts are read in the module's
//! memory, where [`Session`] keeps them. No standard library and no allocator is needed.
#![cfg_attr(not(test), no_std)]

mod describe;
mod row;
mod run;
mod session;
mod session_run;
mod text;

pub use session::{ROOM, Session, VERSION};
pub use text::Text;

/// The session of a module, for one caller at a time.
pub type Shared<M, const N: usize, const R: usize> = spin::Mutex<Session<M, N, R>>;

/// The one place of a module where its session is. It begins as zeros, which a module need not
/// carry along.
pub type Place<M, const N: usize, const R: usize> = spin::Once<Shared<M, N, R>>;

/// The one place of a module where numbers are read.
pub type Numbers = spin::Mutex<[f64; ROOM]>;

/// An empty place for numbers.
pub const fn no_numbers() -> Numbers {
    Numbers::new([0.0; ROOM])
}

/// The place for good: nobody else may have it.
pub fn taken(numbers: &'static Numbers) -> &'static mut [f64; ROOM] {
    spin::MutexGuard::leak(numbers.lock())
}

/// Exports a mechanism: its type, its coordinates, its constraint equations.
///
/// ```text
/// bricard_runtime::include_mechanism!("engine");
/// bricard_wasm::module!(engine::Engine<f64>, 3, 2);
/// ```
///
/// Names that are exported have to be unique in the whole program, which the compiler
/// can't see: that is why Rust calls them unsafe. A module has nothing but these.
#[macro_export]
macro_rules! module {
    ($mechanism:ty, $n:literal, $r:literal) => {
        static NUMBERS: $crate::Numbers = $crate::no_numbers();
        static SESSION: $crate::Place<$mechanism, $n, $r> = $crate::Place::new();

        fn session() -> &'static $crate::Shared<$mechanism, $n, $r> {
            SESSION.call_once(|| {
                let numbers = $crate::taken(&NUMBERS);
                $crate::Session::new(<$mechanism>::default(), numbers).into()
            })
        }

        $crate::export! {
            session:
            version() -> u32;
            numbers() -> *const f64;
            room() -> u32;
            text() -> *const u8;
            length() -> u32;
            describe() -> u32;
            parameter(index: u32) -> f64;
            set_parameter(index: u32, value: f64) -> u32;
            set_input(index: u32, value: f64) -> u32;
            free_input(index: u32) -> u32;
            begin(place: u32, value: f64, held: u32) -> u32;
            start(place: u32) -> u32;
            forget() -> u32;
            fixed(method: u32, step: f64) -> u32;
            adaptive(method: u32, relative: f64, absolute: f64) -> u32;
            settings(form: u32, way: u32, alpha: f64, beta: f64, bits: u32) -> u32;
            assemble() -> u32;
            run(until: f64, every: f64, columns: u32, again: u32) -> u32;
            rows() -> u32;
            unfinished() -> u32;
            width(columns: u32) -> u32;
            marks() -> u32;
            place(index: u32, value: f64) -> u32;
            advance(time: f64) -> u32;
            state() -> u32;
            outputs() -> u32;
            energy() -> u32;
            forces() -> u32;
            draw() -> u32;
        }

        #[cfg(target_os = "unknown")]
        #[panic_handler]
        fn panic(_: &core::panic::PanicInfo) -> ! {
            core::arch::wasm32::unreachable()
        }
    };
}

/// Exports methods of a session as functions.
#[doc(hidden)]
#[macro_export]
macro_rules! export {
    ($session:ident: $($name:ident($($argument:ident: $kind:ty),*) -> $result:ty;)*) => {
        $(
            #[unsafe(no_mangle)]
            extern "C" fn $name($($argument: $kind),*) -> $result {
                $session().lock().$name($($argument),*)
            }
        )*
    };
}
