//! The shape a rule works on. In: a start mesh, or another shape. Out: [`Shape`], cheap to copy: geometry, material
//! and attributes are shared until changed.
//!
//! Geometry is kept in world coordinates of the moment it was made, together with the scope it was made in (its
//! *binding*). Moving, turning or scaling changes only the scope; the world positions follow when they are asked for
//! ([`Shape::bake`]). A shape that was never transformed therefore keeps its coordinates bit for bit, and a size of 0
//! flattens without destroying (reference 3.2).

use std::borrow::Cow;
use std::rc::Rc;
use std::sync::Arc;

use glam::{DMat3, DVec3};
use smallvec::SmallVec;

use super::appearance::Appearance;
use super::context::Trail;
use super::form::Form;
use super::placement::{Frame, euler};
use super::projection::Projection;
use super::seed::Seed;
use super::trim_planes::TrimSource;
use super::value::Value;

/// An oriented box: sizes may be 0 (flat) or negative (mirrored).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scope {
    pub frame: Frame,
    pub size: DVec3,
}

/// The component split that made a shape or an ancestor (reference 5.2), the same for all pieces of one selector.
#[derive(Clone, Debug)]
pub struct CompSplit {
    pub selector: Arc<str>,
    pub total: f64,
}

impl CompSplit {
    /// To be shared by the pieces of one selector.
    pub fn shared(selector: &Arc<str>, total: usize) -> Option<Rc<CompSplit>> {
        Some(Rc::new(CompSplit { selector: selector.clone(), total: total as f64 }))
    }
}

/// What few operations change: shared by a shape and its descendants until then.
#[derive(Clone, Debug)]
pub struct State {
    pub appearance: Arc<Appearance>,
    /// One per uv set that was set up, sorted by set.
    pub projections: SmallVec<[(u8, Projection); 1]>,
    /// Current values of the program's attributes and constants, by id.
    pub attributes: Arc<Vec<Value>>,
    /// The number `set(seedian, …)` gave, for reading it back.
    pub seedian: Option<f64>,
    pub trim_horizontal: bool,
    pub trim_vertical: bool,
}

#[derive(Clone, Debug)]
pub struct Shape {
    pub form: Arc<Form>,
    /// The scope in which `form` has its stored positions.
    pub binding: Scope,
    pub scope: Scope,
    pub pivot: Frame,
    pub state: Rc<State>,
    /// `None` before the first component split.
    pub comp: Option<Rc<CompSplit>>,
    /// Number in the last component split; -1 before the first.
    pub comp_index: i32,
    /// Number in the last scope split, -1 before the first, and how many pieces it made.
    pub split_index: i32,
    pub split_total: u32,
    pub seed: Seed,
    /// The shapes it was made from, kept only where a query may ask.
    pub trail: Option<Arc<Trail>>,
    pub trim_source: Option<Rc<TrimSource>>,
    /// Sources of the form's vertices while a shape is recomposed.
    pub provenance: Option<Arc<[u32]>>,
}

/// Extents below this share of the largest one, plus the noise of the coordinates, are flat.
const FLAT: f64 = 1e-7;
const COORDINATE_NOISE: f64 = 1e-11;

impl Scope {
    /// The smallest box with these axes around the points; `None` without points. Extents within rounding are 0.
    pub fn around(points: &[DVec3], axes: DMat3) -> Option<Scope> {
        let to_axes = axes.transpose();
        let first = to_axes * *points.first()?;
        let (mut lo, mut hi) = (first, first);
        for &p in &points[1..] {
            let q = to_axes * p;
            lo = lo.min(q);
            hi = hi.max(q);
        }
        let mut size = hi - lo;
        let noise = FLAT * size.max_element() + COORDINATE_NOISE * lo.abs().max(hi.abs()).max_element();
        for i in 0..3 {
            if size[i] <= noise {
                size[i] = 0.0;
                lo[i] = (lo[i] + hi[i]) / 2.0;
            }
        }
        Some(Scope { frame: Frame { origin: axes * lo, axes }, size })
    }

    pub fn center(&self) -> DVec3 {
        self.frame.world_from_local(self.size / 2.0)
    }
}

impl Shape {
    /// The state of this shape alone, to change.
    pub fn state_mut(&mut self) -> &mut State {
        Rc::make_mut(&mut self.state)
    }

    /// Translation of the scope in pivot coordinates.
    pub fn translation(&self) -> DVec3 {
        self.pivot.local_from_world(self.scope.frame.origin)
    }

    /// Rotation of the scope in pivot coordinates, degrees.
    pub fn rotation(&self) -> DVec3 {
        euler(&(self.pivot.axes.transpose() * self.scope.frame.axes))
    }

    /// World position of a stored position.
    fn moved(&self, p: DVec3) -> DVec3 {
        let q = self.binding.frame.local_from_world(p);
        self.scope.frame.world_from_local(q * self.growth())
    }

    /// Factors from the stored sizes to those of now.
    fn growth(&self) -> DVec3 {
        let factor = |now: f64, then: f64| if then == 0.0 || now == then { 1.0 } else { now / then };
        DVec3::new(
            factor(self.scope.size.x, self.binding.size.x),
            factor(self.scope.size.y, self.binding.size.y),
            factor(self.scope.size.z, self.binding.size.z),
        )
    }

    /// The form with world positions, without changing the shape.
    pub fn world_form(&self) -> Arc<Form> {
        if self.binding == self.scope {
            return self.form.clone();
        }
        let mut form = (*self.form).clone();
        form.mesh.positions.iter_mut().for_each(|p| *p = self.moved(*p));
        let turn = self.scope.frame.axes * self.binding.frame.axes.transpose();
        form.normals.iter_mut().for_each(|n| *n = turn * *n);
        let stretch = DMat3::from_diagonal(self.growth());
        form.turn_corner_normals(self.scope.frame.axes * stretch * self.binding.frame.axes.transpose());
        Arc::new(form)
    }

    /// Makes the stored positions the world positions.
    pub fn bake(&mut self) -> &Arc<Form> {
        if self.binding != self.scope {
            self.form = self.world_form();
            self.binding = self.scope;
        }
        &self.form
    }

    /// Replaces the geometry by one in world positions and fits the scope to it, keeping axes and pivot
    /// ("fit scope", reference 4.0.2). Empty geometry leaves a scope of size 0 where it was.
    pub fn replace(&mut self, form: Form) {
        let axes = self.scope.frame.axes;
        self.replace_along(form, axes);
    }

    /// As [`Shape::replace`], with new scope axes.
    pub fn replace_along(&mut self, form: Form, axes: DMat3) {
        let origin = self.scope.frame.origin;
        let empty = Scope { frame: Frame { origin, axes }, size: DVec3::ZERO };
        self.scope = Scope::around(&form.mesh.positions, axes).unwrap_or(empty);
        self.form = Arc::new(form);
        self.binding = self.scope;
    }

    /// Replaces the geometry by one in world positions and leaves the scope as it is.
    pub fn replace_in_scope(&mut self, form: Form) {
        self.form = Arc::new(form);
        self.binding = self.scope;
    }

    /// Gives the scope new axes around the same geometry; without geometry only the box turns about its origin.
    pub fn turn_scope(&mut self, axes: DMat3) {
        self.bake();
        let here = Scope { frame: Frame { origin: self.scope.frame.origin, axes }, size: self.scope.size };
        self.scope = Scope::around(&self.form.mesh.positions, axes).unwrap_or(here);
        self.binding = self.scope;
    }

    /// The shape with world positions: itself where they are that already.
    pub fn baked(&self) -> Cow<'_, Shape> {
        if self.binding == self.scope {
            return Cow::Borrowed(self);
        }
        let mut baked = self.clone();
        baked.bake();
        Cow::Owned(baked)
    }

    /// What a part of this one begins as: geometry of its own, in world positions, in a scope of its own.
    pub fn piece(&self, form: Form, scope: Scope) -> Box<Shape> {
        Box::new(Shape {
            form: Arc::new(form),
            binding: scope,
            scope,
            pivot: self.pivot,
            state: self.state.clone(),
            comp: self.comp.clone(),
            comp_index: self.comp_index,
            split_index: self.split_index,
            split_total: self.split_total,
            seed: self.seed,
            trail: self.trail.clone(),
            trim_source: self.trim_source.clone(),
            provenance: self.provenance.clone(),
        })
    }

    /// Puts the pivot on the scope: translation and rotation become 0.
    pub fn pivot_to_scope(&mut self) {
        self.pivot = self.scope.frame;
    }
}
