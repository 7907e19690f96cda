//! Plan: what the recipe demands → which passes run, in which order, over which resources. No GPU here.

pub mod demand;
