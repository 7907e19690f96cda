//! Sizes against the reference's and the compatibility notes' tables. In: blocks of sizes. Out: slabs.

use super::*;
use proptest::prelude::*;

fn abs(x: f64) -> Block {
    Block::Piece { size: Size::Absolute(x), body: 0 }
}

fn rel(x: f64) -> Block {
    Block::Piece { size: Size::Relative(x), body: 1 }
}

fn float(x: f64) -> Block {
    Block::Piece { size: Size::Floating(x), body: 2 }
}

fn times(blocks: Vec<Block>) -> Block {
    Block::Group { blocks, repeat: true }
}

/// Checks the lengths of the pieces.
#[track_caller]
fn check(total: f64, blocks: Vec<Block>, expected: &[f64]) {
    let slabs = resolve(&blocks, total, 1000).expect("few pieces").slabs;
    let lengths: Vec<f64> = slabs.iter().map(|s| s.end - s.start).collect();
    let same = lengths.len() == expected.len() && lengths.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(same, "{total} {blocks:?}: {lengths:?}, not {expected:?}");
}

#[test]
fn sizes_without_repeat_follow_the_reference() {
    check(8.0, vec![rel(0.25), rel(0.125), rel(0.375)], &[2.0, 1.0, 3.0]);
    check(12.0, vec![float(2.0), float(1.0), float(5.0)], &[3.0, 1.5, 7.5]);
    check(9.0, vec![abs(2.5), float(4.0), abs(4.0)], &[2.5, 2.5, 4.0]);
    check(9.0, vec![rel(0.6), rel(0.7), abs(1.0)], &[5.4, 3.6]);
    check(6.0, vec![abs(2.0), abs(0.0), abs(2.0), abs(-1.0), abs(3.0)], &[2.0, 2.0, 2.0]);
    check(12.0, vec![abs(2.0), float(1.0), float(3.0), abs(2.0)], &[2.0, 2.0, 6.0, 2.0]);
    check(12.0, vec![abs(13.0), float(1.0)], &[12.0]);
}

#[test]
fn repeats_follow_the_reference() {
    check(10.0, vec![times(vec![abs(3.0), abs(1.0)])], &[3.0, 1.0, 3.0, 1.0, 2.0]);
    check(1.0, vec![times(vec![rel(0.4)])], &[0.4, 0.4, 0.2]);
    check(1.0, vec![times(vec![rel(0.25), rel(0.125)])], &[0.25, 0.125, 0.25, 0.125, 0.25]);
    check(7.0, vec![times(vec![float(1.8)])], &[1.75; 4]);
    check(13.0, vec![times(vec![float(3.0), float(2.0)])], &[2.6, 1.7333, 2.6, 1.7333, 2.6, 1.7333]);
    check(9.6, vec![times(vec![abs(1.0), float(2.5)]), abs(1.0)], &[1.0, 1.8667, 1.0, 1.8667, 1.0, 1.8667, 1.0]);
    let framed = vec![abs(1.0), times(vec![float(2.0), abs(0.5), float(2.0)]), abs(1.0)];
    check(15.0, framed, &[1.0, 1.9167, 0.5, 1.9167, 1.9167, 0.5, 1.9167, 1.9167, 0.5, 1.9167, 1.0]);
    let ab = [1.037, 1.5556];
    check(14.0, vec![times(vec![float(1.0), float(1.5)]), float(1.0)], &[&ab.repeat(5)[..], &[1.037]].concat());
    check(20.0, vec![abs(4.2), times(vec![float(3.1)]), abs(0.6)], &[4.2, 3.04, 3.04, 3.04, 3.04, 3.04, 0.6]);
    check(3.0, vec![times(vec![float(4.0)])], &[3.0]);
    check(2.0, vec![float(1.0), times(vec![float(5.0)]), float(1.0)], &[1.0, 1.0]);
    check(10.0, vec![times(vec![abs(2.0)]), float(1.0)], &[2.0, 2.0, 2.0, 2.0, 2.0]);
    check(18.0, vec![times(vec![float(4.0)])], &[3.6; 5]);
    let bays = vec![abs(0.8), times(vec![float(2.4), abs(0.3)]), abs(0.5)];
    check(11.0, bays, &[0.8, 2.125, 0.3, 2.125, 0.3, 2.125, 0.3, 2.125, 0.3, 0.5]);
}

#[test]
fn the_count_changes_where_the_notes_say() {
    for n in 1..=12u32 {
        let n = f64::from(n);
        let edge = 2.0 * n * (n + 1.0) / (2.0 * n + 1.0);
        for (ratio, count) in [(edge - 1e-6, n), (edge, n), (edge + 1e-6, n + 1.0), (n, n)] {
            for d in [0.1, 1.0, 3.0] {
                let slabs = resolve(&[times(vec![float(d)])], ratio * d, 1000).expect("few pieces").slabs;
                assert_eq!(slabs.len() as f64, count, "L/d = {ratio}, d = {d}");
            }
        }
    }
    assert_eq!(resolve(&[times(vec![float(3.0)])], 4.0, 1000).map(|s| s.slabs.len()), Ok(1));
}

#[test]
fn exact_multiples_give_whole_counts() {
    for k in 1..400u32 {
        for d in [0.1, 0.3, 0.7, 1.1] {
            let slabs = resolve(&[times(vec![abs(d)])], d * f64::from(k), 1000).expect("few pieces").slabs;
            assert_eq!(slabs.len() as u32, k, "{d} x {k}");
        }
    }
}

#[test]
fn nested_repeats_grow_inside_the_outer_ones() {
    let inner = times(vec![float(1.0)]);
    check(10.0, vec![times(vec![abs(1.0), inner])], &[1.0, 1.0].repeat(5));
    check(0.0, vec![float(1.0)], &[]);
    check(5.0, vec![times(vec![abs(0.0)])], &[]);
}

#[test]
fn too_many_pieces_are_refused_before_they_are_made() {
    assert_eq!(resolve(&[times(vec![float(1e-5)])], 1e9, 1000), Err(TooMany));
    assert_eq!(resolve(&[times(vec![abs(1e-5)])], 1e9, 1000), Err(TooMany));
}

fn blocks() -> impl Strategy<Value = Vec<Block>> {
    let piece = prop_oneof![(-1.0..6.0f64).prop_map(abs), (0.0..0.7f64).prop_map(rel), (0.1..4.0f64).prop_map(float)];
    let block = prop_oneof![4 => piece.clone(), 1 => prop::collection::vec(piece, 1..4).prop_map(times)];
    prop::collection::vec(block, 1..5)
}

proptest! {
    #[test]
    fn slabs_follow_each_other_inside_the_total(blocks in blocks(), total in 0.01..50.0f64) {
        let Ok(Resolved { slabs, .. }) = resolve(&blocks, total, 100_000) else { return Ok(()) };
        let mut at = 0.0;
        for slab in &slabs {
            prop_assert!((slab.start - at).abs() < 1e-9, "{slabs:?}");
            prop_assert!(slab.end > slab.start && slab.end <= total, "{slabs:?}");
            at = slab.end;
        }
    }
}

/// The stage cases of `../shared/hard-cases/stages.json` about sizes alone, each by its name.
mod stages {
    use super::*;

    #[test]
    fn split_floor_trap() {
        check(0.3, vec![times(vec![abs(0.1)])], &[0.1; 3]);
        let sizes = [0.1, 0.3, 0.7, 1.1, 1.3, 1.7, 2.2, 2.4, 2.6, 2.8, 3.1, 3.3, 3.6, 0.05];
        for (k, s) in (1..=2000u32).flat_map(|k| sizes.map(|s| (k, s))) {
            let pieces = resolve(&[times(vec![abs(s)])], f64::from(k) * s, 3000).expect("few pieces").slabs.len();
            assert_eq!(pieces, k as usize, "{s}");
        }
    }

    #[test]
    fn split_million() {
        let pieces = resolve(&[times(vec![abs(0.1)])], 100_000.0, 1_000_001).expect("as many as allowed").slabs;
        assert_eq!(pieces.len(), 1_000_000);
        for (i, slab) in pieces.iter().enumerate() {
            assert!((slab.start - 0.1 * i as f64).abs() <= 1e-10, "{i}: {}", slab.start);
        }
        assert_eq!(pieces[999_999].end, 100_000.0);
        assert_eq!(resolve(&[times(vec![abs(0.1)])], 100_000.0, 300_000), Err(TooMany));
    }

    #[test]
    fn split_huge_scope() {
        assert_eq!(resolve(&[times(vec![abs(1e-6)])], 1e6, 300_000), Err(TooMany));
    }
}
