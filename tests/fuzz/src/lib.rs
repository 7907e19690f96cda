//! In: what a fuzz target draws. Out: the checks that hold for every input. The modules under test are the crate's own,
//! included in place.
#![allow(dead_code, unused_imports)]

#[path = "../../../src/cga/mod.rs"]
pub mod cga;
#[path = "../../../src/diagnostics/mod.rs"]
pub mod diagnostics;
#[path = "../../../src/geometry/mod.rs"]
pub mod geometry;
#[path = "../../../src/interpreter/mod.rs"]
pub mod interpreter;
#[path = "../../../src/parsing/mod.rs"]
pub mod parsing;
#[path = "../../../src/source/mod.rs"]
pub mod source;

pub mod evaluate;
pub mod expression;
pub mod program;
pub mod salad;
pub mod text;
