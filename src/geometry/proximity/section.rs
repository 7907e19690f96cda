//! Plane sections of closed meshes. In: triangles and a plane. Out: closed rings in plan coordinates, the inside on
//! their left.
//!
//! A vertex in the plane counts as in front of it. Rings are followed from edge to edge by number, not by position, so
//! a closed mesh always gives closed rings.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::geometry::{PlaneFrame, Ring};

type Edge = (u32, u32);

/// The section `offset` metres in front of the frame's plane.
pub fn section(positions: &[DVec3], triangles: &[[u32; 3]], frame: &PlaneFrame, offset: f64) -> Vec<Ring> {
    let height = |v: u32| (positions[v as usize] - frame.origin).dot(frame.normal) - offset;
    // From the edge a triangle runs downwards to the edge it runs upwards.
    let mut next: BTreeMap<Edge, Vec<Edge>> = BTreeMap::new();
    for &t in triangles {
        let above = t.map(|v| height(v) >= 0.0);
        if above[0] == above[1] && above[1] == above[2] {
            continue;
        }
        let (mut down, mut up) = ((0, 0), (0, 0));
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            match (above[i], above[(i + 1) % 3]) {
                (true, false) => down = (a.min(b), a.max(b)),
                (false, true) => up = (a.min(b), a.max(b)),
                _ => {}
            }
        }
        next.entry(down).or_default().push(up);
    }
    let crossing = |(a, b): Edge| {
        let (ha, hb) = (height(a), height(b));
        frame.to_plan(positions[a as usize].lerp(positions[b as usize], ha / (ha - hb)))
    };
    let mut rings = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut ring = Ring::new();
        let mut at = start;
        while let Some(ways) = next.get_mut(&at) {
            ring.push(crossing(at));
            let way = ways.pop();
            if ways.is_empty() {
                next.remove(&at);
            }
            at = way.expect("an edge without a way on is taken out");
        }
        rings.push(ring);
    }
    rings
}
