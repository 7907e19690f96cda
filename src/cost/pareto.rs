//! Pareto: times and errors of settings → which of them no other one beats in both.

/// One flag per point: nothing is at most as slow and at most as wrong, and better in one of the two. Points without an
/// error are not on it; of equal points all are.
pub fn frontier(points: &[(f64, Option<f64>)]) -> Vec<bool> {
    let beats = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && (a.0 < b.0 || a.1 < b.1);
    let on = |&(time, error): &(f64, Option<f64>)| {
        error.is_some_and(|error| !points.iter().any(|&(t, e)| e.is_some_and(|e| beats((t, e), (time, error)))))
    };
    points.iter().map(on).collect()
}

#[cfg(test)]
mod tests {
    use super::frontier;
    use proptest::prelude::*;

    #[test]
    fn what_is_slower_and_no_better_is_off() {
        let points = [(1.0, Some(5.0)), (2.0, Some(3.0)), (3.0, Some(3.0)), (4.0, Some(1.0)), (0.5, None)];
        assert_eq!(frontier(&points), [true, true, false, true, false]);
        assert_eq!(frontier(&[(1.0, Some(1.0)), (1.0, Some(1.0))]), [true, true]);
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
