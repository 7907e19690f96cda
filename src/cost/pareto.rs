//! Pareto: times and errors of settings → which of them no other one beats.

/// One flag per point: nothing is at most as slow and at most as wrong, and better in one of the two. Points without an
/// error are not on it; of equal points all are.
pub fn frontier(points: &[(f64, Option<f64>)]) -> Vec<bool> {
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    let on = |&(time, error): &(f64, Option<f64>)| {
        error.is_some_and(|error| !points.iter().any(|&(t, e)| e.is_some_and(|e| beats((t, e), (time, error)))))
    };
    points.iter().map(on).collect()
}

/// A setting by everything that was measured of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The shortest and the longest run.
    pub time: (f64, f64),
    /// One per metric; `None` where there is nothing to measure.
    pub errors: Vec<Option<f64>>,
}

impl Measured {
    /// Faster beyond the spread of both times, better by one metric at least and worse by none.
    fn beats(&self, other: &Measured) -> bool {
        let pairs = || self.errors.iter().zip(&other.errors).filter_map(|(own, other)| Some((*own, (*other)?)));
        self.time.1 < other.time.0
            && pairs().all(|(own, other)| own.is_some_and(|own| own <= other))
            && pairs().any(|(own, other)| own.is_some_and(|own| own < other))
    }
}

/// One flag per setting: no other one beats it by all metrics together.
pub fn joint_frontier(settings: &[Measured]) -> Vec<bool> {
    settings.iter().map(|setting| !settings.iter().any(|other| other.beats(setting))).collect()
}

#[cfg(test)]
mod tests {
    use super::{Measured, frontier, joint_frontier};
    use proptest::prelude::*;

    #[test]
    fn what_is_slower_and_no_better_is_off() {
        let points = [(1.0, Some(5.0)), (2.0, Some(3.0)), (3.0, Some(3.0)), (4.0, Some(1.0)), (0.5, None)];
        assert_eq!(frontier(&points), [true, true, false, true, false]);
        assert_eq!(frontier(&[(1.0, Some(1.0)), (1.0, Some(1.0))]), [true, true]);
    }

    #[test]
    fn of_all_metrics_together_only_what_is_surely_beaten_is_off() {
        let setting = |time, errors: [Option<f64>; 2]| Measured { time, errors: errors.to_vec() };
        let settings = [
            setting((1.0, 2.0), [Some(3.0), Some(3.0)]),
            setting((2.5, 4.0), [Some(3.0), Some(4.0)]), // beaten by the first
            setting((1.5, 4.0), [Some(3.0), Some(4.0)]), // within the spread of the first
            setting((2.5, 4.0), [Some(2.0), Some(4.0)]), // better by one metric
            setting((2.5, 4.0), [Some(3.0), Some(3.0)]), // as good as the first: times of the same work
            setting((2.5, 4.0), [Some(4.0), None]),      // beaten by what both have
            setting((0.5, 0.6), [Some(1.0), None]),      // says nothing of the second metric
        ];
        assert_eq!(joint_frontier(&settings), [true, false, true, true, true, false, true]);
    }

    proptest! {
        #[test]
        fn every_point_off_is_beaten_by_one_on(points in prop::collection::vec((0u8..9, 0u8..9), 1..30)) {
            let points: Vec<_> = points.iter().map(|&(t, e)| (f64::from(t), Some(f64::from(e)))).collect();
            let on = frontier(&points);
            for (point, _) in points.iter().zip(&on).filter(|(_, on)| !**on) {
                let beaten = points.iter().zip(&on).any(|(p, on)| *on && p.0 <= point.0 && p.1 <= point.1 && p != point);
                prop_assert!(beaten);
            }
        }
    }
}
