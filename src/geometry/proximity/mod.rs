//! How shapes lie to each other. In: closed meshes, and faces, edges or points. Out: what is inside, outside or in
//! contact; distances of boxes.
//!
//! A face is compared with two sections of the solid, [`TOLERANCE`] in front of its plane and behind it: what lies in
//! both sections is inside, what lies in neither is outside, and what is left touches the surface. Pieces not wider
//! than the tolerance on the mean do not count, so rounding never decides.

mod boxes;
mod section;
#[cfg(test)]
mod tests;

pub use boxes::OrientedBox;

use glam::{DVec2, DVec3};
use i_overlay::core::overlay_rule::OverlayRule;

use super::boolean::engine::{GridRing, GridShape, overlay};
use super::box_tree::{Bounds, BoxTree};
use super::grid::Grid;
use super::mesh_checks::is_closed;
use super::polygon::signed_area;
use super::triangulate::triangulate_face;
use super::{Face, Mesh, PlaneFrame, Ring};

/// Shapes nearer than this touch, metres.
pub const TOLERANCE: f64 = 1e-3;
/// Planes that turn by less than this are parallel (sine of the angle).
const PARALLEL: f64 = 1e-3;

/// A closed mesh prepared for many questions.
#[derive(Clone, Debug)]
pub struct Solid {
    mesh: Mesh,
    triangles: Vec<[u32; 3]>,
    faces: BoxTree,
    bounds: Bounds,
}

/// What the parts of a face do; several may be true.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Meeting {
    /// Some of it lies inside the solid.
    pub inside: bool,
    /// Some of it lies outside.
    pub outside: bool,
    /// Some of it lies on a face that looks the same way.
    pub same: bool,
    /// Some of it lies on a face that looks the other way.
    pub opposite: bool,
}

/// Where a point is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    Inside,
    Surface,
    Outside,
}

impl Solid {
    /// `None` unless the mesh is closed; vertices at one place count as one.
    pub fn new(mesh: &Mesh) -> Option<Solid> {
        let mesh = mesh.welded();
        if !is_closed(&mesh) {
            return None;
        }
        let bounds = Bounds::around(mesh.positions.iter().copied())?;
        let corners = |face: &Face| face.corners().collect::<Vec<u32>>();
        let triangles_of = |face: &Face| {
            let corners = corners(face);
            triangulate_face(&mesh, face).into_iter().map(move |t| t.map(|c| corners[c as usize])).collect::<Vec<_>>()
        };
        let triangles = mesh.faces.iter().flat_map(triangles_of).collect();
        let faces = BoxTree::of_faces(&mesh, TOLERANCE);
        Some(Solid { mesh, triangles, faces, bounds })
    }

    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// How a face of any mesh lies to this solid. Faces that are not flat are taken as their triangles.
    pub fn meeting(&self, mesh: &Mesh, face: &Face) -> Meeting {
        let Some(frame) = PlaneFrame::of_face(mesh, face) else { return Meeting::default() };
        let height = |v: u32| (mesh.positions[v as usize] - frame.origin).dot(frame.normal).abs();
        if face.outer.len() > 3 && face.corners().any(|v| height(v) > TOLERANCE) {
            let corners: Vec<u32> = face.corners().collect();
            let triangles = triangulate_face(mesh, face).into_iter();
            let each = triangles.map(|t| self.meeting(mesh, &Face::new(t.map(|c| corners[c as usize]).to_vec())));
            return each.fold(Meeting::default(), Meeting::or);
        }
        let near = Bounds::of_face(mesh, face).map(|b| b.grown(TOLERANCE)).filter(|b| b.touches(&self.bounds));
        let Some(near) = near else { return Meeting { outside: true, ..Meeting::default() } };
        let ring = |l: &[u32]| -> Ring { l.iter().map(|&v| frame.to_plan(mesh.positions[v as usize])).collect() };
        let own: Vec<Ring> = face.loops().map(ring).collect();
        let front = section::section(&self.mesh.positions, &self.triangles, &frame, TOLERANCE);
        let behind = section::section(&self.mesh.positions, &self.triangles, &frame, -TOLERANCE);
        let corners = self.bounds.corners().map(|p| frame.to_plan(p));
        let Some(sheet) = Sheet::over(own.iter().flatten().copied().chain(corners)) else { return Meeting::default() };
        let (own, front, behind) = (sheet.snap(&own), sheet.snap(&front), sheet.snap(&behind));
        let both = |rule| {
            let first: Vec<GridRing> = combined(&own, &front, rule).into_iter().flatten().collect();
            sheet.any_wide(&combined(&first, &behind, rule))
        };
        let mut out = Meeting {
            inside: both(OverlayRule::Intersect),
            outside: both(OverlayRule::Difference),
            ..Meeting::default()
        };
        for other in self.faces.touching(&near) {
            self.contact(&self.mesh.faces[other], &frame, &sheet, &own, &mut out);
        }
        out
    }

    /// Notes whether a face of the solid lies in the plane of the frame and covers some of `own`.
    fn contact(&self, other: &Face, frame: &PlaneFrame, sheet: &Sheet, own: &[GridRing], out: &mut Meeting) {
        let normal = self.mesh.normal(other);
        let point = |v: u32| self.mesh.positions[v as usize];
        let off = |v: u32| (point(v) - frame.origin).dot(frame.normal).abs() > TOLERANCE;
        if normal == DVec3::ZERO || normal.cross(frame.normal).length() > PARALLEL || other.corners().any(off) {
            return;
        }
        let rings: Vec<Ring> = other.loops().map(|l| l.iter().map(|&v| frame.to_plan(point(v))).collect()).collect();
        if sheet.any_wide(&combined(own, &sheet.snap(&rings), OverlayRule::Intersect)) {
            if normal.dot(frame.normal) > 0.0 { out.same = true } else { out.opposite = true }
        }
    }

    /// Where a point is: by its distance from the faces, then by the winding number, summed from solid angles
    /// (van Oosterom and Strackee 1983, equation 8).
    pub fn locate(&self, p: DVec3) -> Location {
        if self.bounds.distance(p) > TOLERANCE {
            return Location::Outside;
        }
        let corners = |t: &[u32; 3]| t.map(|v| self.mesh.positions[v as usize] - p);
        if self.triangles.iter().map(corners).any(|t| distance_from_origin(t) <= TOLERANCE) {
            return Location::Surface;
        }
        let angle = |[a, b, c]: [DVec3; 3]| {
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * libm::atan2(a.dot(b.cross(c)), below)
        };
        let turns = self.triangles.iter().map(corners).map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI);
        if turns.abs() > 0.5 { Location::Inside } else { Location::Outside }
    }

    /// Where the parts of a line are, as far as it meets the solid's faces.
    pub fn locations(&self, a: DVec3, b: DVec3) -> Vec<Location> {
        let mut cuts = vec![0.0, 1.0];
        for t in &self.triangles {
            let [p, q, r] = t.map(|v| self.mesh.positions[v as usize]);
            let normal = (q - p).cross(r - p);
            let (da, db) = ((a - p).dot(normal), (b - p).dot(normal));
            if (da > 0.0) != (db > 0.0) {
                cuts.push(da / (da - db));
            }
        }
        cuts.sort_by(f64::total_cmp);
        let long = |w: &&[f64]| (w[1] - w[0]) * a.distance(b) > TOLERANCE;
        cuts.windows(2).filter(long).map(|w| self.locate(a.lerp(b, (w[0] + w[1]) / 2.0))).collect()
    }
}

impl Meeting {
    pub fn or(self, other: Meeting) -> Meeting {
        Meeting {
            inside: self.inside || other.inside,
            outside: self.outside || other.outside,
            same: self.same || other.same,
            opposite: self.opposite || other.opposite,
        }
    }
}

/// A plane on the integer grid of the polygon engine.
struct Sheet {
    grid: Grid,
}

impl Sheet {
    /// `None` where the points have no extent.
    fn over(mut points: impl Iterator<Item = DVec2>) -> Option<Sheet> {
        let first = points.next()?;
        let (lo, hi) = points.fold((first, first), |(lo, hi), p| (lo.min(p), hi.max(p)));
        Some(Sheet { grid: Grid::over(lo, hi)? })
    }

    fn snap(&self, rings: &[Ring]) -> Vec<GridRing> {
        rings.iter().map(|ring| ring.iter().map(|&p| self.grid.snap(p)).collect()).collect()
    }

    /// Whether one of the shapes is wider than the tolerance on the mean.
    fn any_wide(&self, shapes: &[GridShape]) -> bool {
        let plan = |ring: &GridRing| -> Ring { ring.iter().map(|p| DVec2::new(p[0] as f64, p[1] as f64)).collect() };
        let girth = |ring: &Ring| (0..ring.len()).map(|i| ring[i].distance(ring[(i + 1) % ring.len()])).sum::<f64>();
        shapes.iter().any(|shape| {
            let rings: Vec<Ring> = shape.iter().map(plan).collect();
            // Outlines run counter-clockwise, holes clockwise.
            let area: f64 = rings.iter().map(|r| signed_area(r)).sum();
            area * self.grid.step > TOLERANCE * rings.iter().map(girth).sum::<f64>() / 2.0
        })
    }
}

/// Nothing where the engine fails.
fn combined(a: &[GridRing], b: &[GridRing], rule: OverlayRule) -> Vec<GridShape> {
    overlay(a, b, rule).unwrap_or_default()
}

/// Distance of a triangle from the origin: of its plane where the foot lies in it, else of its nearest edge.
fn distance_from_origin([a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let within = |p: DVec3, q: DVec3| (q - p).cross(-p).dot(normal) >= 0.0;
    if normal != DVec3::ZERO && within(a, b) && within(b, c) && within(c, a) {
        return (a.dot(normal) / normal.length()).abs();
    }
    [(a, b), (b, c), (c, a)]
        .map(|(p, q)| boxes::nearest_on_line(DVec3::ZERO, p, q).length())
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}
