//! Mansard: a compiler for declarative city scenes.
//!
//! Each phase takes one type and gives another; a later type can only be made by its phase.
//!
//! | phase | module | takes | gives |
//! | --- | --- | --- | --- |
//! | Source | [`source`] | paths | [`source::SourceFile`] |
//! | Rules | [`cga`] | `SourceFile` | [`cga::program::Program`] |
//! | Map and elevation | [`geodata`] | files | [`geodata::feature::Feature`]s, [`geodata::terrain::Terrain`] |
//! | Derivation | [`interpreter`] | `Program` + start shape + seed | [`interpreter::tree::ShapeTree`] |
//! | Scene | [`scene`] | `ShapeTree`s + terrain | [`scene::Scene`] |
//! | Recipe | [`spec`] | `SourceFile` | [`spec::render_spec::RenderSpec`] |
//! | Plan | [`plan`] | `RenderSpec` + scene summary | [`plan::RenderPlan`] |
//! | Sensor | [`sensor`] | linear pixels | [`frame::Pixels`] |
//! | Truth | [`reference`] | [`plan::demand::ViewDemand`] + `Scene` | [`frame::Frame`] and its standard error |
//! | Render | [`gpu`] | `RenderPlan` + `Scene` | [`frame::Frame`] |
//! | Cost | [`cost`] | demands + `Scene` + both renderers | errors, times, the cheapest settings of a budget |
//! | Dataset | [`dataset`] | `Frame`s + labels | files |
//!
//! A module uses only what stands above it in this list; `tests/it/tidy.rs` holds us to it.

pub mod cga;
pub mod comparison;
pub mod cost;
pub mod dataset;
pub mod diagnostics;
pub mod frame;
pub mod geodata;
pub mod geometry;
pub mod gpu;
pub mod interpreter;
pub mod language_server;
pub mod live;
pub mod output;
pub mod parsing;
pub mod pipeline;
pub mod plan;
pub mod reference;
pub mod scene;
pub mod sensor;
pub mod source;
pub mod spec;
pub mod town;
pub mod window;
