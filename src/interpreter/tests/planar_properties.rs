//! Whatever the lot: planar operations lose no area, hit the areas they were asked for, and keep points inside.

use super::*;
use proptest::prelude::*;

/// A star-shaped lot around (x, z), counter-clockwise seen from above.
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

fn sum(tree: &ShapeTree, rule: &str) -> f64 {
    areas(tree, rule).iter().sum()
}

fn whole(lot: &[(f64, f64)]) -> f64 {
    sum(&derived("Lot --> A.", ground(lot)), "A")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn strips_of_any_depth_and_the_rest_fill_the_lot(lot in lots(), depths in prop::collection::vec(0.0..6.0f64, 8)) {
        let list = depths.iter().map(f64::to_string).collect::<Vec<_>>().join(", ");
        let rules = format!("Lot --> setback([{list}]) {{ comp.index % 2 == 0 : P. | front : P. | remainder : P. }}");
        let area = sum(&derived(&rules, ground(&lot)), "P");
        prop_assert!((area - whole(&lot)).abs() < 1e-6 * area, "{area} of {}", whole(&lot));
    }

    #[test]
    fn the_remainder_has_the_area(lot in lots(), share in 0.05..0.95f64) {
        let wanted = share * whole(&lot);
        let rules = format!("Lot --> setbackToArea({wanted}) {{ all = A. | remainder = B. }}");
        let tree = derived(&rules, ground(&lot));
        prop_assert!(tree.diagnostics.is_empty());
        prop_assert!((sum(&tree, "B") - wanted).abs() < 1e-6 * wanted, "{} of {wanted}", sum(&tree, "B"));
    }

    #[test]
    fn areas_of_a_split_are_those_asked_for(lot in lots(), weights in prop::collection::vec(0.1..3.0f64, 1..6)) {
        let blocks = weights.iter().map(|w| format!("~{w} : A.")).collect::<Vec<_>>().join(" | ");
        let tree = derived(&format!("Lot --> splitArea(z) {{ {blocks} }}"), ground(&lot));
        let all: f64 = weights.iter().sum();
        let area = whole(&lot);
        let got = areas(&tree, "A");
        prop_assert_eq!(got.len(), weights.len());
        for (got, weight) in got.iter().zip(&weights) {
            prop_assert!((got - weight / all * area).abs() < 1e-6 * area, "{got} for {weight} of {all} x {area}");
        }
    }

    #[test]
    fn slabs_abut(lot in lots(), size in 0.7..9.0f64) {
        let rules = format!(r#"Lot --> print(scope.sx) extrude(2) split(x, noAdjust) {{ ~{size} : P | 0.5 : P }}*
P --> print(scope.tx + " " + scope.sx + " " + scope.sy + " " + scope.sz) NIL"#);
        let lines = numbers(&derived(&rules, ground(&lot)));
        let mut end = lines[1][0];
        for line in &lines[1..] {
            prop_assert!((line[0] - end).abs() < 1e-9, "{line:?} {end}");
            prop_assert_eq!(&line[2..], &lines[1][2..]);
            end = line[0] + line[1];
        }
        prop_assert!((end - lines[1][0] - lines[0][0]).abs() < 1e-6);
    }

    #[test]
    fn sections_and_the_rest_fill_the_lot(lot in lots(), length in 1.0..20.0f64, depth in 0.2..5.0f64, offset in -30.0..30.0f64) {
        let same = format!("Lot --> splitAndSetbackPerimeter({offset}) {{ ~{length} : {depth} : A. }}* {{ remainder : R. }}");
        let tree = derived(&same, ground(&lot));
        let area = whole(&lot);
        prop_assert!((sum(&tree, "A") + sum(&tree, "R") - area).abs() < 1e-6 * area, "{} {}", sum(&tree, "A"), sum(&tree, "R"));
        // All of one depth: together the strip of a setback.
        let strip = sum(&derived(&format!("Lot --> setback({depth}) {{ all = A. }}"), ground(&lot)), "A");
        prop_assert!((sum(&tree, "A") - strip).abs() < 1e-5 * area, "{} of {strip}", sum(&tree, "A"));
        let mixed = format!(
            "Lot --> splitAndSetbackPerimeter({offset}) {{ {{ ~{length} : {depth} : A. | 2 : 1 : A. | 0.5 : 0 : NIL }}* }} {{ remainder : A. }}"
        );
        let mixed = derived(&mixed, ground(&lot));
        prop_assert!((sum(&mixed, "A") - area).abs() < 1e-6 * area, "{} of {area}", sum(&mixed, "A"));
    }

    #[test]
    fn rectangles_and_the_rest_fill_the_lot(lot in lots()) {
        let tree = derived("Lot --> innerRectangle(edge) { shape : A. | remainder : B. }", ground(&lot));
        let area = whole(&lot);
        prop_assert!((sum(&tree, "A") + sum(&tree, "B") - area).abs() < 1e-5 * area);
        prop_assert!(sum(&tree, "A") > 0.25 * area, "{} of {area}", sum(&tree, "A"));
    }

    #[test]
    fn scattered_points_lie_on_the_lot(lot in lots(), seed in 0u64..1000) {
        let polygon = Polygon { outer: lot.iter().map(|&(x, z)| DVec2::new(x, -z)).collect(), holes: Vec::new() };
        for kind in ["uniform", "gaussian"] {
            let program = compiled(&format!("Lot --> scatter(surface, 30, {kind}) {{ A. }}"));
            let derive = || derive(&program, &start(ground(&lot), seed), &NoAssets, &Limits::default());
            let (tree, again) = (derive(), derive());
            prop_assert_eq!(tree.leaves.len(), 30);
            for (leaf, other) in tree.leaves.iter().zip(&again.leaves) {
                let p = leaf.mesh.positions[0];
                prop_assert_eq!(p, other.mesh.positions[0]);
                prop_assert!(p.y == 0.0 && polygon.contains(DVec2::new(p.x, -p.z)), "{p}");
            }
        }
    }

    #[test]
    fn pieces_between_lines_of_u_fill_the_surface(lot in lots(), size in 0.5..6.0f64) {
        let rules = format!(
            "Lot --> extrude(5) setupProjection(0, world.xz, 1, 1, 0, 0, 0.5) projectUV(0) Whole. \
             split(u, uvSpace, 0) {{ ~{size} : P. | 0.2 : P. }}*"
        );
        let tree = derived(&rules, ground(&lot));
        let (pieces, all) = (sum(&tree, "P"), sum(&tree, "Whole"));
        prop_assert!((pieces - all).abs() < 1e-6 * all, "{pieces} of {all}");
    }
}
