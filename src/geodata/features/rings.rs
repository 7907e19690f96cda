//! Rings on the integer grid of map positions. In: open and closed lines. Out: simple loops, and which lies in which.
//!
//! All tests are exact (i128 of 1e-7 degrees), so they do not depend on the projection.

use std::collections::BTreeMap;

use crate::geodata::osm::Position;

/// A line of positions with the role it had in its relation.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// Of a ring the last position is not repeated.
    pub points: Vec<Position>,
    pub role: Role,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    Outer,
    Inner,
    /// Empty or unknown.
    None,
}

/// What [`join`] made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joined {
    pub rings: Vec<Strand>,
    /// Lines whose ends met no other line.
    pub open: Vec<Strand>,
}

/// Joins lines at equal ends to rings; falls back on any order where several could follow, and cuts every ring at
/// points that it visits twice.
pub fn join(strands: Vec<Strand>) -> Joined {
    let mut ends: BTreeMap<Position, Vec<usize>> = BTreeMap::new();
    for (i, strand) in strands.iter().enumerate() {
        if let (Some(&first), Some(&last)) = (strand.points.first(), strand.points.last()) {
            ends.entry(first).or_default().push(i);
            ends.entry(last).or_default().push(i);
        }
    }
    let mut used = vec![false; strands.len()];
    let mut joined = Joined::default();
    for i in 0..strands.len() {
        if used[i] || strands[i].points.is_empty() {
            continue;
        }
        used[i] = true;
        let mut chain = strands[i].clone();
        // Grow at the end, then turn round and grow at the start.
        for _ in 0..2 {
            while let Some(next) = follower(&strands, &used, &ends, &chain) {
                used[next] = true;
                append(&mut chain, &strands[next]);
            }
            chain.points.reverse();
        }
        cut_loops(chain, &mut joined);
    }
    joined
}

/// An unused line that starts or ends where the chain ends, the same role first.
fn follower(strands: &[Strand], used: &[bool], ends: &BTreeMap<Position, Vec<usize>>, chain: &Strand) -> Option<usize> {
    let (first, last) = (chain.points.first()?, chain.points.last()?);
    if chain.points.len() > 1 && first == last {
        return None;
    }
    let free: Vec<usize> = ends.get(last)?.iter().copied().filter(|&i| !used[i]).collect();
    free.iter().copied().find(|&i| strands[i].role == chain.role).or(free.first().copied())
}

fn append(chain: &mut Strand, next: &Strand) {
    if next.role != chain.role {
        chain.role = Role::None;
    }
    if chain.points.last() == next.points.first() {
        chain.points.extend(&next.points[1..]);
    } else {
        chain.points.extend(next.points.iter().rev().skip(1));
    }
}

/// Takes every loop out of a chain; what is left over is open.
fn cut_loops(chain: Strand, joined: &mut Joined) {
    let role = chain.role;
    let mut path: Vec<Position> = Vec::new();
    let mut place: BTreeMap<Position, usize> = BTreeMap::new();
    for point in chain.points {
        if path.last() == Some(&point) {
            continue;
        }
        if let Some(&start) = place.get(&point) {
            let points: Vec<Position> = path.drain(start + 1..).collect();
            for p in &points {
                place.remove(p);
            }
            let points: Vec<Position> = std::iter::once(point).chain(points).collect();
            // There and back again encloses nothing.
            if points.len() > 2 {
                joined.rings.push(Strand { points, role });
            }
        } else {
            place.insert(point, path.len());
            path.push(point);
        }
    }
    if path.len() > 1 {
        joined.open.push(Strand { points: path, role });
    }
}

/// Where a point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    Inside,
    Border,
    Outside,
}

/// A point in half units of the grid, so that middles of edges are exact.
type Half = (i128, i128);

fn half(p: Position) -> Half {
    (2 * i128::from(p.lon), 2 * i128::from(p.lat))
}

fn edges(ring: &[Position]) -> impl Iterator<Item = (Half, Half)> + '_ {
    (0..ring.len()).map(|i| (half(ring[i]), half(ring[(i + 1) % ring.len()])))
}

fn side(ring: &[Position], p: Half) -> Side {
    let mut inside = false;
    for (a, b) in edges(ring) {
        let turn = (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0);
        let within = |u: i128, v: i128, w: i128| u.min(v) <= w && w <= u.max(v);
        if turn == 0 && within(a.0, b.0, p.0) && within(a.1, b.1, p.1) {
            return Side::Border;
        }
        if (a.1 > p.1) != (b.1 > p.1) && (turn > 0) == (b.1 > a.1) {
            inside = !inside;
        }
    }
    if inside { Side::Inside } else { Side::Outside }
}

/// How one ring lies to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    Within,
    Apart,
    /// Partly in and partly out.
    Crossing,
    /// The same line.
    Equal,
}

/// How ring `a` lies to ring `b`, where `a` has the smaller area. Decided by `a`'s vertices and the middles of its edges.
pub fn relate(a: &[Position], b: &[Position]) -> Relation {
    if !boxes_meet(a, b) {
        return Relation::Apart;
    }
    let middles = edges(a).map(|(p, q)| ((p.0 + q.0) / 2, (p.1 + q.1) / 2));
    let (mut inside, mut outside) = (false, false);
    for point in a.iter().map(|p| half(*p)).chain(middles) {
        match side(b, point) {
            Side::Inside => inside = true,
            Side::Outside => outside = true,
            Side::Border => {}
        }
    }
    match (inside, outside) {
        (true, true) => Relation::Crossing,
        (true, false) => Relation::Within,
        (false, true) => Relation::Apart,
        (false, false) if twice_area(a).abs() == twice_area(b).abs() => Relation::Equal,
        (false, false) => Relation::Within,
    }
}

/// Whether two rings meet anywhere but in points that both have: edges that cross, or a point inside an edge.
pub fn meet_off_nodes(a: &[Position], b: &[Position]) -> bool {
    let turn = |p: Half, q: Half, r: Half| ((q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)).signum();
    let inside = |p: Half, q: Half, r: Half| {
        let along = (q.0 - p.0) * (r.0 - p.0) + (q.1 - p.1) * (r.1 - p.1);
        let length = (q.0 - p.0) * (q.0 - p.0) + (q.1 - p.1) * (q.1 - p.1);
        turn(p, q, r) == 0 && 0 < along && along < length
    };
    edges(a).any(|(p, q)| {
        edges(b).any(|(r, s)| {
            let crossing = turn(p, q, r) * turn(p, q, s) < 0 && turn(r, s, p) * turn(r, s, q) < 0;
            crossing || inside(p, q, r) || inside(r, s, p)
        })
    })
}

fn boxes_meet(a: &[Position], b: &[Position]) -> bool {
    let span = |ring: &[Position], key: fn(&Position) -> i32| (ring.iter().map(key).min(), ring.iter().map(key).max());
    let meet = |key| {
        let ((a0, a1), (b0, b1)) = (span(a, key), span(b, key));
        a0 <= b1 && b0 <= a1
    };
    meet(|p| p.lon) && meet(|p| p.lat)
}

/// Twice the signed area in grid units.
pub fn twice_area(ring: &[Position]) -> i128 {
    edges(ring).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum::<i128>() / 4
}
