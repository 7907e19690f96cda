//! Footprints drawn twice. In: rings. Out: a form that is equal for equal outlines, whatever their start and direction.

use crate::geodata::osm::Position;

/// The ring from its least position in the direction of its lesser neighbour, without repeated points.
pub fn canonical(ring: &[Position]) -> Vec<Position> {
    let mut points = ring.to_vec();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let Some(start) = (0..points.len()).min_by_key(|&i| points[i]) else { return points };
    points.rotate_left(start);
    if points.len() > 2 && points[points.len() - 1] < points[1] {
        points[1..].reverse();
    }
    points
}
