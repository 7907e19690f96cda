//! Skeletons, wavefronts, offsets and setbacks move with their polygon. In: random polygons and motions. Out: differences.

use glam::{DVec2, DVec3};
use proptest::prelude::*;

use super::*;
use crate::geometry::offset::{Offset, offset, setback};
use crate::geometry::skeleton::{Skeleton, skeleton, wavefront};

/// The faces as a mesh, heights being times, each with its edge.
fn lifted(s: &Skeleton) -> Mesh {
    let positions = s.nodes.iter().map(|n| DVec3::new(n.position.x, n.time, -n.position.y)).collect();
    let face = |f: &crate::geometry::skeleton::SkeletonFace| Face::with_holes(f.boundary.clone(), f.holes.clone());
    Mesh { positions, faces: s.faces.iter().map(face).collect() }
}

fn tops(s: &Skeleton) -> Mesh {
    let faces = s.tops.iter().map(|ring| Face::new(ring.clone())).collect();
    Mesh { faces, ..lifted(s) }
}

fn edges(s: &Skeleton) -> Vec<usize> {
    s.faces.iter().map(|f| f.edge).collect()
}

/// Polygons and strips; strips start with their edge, what is inside may start anywhere.
fn complaint(o: &Offset, moved: &Offset, motion: &Motion, tolerance: f64) -> Option<String> {
    let strips = |o: &Offset| {
        let polygon = |b: &crate::geometry::offset::Border| Polygon { outer: b.ring.clone(), holes: b.holes.clone() };
        sheet(o.borders.iter().map(polygon).collect::<Vec<_>>().iter())
    };
    difference_of_loops(&motion.mesh(&sheet(&o.inside)), &sheet(&moved.inside), tolerance)
        .or_else(|| difference(&motion.mesh(&strips(o)), &strips(moved), tolerance))
}

fn height(s: &Skeleton) -> f64 {
    s.nodes.iter().fold(0.0, |m, n| f64::max(m, n.time))
}

fn swept(p: &Polygon, distance: f64) -> f64 {
    offset(p, -distance).expect("an offset").inside.iter().map(Polygon::area).sum()
}

/// Whether three planes meet in every node and no two nodes are neighbours: then rounding changes no topology.
pub(super) fn has_margin(p: &Polygon, s: &Skeleton) -> bool {
    let corners: usize = p.rings().map(Vec::len).sum();
    let uses = |n: usize| s.faces.iter().filter(|f| f.boundary.contains(&(n as u32))).count();
    let apart = |i: usize| {
        let at = |n: usize| s.nodes[n].position.extend(s.nodes[n].time);
        (0..i).all(|j| at(i).distance(at(j)) > 1e-4 * extent(p))
    };
    (corners..s.nodes.len()).all(|n| uses(n) == 3 && apart(n))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    #[test]
    fn skeletons_follow_exact_motions(p in footprints(), motion in exact()) {
        let (s, t) = (skeleton(&p, None).expect("one"), skeleton(&motion.polygon(&p), None).expect("two"));
        let mut same: Vec<usize> = edges(&s).iter().map(|&e| motion.edge(&p, e)).collect();
        same.sort_unstable();
        prop_assert_eq!(same, edges(&t));
        prop_assert_eq!(difference(&motion.mesh(&lifted(&s)), &lifted(&t), allowed(1e-9, extent(&p), &motion)), None);
    }

    #[test]
    fn weighted_skeletons_follow_exact_motions(p in footprints(), motion in exact(), seed in prop::array::uniform5(0.0..1.2f64)) {
        let count: usize = p.rings().map(Vec::len).sum();
        let weights: Vec<f64> = (0..count).map(|k| if seed[k % 5] < 0.2 { 0.0 } else { seed[k % 5] }).collect();
        let s = skeleton(&p, Some(&weights)).expect("one");
        let t = skeleton(&motion.polygon(&p), Some(&motion.by_edge(&p, &weights))).expect("two");
        prop_assert_eq!(difference(&motion.mesh(&lifted(&s)), &lifted(&t), allowed(1e-9, extent(&p), &motion)), None);
    }

    #[test]
    fn wavefronts_follow_exact_motions(p in footprints(), motion in exact(), share in 0.0..1.0f64) {
        let time = share * height(&skeleton(&p, None).expect("a skeleton"));
        let s = wavefront(&p, None, time).expect("one");
        let t = wavefront(&motion.polygon(&p), None, time * motion.scale).expect("two");
        let tolerance = allowed(1e-9, extent(&p), &motion);
        prop_assert_eq!(difference(&motion.mesh(&lifted(&s)), &lifted(&t), tolerance), None);
        prop_assert_eq!(difference_of_loops(&motion.mesh(&tops(&s)), &tops(&t), tolerance), None);
    }

    #[test]
    fn offsets_follow_exact_motions(p in footprints(), motion in exact(), distance in -10.0..10.0f64) {
        let (s, t) = (offset(&p, distance).expect("one"), offset(&motion.polygon(&p), distance * motion.scale).expect("two"));
        prop_assert_eq!(complaint(&s, &t, &motion, allowed(1e-9, extent(&p) + 20.0, &motion)), None);
    }

    #[test]
    fn setbacks_follow_exact_motions(p in separate(), motion in exact(), distances in prop::array::uniform5(-2.0..4.0f64)) {
        let count: usize = p.rings().map(Vec::len).sum();
        let own: Vec<f64> = (0..count).map(|k| distances[k % 5].max(0.0)).collect();
        let theirs: Vec<f64> = motion.by_edge(&p, &own).iter().map(|d| d * motion.scale).collect();
        let (s, t) = (setback(&p, &own).expect("one"), setback(&motion.polygon(&p), &theirs).expect("two"));
        prop_assert_eq!(complaint(&s, &t, &motion, allowed(1e-9, extent(&p), &motion)), None);
    }

    /// A step of the grid turns the line of an edge by step / length, and that is carried across the building.
    #[test]
    fn skeletons_of_houses_follow_any_motion(p in houses(), motion in any_motion()) {
        let s = skeleton(&p, None).expect("one");
        prop_assume!(has_margin(&p, &s));
        let t = skeleton(&motion.polygon(&p), None).expect("two");
        prop_assert_eq!(difference(&motion.mesh(&lifted(&s)), &lifted(&t), allowed(1e-8, extent(&p), &motion)), None);
    }

    /// Ties come apart, so not the topology: areas at all heights, within the bound that numerics section 3 sets.
    #[test]
    fn level_sets_follow_any_motion(p in houses(), motion in any_motion(), share in 0.0..1.0f64, round in any::<bool>()) {
        let mut p = p;
        if round {
            // Wings of equal width, events at one time.
            p.outer.iter_mut().for_each(|q| *q = (*q / 4.0).round() * 4.0);
        }
        let rings = [p.outer.clone()];
        let Some(p) = repair(&rings, &KERNEL).polygons.into_iter().next() else { return Ok(()) };
        let (own, moved) = (skeleton(&p, None).expect("one"), skeleton(&motion.polygon(&p), None).expect("two"));
        let tolerance = allowed(1e-8, extent(&p), &motion);
        prop_assert!((height(&own) * motion.scale - height(&moved)).abs() <= tolerance);
        let distance = share * height(&own);
        let (a, b) = (swept(&p, distance), swept(&motion.polygon(&p), distance * motion.scale));
        let girth: f64 = (0..p.outer.len()).map(|i| p.outer[i].distance(p.outer[(i + 1) % p.outer.len()])).sum();
        prop_assert!((a * motion.scale * motion.scale - b).abs() <= girth * motion.scale * tolerance, "{a} {b}");
    }

    #[test]
    fn offsets_of_houses_follow_any_motion(p in houses(), motion in any_motion(), distance in -1.9..3.0f64) {
        let (s, t) = (offset(&p, distance).expect("one"), offset(&motion.polygon(&p), distance * motion.scale).expect("two"));
        prop_assert_eq!(complaint(&s, &t, &motion, allowed(1e-8, extent(&p) + 20.0, &motion)), None);
    }

    /// Where a ring starts changes the numbers of the edges and nothing else.
    #[test]
    fn the_start_of_a_ring_does_not_matter(p in footprints(), start in 0usize..20) {
        let mut turned = p.clone();
        let n = p.outer.len();
        turned.outer.rotate_left(start % n);
        let (s, t) = (skeleton(&p, None).expect("one"), skeleton(&turned, None).expect("two"));
        let renumbered: Vec<usize> = edges(&t).iter().map(|&e| if e < n { (e + start) % n } else { e }).collect();
        let mut sorted = renumbered.clone();
        sorted.sort_unstable();
        prop_assert_eq!(sorted, edges(&s));
        prop_assert_eq!(difference(&lifted(&s), &lifted(&t), 1e-9 * extent(&p)), None);
    }
}

/// Nor does the order of the holes.
#[test]
fn the_order_of_holes_does_not_matter() {
    let square = |x: f64, y: f64, side: f64| {
        [(x, y), (x, y + side), (x + side, y + side), (x + side, y)].map(DVec2::from).to_vec()
    };
    let mut outer = square(0.0, 0.0, 40.0);
    outer.reverse();
    let holes = vec![square(5.0, 5.0, 7.0), square(20.0, 8.0, 6.5), square(9.0, 25.0, 8.0), square(25.0, 22.0, 9.0)];
    let one = skeleton(&Polygon { outer: outer.clone(), holes: holes.clone() }, None).expect("one");
    for turn in 1..4 {
        let mut turned = holes.clone();
        turned.rotate_left(turn);
        let two = skeleton(&Polygon { outer: outer.clone(), holes: turned }, None).expect("two");
        assert_eq!(difference(&lifted(&one), &lifted(&two), 4e-8), None);
    }
}

#[test]
fn edges_keep_their_numbers_under_a_mirror() {
    let square = Polygon { outer: vec![DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y], holes: Vec::new() };
    let mirror = Motion { x_axis: -DVec2::X, y_axis: DVec2::Y, scale: 1.0, shift: DVec2::ZERO };
    let moved = mirror.polygon(&square);
    for edge in 0..4 {
        let other = mirror.edge(&square, edge);
        let ends = [square.outer[(edge + 1) % 4], square.outer[edge]].map(|p| mirror.point(p));
        assert_eq!(ends, [moved.outer[other], moved.outer[(other + 1) % 4]]);
    }
}
