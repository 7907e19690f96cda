//! Tags on the edges of set-back pieces (reference 4.5.1, 4.15.3). In: the outline, what was cut from it and how far.
//! Out: `setback.front`, `setback.back`, `setback.side`, `setback.remainder` on the piece's edges.

use glam::DVec3;

use super::super::form::Form;
use crate::geometry::{Face, Mesh};

/// Share of an outline's extent within which lines are the same.
const NEAR: f64 = 1e-6;

/// One edge of the outline.
struct Line {
    from: DVec3,
    to: DVec3,
    /// Unit vector into the face.
    inwards: DVec3,
    distance: f64,
}

impl Line {
    fn contains(&self, p: DVec3, near: f64) -> bool {
        let along = self.to - self.from;
        let length = along.length_squared();
        let share = if length == 0.0 { 0.0 } else { ((p - self.from).dot(along) / length).clamp(0.0, 1.0) };
        (self.from + along * share).distance(p) <= near
    }
}

/// What was cut from the outline.
#[derive(Clone, Copy)]
pub enum Cuts<'a> {
    /// How far each face edge was set back, 0 where it stayed.
    Edges(&'a [f64]),
    /// Stretches of edges.
    Stretches(&'a [Stretch]),
}

/// Part of an edge of a face that was set back.
pub struct Stretch {
    pub face: usize,
    pub ends: [DVec3; 2],
    pub distance: f64,
}

/// Tags the edges of a piece. `sources` is the outline's face of every face of the piece, `is_remainder` whether the
/// piece is what was left.
pub fn mark(outline: &Form, piece: &mut Form, sources: &[usize], cuts: Cuts, is_remainder: bool) {
    let mut names = Vec::new();
    for (face, &source) in piece.mesh.faces.iter().zip(sources) {
        let (lines, near) = lines(&outline.mesh, source, cuts);
        for (a, b) in face.edges() {
            let ends = [a, b].map(|v| piece.mesh.positions[v as usize]);
            names.push(([a, b], name(&lines, ends, near, is_remainder)));
        }
    }
    piece.auto_tag_edges("setback", names);
}

fn lines(mesh: &Mesh, number: usize, cuts: Cuts) -> (Vec<Line>, f64) {
    let face: &Face = &mesh.faces[number];
    let before: usize = mesh.faces[..number].iter().map(|f| f.edges().count()).sum();
    let normal = mesh.normal(face);
    let at = |v: u32| mesh.positions[v as usize];
    let line = |from: DVec3, to: DVec3, distance: f64| {
        let inwards = normal.cross(to - from).normalize_or_zero();
        Line { from, to, inwards, distance }
    };
    let mut lines: Vec<Line> = Vec::new();
    if let Cuts::Stretches(list) = cuts {
        let own = list.iter().filter(|stretch| stretch.face == number);
        lines.extend(own.map(|stretch| line(stretch.ends[0], stretch.ends[1], stretch.distance)));
    }
    for (i, (a, b)) in face.edges().enumerate() {
        let distance = match cuts {
            Cuts::Edges(distances) => distances.get(before + i).copied().unwrap_or(0.0),
            Cuts::Stretches(_) => 0.0,
        };
        lines.push(line(at(a), at(b), distance));
    }
    let extent =
        lines.first().map_or(0.0, |first| lines.iter().map(|l| l.from.distance(first.from)).fold(0.0, f64::max));
    (lines, NEAR * extent)
}

fn name(lines: &[Line], [p, q]: [DVec3; 2], near: f64, is_remainder: bool) -> &'static str {
    if let Some(line) = lines.iter().find(|l| l.contains(p, near) && l.contains(q, near)) {
        return match (line.distance > 0.0, is_remainder) {
            (true, _) => "setback.front",
            (false, true) => "setback.remainder",
            (false, false) => "setback.side",
        };
    }
    let at_distance = |l: &Line, p: DVec3| ((p - l.from).dot(l.inwards) - l.distance).abs() <= near;
    let moved = |l: &&Line| l.distance > 0.0 && at_distance(l, p) && at_distance(l, q);
    if lines.iter().any(|l| moved(&l)) { "setback.back" } else { "setback.side" }
}
