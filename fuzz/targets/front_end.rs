//! Any text is answered with a mechanism and its program, or with findings that have
//! places in the text.

#![no_main]

use bricard_codegen::internals::analyse;
use bricard_codegen::{CompileSettings, compile_source};
use libfuzzer_sys::fuzz_target;

/// Texts beyond this are slow, not new.
const LONGEST: usize = 4096;

fuzz_target!(|source: &str| {
    if source.len() > LONGEST {
        return;
    }
    let settings = CompileSettings::default();
    match analyse(source, &settings) {
        Err(errors) => {
            assert!(errors.error_count() > 0, "refused without a word");
            assert!(errors.render("fuzz.mech", source).contains("fuzz.mech:"));
        }
        Ok((mechanism, warnings)) => {
            warnings.render("fuzz.mech", source);
            // Generation of a large mechanism takes long, which is no finding.
            if mechanism.coordinates.len() <= 4 && source.len() < 600 {
                let first = compile_source(source, "fuzz", "fuzz.mech", &settings);
                let again = compile_source(source, "fuzz", "fuzz.mech", &settings);
                match (first, again) {
                    (Ok(first), Ok(again)) => assert_eq!(first.code, again.code),
                    (Err(_), Err(_)) => {}
                    _ => panic!("the same text was accepted and refused"),
                }
            }
        }
    }
    // Texts that were read are kept for the places in them; here that would be for ever.
    proc_macro2::extra::invalidate_current_thread_spans();
});
