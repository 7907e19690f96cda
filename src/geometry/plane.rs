//! Planes and plane frames. In: points and normals in space. Out: signed distances, and a face seen as a plan polygon.

use glam::{DVec2, DVec3};

use super::mesh::Loop;
use super::{Face, Mesh, Polygon};

/// The vector at length 1, exact if it lies along an axis; `None` if it has no direction (zero or not finite).
pub fn unit(v: DVec3) -> Option<DVec3> {
    let length = v.length();
    (length > 0.0 && length.is_finite()).then(|| v / length)
}

/// The plane `normal . p = offset`; `normal` has length 1 and points to the front. Metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    pub normal: DVec3,
    pub offset: f64,
}

impl Plane {
    /// `None` if the normal has no direction (zero or not finite).
    pub fn through(point: DVec3, normal: DVec3) -> Option<Plane> {
        let normal = unit(normal)?;
        Some(Plane { normal, offset: normal.dot(point) })
    }

    /// Metres in front of the plane, negative behind it.
    pub fn signed_distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p) - self.offset
    }

    pub fn flipped(&self) -> Plane {
        Plane { normal: -self.normal, offset: -self.offset }
    }
}

/// Below this slope a plane has no direction of its own: `u` goes east.
const LEVEL: f64 = 1e-6;

/// A right-handed orthonormal frame `u`, `v`, `normal` at `origin`: plan coordinates of a plane in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneFrame {
    pub origin: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub normal: DVec3,
}

impl PlaneFrame {
    /// The ground plan: (x, y) of the plan is (x, -z) of the world, so coordinates pass through unchanged.
    pub const PLAN: PlaneFrame = PlaneFrame { origin: DVec3::ZERO, u: DVec3::X, v: DVec3::NEG_Z, normal: DVec3::Y };

    /// Origin at corner 0 of the face. A level face has `u` = +x exactly (so no coordinate is rotated), any other
    /// has `u` level and `v` rising: (along, up) on a wall. `None` if the face has no area.
    pub fn of_face(mesh: &Mesh, face: &Face) -> Option<PlaneFrame> {
        let origin = mesh.positions[*face.outer.first()? as usize];
        let normal = unit(mesh.newell(face))?;
        Some(PlaneFrame::of_plane(&Plane { normal, offset: normal.dot(origin) }, origin))
    }

    /// Origin at corner 0, `u` along the first edge, `v` in the plane to the inside: the axes of a component face
    /// (compatibility notes, "Scope of a component face"). `None` if the face or its first edge has no extent.
    pub fn along_first_edge(mesh: &Mesh, face: &Face) -> Option<PlaneFrame> {
        let (&a, &b) = (face.outer.first()?, face.outer.get(1)?);
        let origin = mesh.positions[a as usize];
        let normal = unit(mesh.newell(face))?;
        let edge = mesh.positions[b as usize] - origin;
        let u = unit(edge - normal * normal.dot(edge))?;
        Some(PlaneFrame { origin, u, v: normal.cross(u), normal })
    }

    /// A frame of a plane at a given origin: `u` = +x if the plane is level (exactly, if it is exactly level), else `u` level and `v` rising.
    pub fn of_plane(plane: &Plane, origin: DVec3) -> PlaneFrame {
        let normal = plane.normal;
        let level = normal.x.abs().max(normal.z.abs()) < LEVEL;
        let u = if level { DVec3::X - normal * normal.x } else { DVec3::new(normal.z, 0.0, -normal.x) };
        let u = unit(u).unwrap_or(DVec3::X);
        PlaneFrame { origin, u, v: normal.cross(u), normal }
    }

    /// Plan coordinates of the foot of the perpendicular from `p`.
    pub fn to_plan(&self, p: DVec3) -> DVec2 {
        let d = p - self.origin;
        DVec2::new(d.dot(self.u), d.dot(self.v))
    }

    /// The point `height` metres in front of the plane above plan point `q`.
    pub fn to_space(&self, q: DVec2, height: f64) -> DVec3 {
        self.origin + self.u * q.x + self.v * q.y + self.normal * height
    }

    pub fn plane(&self) -> Plane {
        Plane { normal: self.normal, offset: self.normal.dot(self.origin) }
    }

    /// The face's loops in plan coordinates; the outer ring is counter-clockwise if this is the face's own frame.
    pub fn face_to_plan(&self, mesh: &Mesh, face: &Face) -> Polygon {
        let ring = |l: &[u32]| l.iter().map(|&i| self.to_plan(mesh.positions[i as usize])).collect();
        Polygon { outer: ring(&face.outer), holes: face.holes.iter().map(|h| ring(h)).collect() }
    }

    /// Appends a plan polygon as one face at `height` in front of the plane; vertices are the rings in order.
    pub fn push_face(&self, mesh: &mut Mesh, polygon: &Polygon, height: f64) {
        let mut add = |ring: &[DVec2]| -> Loop {
            let start = mesh.positions.len() as u32;
            mesh.positions.extend(ring.iter().map(|&q| self.to_space(q, height)));
            (start..start + ring.len() as u32).collect()
        };
        let outer = add(&polygon.outer);
        let holes = polygon.holes.iter().map(|h| add(h)).collect();
        mesh.faces.push(Face { outer, holes, ..Face::default() });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axis_directions_stay_exact() {
        for a in [3.0, 0.1, 1e-9, 7.7e12] {
            assert_eq!(unit(DVec3::new(0.0, a, 0.0)), Some(DVec3::Y));
            assert_eq!(unit(DVec3::new(-a, 0.0, 0.0)), Some(DVec3::NEG_X));
        }
        assert_eq!(unit(DVec3::ZERO), None);
        assert_eq!(unit(DVec3::NAN), None);
    }

    #[test]
    fn a_level_face_keeps_its_coordinates() {
        let positions = vec![DVec3::ZERO, DVec3::new(4.1, 0.0, 0.0), DVec3::new(4.1, 0.0, -3.3)];
        let mesh = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2])] };
        let frame = PlaneFrame::of_face(&mesh, &mesh.faces[0]).expect("has area");
        assert_eq!((frame.u, frame.v, frame.normal), (DVec3::X, DVec3::NEG_Z, DVec3::Y));
        let plan = frame.face_to_plan(&mesh, &mesh.faces[0]);
        assert_eq!(plan.outer, [DVec2::ZERO, DVec2::new(4.1, 0.0), DVec2::new(4.1, 3.3)]);
    }

    #[test]
    fn plan_and_back_is_the_same_point() {
        let positions = vec![DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 2.5, 3.0), DVec3::new(4.0, 6.0, 1.0)];
        let mesh = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2])] };
        for frame in [PlaneFrame::of_face(&mesh, &mesh.faces[0]), PlaneFrame::along_first_edge(&mesh, &mesh.faces[0])] {
            let frame = frame.expect("has area");
            assert!(frame.u.cross(frame.v).distance(frame.normal) < 1e-15);
            for &p in &mesh.positions {
                assert!(frame.to_space(frame.to_plan(p), 0.0).distance(p) < 1e-14);
            }
        }
        let frame = PlaneFrame::along_first_edge(&mesh, &mesh.faces[0]).expect("has area");
        let second = frame.to_plan(mesh.positions[1]);
        assert!(second.x > 0.0 && second.y.abs() < 1e-15);
    }
}
