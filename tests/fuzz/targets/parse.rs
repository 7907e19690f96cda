//! Any bytes are parsed and formatted.
#![no_main]

use libfuzzer_sys::fuzz_target;
use mansard_fuzz::text::{LONGEST, parse_and_format};

fuzz_target!(|bytes: &[u8]| {
    if bytes.len() <= LONGEST {
        parse_and_format(bytes);
    }
});
