//! In: bytes. Out: nothing, or a panic where a derivation breaks its word.

use arbitrary::{Result, Unstructured};
use glam::DVec3;

use crate::cga::{CompileOptions, compile_text};
use crate::diagnostics::render;
use crate::geometry::{Face, Mesh};
use crate::interpreter::seed::Seed;
use crate::interpreter::{Limits, NoAssets, StartShape, derive};
use crate::source::SourceMap;
use crate::text::SHOWN;

/// Corners of start shapes, counter-clockwise seen from above.
const OUTLINES: &[&[(f64, f64)]] = &[
    &[(0.0, 0.0), (20.0, 0.0), (20.0, 10.0), (0.0, 10.0)],
    &[(0.0, 0.0), (20.0, 0.0), (20.0, 8.0), (9.0, 8.0), (9.0, 15.0), (0.0, 15.0)],
    &[(0.0, 0.0), (7.0, 1.0), (9.0, 6.0), (3.0, 9.0), (-2.0, 4.0)],
    &[(0.0, 0.0), (5.0, 0.0), (5.0, 0.0), (2.0, 4.0)],
];

pub fn limits() -> Limits {
    Limits {
        max_depth: 40,
        max_shapes: 400,
        max_pending: 300,
        max_vertices: 4_000,
        max_expression_depth: 60,
        max_array: 500,
        max_text: 4096,
        ..Limits::default()
    }
}

/// Compiles and derives `program`: no panic, finite coordinates, indices in range, every message can be shown.
pub fn evaluate(program: &str, bytes: &mut Unstructured<'_>) -> Result<()> {
    let mut sources = SourceMap::default();
    let (compiled, diagnostics) = compile_text("fuzz.cga", program, &mut sources, &CompileOptions::default());
    for diagnostic in diagnostics.iter().take(SHOWN) {
        assert!(!render(diagnostic, &sources, false).is_empty());
    }
    let Some(compiled) = compiled else { return Ok(()) };
    let outline = *bytes.choose(OUTLINES)?;
    let positions = outline.iter().map(|&(x, y)| DVec3::new(x, 0.0, -y)).collect();
    let face = Face::new((0..outline.len() as u32).collect::<Vec<_>>());
    let mesh = Mesh { positions, faces: vec![face] };
    let start = StartShape::new(mesh, Seed::root(u64::from(bytes.int_in_range(0..=3u8)?)), "fuzz");
    let tree = derive(&compiled, &start, &NoAssets, &limits());
    for diagnostic in tree.diagnostics.iter().take(SHOWN) {
        assert!(!render(diagnostic, &sources, false).is_empty());
    }
    for leaf in &tree.leaves {
        let mesh = &leaf.mesh;
        assert!(mesh.positions.iter().all(|p| p.is_finite()), "a coordinate of {} is not finite\n{program}", leaf.rule);
        for face in &mesh.faces {
            let in_range = face.corners().all(|corner| (corner as usize) < mesh.positions.len());
            assert!(in_range, "an index of {} is out of range\n{program}", leaf.rule);
            let corners = face.corners().count();
            for (set, uvs) in &face.uvs {
                assert_eq!(uvs.len(), corners, "uv set {set} of {}\n{program}", leaf.rule);
                assert!(uvs.iter().all(|uv| uv.is_finite()), "a uv of {} is not finite\n{program}", leaf.rule);
            }
        }
    }
    Ok(())
}
