//! An engine as a WebAssembly module.
#![no_std]

bricard_runtime::include_mechanism!("engine");
bricard_wasm::module!(engine::Engine<f64>, 3, 2);
