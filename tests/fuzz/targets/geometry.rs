//! Footprints made from bytes are repaired, roofed, offset and checked.
#![no_main]

use arbitrary::Unstructured;
use libfuzzer_sys::fuzz_target;
use mansard_fuzz::footprint::rings;
use mansard_fuzz::footprint_checks::check;

fuzz_target!(|bytes: &[u8]| {
    let mut bytes = Unstructured::new(bytes);
    if let Ok(rings) = rings(&mut bytes) {
        let _ = check(&rings, &mut bytes);
    }
});
