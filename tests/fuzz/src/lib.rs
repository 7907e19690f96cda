//! In: what a fuzz target draws. Out: the checks that hold for every input. The modules under test are the crate's own,
//! included in place.
#![allow(dead_code, unused_imports)]

#[path = "../../../src/cga/mod.rs"]
pub mod cga;
#[path = "../../../src/diagnostics/mod.rs"]
pub mod diagnostics;
#[cfg(feature = "evaluate")]
#[path = "../../../src/geometry/mod.rs"]
pub mod geometry;
#[cfg(feature = "evaluate")]
#[path = "../../../src/interpreter/mod.rs"]
pub mod interpreter;
#[path = "../../../src/parsing/mod.rs"]
pub mod parsing;
#[path = "../../../src/source/mod.rs"]
pub mod source;

#[cfg(feature = "evaluate")]
pub mod evaluate;
#[cfg(feature = "evaluate")]
pub mod expression;
#[cfg(feature = "evaluate")]
pub mod program;
pub mod salad;
pub mod text;
