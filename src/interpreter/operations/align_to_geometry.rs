//! `alignScopeToGeometry` (reference 4.7; compatibility notes). In: which axis is up, a face, an edge. Out: pivot and
//! scope along them, fitted around geometry that stays.

use glam::{DMat3, DVec3};

use super::super::derivation::Derivation;
use super::super::placement::{Frame, perpendicular};
use super::super::shape::{Scope, Shape};
use super::args::Args;
use crate::cga::builtins::Word;
use crate::geometry::Mesh;

/// Sizes and heights this near are equal (metres); the first of equals is taken.
const EQUAL: f64 = 1e-6;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    shape.bake();
    let mesh = &shape.form.mesh;
    if mesh.faces.is_empty() {
        return;
    }
    let edge_word = if args.word(1) == Some(Word::Auto) { Some(Word::WorldLowest) } else { args.word(2) };
    let edge_index = args.float(run, 2);
    let (face, edge) = match (args.word(1), args.float(run, 1)) {
        (Some(Word::Any | Word::Auto), _) => edge_of_all(mesh, edge_word),
        (Some(Word::Largest), _) => in_face(mesh, largest_face(mesh), edge_word, edge_index),
        (Some(_), _) => in_face(mesh, lowest_face(mesh), edge_word, edge_index),
        (None, index) => in_face(mesh, wrapped(index.unwrap_or(0.0), mesh.faces.len()), edge_word, edge_index),
    };
    let Some((from, to)) = mesh.faces[face].edges().nth(edge) else { return };
    let origin = mesh.positions[from as usize];
    let normal = mesh.normal(&mesh.faces[face]);
    let up = if normal == DVec3::ZERO { shape.scope.frame.axes.y_axis } else { normal };
    let x = perpendicular(up, mesh.positions[to as usize] - origin, shape.scope.frame.axes.x_axis);
    let axes = match args.word(0) {
        Some(Word::ZUp) => DMat3::from_cols(x, up.cross(x), up),
        _ => DMat3::from_cols(x, up, x.cross(up)),
    };
    shape.pivot = Frame { origin, axes };
    shape.scope = Scope::around(&mesh.positions, axes).unwrap_or(shape.scope);
    shape.binding = shape.scope;
}

fn wrapped(index: f64, count: usize) -> usize {
    (libm::rint(index).rem_euclid(count as f64) as usize).min(count - 1)
}

fn in_face(mesh: &Mesh, face: usize, word: Option<Word>, index: Option<f64>) -> (usize, usize) {
    let edges: Vec<(u32, u32)> = mesh.faces[face].edges().collect();
    let edge = match (word, index) {
        (Some(Word::WorldLowest), _) => lowest(edges.iter().map(|&e| measured(mesh, e))),
        (Some(_), _) => longest(edges.iter().map(|&e| measured(mesh, e))),
        (None, index) => wrapped(index.unwrap_or(0.0), edges.len().max(1)),
    };
    (face, edge)
}

/// The face and edge of the extreme edge of all faces.
fn edge_of_all(mesh: &Mesh, word: Option<Word>) -> (usize, usize) {
    let places: Vec<(usize, usize, (u32, u32))> = mesh
        .faces
        .iter()
        .enumerate()
        .flat_map(|(f, face)| face.edges().enumerate().map(move |(e, ends)| (f, e, ends)))
        .collect();
    let measures = places.iter().map(|p| measured(mesh, p.2));
    let best = if word == Some(Word::WorldLowest) { lowest(measures) } else { longest(measures) };
    places.get(best).map_or((0, 0), |p| (p.0, p.1))
}

/// Mean height and length of an edge.
fn measured(mesh: &Mesh, (a, b): (u32, u32)) -> (f64, f64) {
    let (a, b) = (mesh.positions[a as usize], mesh.positions[b as usize]);
    ((a.y + b.y) / 2.0, a.distance(b))
}

/// First of the longest.
fn longest(edges: impl Iterator<Item = (f64, f64)>) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for (i, (_, length)) in edges.enumerate() {
        if length > best.1 + EQUAL {
            best = (i, length);
        }
    }
    best.0
}

/// First of the lowest; if all are level, the longest.
fn lowest(edges: impl Iterator<Item = (f64, f64)>) -> usize {
    let edges: Vec<(f64, f64)> = edges.collect();
    let low = edges.iter().map(|e| e.0).fold(f64::INFINITY, f64::min);
    let high = edges.iter().map(|e| e.0).fold(f64::NEG_INFINITY, f64::max);
    if high - low <= EQUAL {
        return longest(edges.into_iter());
    }
    edges.iter().position(|e| e.0 <= low + EQUAL).unwrap_or(0)
}

fn largest_face(mesh: &Mesh) -> usize {
    let mut best = (0, 0.0);
    for (i, face) in mesh.faces.iter().enumerate() {
        let area = mesh.area(face);
        if area > best.1 + EQUAL {
            best = (i, area);
        }
    }
    best.0
}

fn lowest_face(mesh: &Mesh) -> usize {
    let height = |face: &crate::geometry::Face| {
        let sum: f64 = face.outer.iter().map(|&v| mesh.positions[v as usize].y).sum();
        sum / face.outer.len().max(1) as f64
    };
    let mut best = (0, f64::INFINITY);
    for (i, face) in mesh.faces.iter().enumerate() {
        let y = height(face);
        if y < best.1 - EQUAL {
            best = (i, y);
        }
    }
    best.0
}
