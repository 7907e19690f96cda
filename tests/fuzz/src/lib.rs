//! In: what a fuzz target draws. Out: the checks that hold for every input. The modules under test are the crate's own,
//! included in place.
#![allow(dead_code, unused_imports)]

// The benchmark's files, included below, name the crate as its users do.
#[cfg(feature = "geometry")]
extern crate self as mansard;

#[path = "../../../src/cga/mod.rs"]
pub mod cga;
#[path = "../../../src/diagnostics/mod.rs"]
pub mod diagnostics;
#[cfg(feature = "geometry")]
#[path = "../../bench/geometry/classes.rs"]
pub mod classes;
#[cfg(feature = "geometry")]
#[path = "../../bench/geometry/double_area.rs"]
pub mod double_area;
#[cfg(feature = "geometry")]
#[path = "../../../src/geometry/mod.rs"]
pub mod geometry;
#[cfg(feature = "evaluate")]
#[path = "../../../src/interpreter/mod.rs"]
pub mod interpreter;
#[cfg(feature = "geometry")]
#[path = "../../bench/geometry/judge.rs"]
pub mod judge;
#[path = "../../../src/parsing/mod.rs"]
pub mod parsing;
#[cfg(feature = "geometry")]
#[path = "../../bench/geometry/plans.rs"]
pub mod plans;
#[cfg(feature = "geometry")]
#[path = "../../bench/geometry/random.rs"]
pub mod random;
#[path = "../../../src/source/mod.rs"]
pub mod source;

#[cfg(feature = "evaluate")]
pub mod evaluate;
#[cfg(feature = "evaluate")]
pub mod expression;
#[cfg(feature = "geometry")]
pub mod footprint;
#[cfg(feature = "geometry")]
pub mod footprint_checks;
#[cfg(feature = "evaluate")]
pub mod program;
pub mod salad;
pub mod text;
