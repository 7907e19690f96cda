//! Tracer: a scene in a hierarchy of boxes. In: rays. Out: the nearest face, or whether the way is free.

use glam::DVec3;
use smallvec::SmallVec;

use super::ReferenceError;
use super::hierarchy::Hierarchy;
use super::ray::{Crossing, Ray};
use super::surface::{self, Face, Point, Surfaces};
use crate::plan::summary::{ObjectSummary, summarize};
use crate::scene::Scene;

/// Faces whose distances differ by less than this share lie in one place: the uppermost layer is seen.
const TIE: f64 = 1e-12;

/// A scene ready for rays: both states once, in f64 about its least corner.
pub struct Tracer {
    hierarchy: Hierarchy,
    faces: Vec<Face>,
    surfaces: Surfaces,
    origin: DVec3,
    /// Bound on the error of a point of a surface, metres: how near a face may be to the plane of the one a ray
    /// leaves before it counts as touching it.
    touching: f64,
    /// Labels of the scene's objects.
    pub(super) objects: Vec<ObjectSummary>,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    face: usize,
    pub crossing: Crossing,
}

impl Tracer {
    /// Fails on a number that is not finite.
    pub fn new(scene: &Scene) -> Result<Tracer, ReferenceError> {
        let corners = scene.objects.iter().flat_map(|o| &o.mesh.positions);
        let origin = corners.copied().filter(|p| p.is_finite()).reduce(DVec3::min).unwrap_or(DVec3::ZERO);
        let (triangles, faces) = surface::faces(scene, origin)?;
        let (hierarchy, order) = Hierarchy::new(&triangles);
        let faces = order.iter().map(|&i| faces[i as usize]).collect();
        let extent = if triangles.is_empty() { 0.0 } else { hierarchy.extent([0.0; 3]) };
        let (surfaces, objects) = (Surfaces::new(scene), summarize(scene));
        Ok(Tracer { hierarchy, faces, surfaces, origin, touching: 64.0 * f64::EPSILON * extent, objects })
    }

    pub fn triangles(&self) -> usize {
        self.faces.len()
    }

    /// A ray from a point of the world.
    pub(super) fn ray(&self, (from, direction): (DVec3, DVec3)) -> Ray {
        let from = (from - self.origin).to_array();
        Ray::new(from, direction.to_array(), self.hierarchy.extent(from))
    }

    /// The nearest face from `near` on. Of faces in one place the uppermost layer wins, whatever the walk's order.
    pub(super) fn nearest(&self, ray: &Ray, near: f64, shown: &[bool]) -> Option<Hit> {
        let mut hits: SmallVec<[Hit; 8]> = SmallVec::new();
        self.hierarchy.walk(ray, near, f64::INFINITY, |face, triangle, far| {
            match ray.crosses(triangle).filter(|c| c.t >= near && c.t <= far) {
                Some(crossing) if self.is_there(face, &crossing, shown) => {
                    hits.push(Hit { face, crossing });
                    far.min(crossing.t + crossing.t.abs() * TIE)
                }
                _ => far,
            }
        });
        let first = hits.iter().map(|hit| hit.crossing.t).fold(f64::INFINITY, f64::min);
        let in_first_place = hits.into_iter().filter(|hit| hit.crossing.t <= first + first.abs() * TIE);
        in_first_place.min_by_key(|hit| self.surfaces.rank(&self.faces[hit.face]))
    }

    fn is_there(&self, face: usize, crossing: &Crossing, shown: &[bool]) -> bool {
        let face = &self.faces[face];
        shown[face.object as usize] && !self.surfaces.is_hole(face, crossing.weights)
    }

    /// A place about the tracer's origin, in the world.
    pub(super) fn in_world(&self, place: DVec3) -> DVec3 {
        place + self.origin
    }

    pub(super) fn object(&self, hit: &Hit) -> usize {
        self.faces[hit.face].object as usize
    }

    /// Position and normals are about the tracer's origin.
    pub(super) fn point(&self, hit: &Hit, ray: &Ray) -> Point {
        let direction = DVec3::from_array(ray.direction);
        let triangle = &self.hierarchy.triangles[hit.face];
        self.surfaces.point(&self.faces[hit.face], triangle, &hit.crossing, direction)
    }

    /// Whether nothing is in the way from a point in a direction of unit length.
    ///
    /// Rays begin at the point itself, without an offset. What they meet within the rounding error of the plane that
    /// they leave is that plane (itself or a neighbour in it); everything farther hides, so shadows begin at the
    /// caster's foot within 10⁻¹⁰ m for scenes of some kilometres.
    pub(super) fn sees(&self, point: &Point, towards: DVec3, shown: &[bool]) -> bool {
        let leaving = point.face_normal.dot(towards);
        if leaving <= 0.0 {
            return false;
        }
        let from = point.position.to_array();
        let ray = Ray::new(from, towards.to_array(), self.hierarchy.extent(from));
        let near = self.touching / leaving;
        let mut free = true;
        self.hierarchy.walk(&ray, near, f64::INFINITY, |face, triangle, far| {
            let hides = |c: &Crossing| c.t > near && self.is_there(face, c, shown);
            if ray.crosses(triangle).filter(hides).is_some() {
                free = false;
                return f64::NEG_INFINITY;
            }
            far
        });
        free
    }
}
