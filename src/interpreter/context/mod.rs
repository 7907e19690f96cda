//! What shapes know of each other (reference 6.8). In: first derivations. Out: [`Survey`]s of the shapes they made, and
//! [`Surroundings`] that answer the queries of second derivations.
//!
//! Two passes: a first derivation answers every query with its default and notes labelled shapes and occluders; a second
//! one is answered from the first. What others see of a start shape is always its first derivation, so nothing depends
//! on the order in which start shapes are derived.

mod batch;
mod record;

use std::sync::{Arc, OnceLock};

pub use batch::{Batch, Member, Worlds};
pub use record::{Context, Trail};

use super::form::Form;
use super::seed::Seed;
use super::shape::Scope;
use crate::geometry::box_tree::{Bounds, BoxTree};
use crate::geometry::proximity::{OrientedBox, Solid};

/// A shape of a first derivation.
#[derive(Debug)]
pub struct ContextShape {
    /// `None` for one that was not labelled.
    pub label: Option<Arc<str>>,
    /// The shapes it was made from, then itself, as seeds, from the root.
    pub trail: Box<[Seed]>,
    pub scope: Scope,
    /// In world coordinates.
    pub form: Arc<Form>,
    solid: OnceLock<Option<Box<Solid>>>,
}

impl ContextShape {
    /// The closed geometry; `None` for anything else, which occludes nothing.
    pub fn solid(&self) -> Option<&Solid> {
        self.solid.get_or_init(|| Solid::new(&self.form.mesh).map(Box::new)).as_deref()
    }

    /// Whether one was made from the other.
    pub fn is_related(&self, trail: &[Seed]) -> bool {
        self.trail.iter().zip(trail).all(|(a, b)| a == b)
    }
}

/// The shapes of one start shape that queries may meet.
#[derive(Debug, Default)]
pub struct Survey {
    shapes: Vec<ContextShape>,
    boxes: BoxTree,
}

impl Survey {
    fn new(shapes: Vec<ContextShape>) -> Survey {
        let nowhere = Bounds { lo: glam::DVec3::INFINITY, hi: glam::DVec3::NEG_INFINITY };
        let bounds = |s: &ContextShape| Bounds::around(s.form.mesh.positions.iter().copied()).unwrap_or(nowhere);
        let boxes = BoxTree::new(shapes.iter().map(bounds).collect());
        Survey { shapes, boxes }
    }

    /// Shapes whose boxes touch this one.
    pub fn touching<'a>(&'a self, bounds: &Bounds) -> impl Iterator<Item = &'a ContextShape> {
        self.boxes.touching(bounds).into_iter().map(|i| &self.shapes[i])
    }

    pub fn labelled<'a>(&'a self, label: &'a str) -> impl Iterator<Item = &'a ContextShape> {
        self.shapes.iter().filter(move |s| s.label.as_deref() == Some(label))
    }
}

/// What the queries of one start shape are answered from.
#[derive(Clone, Debug, Default)]
pub struct Surroundings<'a> {
    /// Its own first derivation.
    pub own: Option<&'a Survey>,
    /// First derivations of start shapes within reach of occlusion queries.
    pub near: Vec<&'a Survey>,
    /// Those of all others that have labels.
    pub labelled: Vec<&'a Survey>,
}

/// The box of a scope.
pub fn scope_box(scope: &Scope) -> OrientedBox {
    OrientedBox { origin: scope.frame.origin, axes: scope.frame.axes, size: scope.size }
}
