//! What an expression sees while it is evaluated. In: the current shape and the slots of the running declaration.
//! Out: [`Env`], and random numbers keyed by shape and place.

use std::cell::Cell;

use glam::{DVec2, DVec3};

use super::seed::Seed;
use super::shape::Shape;
use super::value::Value;
use crate::cga::program::DrawSite;

/// A component a selector is asked about; groups and materials are asked about each of their faces.
#[derive(Clone, Copy, Debug)]
pub struct Facet {
    pub place: Place,
    /// World direction that orientation words judge (reference 3.5).
    pub direction: DVec3,
    pub is_border: bool,
    pub roof_edge: Option<RoofEdge>,
    /// Of face edges, where `uv` selectors ask for it.
    pub uv_side: Option<UvSide>,
}

/// A face edge in texture space.
#[derive(Clone, Copy, Debug)]
pub struct UvSide {
    /// Away from the face, as long as the edge.
    pub outward: DVec2,
    /// Both ends have the least or greatest coordinate of the geometry.
    pub u_min: bool,
    pub u_max: bool,
    pub v_min: bool,
    pub v_max: bool,
}

/// Where a component is in the mesh it was taken from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    Face(u32),
    /// By its vertices.
    Edge([u32; 2]),
    Vertex(u32),
}

/// Roof edges of reference 3.6.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoofEdge {
    Eave,
    Hip,
    Valley,
    Ridge,
}

/// The surroundings of an expression.
pub struct Env<'e> {
    pub shape: &'e Shape,
    /// Parameters and locals of the running rule, function or attribute.
    pub slots: &'e [Value],
    /// Tells apart evaluations of the same draw site on the same shape: the place in the rule, the calls above.
    salt: Seed,
    /// Function calls made so far from here.
    calls: Cell<u64>,
    /// Not empty: what the current component is made of, in `outer`.
    pub component: Option<&'e [Facet]>,
    /// What selectors without a component (such as `geometry.area(top)`) are judged from.
    pub outer: Option<&'e Shape>,
}

impl<'e> Env<'e> {
    pub fn new(shape: &'e Shape, slots: &'e [Value], place: u64) -> Self {
        Env { shape, slots, salt: Seed::root(place), calls: Cell::new(0), component: None, outer: None }
    }

    /// The same declaration on a component of the shape.
    pub fn on_component<'c>(&'c self, shape: &'c Shape, outer: &'c Shape, facets: &'c [Facet]) -> Env<'c> {
        let (salt, slots) = (self.salt, self.slots);
        Env { shape, slots, salt, calls: Cell::new(0), component: Some(facets), outer: Some(outer) }
    }

    /// The same declaration on another shape.
    pub fn on_shape<'c>(&'c self, shape: &'c Shape) -> Env<'c> {
        let (salt, slots) = (self.salt, self.slots);
        Env { shape, slots, salt, calls: Cell::new(0), component: self.component, outer: self.outer }
    }

    /// A function called from here, with its own slots.
    pub fn call<'c>(&'c self, slots: &'c [Value]) -> Env<'c> {
        let number = self.calls.replace(self.calls.get() + 1);
        self.elsewhere(slots, self.salt.part(number), 0)
    }

    /// The seed of this place on this shape.
    pub fn seed(&self) -> Seed {
        self.shape.seed.part(self.salt.bits())
    }

    /// A number in [0, 1), the same whenever this place is evaluated on this shape.
    pub fn draw(&self, site: Option<DrawSite>) -> f64 {
        self.seed().part(site.map_or(0, |s| u64::from(s.0))).unit()
    }

    /// The same place with other slots: for locals, which see those before them.
    pub fn with_slots<'c>(&'c self, slots: &'c [Value]) -> Env<'c> {
        let number = self.calls.replace(self.calls.get() + 1);
        self.elsewhere(slots, self.salt, number << 32)
    }

    fn elsewhere<'c>(&'c self, slots: &'c [Value], salt: Seed, calls: u64) -> Env<'c> {
        let (shape, component, outer) = (self.shape, self.component, self.outer);
        Env { shape, slots, salt, calls: Cell::new(calls), component, outer }
    }
}
