//! Rounds over all polygons, and our own. In: polygons. Out: seconds for one of them, best and median round.

use std::hint::black_box;
use std::time::{Duration, Instant};

use mansard::geometry::Polygon;
use mansard::geometry::skeleton::skeleton;

/// At least so many rounds, for at least so long.
pub const ROUNDS: usize = 5;
pub const SECONDS: f64 = 1.0;

pub struct Timing {
    /// Seconds of one polygon in the best and in the median round.
    pub best: f64,
    pub median: f64,
    /// Greatest time of a node, summed over the polygons: what two implementations have to agree on.
    pub height: f64,
}

impl Timing {
    /// From the seconds of whole rounds.
    pub fn of_rounds(mut rounds: Vec<f64>, polygons: usize, height: f64) -> Timing {
        rounds.sort_by(f64::total_cmp);
        let each = |seconds: f64| seconds / polygons as f64;
        Timing { best: each(rounds[0]), median: each(rounds[rounds.len() / 2]), height }
    }
}

/// Time `skeleton`, the freeing of its result included.
pub fn ours(polygons: &[Polygon]) -> Timing {
    let height = |p: &Polygon| {
        let skeleton = skeleton(p, None).expect("the polygon is simple");
        skeleton.nodes.iter().fold(0.0, |m, node| f64::max(m, node.time))
    };
    let height = polygons.iter().map(height).sum();
    let mut rounds = Vec::new();
    let begin = Instant::now();
    while rounds.len() < ROUNDS || begin.elapsed() < Duration::from_secs_f64(SECONDS) {
        let start = Instant::now();
        for polygon in polygons {
            drop(black_box(skeleton(black_box(polygon), None)));
        }
        rounds.push(start.elapsed().as_secs_f64());
    }
    Timing::of_rounds(rounds, polygons.len(), height)
}
