//! Sides of faces in texture space (reference 4.5.1). In: face edges and a texture set. Out: what the selectors
//! `uv.left`, `uv.right`, `uv.bottom`, `uv.top`, `uv.uMin`, `uv.uMax`, `uv.vMin` and `uv.vMax` ask for.

use glam::DVec2;

use super::super::environment::UvSide;
use super::components::Components;
use crate::cga::builtins::Word;
use crate::cga::program::{Expr, ExprKind};
use crate::geometry::Mesh;
use crate::geometry::polygon::signed_area;

/// Coordinates within this share of the range are equal.
const EQUAL: f64 = 1e-9;
/// Ties at 45 degrees go to left and right.
const TIE: f64 = 1e-6;

/// Whether a test asks for a side in texture space.
pub fn mentioned(test: &Expr) -> bool {
    match &test.kind {
        ExprKind::Selector(word) => matches!(
            word,
            Word::UvLeft
                | Word::UvRight
                | Word::UvBottom
                | Word::UvTop
                | Word::UvUMin
                | Word::UvUMax
                | Word::UvVMin
                | Word::UvVMax
        ),
        ExprKind::Unary(_, inner) => mentioned(inner),
        ExprKind::Binary(_, a, b) => mentioned(a) || mentioned(b),
        _ => false,
    }
}

/// Notes the sides on all face edges; false if some face has no coordinates in the set.
pub fn mark(components: &mut Components, mesh: &Mesh, set: u8) -> bool {
    let mut range: Option<(DVec2, DVec2)> = None;
    for p in mesh.faces.iter().filter_map(|face| face.uv(set)).flatten() {
        range = Some(range.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))));
    }
    let Some((low, high)) = range else { return false };
    let near = (high - low) * EQUAL;
    let mut complete = true;
    let mut edge = 0;
    for face in &mesh.faces {
        let Some(uv) = face.uv(set) else {
            complete = false;
            edge += face.edges().count();
            continue;
        };
        // The outer loop runs clockwise where the texture is mirrored.
        let turn = signed_area(&uv[..face.outer.len()]).signum();
        let mut start = 0;
        for length in face.loops().map(|ring| ring.len()) {
            for i in 0..length {
                let (a, b) = (uv[start + i], uv[start + (i + 1) % length]);
                let at = |value: f64, x: f64, y: f64, near: f64| (x - value).abs() <= near && (y - value).abs() <= near;
                let side = UvSide {
                    outward: -(b - a).perp() * turn,
                    u_min: at(low.x, a.x, b.x, near.x),
                    u_max: at(high.x, a.x, b.x, near.x),
                    v_min: at(low.y, a.y, b.y, near.y),
                    v_max: at(high.y, a.y, b.y, near.y),
                };
                components.set_uv_side(edge, side);
                edge += 1;
            }
            start += length;
        }
    }
    complete
}

/// Whether a side is the one a word asks for; `None` if the word asks for none.
pub fn agrees(word: Word, side: &UvSide) -> Option<bool> {
    let d = side.outward;
    let sideways = d.x.abs() >= d.y.abs() - TIE * d.length() && d != DVec2::ZERO;
    let upright = !sideways && d != DVec2::ZERO;
    Some(match word {
        Word::UvLeft => sideways && d.x < 0.0,
        Word::UvRight => sideways && d.x > 0.0,
        Word::UvBottom => upright && d.y < 0.0,
        Word::UvTop => upright && d.y > 0.0,
        Word::UvUMin => side.u_min,
        Word::UvUMax => side.u_max,
        Word::UvVMin => side.v_min,
        Word::UvVMax => side.v_max,
        _ => return None,
    })
}
