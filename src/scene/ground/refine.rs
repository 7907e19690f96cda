//! In: a triangulation and the terrain's posts. Out: the same with posts added until the tolerance is met.
//!
//! In every round the worst post of each triangle is inserted if it is off by more than the tolerance (the parallel
//! form of greedy insertion: Garland and Heckbert, "Fast polygonal approximation of terrains", 1995, section 4.4).
//! Ties go to the lower index, so the mesh is reproducible.

use spade::{HasPosition as _, PositionInTriangulation, Triangulation as _};

use super::GroundError;
use super::triangulation::{Triangulation, Vertex};

/// Of many posts a share of this size is tried first, then four times as many, and so on: most of a fine raster's
/// posts are then looked at only a few times.
const FIRST_SHARE: usize = 4096;

/// Adds posts; gives the greatest vertical distance left at any post, metres.
pub(super) fn refine(
    triangulation: &mut Triangulation,
    posts: &[Vertex],
    tolerance_m: f64,
) -> Result<f64, GroundError> {
    let mut stride = 1;
    while posts.len() / stride > FIRST_SHARE {
        stride *= 4;
    }
    loop {
        let worst = worst_per_triangle(triangulation, posts, stride);
        let greatest = worst.iter().map(|w| w.error).fold(0.0, f64::max);
        let mut off: Vec<usize> = worst.iter().filter(|w| w.error > tolerance_m).map(|w| w.post).collect();
        if off.is_empty() && stride == 1 {
            return Ok(greatest);
        } else if off.is_empty() {
            stride /= 4;
        }
        off.sort_unstable();
        for post in off {
            triangulation.insert(posts[post]).expect("lattice coordinates are finite");
        }
    }
}

#[derive(Clone, Copy)]
struct Worst {
    error: f64,
    post: usize,
}

/// The worst post of every triangle, of every `stride`th post.
fn worst_per_triangle(triangulation: &Triangulation, posts: &[Vertex], stride: usize) -> Vec<Worst> {
    let mut worst = vec![Worst { error: 0.0, post: 0 }; triangulation.num_all_faces()];
    let mut hint = None;
    for (index, post) in posts.iter().enumerate().step_by(stride) {
        let place = match hint {
            Some(hint) => triangulation.locate_with_hint(post.position(), hint),
            None => triangulation.locate(post.position()),
        };
        let face = match place {
            PositionInTriangulation::OnFace(face) => triangulation.face(face),
            PositionInTriangulation::OnEdge(edge) => {
                let edge = triangulation.directed_edge(edge);
                match edge.face().as_inner().or_else(|| edge.rev().face().as_inner()) {
                    Some(face) => face,
                    None => continue,
                }
            }
            _ => continue,
        };
        let corners = face.vertices();
        hint = Some(corners[0].fix());
        let error = (height_in(corners.map(|v| *v.data()), post) - post.height).abs();
        let slot = &mut worst[face.index()];
        if error > slot.error {
            *slot = Worst { error, post: index };
        }
    }
    worst
}

/// Height of the plane through three vertices at a post's place.
fn height_in([a, b, c]: [Vertex; 3], post: &Vertex) -> f64 {
    let (u, v, p) = (b.plan() - a.plan(), c.plan() - a.plan(), post.plan() - a.plan());
    let area = u.perp_dot(v);
    a.height + (b.height - a.height) * p.perp_dot(v) / area + (c.height - a.height) * u.perp_dot(p) / area
}
