//! Whatever the shape: components come once each, selectors divide them, tags follow their faces.

use proptest::prelude::*;

use super::*;

/// A star-shaped lot, counter-clockwise seen from above.
fn lots() -> impl Strategy<Value = Vec<(f64, f64)>> {
    prop::collection::vec(2.0..20.0f64, 3..9).prop_map(|radii| {
        let n = radii.len() as f64;
        let corner = |(i, r): (usize, &f64)| {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * i as f64 / n);
            (r * cos, -r * sin)
        };
        radii.iter().enumerate().map(corner).collect()
    })
}

const BODIES: [&str; 4] = ["", "extrude(5)", "roofHip(35)", "offset(-0.5) extrude(2)"];

/// What a body makes, as one leaf.
fn whole(body: &str, lot: &[(f64, f64)]) -> ShapeTree {
    derived(&format!("Lot --> {body} A."), ground(lot))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn every_component_comes_once(lot in lots(), body in 0..BODIES.len()) {
        let body = BODIES[body];
        let tree = whole(body, &lot);
        let mesh = &tree.leaves[0].mesh;
        let corners: usize = mesh.faces.iter().map(|f| f.corners().count()).sum();
        let text = |query: &str| {
            let tree = derived(&format!("Lot --> {body} print({query}) NIL"), ground(&lot));
            tree.prints[0].parse::<usize>().expect("a number")
        };
        let expected = [
            ("f", mesh.faces.len()), ("e", text("geometry.nEdges")), ("fe", corners), ("v", text("geometry.nVertices")),
            ("fv", corners), ("g", 1), ("m", 1), ("h", text("geometry.nHoles")),
        ];
        for (component, count) in expected {
            for align in ["", ", noAlign"] {
                let rules = format!("Lot --> {body} comp({component}{align}) {{ all : print(comp.index + \" \" + comp.total) A. }}");
                let tree = derived(&rules, ground(&lot));
                prop_assert_eq!(tree.prints.len(), count, "{}", rules);
                for (i, line) in tree.prints.iter().enumerate() {
                    prop_assert_eq!(line, &format!("{i} {count}"));
                }
                let together = derived(&rules.replace("all :", "all ="), ground(&lot));
                prop_assert_eq!(together.prints.len(), usize::from(count > 0), "{}", rules);
            }
        }
    }

    #[test]
    fn selectors_divide_the_components(lot in lots(), body in 0..BODIES.len(), component in 0usize..5) {
        let body = BODIES[body];
        let component = ["f", "e", "fe", "v", "fv"][component];
        let count = |selectors: &str| {
            let tree = derived(&format!("Lot --> {body} comp({component}) {{ {selectors} }}"), ground(&lot));
            tree.leaves.len()
        };
        let all = count("all : A.");
        for parts in [
            ["border", "inside"], ["front || back || left || right", "top || bottom"], ["side", "horizontal"],
            ["top", "!top"], ["vertical || aslant || nutant", "horizontal"], ["world.side", "world.up || world.down"],
            ["comp.index % 2 == 0", "comp.index % 2 == 1"], ["0", "comp.index > 0"],
        ] {
            // Alone, and one after the other, the parts make up the whole; only what has no direction (the edge
            // between two opposite faces) may be in none.
            let [a, b] = parts.map(|part| count(&format!("{part} : A.")));
            prop_assert_eq!(count(&format!("{} : A. | {} : B.", parts[0], parts[1])), a + b, "{:?}", parts);
            prop_assert_eq!(count(&format!("{} : A. | all : B.", parts[0])), all);
            prop_assert!(a + b <= all);
            if component == "f" {
                prop_assert_eq!(a + b, all, "{:?} of {} {}", parts, component, body);
            }
        }
    }

    #[test]
    fn connected_parts_hold_every_face_once(lot in lots(), body in 0..BODIES.len()) {
        let body = BODIES[body];
        let faces = whole(body, &lot).leaves[0].mesh.faces.len();
        let rules = format!("Lot --> {body} comp(f) {{ side =: A. | all =: A. }}");
        let sum: usize = derived(&rules, ground(&lot)).leaves.iter().map(|l| l.mesh.faces.len()).sum();
        prop_assert_eq!(sum, faces);
    }

    /// Names given to the faces of a block are on the same areas after cuts and clean-up.
    #[test]
    fn tags_stay_on_their_faces(lot in lots(), size in 0.8..6.0f64) {
        let area = |middle: &str, query: &str| -> f64 {
            let rules = format!("Lot --> extrude(5) {middle}\nPiece --> comp(f) {{ isTagged(\"{query}\") : A. }}");
            areas(&derived(&rules, ground(&lot)), "A").iter().sum()
        };
        for query in ["extrude.top", "extrude.side", "extrude.bottom", "extrude"] {
            let cut = format!("split(x) {{ ~{size} : split(z) {{ ~{size} : cleanupGeometry(vertices, 0) split(y) {{ 1 : Piece | ~1 : Piece }} }}* }}*");
            let (before, after) = (area("Piece", query), area(&cut, query));
            prop_assert!((before - after).abs() < 1e-6 * before, "{query}: {before} {after}");
        }
    }

    /// A tag means the same whichever face comes first.
    #[test]
    fn tags_do_not_depend_on_the_order_of_faces(turned in 0u32..6) {
        let block = derived("Lot --> extrude(3) A.", ground(SMALL)).leaves[0].mesh.clone();
        let mut other = block.clone();
        other.faces.rotate_left(turned as usize);
        let rules = r#"Lot --> tag("rim", edges) comp(f) { top : tag("up") P | all : P }
P --> print(geometry.tags) extrude(1) comp(f) { isTagged("up") : U. | isTagged("rim") : R. | all : X. }"#;
        let sorted = |mesh: &Mesh| {
            let tree = derived(rules, mesh.clone());
            let mut prints = tree.prints.clone();
            prints.sort();
            (prints, ["U", "R", "X"].map(|rule| count(&tree, rule)))
        };
        prop_assert_eq!(sorted(&block), sorted(&other));
        prop_assert_eq!(sorted(&other).1, [2, 24, 10]);
    }
}
