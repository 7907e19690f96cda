//! Closed forms of `cga-reference.md` §10.6 and of the offset cases in `hard-cases/stages.json`.

use glam::DVec2;

use super::{Offset, offset, reversed_edge, setback};
use crate::geometry::polygon::{Polygon, signed_area};

fn polygon(outer: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Polygon {
    let ring = |r: &[(f64, f64)]| r.iter().map(|&(x, y)| DVec2::new(x, y)).collect();
    Polygon { outer: ring(outer), holes: holes.iter().map(|h| ring(h)).collect() }
}

fn rectangle(w: f64, h: f64) -> Polygon {
    polygon(&[(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)], &[])
}

fn inside_area(o: &Offset) -> f64 {
    o.inside.iter().map(Polygon::area).sum()
}

fn border_areas(o: &Offset) -> Vec<(usize, f64)> {
    let area = |b: &super::Border| signed_area(&b.ring) + b.holes.iter().map(|h| signed_area(h)).sum::<f64>();
    o.borders.iter().map(|b| (b.edge, area(b))).collect()
}

#[track_caller]
fn assert_areas(o: &Offset, inside: f64, borders: &[(usize, f64)]) {
    assert!((inside_area(o) - inside).abs() < 1e-6, "inside {}", inside_area(o));
    let found = border_areas(o);
    assert_eq!(found.len(), borders.len(), "{found:?}");
    for (f, b) in found.iter().zip(borders) {
        assert!(f.0 == b.0 && (f.1 - b.1).abs() < 1e-6, "{found:?}");
    }
}

#[test]
fn offset_of_a_rectangle() {
    let r = rectangle(10.0, 6.0);
    assert_areas(&offset(&r, -1.0).unwrap(), 32.0, &[(0, 9.0), (1, 5.0), (2, 9.0), (3, 5.0)]);
    assert_areas(&offset(&r, 1.0).unwrap(), 96.0, &[(0, 11.0), (1, 7.0), (2, 11.0), (3, 7.0)]);
    let first = &offset(&r, 1.0).unwrap().borders[0].ring;
    assert_eq!(first[..2], [DVec2::new(10.0, 0.0), DVec2::ZERO]);
}

#[test]
fn from_the_inradius_on_nothing_is_left() {
    let square = rectangle(10.0, 10.0);
    let quarter = [(0, 25.0), (1, 25.0), (2, 25.0), (3, 25.0)];
    assert_areas(&offset(&square, -5.0).unwrap(), 0.0, &quarter);
    assert_areas(&offset(&square, -50.0).unwrap(), 0.0, &quarter);
    assert!(offset(&square, -5.0).unwrap().inside.is_empty());
    assert_areas(&offset(&square, 0.0).unwrap(), 100.0, &[]);
}

#[test]
fn setback_of_a_rectangle() {
    let r = rectangle(10.0, 6.0);
    assert_areas(&setback(&r, &[2.0]).unwrap(), 40.0, &[(0, 20.0)]);
    assert_areas(&setback(&r, &[2.0, 0.0, 1.0]).unwrap(), 30.0, &[(0, 20.0), (2, 10.0)]);
    assert_areas(&setback(&r, &[2.0, 0.0, 0.0, 3.0]).unwrap(), 28.0, &[(0, 17.0), (3, 15.0)]);
    let stages = rectangle(20.0, 10.0);
    assert_areas(&setback(&stages, &[3.0, 0.0, 1.0, 0.0]).unwrap(), 120.0, &[(0, 60.0), (2, 20.0)]);
}

#[test]
fn setback_ends_square_at_a_concave_corner() {
    let l = polygon(&[(0.0, 0.0), (10.0, 0.0), (10.0, 5.0), (5.0, 5.0), (5.0, 10.0), (0.0, 10.0)], &[]);
    let o = setback(&l, &[0.0, 0.0, 2.0, 0.0, 0.0, 0.0]).unwrap();
    assert_areas(&o, 65.0, &[(2, 10.0)]);
}

#[test]
fn collinear_edges_of_different_distance_part_square() {
    let r = polygon(&[(0.0, 0.0), (4.0, 0.0), (10.0, 0.0), (10.0, 6.0), (0.0, 6.0)], &[]);
    assert_areas(&setback(&r, &[1.0, 2.0]).unwrap(), 44.0, &[(0, 4.0), (1, 12.0)]);
    assert_areas(&setback(&r, &[2.0, 1.0]).unwrap(), 46.0, &[(0, 8.0), (1, 6.0)]);
    assert_areas(&setback(&r, &[0.0, 1.0]).unwrap(), 54.0, &[(1, 6.0)]);
}

#[test]
fn setback_passes_a_hole_that_stands_still() {
    let p = polygon(
        &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
        &[&[(3.0, 5.0), (5.0, 5.0), (5.0, 3.0), (3.0, 3.0)]],
    );
    assert_areas(&setback(&p, &[2.0]).unwrap(), 76.0, &[(0, 20.0)]);
    assert_areas(&setback(&p, &[4.0]).unwrap(), 58.0, &[(0, 38.0)]);
    // Behind the hole, whose far edge is parallel, a strip as wide as the hole stays.
    assert_areas(&setback(&p, &[6.0]).unwrap(), 42.0, &[(0, 54.0)]);
}

#[test]
fn growing_closes_holes_and_pockets() {
    let p = polygon(
        &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)],
        &[&[(3.0, 7.0), (7.0, 7.0), (7.0, 3.0), (3.0, 3.0)]],
    );
    let o = offset(&p, 1.0).unwrap();
    assert!((inside_area(&o) - (144.0 - 4.0)).abs() < 1e-6);
    assert_eq!((o.inside.len(), o.inside[0].holes.len(), o.borders.len()), (1, 1, 8));
    assert!(offset(&p, 2.5).unwrap().inside[0].holes.is_empty());
    // A C whose mouth of 2 m closes before its room of 4 m is filled.
    let c = polygon(
        &[
            (0.0, 0.0),
            (12.0, 0.0),
            (12.0, 5.0),
            (8.0, 5.0),
            (8.0, 4.0),
            (4.0, 4.0),
            (4.0, 8.0),
            (8.0, 8.0),
            (8.0, 7.0),
            (12.0, 7.0),
            (12.0, 12.0),
            (0.0, 12.0),
        ],
        &[],
    );
    let o = offset(&c, 1.5).unwrap();
    assert_eq!((o.inside.len(), o.inside[0].holes.len()), (1, 1));
    assert!((inside_area(&o) - (225.0 - 1.0)).abs() < 1e-6, "{}", inside_area(&o));
}

#[test]
fn sharp_corners_are_cut_at_the_mitre_limit() {
    let needle = polygon(&[(0.0, 0.0), (100.0, 0.0), (100.0, 0.2)], &[]);
    let o = offset(&needle, 1.0).unwrap();
    let (low, high) = o.inside[0].bounds().unwrap();
    assert!((low.x + super::MITRE_LIMIT).abs() < 1e-2 && high.x < 101.1, "{low} {high}");
}

#[test]
fn reversed_edges() {
    // Ring 0 1 2 3 reversed is 3 2 1 0: its edge 0 runs from 3 to 2, which is edge 2.
    assert_eq!((0..4).map(|e| reversed_edge(e, 4)).collect::<Vec<_>>(), [2, 1, 0, 3]);
}

/// Found by the fuzz target `geometry`: a detail of a few grid steps crosses itself on the coarser grid of what it grows
/// into.
#[test]
fn outlines_with_details_below_the_coarser_grid_grow() {
    let p = polygon(
        &[(0.0, 0.0), (30.0, 0.0), (30.0, 20.0), (1e-7, 20.0), (1.5e-7, 19.999_999_9), (0.0, 20.000_000_05)],
        &[],
    );
    let p = crate::geometry::repair::repair(&[p.outer], &Default::default()).polygons.remove(0);
    for distance in [0.5, 7.0, 12.57081263163127, 40.0] {
        let made = offset(&p, distance).unwrap();
        let wanted = (30.0 + 2.0 * distance) * (20.0 + 2.0 * distance);
        assert!((inside_area(&made) - wanted).abs() < 1e-4 * distance, "{distance}: {}", inside_area(&made));
        let strips: f64 = border_areas(&made).iter().map(|b| b.1.abs()).sum();
        assert!((strips - (wanted - 600.0)).abs() < 1e-4 * distance, "{distance}: {strips}");
    }
}

/// Found by the fuzz target `geometry`: a bevel where sharp corners touch vanished, and the front ran to the frame.
#[test]
fn sharp_corners_that_touch_keep_their_bevel() {
    let outer = [
        (0.3700000047683716, 0.0),
        (0.09431374073028564, -0.2684313654899597),
        (0.10673075914382935, -0.26326924562454224),
        (0.0, -0.3700000047683716),
        (0.0, -0.3602631688117981),
        (0.09431374073028564, -0.2684313654899597),
        (-4.443333327770233, -4.686666667461395),
        (-6.662499129772186, -6.84743332862854),
        (-2.1295555233955383, -11.502888917922974),
        (0.0, -11.100000023841858),
        (0.0, -6.93876713514328),
        (13.319999992847443, -13.689999997615814),
        (0.4744355082511902, -0.11040323972702026),
        (0.7252662181854248, -0.006125271320343018),
    ];
    let p = polygon(&outer, &[]);
    for distance in [0.07805663719773293, 0.5463964603841305, 6.0] {
        let made = offset(&p, distance).unwrap();
        let around: f64 = made.inside.iter().flat_map(|p| &p.outer).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        assert!(inside_area(&made) > p.area(), "{distance}: {}", inside_area(&made));
        // The farthest corner, and the longest mitre.
        assert!(around < 13.7 + 4.5 * distance, "{distance}: {around}");
        let strips: f64 = border_areas(&made).iter().map(|b| b.1.abs()).sum();
        assert!(inside_area(&made) - p.area() >= strips - 1e-3, "{distance}: {strips}");
    }
}
