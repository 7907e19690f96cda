//! The sea. In: coastline ways (land on the left, water on the right) and the area's ring. Out: polygons of water.
//!
//! Lines are joined and cut to the area; each piece that leaves it is continued clockwise along the border to the next
//! piece that enters. Islands become holes, and an area with islands only is sea all round.

use glam::DVec2;

use super::area::clip_line;
use crate::geometry::polygon::signed_area;
use crate::geometry::{Polygon, Ring};

/// The sea of an area.
#[derive(Debug, Default)]
pub struct Sea {
    /// Before repair: outer ring and holes.
    pub polygons: Vec<Polygon>,
    /// The longest way, in metres, that a coastline was continued straight to the border.
    pub bridged: f64,
}

/// The sea, or why it cannot be closed.
pub fn sea(ways: &[Vec<DVec2>], area: &[DVec2]) -> Result<Sea, String> {
    let (mut islands, mut pieces) = (Vec::new(), Vec::new());
    let mut basins: Vec<Ring> = Vec::new();
    for chain in join(ways) {
        let closed = chain.len() > 3 && chain.first() == chain.last();
        let mut parts = clip_line(&chain, area);
        if closed && parts.len() == 1 && parts[0].len() == chain.len() && parts[0] == chain {
            let ring = chain[1..].to_vec();
            if signed_area(&ring) > 0.0 {
                islands.push(ring)
            } else {
                basins.push(ring)
            }
            continue;
        }
        // A ring that starts inside the area was cut at its seam: join the last piece to the first.
        if closed && parts.len() > 1 && parts[0].first() == parts[parts.len() - 1].last() {
            let first = parts.remove(0);
            let last = parts.len() - 1;
            parts[last].extend(&first[1..]);
        }
        pieces.extend(parts);
    }
    let (mut outers, bridged) = close_along_border(pieces, area)?;
    outers.extend(basins);
    if outers.is_empty() && !islands.is_empty() {
        outers.push(area.to_vec());
    }
    let mut polygons: Vec<Polygon> = outers.into_iter().map(|outer| Polygon { outer, holes: Vec::new() }).collect();
    for island in islands {
        if let Some(sea) = polygons.iter_mut().find(|p| p.contains(island[0])) {
            sea.holes.push(island);
        }
    }
    for polygon in &mut polygons {
        if signed_area(&polygon.outer) < 0.0 {
            polygon.outer.reverse();
        }
        for hole in polygon.holes.iter_mut().filter(|hole| signed_area(hole) > 0.0) {
            hole.reverse();
        }
    }
    Ok(Sea { polygons, bridged })
}

/// Joins lines where one ends and another starts, keeping their direction.
fn join(ways: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    let mut chains: Vec<Vec<DVec2>> = ways.iter().filter(|way| way.len() > 1).cloned().collect();
    let mut i = 0;
    while i < chains.len() {
        let end = chains[i].last().copied();
        let next = (0..chains.len()).find(|&j| j != i && chains[j].first().copied() == end);
        match next {
            Some(j) if chains[i].first().copied() != end => {
                let tail = chains.remove(j);
                i -= usize::from(j < i);
                chains[i].extend(&tail[1..]);
            }
            _ => i += 1,
        }
    }
    chains
}

/// Place on the border: edge number and share of the edge.
fn border_place(point: DVec2, area: &[DVec2]) -> f64 {
    let (mut best, mut least) = (0.0, f64::INFINITY);
    for i in 0..area.len() {
        let (a, b) = (area[i], area[(i + 1) % area.len()]);
        let t = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        let distance = point.distance_squared(a.lerp(b, t));
        if distance < least {
            (best, least) = (i as f64 + t, distance);
        }
    }
    best
}

/// Greatest distance of a coastline's end from the border that is bridged by a straight line, as a share of the
/// area's size (extracts end at borders of their own).
const END_GAP: f64 = 0.25;

/// A cut lies on the border up to this distance, metres.
const ON_BORDER: f64 = 1e-6;

/// A coastline from border to border.
struct Stretch {
    /// Border places of its ends.
    enter: f64,
    leave: f64,
    line: Vec<DVec2>,
    /// An end did not reach the border by itself.
    loose: bool,
}

/// Whether lines enter and leave in turn along the border.
fn alternate(open: &[Stretch]) -> bool {
    let mut ends: Vec<(f64, bool)> = open.iter().flat_map(|s| [(s.enter, true), (s.leave, false)]).collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    (0..ends.len()).all(|i| ends[i].1 != ends[(i + 1) % ends.len()].1)
}

fn close_along_border(pieces: Vec<Vec<DVec2>>, area: &[DVec2]) -> Result<(Vec<Ring>, f64), String> {
    let on_border = |t: f64| {
        let i = (t.floor() as usize) % area.len();
        area[i].lerp(area[(i + 1) % area.len()], t - t.floor())
    };
    let limit = END_GAP * signed_area(area).abs().sqrt();
    let mut bridged = 0.0;
    let mut open: Vec<Stretch> = Vec::new();
    for mut line in pieces {
        let (start, end) = (line[0], line[line.len() - 1]);
        let (enter, leave) = (border_place(start, area), border_place(end, area));
        let mut loose = false;
        for (at, place, index) in [(start, enter, 0), (end, leave, usize::MAX)] {
            let gap = at.distance(on_border(place));
            if gap > limit {
                return Err(format!("the coastline ends inside the area, {gap:.0} m from its border"));
            }
            if gap > ON_BORDER {
                line.insert(index.min(line.len()), on_border(place));
                bridged = gap.max(bridged);
                loose = true;
            }
        }
        open.push(Stretch { enter, leave, line, loose });
    }
    while !alternate(&open) {
        let length = |s: &Stretch| s.line.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        let loose = (0..open.len()).filter(|&i| open[i].loose);
        let Some(shortest) = loose.min_by(|&i, &j| length(&open[i]).total_cmp(&length(&open[j]))) else {
            return Err("land and water do not alternate along the area's border".to_owned());
        };
        open.remove(shortest);
    }
    let sides = area.len() as f64;
    let mut rings = Vec::new();
    while let Some(Stretch { enter: start, leave: mut at, line: mut ring, .. }) = open.pop() {
        loop {
            // Clockwise is backwards along the counter-clockwise area.
            let behind = |t: f64| (at - t).rem_euclid(sides);
            let next = (0..open.len()).min_by(|&i, &j| behind(open[i].enter).total_cmp(&behind(open[j].enter)));
            let next = next.filter(|&i| behind(open[i].enter) < behind(start));
            let to = next.map_or(start, |i| open[i].enter);
            ring.extend(corners_between(at, to, area));
            let Some(next) = next else { break };
            let next = open.remove(next);
            ring.extend(next.line);
            at = next.leave;
        }
        rings.push(ring);
    }
    Ok((rings, bridged))
}

/// The area's corners met when going clockwise from one border place to another.
fn corners_between(from: f64, to: f64, area: &[DVec2]) -> Vec<DVec2> {
    let sides = area.len() as f64;
    let way = (from - to).rem_euclid(sides);
    let mut corners: Vec<(f64, usize)> =
        (0..area.len()).map(|i| ((from - i as f64).rem_euclid(sides), i)).filter(|(d, _)| *d < way).collect();
    corners.sort_by(|a, b| a.0.total_cmp(&b.0));
    corners.into_iter().map(|(_, i)| area[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f64, f64)]) -> Vec<DVec2> {
        list.iter().map(|&(x, y)| DVec2::new(x, y)).collect()
    }

    fn area() -> Ring {
        points(&[(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)])
    }

    fn total(polygons: &[Polygon]) -> f64 {
        polygons.iter().map(Polygon::area).sum()
    }

    #[test]
    fn water_lies_on_the_right_of_the_coast() {
        // Going east at y = 4: the right hand is south.
        let south =
            sea(&[points(&[(-5.0, 4.0), (5.0, 4.0)]), points(&[(5.0, 4.0), (15.0, 4.0)])], &area()).unwrap().polygons;
        assert!((total(&south) - 40.0).abs() < 1e-9 && south[0].contains(DVec2::new(5.0, 1.0)));
        let north = sea(&[points(&[(15.0, 4.0), (-5.0, 4.0)])], &area()).unwrap().polygons;
        assert!((total(&north) - 60.0).abs() < 1e-9 && north[0].contains(DVec2::new(5.0, 9.0)));
    }

    #[test]
    fn a_cape_and_a_bay_split_the_sea() {
        let capes = [points(&[(2.0, -1.0), (2.0, 11.0)]), points(&[(8.0, 11.0), (8.0, -1.0)])];
        // North-going at x = 2: water east; south-going at x = 8: water west.
        assert!((total(&sea(&capes, &area()).unwrap().polygons) - 60.0).abs() < 1e-9);
        let straits = [points(&[(2.0, 11.0), (2.0, -1.0)]), points(&[(8.0, -1.0), (8.0, 11.0)])];
        let both = sea(&straits, &area()).unwrap().polygons;
        assert_eq!(both.len(), 2);
        assert!((total(&both) - 40.0).abs() < 1e-9);
    }

    #[test]
    fn an_island_alone_makes_the_rest_sea() {
        let island = points(&[(4.0, 4.0), (6.0, 4.0), (6.0, 6.0), (4.0, 6.0), (4.0, 4.0)]);
        let all = sea(&[island], &area()).unwrap().polygons;
        assert!((total(&all) - 96.0).abs() < 1e-9, "{all:?}");
    }

    #[test]
    fn an_island_across_the_border_starts_anywhere() {
        let ring = [(5.0, -2.0), (7.0, 3.0), (3.0, 3.0)];
        for start in 0..3 {
            let mut island: Vec<(f64, f64)> = (0..=3).map(|i| ring[(start + i) % 3]).collect();
            island[3] = island[0];
            let water = sea(&[points(&island)], &area()).unwrap().polygons;
            // The triangle above y = 0: widths 1.6 and 4 over 3 m.
            assert!((total(&water) - (100.0 - 8.4)).abs() < 1e-9, "{start}: {}", total(&water));
        }
    }

    #[test]
    fn a_coast_that_ends_inside_is_refused() {
        assert!(sea(&[points(&[(-5.0, 4.0), (5.0, 4.5)])], &area()).unwrap_err().contains("ends inside"));
    }

    #[test]
    fn a_coast_that_ends_near_the_border_is_continued() {
        let made = sea(&[points(&[(-5.0, 4.0), (8.0, 4.0)])], &area()).unwrap();
        assert!((made.bridged - 2.0).abs() < 1e-9 && (total(&made.polygons) - 40.0).abs() < 1e-9, "{made:?}");
    }
}
