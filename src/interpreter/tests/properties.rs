//! Whatever the lot, pieces tile their parent and every face comes once.

use super::*;
use proptest::prelude::*;

/// A star-shaped lot, counter-clockwise seen from above.
fn lots() -> impl Strategy<Value = Vec<(f64, f64)>> {
    (prop::collection::vec(2.0..20.0f64, 3..9), -500.0..500.0f64, -500.0..500.0f64).prop_map(|(radii, x, z)| {
        let n = radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
            (x + r * cos, z - r * sin)
        };
        radii.iter().enumerate().map(corner).collect()
    })
}

fn volume(mesh: &Mesh) -> f64 {
    let mut near = mesh.clone();
    let origin = mesh.positions[0];
    near.positions.iter_mut().for_each(|p| *p -= origin);
    crate::geometry::mesh_checks::volume(&near)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn pieces_fill_the_parent(lot in lots(), size in 0.7..9.0f64) {
        let rules = format!("Lot --> extrude(7) Whole. split(x) {{ ~{size} : split(z) {{ 1.5 : Piece. | ~1 : Piece. }} | '0.1 : Piece. }}*");
        let tree = derived(&rules, ground(&lot));
        let sum: f64 = tree.leaves[1..].iter().map(|l| volume(&l.mesh)).sum();
        let whole = volume(&tree.leaves[0].mesh);
        prop_assert!((sum - whole).abs() < 1e-6 * whole, "{sum} of {whole}");
    }

    #[test]
    fn every_face_comes_once(lot in lots()) {
        let rules = "Lot --> extrude(7) comp(f) { front : F. | left : F. | geometry.area > 20 : F. | side : F. | horizontal : F. | all : F. }";
        let tree = derived(rules, ground(&lot));
        let whole = derived("Lot --> extrude(7)", ground(&lot));
        prop_assert_eq!(tree.leaves.len(), whole.leaves[0].mesh.faces.len());
        let sum: f64 = areas(&tree, "F").iter().sum();
        prop_assert!((sum - areas(&whole, "Lot")[0]).abs() < 1e-6 * sum);
    }

    #[test]
    fn strips_and_remainder_fill_the_lot(lot in lots(), distance in 0.1..6.0f64) {
        let rules = format!("Lot --> setback({distance}) {{ all : Piece. | remainder : Piece. }}");
        let tree = derived(&rules, ground(&lot));
        let sum: f64 = areas(&tree, "Piece").iter().sum();
        let whole = areas(&derived("Lot --> A.", ground(&lot)), "A")[0];
        prop_assert!((sum - whole).abs() < 1e-6 * whole, "{sum} of {whole}");
    }

    #[test]
    fn moving_the_lot_moves_the_result(lot in lots()) {
        let rules = "Lot --> extrude(4) comp(f) { top : roofHip(30) Roof. | side : split(x) { ~2 : W. }* }";
        let moved: Vec<(f64, f64)> = lot.iter().map(|&(x, z)| (x + 64.0, z - 32.0)).collect();
        let (a, b) = (derived(rules, ground(&lot)), derived(rules, ground(&moved)));
        prop_assert_eq!(a.leaves.len(), b.leaves.len());
        for (p, q) in a.leaves.iter().zip(&b.leaves) {
            prop_assert_eq!(&p.rule, &q.rule);
            for (u, v) in p.mesh.positions.iter().zip(&q.mesh.positions) {
                prop_assert!((*u + DVec3::new(64.0, 0.0, -32.0)).distance(*v) < 1e-6);
            }
        }
    }
}
