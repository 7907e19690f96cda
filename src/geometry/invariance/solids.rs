//! Cuts, booleans in space, extrusion and simplification move with their meshes. In: random blocks and motions. Out:
//! differences.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::geometry::cut::{Piece, cut, slice};
use crate::geometry::envelope::{Envelope, Limit, envelope};
use crate::geometry::extrude::{Direction, extrude};
use crate::geometry::mesh_checks::{is_closed, non_planar_faces, surface_area, volume};
use crate::geometry::plane::Plane;
use crate::geometry::simplify::simplify;
use crate::geometry::solid::{OpenMeshes, Operator, combine};

/// A prism over a polygon.
fn block(p: &Polygon, height: f64) -> Mesh {
    extrude(&sheet([p]), Direction::FaceNormal, height).expect("has area").mesh
}

/// A direction in space, turned along.
fn turned(motion: &Motion, d: DVec3) -> DVec3 {
    (motion.space().matrix3 * d / motion.scale).normalize()
}

fn directions() -> impl Strategy<Value = DVec3> {
    let any = prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from);
    let upright = prop::sample::select(vec![DVec3::X, DVec3::Y, DVec3::Z]);
    prop_oneof![any.prop_filter("no direction", |d| d.length() > 0.1).prop_map(DVec3::normalize), upright]
}

/// The plane through a point of the middle of the block, before and after.
fn planes(mesh: &Mesh, normal: DVec3, share: f64, motion: &Motion) -> (Plane, Plane) {
    let (low, high) = mesh.bounds().expect("a block");
    let through = low + (high - low) * share;
    let moved = Plane::through(motion.space().transform_point3(through), turned(motion, normal)).expect("a direction");
    (Plane::through(through, normal).expect("a direction"), moved)
}

fn total(pieces: &[&Piece], measure: fn(&Mesh) -> f64) -> Vec<f64> {
    pieces.iter().map(|p| measure(&p.mesh)).collect()
}

/// The distance of the nearest corner from a plane: nearer than its thickness counts as on it.
fn room(mesh: &Mesh, plane: &Plane) -> f64 {
    mesh.positions.iter().map(|&p| plane.signed_distance(p).abs()).fold(f64::INFINITY, f64::min)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(120))]

    #[test]
    fn cuts_follow_exact_motions(p in footprints(), normal in directions(), share in 0.05..0.95f64, motion in exact()) {
        let mesh = block(&p, 9.0);
        let (plane, moved_plane) = planes(&mesh, normal, share, &motion);
        prop_assume!(room(&mesh, &plane) > 1e-5);
        let (own, moved) = (cut(&mesh, &plane), cut(&motion.mesh(&mesh), &moved_plane));
        // A plane's place is rounded far out, and an edge along it magnifies that.
        let tolerance = allowed(1e-9, extent(&p), &motion) * 1e3;
        for (a, b) in [(&own.behind, &moved.behind), (&own.front, &moved.front)] {
            prop_assert_eq!(a.mesh.faces.len(), b.mesh.faces.len());
            prop_assert_eq!(a.origins.len(), b.origins.len());
            prop_assert_eq!(is_closed(&a.mesh), is_closed(&b.mesh));
            let (va, vb) = (volume(&a.mesh) * motion.scale.powi(3), volume(&b.mesh));
            prop_assert!((va - vb).abs() <= tolerance * (100.0 * motion.scale).powi(2), "{va} {vb}");
        }
    }

    #[test]
    fn cuts_of_houses_follow_any_motion(p in houses(), normal in directions(), share in 0.05..0.95f64, motion in any_motion()) {
        let mesh = block(&p, 9.0);
        let (plane, moved_plane) = planes(&mesh, normal, share, &motion);
        prop_assume!(room(&mesh, &plane) > 1e-5);
        let (own, moved) = (cut(&mesh, &plane), cut(&motion.mesh(&mesh), &moved_plane));
        let tolerance = allowed(1e-9, extent(&p), &motion);
        for (a, b) in [(&own.behind, &moved.behind), (&own.front, &moved.front)] {
            prop_assert_eq!(a.mesh.faces.len(), b.mesh.faces.len());
            prop_assert_eq!(is_closed(&a.mesh), is_closed(&b.mesh));
            let (va, vb) = (volume(&a.mesh) * motion.scale.powi(3), volume(&b.mesh));
            prop_assert!((va - vb).abs() <= tolerance * surface_area(&mesh) * motion.scale.powi(2), "{va} {vb}");
        }
    }

    /// Floors of a building, as a split makes them.
    #[test]
    fn slices_follow(p in houses(), motion in any_motion(), floors in 1u32..6) {
        let mesh = block(&p, 12.0);
        let boundaries: Vec<f64> = (1..floors).map(|k| 12.0 * f64::from(k) / f64::from(floors)).collect();
        let moved: Vec<f64> = boundaries.iter().map(|b| b * motion.scale).collect();
        let (own, moved) = (slice(&mesh, DVec3::Y, &boundaries), slice(&motion.mesh(&mesh), DVec3::Y, &moved));
        let tolerance = allowed(1e-9, 12.0 + extent(&p), &motion);
        for (a, b) in own.iter().zip(&moved) {
            prop_assert_eq!(difference_of_loops(&motion.mesh(&a.mesh), &b.mesh, tolerance), None);
        }
        let volumes = total(&own.iter().collect::<Vec<_>>(), volume);
        prop_assert!(volumes.iter().all(|v| (v - volumes[0]).abs() < 1e-9 * volumes[0]));
    }

    #[test]
    fn solids_follow_exact_motions(a in houses(), b in houses(), motion in exact(), by in prop::array::uniform3(-6.0..6.0f64)) {
        solids_follow(&a, &b, &motion, by, 1e-9)?;
    }

    #[test]
    fn solids_follow_any_motion(a in houses(), b in houses(), motion in any_motion(), by in prop::array::uniform3(-6.0..6.0f64)) {
        solids_follow(&a, &b, &motion, by, 1e-8)?;
    }

    /// Rectangles and Ls: where walls stand on one line, rounding at the height where they begin to recede decides who
    /// passes whom.
    #[test]
    fn envelopes_follow_exact_motions(p in houses().prop_filter("walls on one line", |p| p.outer.len() <= 6), motion in exact(), seed in prop::array::uniform4((0.0..6.0f64, 20.0..120.0f64))) {
        let count: usize = p.rings().map(Vec::len).sum();
        let limits: Vec<Limit> = (0..count).map(|k| Limit { base: seed[k % 4].0, angle: seed[k % 4].1 }).collect();
        let higher = |l: &Limit| Limit { base: l.base * motion.scale, angle: l.angle };
        let theirs: Vec<Limit> = motion.by_edge(&p, &limits).iter().map(higher).collect();
        let (own, moved) = (envelope(&p, &limits, 10.0), envelope(&motion.polygon(&p), &theirs, 10.0 * motion.scale));
        prop_assert_eq!(own.as_ref().err(), moved.as_ref().err());
        let (Ok(Envelope { mesh: own, .. }), Ok(Envelope { mesh: moved, .. })) = (own, moved) else { return Ok(()) };
        prop_assert_eq!(own.faces.len(), moved.faces.len());
        prop_assert_eq!(non_planar_faces(&own, 1e-6), Vec::new());
        let (va, vb) = (volume(&own) * motion.scale.powi(3), volume(&moved));
        let tolerance = allowed(1e-8, extent(&p), &motion) * surface_area(&own) * motion.scale.powi(2);
        prop_assert!((va - vb).abs() <= tolerance, "{va} {vb}");
    }

    /// Scaled by a power of two and shifted without loss, the very same edges collapse.
    #[test]
    fn simplification_follows(heights in prop::collection::vec(0.0..3.0f64, 36), count in 0usize..20, motion in exact()) {
        let mesh = hills(&heights);
        let motion = Motion { x_axis: DVec2::X, y_axis: DVec2::Y, ..motion };
        let (own, moved) = (simplify(&mesh, count), simplify(&motion.mesh(&mesh), count));
        prop_assert_eq!(own.removed, moved.removed);
        prop_assert_eq!(&own.sources, &moved.sources);
        prop_assert_eq!(difference(&motion.mesh(&own.mesh), &moved.mesh, allowed(1e-9, 6.0, &motion)), None);
    }
}

fn solids_follow(a: &Polygon, b: &Polygon, motion: &Motion, by: [f64; 3], share: f64) -> Result<(), TestCaseError> {
    let (a, mut b) = (block(a, 9.0), block(b, 7.0));
    b.positions.iter_mut().for_each(|p| *p += DVec3::from(by));
    let size = extent_of(&a) + extent_of(&b);
    let tolerance = allowed(share, size, motion);
    for operator in [Operator::Union, Operator::Subtract, Operator::Intersect] {
        let own = combine(&a, &b, operator, OpenMeshes::HalfSpaces).expect("one").mesh;
        let moved = combine(&motion.mesh(&a), &motion.mesh(&b), operator, OpenMeshes::HalfSpaces).expect("two").mesh;
        prop_assert_eq!((own.faces.len(), own.positions.len()), (moved.faces.len(), moved.positions.len()));
        prop_assert_eq!(is_closed(&own), is_closed(&moved));
        let (va, vb) = (volume(&own) * motion.scale.powi(3), volume(&moved));
        prop_assert!((va - vb).abs() <= tolerance * 6.0 * (size * motion.scale).powi(2), "{operator:?} {va} {vb}");
        prop_assert_eq!(difference_of_loops(&motion.mesh(&own), &moved, 10.0 * tolerance), None);
    }
    Ok(())
}

/// A sheet of 5 x 5 squares over these heights.
fn hills(heights: &[f64]) -> Mesh {
    let mut mesh = Mesh::default();
    for (k, &height) in heights.iter().enumerate() {
        mesh.positions.push(DVec3::new((k % 6) as f64, (height * 1024.0).round() / 1024.0, -((k / 6) as f64)));
    }
    for (i, j) in (0..5u32).flat_map(|j| (0..5u32).map(move |i| (i, j))) {
        let at = |i: u32, j: u32| j * 6 + i;
        mesh.faces.push(Face::new(vec![at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]));
    }
    mesh
}
