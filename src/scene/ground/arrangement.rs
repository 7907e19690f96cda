//! In: segments on the lattice that cross, overlap and touch at will. Out: segments that meet in common ends only.
//!
//! Iterated snap rounding (Hobby, "Practical segment intersection with finite precision output", 1999): crossings are
//! rounded to lattice nodes, and a node less than half a step beside a segment splits it. Rounding can make new crossings, so
//! this is repeated until there are none; later rounds look only at what the round before has changed.

use super::lattice::{Node, Segment, crossing, dot, lies_on, segment};

/// Real maps need 2 to 5 rounds.
const MAX_ROUNDS: usize = 64;

/// Splits segments until they meet in common ends only; gives them sorted, each once. `None` if the rounds run out.
pub fn arrange(segments: Vec<Segment>) -> Option<Vec<Segment>> {
    let mut pieces: Vec<Piece> = segments.into_iter().map(|segment| Piece { segment, fresh: true }).collect();
    for _ in 0..MAX_ROUNDS {
        pieces.sort_unstable();
        pieces.dedup_by_key(|p| p.segment);
        let splits = splits(&pieces);
        if splits.is_empty() {
            return Some(pieces.into_iter().map(|p| p.segment).collect());
        }
        pieces = split(&pieces, &splits);
    }
    None
}

/// A segment and whether it is new in this round. Of equal segments the one that is not new sorts first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    segment: Segment,
    fresh: bool,
}

/// At which nodes which pieces must be split, sorted.
fn splits(pieces: &[Piece]) -> Vec<(u32, Node)> {
    let mut splits = Vec::new();
    for bucket in buckets(pieces).chunk_by(|a, b| a.0 == b.0) {
        for (k, &(_, i)) in bucket.iter().enumerate() {
            for &(_, j) in &bucket[k + 1..] {
                let (p, q) = (pieces[i as usize], pieces[j as usize]);
                if (p.fresh || q.fresh) && boxes_meet(p.segment, q.segment) {
                    meet((i, p.segment), (j, q.segment), &mut splits);
                }
            }
        }
    }
    splits.sort_unstable();
    splits.dedup();
    splits
}

fn boxes_meet(p: Segment, q: Segment) -> bool {
    (0..2).all(|i| {
        let (p_lo, p_hi) = (p[0][i].min(p[1][i]), p[0][i].max(p[1][i]));
        let (q_lo, q_hi) = (q[0][i].min(q[1][i]), q[0][i].max(q[1][i]));
        p_lo <= q_hi + 1 && q_lo <= p_hi + 1
    })
}

fn meet((i, p): (u32, Segment), (j, q): (u32, Segment), splits: &mut Vec<(u32, Node)>) {
    let before = splits.len();
    splits.extend(q.into_iter().filter(|&n| lies_on(n, p)).map(|n| (i, n)));
    splits.extend(p.into_iter().filter(|&n| lies_on(n, q)).map(|n| (j, n)));
    if splits.len() > before {
        return;
    }
    if let Some(node) = crossing(p, q) {
        splits.extend([(i, p), (j, q)].into_iter().filter(|(_, s)| !s.contains(&node)).map(|(k, _)| (k, node)));
    }
}

fn split(pieces: &[Piece], splits: &[(u32, Node)]) -> Vec<Piece> {
    let mut out = Vec::with_capacity(pieces.len() + splits.len());
    let mut rest = splits;
    for (i, piece) in pieces.iter().enumerate() {
        let (own, others) = rest.split_at(rest.partition_point(|&(k, _)| k as usize <= i));
        rest = others;
        if own.is_empty() {
            out.push(Piece { fresh: false, ..*piece });
            continue;
        }
        let [a, b] = piece.segment;
        let mut nodes: Vec<Node> = own.iter().map(|&(_, node)| node).collect();
        nodes.sort_by_key(|&n| (dot(a, b, n), n));
        let mut from = a;
        for to in nodes.into_iter().chain([b]) {
            out.extend(segment(from, to).map(|segment| Piece { segment, fresh: true }));
            from = to;
        }
    }
    out
}

/// Pieces by the square cells that they pass through, sorted by cell.
fn buckets(pieces: &[Piece]) -> Vec<(u64, u32)> {
    let length = |s: Segment| (s[1][0] - s[0][0]).abs().max((s[1][1] - s[0][1]).abs());
    let mean = pieces.iter().map(|p| length(p.segment) as f64).sum::<f64>() / pieces.len().max(1) as f64;
    let cell = (mean as i64).max(64);
    let mut buckets = Vec::with_capacity(3 * pieces.len());
    for (i, piece) in pieces.iter().enumerate() {
        cells(piece.segment, cell, |x, y| {
            let key = u64::from(x as u32) << 32 | u64::from(y as u32);
            buckets.push((key, i as u32));
        });
    }
    buckets.sort_unstable();
    buckets
}

/// Calls `visit` for every cell within 1 step of the segment (and possibly some beside it).
fn cells([a, b]: Segment, cell: i64, mut visit: impl FnMut(i64, i64)) {
    let (y_lo, y_hi) = (a[1].min(b[1]) - 1, a[1].max(b[1]) + 1);
    let slope = (b[0] - a[0]) as f64 / (b[1] - a[1]) as f64;
    for row in y_lo.div_euclid(cell)..=y_hi.div_euclid(cell) {
        // Nodes are sorted, so a is the western end.
        let (mut x_lo, mut x_hi) = (a[0] - 1, b[0] + 1);
        if a[1] != b[1] {
            let at = |y: i64| a[0] as f64 + slope * (y - a[1]) as f64;
            let (s, e) = (at((row * cell - 1).max(y_lo)), at(((row + 1) * cell + 1).min(y_hi)));
            x_lo = x_lo.max(s.min(e) as i64 - 2);
            x_hi = x_hi.min(s.max(e) as i64 + 2);
        }
        for column in x_lo.div_euclid(cell)..=x_hi.div_euclid(cell) {
            visit(column, row);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// No two segments cross, overlap or touch but in common ends.
    fn assert_arranged(segments: &[Segment]) {
        for (i, &p) in segments.iter().enumerate() {
            for &q in segments[i + 1..].iter().filter(|q| boxes_meet(p, **q)) {
                assert!(crossing(p, q).is_none(), "{p:?} crosses {q:?}");
                assert!(!q.iter().any(|&n| lies_on(n, p)) && !p.iter().any(|&n| lies_on(n, q)), "{p:?} touches {q:?}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]
        #[test]
        fn random_segments_come_apart(
            ends in prop::collection::vec((0_i64..600, 0_i64..600, 0_i64..600, 0_i64..600), 1..25), shrink in 1_i64..40
        ) {
            let segments: Vec<Segment> = ends
                .into_iter()
                .filter_map(|(a, b, c, d)| segment([a / shrink, b / shrink], [c / shrink, d / shrink]))
                .collect();
            assert_arranged(&arrange(segments).unwrap());
        }
    }

    #[test]
    fn a_fan_of_nearly_parallel_lines_comes_apart() {
        let segments = (0..80).map(|i| [[0, 3 * i], [4096, 240 - 2 * i]]).collect();
        assert_arranged(&arrange(segments).unwrap());
    }

    #[test]
    fn overlaps_become_one() {
        let arranged = arrange(vec![[[0, 0], [100, 0]], [[40, 0], [200, 0]], [[50, -9], [50, 9]]]).unwrap();
        let expected = vec![
            [[0, 0], [40, 0]],
            [[40, 0], [50, 0]],
            [[50, -9], [50, 0]],
            [[50, 0], [50, 9]],
            [[50, 0], [100, 0]],
            [[100, 0], [200, 0]],
        ];
        assert_eq!(arranged, expected);
    }
}
