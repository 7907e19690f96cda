//! The shipped rules for buildings follow the map's roof tags, and what they make is closed.

use super::*;
use crate::geometry::mesh_checks::bodies;

const RULES: [(&str, &str); 2] = [
    ("building", include_str!("../../../rules/building.cga")),
    ("residential", include_str!("../../../rules/residential.cga")),
];
/// 12 x 8, seen from above an L of two wings.
const ELL: &[(f64, f64)] = &[(0.0, 0.0), (12.0, 0.0), (12.0, -4.0), (5.0, -4.0), (5.0, -8.0), (0.0, -8.0)];

/// All leaves as one mesh, and the warnings about roofs.
fn house(rules: &str, outline: &[(f64, f64)], attributes: &[(&str, Scalar)]) -> (Mesh, Vec<&'static str>) {
    let mut start = start(ground(outline), 0);
    start.attributes = attributes.iter().map(|(name, value)| ((*name).into(), value.clone())).collect();
    let tree = derive(&compiled(rules), &start, &NoAssets, &Limits::default());
    let mut mesh = Mesh::default();
    for leaf in &tree.leaves {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(&leaf.mesh.positions);
        mesh.faces.extend(leaf.mesh.faces.iter().cloned().map(|mut face| {
            face.loops_mut().flatten().for_each(|v| *v += first);
            face
        }));
    }
    (mesh, tree.diagnostics.iter().map(|d| d.code).filter(|c| c.starts_with("cga::roof")).collect())
}

fn text(value: &str) -> Scalar {
    Scalar::String(value.into())
}

#[test]
fn every_mapped_shape_gives_a_closed_house_of_the_mapped_height() {
    let shapes = [
        "flat",
        "gabled",
        "hipped",
        "half-hipped",
        "pyramidal",
        "skillion",
        "gambrel",
        "mansard",
        "dome",
        "round",
        "saltbox",
    ];
    for (name, rules) in RULES {
        for shape in shapes {
            for outline in [SMALL, ELL] {
                let attributes =
                    [("height", Scalar::Float(9.0)), ("roofHeight", Scalar::Float(3.0)), ("roofShape", text(shape))];
                let (mesh, warnings) = house(rules, outline, &attributes);
                let found = bodies(&mesh);
                assert_eq!((found.closed, found.defects.len()), (1, 0), "{name} {shape}: {found:?}");
                let top = mesh.bounds().expect("a house").1.y;
                // A residential skillion is never steeper than 2.5 m.
                let expected = if name == "residential" && shape == "skillion" { 8.5 } else { 9.0 };
                assert!((top - expected).abs() < 1e-9, "{name} {shape}: {top}");
                let hip_instead = shape == "pyramidal" && outline.len() > 4;
                assert!(warnings.is_empty() || hip_instead, "{name} {shape}: {warnings:?}");
            }
        }
    }
}

#[test]
fn direction_and_orientation_of_the_map_turn_the_roof() {
    for (name, rules) in RULES {
        let ridge = |extra: &[(&str, Scalar)]| {
            let mut attributes = vec![("height", Scalar::Float(9.0)), ("roofHeight", Scalar::Float(3.0))];
            attributes.push(("roofShape", text("gabled")));
            attributes.extend_from_slice(extra);
            let (mesh, _) = house(rules, SMALL, &attributes);
            let top = mesh.positions.iter().filter(|p| p.y > 9.0 - 1e-6);
            let (low, high) = top.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
            high - low
        };
        assert!(ridge(&[]).z < 1e-6 && ridge(&[]).x > 9.9, "{name}");
        for turned in [("roofDirection", Scalar::Float(90.0)), ("roofOrientation", text("across"))] {
            let ridge = ridge(&[turned]);
            assert!(ridge.x < 1e-6 && (ridge.z - 6.0).abs() < 1e-6, "{name}: {ridge}");
        }
    }
}

#[test]
fn an_unknown_mapped_shape_is_flat_and_named() {
    for (name, rules) in RULES {
        let attributes =
            [("height", Scalar::Float(9.0)), ("roofHeight", Scalar::Float(3.0)), ("roofShape", text("tepee"))];
        let (mesh, warnings) = house(rules, SMALL, &attributes);
        assert_eq!(warnings, ["cga::roof-shape"], "{name}");
        assert_eq!(mesh.bounds().map(|b| b.1.y), Some(9.0), "{name}");
    }
}
