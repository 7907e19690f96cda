//! `split(x | y | z)` (reference 4.3). In: a block of sizes. Out: pieces between parallel planes, closed meshes closed
//! again, with the scopes they get.

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::form::Form;
use super::super::limits::Outcome;
use super::super::shape::{Scope, Shape};
use super::{Pieces, split_pattern};
use crate::cga::program::{Axis, SplitBlock};
use crate::geometry::cut::{self, Origin};
use crate::source::Span;

/// Splits the current shape along an axis of its scope. Slabs without geometry give no piece (reference A11).
pub fn along_scope<'p>(
    run: &mut Derivation<'p>,
    axis: Axis,
    adjust: bool,
    block: &'p SplitBlock,
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let parent = env.shape.baked();
    let axis = axis_number(axis);
    let total = parent.scope.size[axis].abs();
    let layout = split_pattern::lay_out(run, block, total, span, env)?;
    let slabs: Vec<(f64, f64)> = layout.slabs.iter().map(|s| (s.start, s.end)).collect();
    let forms = cut_at(&parent, axis, &slabs);
    Ok(layout.pieces(forms, &parent, |i, form| piece(&parent, axis, slabs[i], form, adjust)))
}

/// Position of an axis in vectors.
pub fn axis_number(axis: Axis) -> usize {
    match axis {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
    }
}

/// The geometry of every slab (start and end in metres along the axis). What lies before the first slab goes to it, what lies behind the end of the scope to
/// the last one if that reaches the end.
pub fn cut_at(parent: &Shape, axis: usize, slabs: &[(f64, f64)]) -> Vec<Form> {
    let Some(last) = slabs.last() else { return Vec::new() };
    let size = parent.scope.size[axis];
    let normal = parent.scope.frame.axes.col(axis) * size.signum();
    let base = normal.dot(parent.scope.frame.origin);
    let reaches_end = last.1 >= size.abs();
    let inner = slabs.len() - usize::from(reaches_end);
    let boundaries: Vec<f64> = slabs[..inner].iter().map(|s| base + s.1).collect();
    if parent.form.mesh.faces.is_empty() {
        return cut_edges(&parent.form, normal, &boundaries, slabs.len());
    }
    if boundaries.is_empty() {
        return vec![(*parent.form).clone()];
    }
    let sliced = cut::slice(&parent.form.mesh, normal, &boundaries).into_iter().take(slabs.len());
    sliced
        .map(|piece| {
            let sources = piece.origins.into_iter().map(|origin| match origin {
                Origin::Face(face) => Some(face),
                Origin::Cap => None,
            });
            let form = parent.form.derived(piece.mesh, sources);
            if form.mesh.faces.is_empty() { Form::default() } else { form }
        })
        .collect()
}

/// Edge geometry: each edge is cut at the planes; points go where they lie.
fn cut_edges(form: &Form, normal: DVec3, boundaries: &[f64], pieces: usize) -> Vec<Form> {
    let mut out = vec![Form::default(); pieces];
    let at = |d: f64| boundaries.partition_point(|&b| b <= d);
    let positions = &form.mesh.positions;
    if form.edges.is_empty() {
        for (i, p) in positions.iter().enumerate() {
            if let Some(piece) = out.get_mut(at(normal.dot(*p))) {
                piece.mesh.positions.push(*p);
                piece.normals.extend(form.normals.get(i));
                if let Some(tags) = form.tags() {
                    let new = piece.mesh.positions.len() as u32 - 1;
                    piece.tags_mut().extend_vertex(new, tags.vertex(i as u32));
                }
            }
        }
        return out;
    }
    for (i, &[a, b]) in form.edges.iter().enumerate() {
        let (p, q) = (positions[a as usize], positions[b as usize]);
        let (dp, dq) = (normal.dot(p), normal.dot(q));
        let point = |d: f64| p + (q - p) * ((d - dp) / (dq - dp));
        for (k, piece) in out.iter_mut().enumerate() {
            let low = if k == 0 { f64::NEG_INFINITY } else { boundaries[k - 1] };
            let high = boundaries.get(k).copied().unwrap_or(f64::INFINITY);
            let (from, to) = (dp.clamp(low, high), dq.clamp(low, high));
            let inside = if dp == dq { at(dp) == k } else { from != to };
            if inside {
                let start = piece.mesh.positions.len() as u32;
                piece.mesh.positions.push(if from == dp { p } else { point(from) });
                piece.mesh.positions.push(if to == dq { q } else { point(to) });
                piece.edges.push([start, start + 1]);
                piece.normals.extend(form.normals.get(i));
                if let Some(tags) = form.tags() {
                    let own = piece.tags_mut();
                    own.extend_edge([start, start + 1], tags.edge([a, b]));
                    // Cut points are new vertices.
                    let ends = [(from == dp, start, a), (to == dq, start + 1, b)];
                    ends.iter().filter(|e| e.0).for_each(|&(_, new, old)| own.extend_vertex(new, tags.vertex(old)));
                }
            }
        }
    }
    out
}

/// The shape of a slab: fitted to its geometry, or (`noAdjust`) the slab of the parent's box. Signs of sizes stay.
pub fn piece(parent: &Shape, axis: usize, (start, end): (f64, f64), form: Form, adjust: bool) -> Box<Shape> {
    let mut scope = parent.scope;
    let sign = parent.scope.size[axis].signum();
    scope.frame.origin += scope.frame.axes.col(axis) * (start * sign);
    scope.size[axis] = (end - start) * sign;
    if adjust {
        scope =
            Scope::around(&form.mesh.positions, scope.frame.axes).map_or(scope, |fit| signed(fit, parent.scope.size));
    }
    parent.piece(form, scope)
}

/// The same box with the signs of other sizes.
fn signed(mut scope: Scope, signs: DVec3) -> Scope {
    for i in 0..3 {
        if signs[i] < 0.0 {
            scope.frame.origin += scope.frame.axes.col(i) * scope.size[i];
            scope.size[i] = -scope.size[i];
        }
    }
    scope
}
