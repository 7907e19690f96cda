//! Every polygon timed by itself, in rounds over all. In: polygons. Out: mean seconds of one, from best and median rounds.

use std::hint::black_box;
use std::time::{Duration, Instant};

use mansard::geometry::Polygon;
use mansard::geometry::skeleton::skeleton;

/// At least so many rounds, for at least so long.
pub const ROUNDS: usize = 5;
pub const SECONDS: f64 = 1.0;

pub struct Timing {
    /// Mean over the polygons of the best, and of the median, of the rounds: seconds.
    pub best: f64,
    pub median: f64,
    /// Greatest time of a node, summed over the polygons: what two implementations have to agree on.
    pub height: f64,
}

impl Timing {
    /// From the seconds of every polygon in every round (round after round), unless there is no whole round.
    pub fn of_rounds(seconds: &[f64], polygons: usize, height: f64) -> Option<Timing> {
        let rounds = seconds.len() / polygons;
        if rounds == 0 {
            return None;
        }
        let (mut best, mut median) = (0.0, 0.0);
        for k in 0..polygons {
            let mut times: Vec<f64> = (0..rounds).map(|round| seconds[round * polygons + k]).collect();
            times.sort_by(f64::total_cmp);
            best += times[0];
            median += times[rounds / 2];
        }
        let each = 1.0 / polygons as f64;
        Some(Timing { best: best * each, median: median * each, height })
    }
}

/// Time `skeleton`, the freeing of its result included.
pub fn ours(polygons: &[Polygon]) -> Timing {
    let height = |p: &Polygon| {
        let skeleton = skeleton(p, None).expect("the polygon is simple");
        skeleton.nodes.iter().fold(0.0, |m, node| f64::max(m, node.time))
    };
    let height = polygons.iter().map(height).sum();
    let mut seconds = Vec::new();
    let begin = Instant::now();
    while seconds.len() < ROUNDS * polygons.len() || begin.elapsed() < Duration::from_secs_f64(SECONDS) {
        for polygon in polygons {
            let start = Instant::now();
            drop(black_box(skeleton(black_box(polygon), None)));
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    Timing::of_rounds(&seconds, polygons.len(), height).expect("at least one round")
}
