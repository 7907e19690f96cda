//! Report: a sweep → `cost.csv`, plots, and one page that needs nothing else.

pub mod page;
pub mod picture;
pub mod plot;
pub mod table;
pub mod words;
