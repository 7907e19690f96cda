//! `splitArea` (reference 4.4). In: a block of areas. Out: pieces of a flat shape between parallel planes, each of the
//! area asked for (to about 1e-12 of the whole).

use glam::DVec3;

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::shape::Shape;
use super::super::topology::Topology;
use super::split::{axis_number, cut_at, piece};
use super::{Pieces, split_pattern};
use crate::cga::program::{Axis, SplitBlock};
use crate::geometry::mesh_checks::pairwise_sum;
use crate::geometry::triangulate::triangles;
use crate::source::Span;

pub fn by_area<'p>(
    run: &mut Derivation<'p>,
    axis: Axis,
    adjust: bool,
    block: &'p SplitBlock,
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let mut parent = env.shape.clone();
    parent.bake();
    let axis = axis_number(axis);
    if Topology::of(&parent.form.mesh).is_closed() {
        run.warn("cga::split-area", span, || "a closed body has no area to split: this is for flat shapes".into());
        return Ok(Vec::new());
    }
    let extent = parent.scope.size[axis].abs();
    let profile = Profile::of(&parent, axis);
    let total = if extent > 0.0 { profile.total } else { 0.0 };
    let layout = split_pattern::lay_out(run, block, total, span, env)?;
    let place = |area: f64| match area {
        0.0 => 0.0,
        a if a >= total => extent,
        a => profile.position(a, extent),
    };
    let slabs: Vec<(f64, f64)> = layout.slabs.iter().map(|s| (place(s.start), place(s.end))).collect();
    let forms = cut_at(&parent, axis, &slabs);
    Ok(layout.pieces(forms, &parent, |i, form| piece(&parent, axis, slabs[i], form, adjust)))
}

/// How the area grows along an axis: triangles by the distances of their corners from the start.
struct Profile {
    triangles: Vec<Triangle>,
    total: f64,
}

struct Triangle {
    /// Rising.
    distances: [f64; 3],
    area: f64,
}

impl Profile {
    fn of(shape: &Shape, axis: usize) -> Profile {
        let along = shape.scope.frame.axes.col(axis) * shape.scope.size[axis].signum();
        let start = along.dot(shape.scope.frame.origin);
        let triangle = |[a, b, c]: [DVec3; 3]| {
            let mut distances = [a, b, c].map(|p| along.dot(p) - start);
            distances.sort_by(f64::total_cmp);
            Triangle { distances, area: (b - a).cross(c - a).length() / 2.0 }
        };
        let list: Vec<Triangle> = triangles(&shape.form.mesh).map(|(_, corners)| triangle(corners)).collect();
        let total = pairwise_sum(&list.iter().map(|t| t.area).collect::<Vec<f64>>());
        Profile { triangles: list, total }
    }

    /// Area before a distance.
    fn before(&self, x: f64) -> f64 {
        pairwise_sum(&self.triangles.iter().map(|t| t.before(x)).collect::<Vec<f64>>())
    }

    /// The distance before which this much area lies: area rises with distance, so halving the interval finds it to the
    /// last bit.
    fn position(&self, area: f64, extent: f64) -> f64 {
        let (mut low, mut high) = (0.0, extent);
        loop {
            let middle = low + (high - low) / 2.0;
            if middle <= low || middle >= high {
                return high;
            }
            if self.before(middle) < area { low = middle } else { high = middle }
        }
    }
}

impl Triangle {
    fn before(&self, x: f64) -> f64 {
        let [a, b, c] = self.distances;
        if x <= a {
            0.0
        } else if x >= c {
            self.area
        } else if x < b {
            self.area * (x - a) / (b - a) * (x - a) / (c - a)
        } else {
            self.area * (1.0 - (c - x) / (c - b) * (c - x) / (c - a))
        }
    }
}
