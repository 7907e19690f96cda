//! Cost: what accuracy costs in time. In: a scene, what its views ask for, a renderer. Out: errors against the reference
//! and times of every setting ([`sweep`]), the cheapest settings that keep an error budget ([`budget`]), and a table,
//! plots and a page that say so ([`report`]).

pub mod bench;
pub mod budget;
pub mod errors;
pub mod knobs;
pub mod metrics;
pub mod pareto;
pub mod probe;
pub mod report;
pub mod sweep;
pub mod window;
pub mod work;

#[cfg(test)]
mod tests;
