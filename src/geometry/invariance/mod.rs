//! Position independence: an input that is moved, turned, mirrored or scaled gives the output moved, turned, mirrored or
//! scaled. In: random shapes and [`Motion`]s. Out: what differs, if anything.
//!
//! Two kinds of motions. *Exact* ones (quarter turns, mirrors, powers of two, shifts by whole numbers) lose no digit of a
//! coordinate: the integers on the kernel's grid are the same, so the topology must be the same and coordinates equal to
//! 1e-9 of the extent. *Any* motion rounds coordinates: a footprint stays the same to one step of the grid (2^-30 of the
//! extent), and results follow to what that step does to them (`../shared/numerics.md` sections 3 and 11): shapes with a margin
//! keep their topology, all others their areas and volumes.

mod laws;
mod regions;
mod roofs;
mod skeletons;
mod solids;

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use proptest::prelude::*;

use super::polygon::{Polygon, Ring};
use super::polygon_checks::touching_edges;
use super::repair::{Options, repair};
use super::transform::{flip_loop, transform};
use super::{Face, Mesh, PlaneFrame};

/// A similarity of the plan: turn or mirror, then scale, then shift.
#[derive(Clone, Copy, Debug)]
struct Motion {
    x_axis: DVec2,
    y_axis: DVec2,
    scale: f64,
    shift: DVec2,
}

impl Motion {
    fn mirrors(&self) -> bool {
        self.x_axis.perp_dot(self.y_axis) < 0.0
    }

    fn direction(&self, d: DVec2) -> DVec2 {
        self.x_axis * d.x + self.y_axis * d.y
    }

    fn point(&self, p: DVec2) -> DVec2 {
        self.direction(p) * self.scale + self.shift
    }

    /// Directions stay what they were: a mirrored ring is run the other way, its first edge first.
    fn ring(&self, ring: &Ring) -> Ring {
        let mut moved: Ring = ring.iter().map(|&p| self.point(p)).collect();
        if self.mirrors() {
            flip_loop(&mut moved);
        }
        moved
    }

    fn polygon(&self, p: &Polygon) -> Polygon {
        Polygon { outer: self.ring(&p.outer), holes: p.holes.iter().map(|h| self.ring(h)).collect() }
    }

    /// The number of an edge in the moved polygon.
    fn edge(&self, p: &Polygon, edge: usize) -> usize {
        let mut first = 0;
        for ring in p.rings() {
            let n = ring.len();
            if edge < first + n {
                return if self.mirrors() { first + (first + n - edge) % n } else { edge };
            }
            first += n;
        }
        edge
    }

    /// Values by edge, for the moved polygon.
    fn by_edge<T: Copy>(&self, p: &Polygon, values: &[T]) -> Vec<T> {
        let mut moved = values.to_vec();
        (0..values.len()).for_each(|e| moved[self.edge(p, e)] = values[e]);
        moved
    }

    /// The same in space, where plan (x, y) is (x, height, -y) and heights scale too.
    fn space(&self) -> DAffine3 {
        let lift = |d: DVec2| DVec3::new(d.x, 0.0, -d.y) * self.scale;
        let matrix = DMat3::from_cols(lift(self.x_axis), DVec3::Y * self.scale, -lift(self.y_axis));
        DAffine3 { matrix3: matrix, translation: DVec3::new(self.shift.x, 0.0, -self.shift.y) }
    }

    fn mesh(&self, mesh: &Mesh) -> Mesh {
        transform(mesh, &self.space())
    }
}

/// Shifts in metres: none, a UTM zone's, round the planet.
fn shifts() -> impl Strategy<Value = DVec2> {
    let far = [(0.0, 0.0), (500_000.0, 4_200_000.0), (-333_001.0, 7_654_321.0), (20_037_508.0, -20_037_508.0)];
    (prop::sample::select(far.to_vec()), -500i32..500, -500i32..500)
        .prop_map(|(far, x, y)| DVec2::from(far) + DVec2::new(f64::from(x), f64::from(y)))
}

/// Motions that round nothing; from about thousandths to about thousands, shifts in proportion.
fn exact() -> impl Strategy<Value = Motion> {
    (0u8..8, -12i32..13, shifts()).prop_map(|(symmetry, power, shift)| {
        let (mut x_axis, mut y_axis) = (DVec2::X, DVec2::Y);
        (0..symmetry % 4).for_each(|_| (x_axis, y_axis) = (x_axis.perp(), y_axis.perp()));
        if symmetry >= 4 {
            x_axis = -x_axis;
        }
        let scale = libm::ldexp(1.0, power);
        Motion { x_axis, y_axis, scale, shift: shift * scale }
    })
}

/// Any angle, mirrored or not, in millimetres, metres, kilometres and an odd unit.
fn any_motion() -> impl Strategy<Value = Motion> {
    let scales = prop::sample::select(vec![1e3, 1.0, 1e-3, 1.0 / 3.0]);
    (0.0..TAU, any::<bool>(), scales, shifts()).prop_map(|(angle, is_mirror, scale, shift)| {
        let x_axis = DVec2::new(libm::cos(angle), libm::sin(angle));
        let y_axis = if is_mirror { -x_axis.perp() } else { x_axis.perp() };
        Motion { x_axis, y_axis, scale, shift: shift * scale }
    })
}

const KERNEL: Options = Options { weld: 0.0, min_area: 0.0 };

/// A ring around the origin through random distances at rising angles, rounded to `unit`.
fn star(corners: &[(f64, f64)], unit: f64) -> Ring {
    let mut corners = corners.to_vec();
    corners.sort_by(|p, q| p.0.total_cmp(&q.0));
    let place = |(turn, r): (f64, f64)| DVec2::new(libm::cos(turn * TAU), libm::sin(turn * TAU)) * r;
    corners.into_iter().map(|c| (place(c) / unit).round() * unit).collect()
}

/// Clean polygons of up to 100 m, with and without a hole, many of them on so coarse a grid that events coincide.
fn footprints() -> impl Strategy<Value = Polygon> {
    let corners = prop::collection::vec((0.0..1.0f64, 12.0..50.0f64), 3..20);
    let hole = prop::collection::vec((0.0..1.0f64, 2.0..10.0f64), 0..8);
    (corners, hole, prop::sample::select(vec![4, 7, 10, 23])).prop_filter_map("no polygon", |(outer, hole, bits)| {
        let unit = libm::ldexp(64.0, -bits);
        let mut rings = vec![star(&outer, unit)];
        rings.extend((hole.len() > 2).then(|| star(&hole, unit)));
        repair(&rings, &Options { weld: 0.0, min_area: 1.0 }).polygons.into_iter().next()
    })
}

/// Buildings: wings of 4 to 12 m at right angles, a different width each; ties only by chance.
fn houses() -> impl Strategy<Value = Polygon> {
    (0usize..5, prop::array::uniform6(4.0..12.0f64)).prop_map(|(kind, [a, b, c, d, e, f])| {
        let outer: Vec<(f64, f64)> = match kind {
            0 => vec![(0.0, 0.0), (a + b, 0.0), (a + b, c), (0.0, c)],
            1 => vec![(0.0, 0.0), (a + b, 0.0), (a + b, c), (a, c), (a, c + d), (0.0, c + d)],
            2 => {
                let (x1, x2, x3) = (a, a + b, a + b + e);
                vec![(0.0, 0.0), (x3, 0.0), (x3, c), (x2, c), (x2, c + d), (x1, c + d), (x1, c), (0.0, c)]
            }
            3 => {
                let (x1, x2, x3) = (a, a + b, a + b + e);
                vec![(0.0, 0.0), (x3, 0.0), (x3, c + f), (x2, c + f), (x2, c), (x1, c), (x1, c + d), (0.0, c + d)]
            }
            _ => {
                let (x1, x2) = (a, a + b);
                vec![
                    (0.0, 0.0),
                    (x2, 0.0),
                    (x2, c),
                    (x2 + e, c),
                    (x2 + e, c + d + f),
                    (x1, c + d + f),
                    (x1, c + d),
                    (0.0, c + d),
                ]
            }
        };
        Polygon { outer: outer.into_iter().map(DVec2::from).collect(), holes: Vec::new() }
    })
}

/// Those whose rings touch nowhere.
fn separate() -> impl Strategy<Value = Polygon> {
    footprints().prop_filter("rings touch", |p| touching_edges(p).is_empty())
}

fn extent(p: &Polygon) -> f64 {
    p.bounds().map_or(0.0, |(low, high)| (high - low).max_element())
}

fn extent_of(mesh: &Mesh) -> f64 {
    mesh.bounds().map_or(0.0, |(low, high)| (high - low).max_element())
}

/// Relative to the extent, and never below what f64 resolves so far out.
fn allowed(share: f64, extent: f64, motion: &Motion) -> f64 {
    (share * extent * motion.scale).max(4.0 * f64::EPSILON * motion.shift.abs().max_element())
}

/// How the faces of two meshes differ, if they do: the same loops, each started at the same corner, within `tolerance`.
/// Faces may come in another order, as may the holes of a face, which may start anywhere.
fn difference(expected: &Mesh, got: &Mesh, tolerance: f64) -> Option<String> {
    compare(expected, got, tolerance, near)
}

/// The same for faces that may start at any corner.
fn difference_of_loops(expected: &Mesh, got: &Mesh, tolerance: f64) -> Option<String> {
    compare(expected, got, tolerance, same_cycle)
}

type Same = fn(&[DVec3], &[DVec3], f64) -> bool;

fn compare(expected: &Mesh, got: &Mesh, tolerance: f64, same: Same) -> Option<String> {
    let mut left = loops(got, tolerance);
    for wanted in loops(expected, tolerance) {
        let hole_fits = |hole: &Vec<DVec3>, other: &[Vec<DVec3>]| other.iter().any(|h| same_cycle(hole, h, tolerance));
        let fits = |other: &Vec<Vec<DVec3>>| {
            same(&wanted[0], &other[0], tolerance)
                && wanted.len() == other.len()
                && wanted[1..].iter().all(|hole| hole_fits(hole, &other[1..]))
        };
        match left.iter().position(fits) {
            Some(found) => drop(left.swap_remove(found)),
            None => return Some(format!("within {tolerance:e} no face is {wanted:?}\nleft are {left:?}")),
        }
    }
    (!left.is_empty()).then(|| format!("too many faces: {left:?}"))
}

/// The corners of every face by loop, outer loop first. Where rings of a polygon touch, faces run from the corner of one ring
/// to that of the other: corners at one place are one here, faces that are nothing else are none.
fn loops(mesh: &Mesh, tolerance: f64) -> Vec<Vec<Vec<DVec3>>> {
    let corners = |ring: &[u32]| {
        let mut corners: Vec<DVec3> = ring.iter().map(|&v| mesh.positions[v as usize]).collect();
        corners.dedup_by(|q, p| p.distance(*q) <= tolerance);
        while corners.len() > 1 && corners[0].distance(corners[corners.len() - 1]) <= tolerance {
            corners.pop();
        }
        corners
    };
    let faces = mesh.faces.iter().map(|face| face.loops().map(corners).collect::<Vec<_>>());
    faces.filter(|face| face[0].len() > 2).collect()
}

fn near(a: &[DVec3], b: &[DVec3], tolerance: f64) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(p, q)| p.distance(*q) <= tolerance)
}

/// Equal loops, wherever they start.
fn same_cycle(a: &[DVec3], b: &[DVec3], tolerance: f64) -> bool {
    let turned = |k: usize| [&b[k..], &b[..k]].concat();
    a.len() == b.len() && (0..b.len()).any(|k| near(a, &turned(k), tolerance))
}

/// Polygons as faces at height 0.
fn sheet<'a>(polygons: impl IntoIterator<Item = &'a Polygon>) -> Mesh {
    let mut mesh = Mesh::default();
    polygons.into_iter().for_each(|polygon| PlaneFrame::PLAN.push_face(&mut mesh, polygon, 0.0));
    mesh
}
