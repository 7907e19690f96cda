//! Pieces tile the parent, closed stays closed, first edges survive, walls in the plane make no slivers.

use super::*;
use crate::geometry::Polygon;
use crate::geometry::extrude::{Direction, extrude};
use crate::geometry::mesh_checks::{
    doubled_corners, faces_without_area, is_closed, non_planar_faces, surface_area, volume,
};
use crate::geometry::plane::PlaneFrame;
use glam::DVec2;
use proptest::prelude::*;

fn ring(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
}

fn lot(outer: &[(f64, f64)], holes: &[&[(f64, f64)]]) -> Mesh {
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(
        &mut mesh,
        &Polygon { outer: ring(outer), holes: holes.iter().map(|h| ring(h)).collect() },
        0.0,
    );
    mesh
}

fn block(outer: &[(f64, f64)], holes: &[&[(f64, f64)]], height: f64) -> Mesh {
    extrude(&lot(outer, holes), Direction::FaceNormal, height).expect("has area").mesh
}

fn plane(normal: DVec3, offset: f64) -> Plane {
    Plane { normal, offset }
}

const SQUARE: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)];
const HOLE: &[(f64, f64)] = &[(3.0, 3.0), (3.0, 7.0), (7.0, 7.0), (7.0, 3.0)];
const U: &[(f64, f64)] =
    &[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (7.0, 10.0), (7.0, 3.0), (3.0, 3.0), (3.0, 10.0), (0.0, 10.0)];

fn clean(piece: &Piece) {
    assert!(faces_without_area(&piece.mesh).is_empty());
    assert!(doubled_corners(&piece.mesh).is_empty());
    assert!(non_planar_faces(&piece.mesh, 1e-9).is_empty());
    assert_eq!(piece.mesh.faces.len(), piece.origins.len());
}

#[test]
fn a_block_cut_into_floors() {
    let mesh = block(SQUARE, &[HOLE], 9.0);
    let floors = slice(&mesh, DVec3::Y, &[0.0, 3.0, 6.0, 9.0]);
    assert_eq!(floors.iter().map(Piece::is_empty).collect::<Vec<_>>(), [true, false, false, false, true]);
    for (level, floor) in floors[1..4].iter().enumerate() {
        clean(floor);
        assert!(is_closed(&floor.mesh));
        assert!((volume(&floor.mesh) - 84.0 * 3.0).abs() < 1e-9);
        let (lo, hi) = floor.mesh.bounds().expect("not empty");
        assert_eq!((lo.y, hi.y), (3.0 * level as f64, 3.0 * level as f64 + 3.0));
        assert_eq!(floor.mesh.faces.len(), 10);
        // The floor's own bottom comes first: the block's for the lowest one, a cap for the others.
        assert_eq!(floor.origins[0], if level == 0 { Origin::Face(0) } else { Origin::Cap });
        let bottom = &floor.mesh.faces[0];
        assert!(floor.mesh.newell(bottom).y < 0.0);
        assert_eq!(bottom.holes.len(), 1);
        let first = [bottom.outer[0], bottom.outer[1]].map(|i| floor.mesh.positions[i as usize]);
        assert_eq!(first.map(|p| (p.x, p.z)), [(10.0, 0.0), (0.0, 0.0)]);
    }
}

#[test]
fn a_u_cut_across_its_wings_gives_two_caps_and_two_parts() {
    let cut = cut(&block(U, &[], 4.0), &plane(DVec3::NEG_Z, 6.0));
    for (piece, area) in [(&cut.behind, 48.0), (&cut.front, 24.0)] {
        clean(piece);
        assert!(is_closed(&piece.mesh));
        assert!((volume(&piece.mesh) - area * 4.0).abs() < 1e-9);
        assert_eq!(piece.origins.iter().filter(|&&o| o == Origin::Cap).count(), 2);
    }
    assert_eq!(cut.front.origins.iter().filter(|&&o| o == Origin::Face(0)).count(), 2);
}

#[test]
fn a_plane_along_a_wall_makes_no_sliver() {
    for (offset, behind, front) in [(3.0, 30.0, 42.0), (10.0, 72.0, 0.0), (0.0, 0.0, 72.0)] {
        for wobble in [0.0, 1e-10, -1e-10] {
            let cut = cut(&block(U, &[], 4.0), &plane(DVec3::NEG_Z, offset + wobble));
            for (piece, area) in [(&cut.behind, behind), (&cut.front, front)] {
                clean(piece);
                assert_eq!(piece.is_empty(), area == 0.0);
                assert!((volume(&piece.mesh) - area * 4.0).abs() < 1e-7);
                assert_eq!(is_closed(&piece.mesh), area > 0.0);
            }
        }
    }
}

#[test]
fn a_flat_lot_is_just_cut_and_keeps_its_first_edge() {
    let mesh = lot(SQUARE, &[]);
    let pieces = slice(&mesh, DVec3::X, &[2.0, 5.0]);
    assert!(pieces.iter().all(|p| p.mesh.faces.len() == 1 && p.origins[..] == [Origin::Face(0)]));
    for (piece, (from, to)) in pieces.iter().zip([(0.0, 2.0), (2.0, 5.0), (5.0, 10.0)]) {
        let outer = &piece.mesh.faces[0].outer;
        assert_eq!(piece.mesh.positions[outer[0] as usize], DVec3::new(from, 0.0, 0.0));
        assert_eq!(piece.mesh.positions[outer[1] as usize], DVec3::new(to, 0.0, 0.0));
    }
    // Cut across: the part without edge 0 starts with the first edge it still has, the right-hand one.
    let cut = cut(&mesh, &plane(DVec3::NEG_Z, 4.0));
    let outer = &cut.front.mesh.faces[0].outer;
    assert_eq!(cut.front.mesh.positions[outer[0] as usize], DVec3::new(10.0, 0.0, -4.0));
}

#[test]
fn both_pieces_and_both_neighbours_share_the_cut_points_bitwise() {
    let mesh = block(U, &[], 4.0);
    let normal = DVec3::new(0.3, 0.2, -0.7).normalize();
    let cut = cut(&mesh, &plane(normal, normal.dot(DVec3::new(4.0, 2.0, -5.0))));
    let key = |p: &DVec3| p.to_array().map(f64::to_bits);
    let old: Vec<_> = mesh.positions.iter().map(key).collect();
    let new = |piece: &Piece| -> std::collections::BTreeSet<_> {
        piece.mesh.positions.iter().map(key).filter(|k| !old.contains(k)).collect()
    };
    assert_eq!(new(&cut.behind), new(&cut.front));
    assert!(new(&cut.front).len() >= 6);
}

#[test]
fn uvs_are_interpolated_and_caps_have_none() {
    let mut mesh = block(SQUARE, &[HOLE], 4.0);
    let uvs: Vec<Vec<DVec2>> = mesh
        .faces
        .iter()
        .map(|f| f.corners().map(|c| mesh.positions[c as usize]).map(|p| DVec2::new(p.x + p.y, p.z)).collect())
        .collect();
    mesh.faces.iter_mut().zip(uvs).for_each(|(f, uv)| f.uvs.push((0, uv.into())));
    let normal = DVec3::new(0.4, 0.1, 0.8).normalize();
    let cut = cut(&mesh, &plane(normal, normal.dot(DVec3::new(5.0, 2.0, -5.0))));
    for piece in [&cut.behind, &cut.front] {
        for (face, origin) in piece.mesh.faces.iter().zip(&piece.origins) {
            let Some(uv) = face.uv(0) else {
                assert_eq!(*origin, Origin::Cap);
                continue;
            };
            for (c, uv) in face.corners().zip(uv) {
                let p = piece.mesh.positions[c as usize];
                assert!(uv.distance(DVec2::new(p.x + p.y, p.z)) < 1e-12);
            }
        }
    }
}

#[test]
fn a_step_keeps_its_tread_and_gets_a_cap_beside_it() {
    // An L standing up: tread at height 2, plane exactly there.
    let side: &[(f64, f64)] = &[(0.0, 0.0), (6.0, 0.0), (6.0, 2.0), (3.0, 2.0), (3.0, 5.0), (0.0, 5.0)];
    let mut mesh = block(side, &[], 4.0);
    mesh.positions.iter_mut().for_each(|p| *p = DVec3::new(p.x, -p.z, p.y));
    let cut = cut(&mesh, &plane(DVec3::Y, 2.0));
    assert!(is_closed(&cut.behind.mesh) && is_closed(&cut.front.mesh));
    assert!((volume(&cut.behind.mesh) - 48.0).abs() < 1e-12);
    assert!((volume(&cut.front.mesh) - 36.0).abs() < 1e-12);
    assert_eq!(cut.behind.origins.iter().filter(|&&o| o == Origin::Cap).count(), 1);
    clean(&cut.behind);
    clean(&cut.front);
}

#[test]
fn corners_that_touch_the_plane_do_not_cut() {
    // A W: the middle corner touches the plane from above, the notches from below.
    let w: &[(f64, f64)] = &[(0.0, 0.0), (8.0, 0.0), (8.0, 6.0), (6.0, 3.0), (4.0, 6.0), (2.0, 3.0), (0.0, 6.0)];
    for height in [1.0, 3.0, 4.5, 6.0] {
        let mesh = lot(w, &[]);
        let cut = cut(&mesh, &plane(DVec3::NEG_Z, height));
        let sum = surface_area(&cut.behind.mesh) + surface_area(&cut.front.mesh);
        assert!((sum - surface_area(&mesh)).abs() < 1e-12, "{height}");
        clean(&cut.behind);
        clean(&cut.front);
        assert_eq!(
            cut.front.mesh.faces.len(),
            if height == 1.0 {
                1
            } else if height < 6.0 {
                3
            } else {
                0
            }
        );
    }
}

#[test]
fn open_and_closed_parts_of_one_mesh_are_told_apart() {
    let mut mesh = block(SQUARE, &[], 4.0);
    let first = mesh.positions.len() as u32;
    mesh.positions.extend([DVec3::new(0.0, 0.0, 20.0), DVec3::new(10.0, 0.0, 20.0), DVec3::new(10.0, 9.0, 20.0)]);
    mesh.faces.push(Face::new(vec![first, first + 1, first + 2]));
    let cut = cut(&mesh, &plane(DVec3::X, 5.0));
    for piece in [cut.behind, cut.front] {
        let mut block = piece.mesh;
        let caps: Vec<usize> = (0..piece.origins.len()).filter(|&i| piece.origins[i] == Origin::Cap).collect();
        assert_eq!(caps.len(), 1);
        assert_eq!(block.area(&block.faces[caps[0]]), 40.0);
        let triangle = piece.origins.iter().position(|&o| o == Origin::Face(6)).expect("both pieces have a part of it");
        block.faces.remove(triangle);
        assert!(is_closed(&block));
    }
}

fn star(radii: &[f64], turn: f64) -> Vec<(f64, f64)> {
    let step = turn * std::f64::consts::TAU / radii.len() as f64;
    radii.iter().enumerate().map(|(i, r)| (r * libm::cos(step * i as f64), r * libm::sin(step * i as f64))).collect()
}

/// Rounded to quarters: then many corners lie exactly on the planes.
fn coarse(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.into_iter().map(|(x, y)| ((x * 4.0).round() / 4.0, (y * 4.0).round() / 4.0)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn slices_tile_a_block_with_a_hole(
        radii in prop::collection::vec(4.0f64..10.0, 6..16),
        inner in prop::collection::vec(0.5f64..2.0, 3..8),
        direction in prop::array::uniform3(-1.0f64..1.0),
        shares in prop::collection::vec(0.0f64..1.0, 1..6),
    ) {
        let normal = DVec3::from(direction);
        prop_assume!(normal.length() > 0.1);
        let normal = normal.normalize();
        let mesh = block(&star(&radii, 1.0), &[&star(&inner, -1.0)], 5.0);
        let heights: Vec<f64> = mesh.positions.iter().map(|p| p.dot(normal)).collect();
        let lo = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let hi = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut boundaries: Vec<f64> = shares.iter().map(|s| lo + (hi - lo) * s).collect();
        boundaries.sort_by(f64::total_cmp);
        let pieces = slice(&mesh, normal, &boundaries);
        prop_assert_eq!(pieces.len(), boundaries.len() + 1);
        let total: f64 = pieces.iter().map(|p| volume(&p.mesh)).sum();
        prop_assert!((total - volume(&mesh)).abs() < 1e-9 * volume(&mesh));
        for piece in pieces.iter().filter(|p| !p.is_empty()) {
            prop_assert!(is_closed(&piece.mesh));
        }
        let own = |p: &Piece| -> f64 { p.mesh.faces.iter().zip(&p.origins).filter(|(_, o)| **o != Origin::Cap).map(|(f, _)| p.mesh.area(f)).sum() };
        let skin: f64 = pieces.iter().map(own).sum();
        prop_assert!((skin - surface_area(&mesh)).abs() < 1e-9 * skin);
    }

    #[test]
    fn slices_through_corners_and_along_walls_tile_too(
        radii in prop::collection::vec(2.0f64..6.0, 5..16),
        boundaries in prop::collection::vec(-24i32..24, 1..8),
        axis in 0usize..2,
        start in 0usize..16,
    ) {
        let mut outline = coarse(star(&radii, 1.0));
        outline.dedup();
        let rings = outline.iter().map(|&(x, y)| DVec2::new(x, y)).collect::<Vec<_>>();
        let simple = crate::geometry::triangulate::triangulate_polygon(&Polygon { outer: rings.clone(), holes: Vec::new() }).len() + 2 == rings.len();
        prop_assume!(simple);
        let at = start % outline.len();
        outline.rotate_left(at);
        let mut boundaries: Vec<f64> = boundaries.iter().map(|&b| f64::from(b) / 4.0).collect();
        boundaries.sort_by(f64::total_cmp);
        let normal = [DVec3::X, DVec3::NEG_Z][axis];
        for mesh in [lot(&outline, &[]), block(&outline, &[], 2.0)] {
            let pieces = slice(&mesh, normal, &boundaries);
            let own = |p: &Piece| -> f64 { p.mesh.faces.iter().zip(&p.origins).filter(|(_, o)| **o != Origin::Cap).map(|(f, _)| p.mesh.area(f)).sum() };
            let skin: f64 = pieces.iter().map(own).sum();
            prop_assert!((skin - surface_area(&mesh)).abs() < 1e-9 * skin, "{skin} {}", surface_area(&mesh));
            if mesh.faces.len() > 1 {
                let total: f64 = pieces.iter().map(|p| volume(&p.mesh)).sum();
                prop_assert!((total - volume(&mesh)).abs() < 1e-9 * total);
                for piece in pieces.iter().filter(|p| !p.is_empty()) {
                    prop_assert!(is_closed(&piece.mesh));
                    prop_assert_eq!(faces_without_area(&piece.mesh), Vec::<usize>::new());
                    prop_assert_eq!(doubled_corners(&piece.mesh), Vec::<(usize, usize)>::new());
                }
            }
        }
    }
}

/// The stage cases of `../shared/hard-cases/stages.json`, each by its name.
mod stages {
    use super::*;
    use crate::geometry::hard_cases::footprint;

    fn lot_of(name: &str) -> Option<Mesh> {
        let mut mesh = Mesh::default();
        PlaneFrame::PLAN.push_face(&mut mesh, &footprint(name)?, 0.0);
        Some(mesh)
    }

    fn areas(pieces: &[Piece]) -> Vec<f64> {
        pieces.iter().map(|p| surface_area(&p.mesh)).collect()
    }

    #[test]
    fn split_polygon_hole() {
        let Some(mesh) = lot_of("annulus_offcentre") else { return };
        let (lo, hi) = mesh.bounds().expect("points");
        let boundaries: Vec<f64> = (1..).map(|k| lo.x + 2.0 * f64::from(k)).take_while(|&x| x < hi.x).collect();
        let pieces = slice(&mesh, DVec3::X, &boundaries);
        assert!((areas(&pieces).iter().sum::<f64>() - 245.0).abs() < 245e-9);
        for piece in &pieces {
            clean(piece);
            assert!(piece.mesh.faces.iter().all(|f| piece.mesh.area(f) > 1e-9));
        }
        // No T-vertices: what one piece has on a boundary its neighbour has too.
        for (k, x) in boundaries.iter().enumerate() {
            let on = |p: &Piece| -> std::collections::BTreeSet<u64> {
                p.mesh.positions.iter().filter(|q| q.x == *x).map(|q| q.z.to_bits()).collect()
            };
            assert_eq!(on(&pieces[k]), on(&pieces[k + 1]), "at {x}");
        }
    }

    #[test]
    fn split_along_edge() {
        let Some(mesh) = lot_of("plus_30") else { return };
        let pieces = slice(&mesh, DVec3::X, &[10.0, 20.0]);
        for (area, expected) in areas(&pieces).iter().zip([100.0, 300.0, 100.0]) {
            assert!((area - expected).abs() < 1e-9 * expected);
        }
        assert!(pieces.iter().all(|p| p.mesh.faces.len() == 1));
    }

    #[test]
    fn split_rotated_edge() {
        let Some(mut mesh) = lot_of("plus_30") else { return };
        let turn = glam::DMat3::from_rotation_y(1e-9);
        mesh.positions.iter_mut().for_each(|p| *p = turn * *p);
        let pieces = slice(&mesh, DVec3::X, &[10.0, 20.0]);
        for (area, expected) in areas(&pieces).iter().zip([100.0, 300.0, 100.0]) {
            assert!((area - expected).abs() < 1e-6 * expected);
        }
        assert!(pieces.iter().all(|p| p.mesh.faces.len() == 1));
    }

    #[test]
    fn split_commute() {
        let Some(mesh) = lot_of("random_star_500") else { return };
        let (lo, hi) = mesh.bounds().expect("points");
        let thirds = |from: f64, to: f64| -> Vec<f64> {
            (1..).map(|k| from + 3.0 * f64::from(k)).take_while(|&b| b < to).collect()
        };
        let (xs, zs) = (thirds(lo.x, hi.x), thirds(lo.z, hi.z));
        let grid = |first: (DVec3, &[f64]), second: (DVec3, &[f64])| -> Vec<f64> {
            let columns = slice(&mesh, first.0, first.1);
            let cells = columns.iter().flat_map(|c| slice(&c.mesh, second.0, second.1));
            let mut areas: Vec<f64> = cells.filter(|c| !c.is_empty()).map(|c| surface_area(&c.mesh)).collect();
            areas.sort_by(f64::total_cmp);
            areas
        };
        let (a, b) = (grid((DVec3::X, &xs), (DVec3::Z, &zs)), grid((DVec3::Z, &zs), (DVec3::X, &xs)));
        assert_eq!(a.len(), b.len());
        let total = surface_area(&mesh);
        assert!(a.iter().zip(&b).all(|(p, q)| (p - q).abs() < 1e-9 * total));
        assert!((a.iter().sum::<f64>() - total).abs() < 1e-9 * total);
    }
}
