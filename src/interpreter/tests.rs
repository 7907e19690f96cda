//! Rule texts derived end to end: the worked micro-tests of reference 10 and the facts of the compatibility notes.

mod along_uv;
mod component_properties;
mod components;
mod context;
mod dispatch;
mod edges;
mod editing;
mod expressions;
mod files;
mod flat;
mod found;
mod frames;
mod groups;
mod imports;
mod library;
mod limits;
mod mapped_roofs;
mod materials;
mod measures;
mod normals;
mod planar;
mod planar_properties;
mod properties;
mod random;
mod recomposition;
mod reports;
mod roofs;
mod scatter;
mod scenes;
mod selectors;
mod setbacks;
mod solids;
mod split_sizes;
mod split_uv;
mod splits;
mod stages;
mod strange_shapes;
mod surfaces;
mod tags;
mod transforms;
mod trims;
mod uv;

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::seed::Seed;
use super::tree::{Scalar, ShapeTree};
use super::{Limits, NoAssets, StartShape, derive};
use crate::cga::program::Program;
use crate::cga::{CompileOptions, compile_text};
use crate::geometry::{Mesh, PlaneFrame, Polygon};
use crate::source::SourceMap;

/// The test lot of reference 10: 20 x 10, its first edge to the south, at (100, 0, 200).
const LOT: &[(f64, f64)] = &[(100.0, 200.0), (120.0, 200.0), (120.0, 190.0), (100.0, 190.0)];
/// 10 x 6, edge 0 long, in front.
const SMALL: &[(f64, f64)] = &[(0.0, 0.0), (10.0, 0.0), (10.0, -6.0), (0.0, -6.0)];

/// A polygon on the ground from (x, z) corners, kept in the order given.
fn ground(corners: &[(f64, f64)]) -> Mesh {
    let outer = corners.iter().map(|&(x, z)| DVec2::new(x, -z)).collect();
    let mut mesh = Mesh::default();
    PlaneFrame::PLAN.push_face(&mut mesh, &Polygon { outer, holes: Vec::new() }, 0.0);
    mesh
}

#[track_caller]
fn compiled(rules: &str) -> Program {
    let mut sources = SourceMap::default();
    let (program, diagnostics) = compile_text("test.cga", rules, &mut sources, &CompileOptions::default());
    let messages: Vec<&str> = diagnostics.iter().map(|d| d.message.as_str()).collect();
    program.unwrap_or_else(|| panic!("{rules}\n{messages:?}"))
}

fn start(mesh: Mesh, seed: u64) -> StartShape {
    StartShape::new(mesh, Seed::root(seed), "test")
}

#[track_caller]
fn derived(rules: &str, mesh: Mesh) -> ShapeTree {
    derive(&compiled(rules), &start(mesh, 0), &NoAssets, &Limits::default())
}

/// Derives rules that must run without any message.
#[track_caller]
fn run(rules: &str, corners: &[(f64, f64)]) -> ShapeTree {
    let tree = derived(rules, ground(corners));
    let messages: Vec<&str> = tree.diagnostics.iter().map(|d| d.message.as_str()).collect();
    assert!(messages.is_empty(), "{rules}\n{messages:?}");
    tree
}

/// The numbers printed, line by line (`a b c`).
#[track_caller]
fn numbers(tree: &ShapeTree) -> Vec<Vec<f64>> {
    let line = |l: &String| l.split_whitespace().map(|w| w.parse().expect("numbers were printed")).collect();
    tree.prints.iter().map(line).collect()
}

#[track_caller]
fn near(got: &[f64], expected: &[f64]) {
    let same = got.len() == expected.len() && got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(same, "{got:?}, not {expected:?}");
}

/// Prints scope translation, rotation and size, pivot position and orientation.
const SHOW: &str = r#"
Show --> print(scope.tx + " " + scope.ty + " " + scope.tz + " " + scope.rx + " " + scope.ry + " " + scope.rz
  + " " + scope.sx + " " + scope.sy + " " + scope.sz + " " + pivot.px + " " + pivot.py + " " + pivot.pz
  + " " + pivot.ox + " " + pivot.oy + " " + pivot.oz) NIL
"#;

/// What `Show` printed.
struct Shown {
    t: [f64; 3],
    r: [f64; 3],
    s: [f64; 3],
    p: [f64; 3],
    o: [f64; 3],
}

/// Runs `Lot --> body` on the test lot; `body` calls `Show` once.
#[track_caller]
fn show(body: &str) -> Shown {
    show_on(body, LOT)
}

#[track_caller]
fn show_on(body: &str, corners: &[(f64, f64)]) -> Shown {
    let tree = run(&format!("Lot --> {body}\n{SHOW}"), corners);
    let lines = numbers(&tree);
    assert_eq!(lines.len(), 1, "{body}: {:?}", tree.prints);
    let part = |i: usize| [lines[0][i], lines[0][i + 1], lines[0][i + 2]];
    Shown { t: part(0), r: part(3), s: part(6), p: part(9), o: part(12) }
}

/// Areas of the leaves of a rule, in order.
fn areas(tree: &ShapeTree, rule: &str) -> Vec<f64> {
    let own = tree.leaves.iter().filter(|leaf| &*leaf.rule == rule);
    own.map(|leaf| leaf.mesh.faces.iter().map(|f| leaf.mesh.area(f)).sum()).collect()
}

fn count(tree: &ShapeTree, rule: &str) -> usize {
    tree.leaves.iter().filter(|leaf| &*leaf.rule == rule).count()
}
