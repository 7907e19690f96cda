//! Any bytes, and any salad of the language's words, are compiled.
#![no_main]

use arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;
use mansard_fuzz::salad;
use mansard_fuzz::text::{LONGEST, check};

fuzz_target!(|bytes: &[u8]| {
    if bytes.len() > LONGEST {
        return;
    }
    // Salads begin with a byte that no text begins with.
    match bytes.split_first() {
        Some((0x01, rest)) => {
            if let Ok(text) = salad::text(&mut Unstructured::new(rest)) {
                check(&text);
            }
        }
        _ => check(&String::from_utf8_lossy(bytes)),
    }
});
