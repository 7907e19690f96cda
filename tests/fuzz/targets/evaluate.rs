//! Programs made from bytes are compiled and derived.
#![no_main]

use arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;
use mansard_fuzz::evaluate::evaluate;
use mansard_fuzz::program::program;

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    if let Ok(program) = program(&mut bytes) {
        if std::env::var_os("SHOW_PROGRAM").is_some() {
            eprintln!("{program}");
        }
        let _ = evaluate(&program, &mut bytes);
    }
});
