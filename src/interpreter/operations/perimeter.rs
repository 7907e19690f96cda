//! Perimeters in sections. In: a loop of edges and slabs of its length. Out: which part of which edge belongs to which
//! section.

use glam::DVec2;

use super::split_sizes::{LEAST, Slab};
use crate::geometry::Polygon;

/// Edges of one loop, chained in its direction.
pub struct Perimeter {
    edges: Vec<ChainEdge>,
    /// The last edge ends where the first begins.
    closed: bool,
    pub sections: Vec<Section>,
}

struct ChainEdge {
    /// Number among the edges of the polygon.
    number: usize,
    from: DVec2,
    to: DVec2,
    /// Distance along the chain where it starts.
    start: f64,
}

/// A stretch of the perimeter.
pub struct Section {
    /// What is to be made of it: the number of the pattern's block.
    pub content: usize,
    /// Metres inwards.
    pub depth: f64,
    /// Along the chain, in order.
    pub parts: Vec<Part>,
    /// From the chain's start; `end` may lie beyond its end where the chain is closed.
    start: f64,
    end: f64,
}

/// One stretch of an edge.
pub struct Part {
    pub edge: usize,
    pub from: DVec2,
    pub to: DVec2,
    /// The ends of the stretch inside the edge, if not at its corners.
    cut_from: bool,
    cut_to: bool,
}

impl Perimeter {
    /// The edges of a ring for which `chosen` holds (all: a closed chain), from edge `start` on. `before` edges of the
    /// polygon come before the ring.
    pub fn of(ring: &[DVec2], before: usize, start: usize, chosen: impl Fn(usize) -> bool) -> Perimeter {
        let n = ring.len();
        let mut edges = Vec::with_capacity(n);
        let mut length = 0.0;
        for i in (start..start + n).map(|i| i % n).filter(|&i| chosen(i)) {
            let (from, to) = (ring[i], ring[(i + 1) % n]);
            edges.push(ChainEdge { number: before + i, from, to, start: length });
            length += from.distance(to);
        }
        Perimeter { closed: edges.len() == n, edges, sections: Vec::new() }
    }

    pub fn length(&self) -> f64 {
        self.edges.last().map_or(0.0, |e| e.start + e.from.distance(e.to))
    }

    /// Lays sections out, the first `offset` metres from the start. On a closed chain they go round; of an open one
    /// what lies beyond its ends is left out.
    pub fn lay(&mut self, slabs: &[Slab], offset: f64) {
        let length = self.length();
        let offset = if self.closed { offset.rem_euclid(length) } else { offset };
        for slab in slabs {
            let (start, end) = (slab.start + offset, slab.end + offset);
            let mut parts = self.parts(start, end);
            if self.closed {
                parts.extend(self.parts(start - length, end - length));
            }
            self.sections.push(Section { content: slab.body, depth: 0.0, parts, start, end });
        }
    }

    /// The stretches of edges between two places of the chain. Ends within [`LEAST`] of a corner are at the corner.
    fn parts(&self, start: f64, end: f64) -> Vec<Part> {
        let mut parts = Vec::new();
        for edge in &self.edges {
            let length = edge.from.distance(edge.to);
            let (a, b) = ((start - edge.start).max(0.0), (end - edge.start).min(length));
            if b - a <= LEAST {
                continue;
            }
            let (cut_from, cut_to) = (a > LEAST, b < length - LEAST);
            let at = |x: f64| edge.from + (edge.to - edge.from) * (x / length);
            let from = if cut_from { at(a) } else { edge.from };
            let to = if cut_to { at(b) } else { edge.to };
            parts.push(Part { edge: edge.number, from, to, cut_from, cut_to });
        }
        parts
    }

    /// Sections that follow each other with one depth above 0, with that depth; round the seam of a closed chain.
    pub fn runs(&self) -> Vec<(f64, Vec<usize>)> {
        let mut runs: Vec<(f64, Vec<usize>)> = Vec::new();
        let meets = |a: &Section, b: &Section| a.depth == b.depth && (b.start - a.end).abs() <= LEAST;
        for (i, section) in self.sections.iter().enumerate() {
            match runs.last_mut() {
                Some((_, list)) if meets(&self.sections[list[list.len() - 1]], section) => list.push(i),
                _ => runs.push((section.depth, vec![i])),
            }
        }
        if let [first, .., last] = &self.sections[..]
            && runs.len() > 1
            && self.closed
            && first.depth == last.depth
            && (last.end - self.length() - first.start).abs() <= LEAST
            && let Some((_, tail)) = runs.pop()
        {
            runs[0].1.splice(0..0, tail);
        }
        runs.retain(|(depth, _)| *depth > 0.0);
        runs
    }
}

impl Part {
    /// The band square to the edge within the stretch; `None` if it reaches from corner to corner, so that the strip's own
    /// ends count.
    pub fn band(&self, polygon: &Polygon) -> Option<Polygon> {
        if !self.cut_from && !self.cut_to {
            return None;
        }
        let (low, high) = polygon.bounds()?;
        let far = 2.0 * (high - low).length();
        let along = (self.to - self.from).try_normalize()?;
        let across = along.perp() * far;
        let from = if self.cut_from { self.from } else { self.from - along * far };
        let to = if self.cut_to { self.to } else { self.to + along * far };
        Some(Polygon { outer: vec![from - across, to - across, to + across, from + across], holes: Vec::new() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec2> {
        vec![DVec2::ZERO, DVec2::new(10.0, 0.0), DVec2::new(10.0, 10.0), DVec2::new(0.0, 10.0)]
    }

    fn laid(ends: &[(f64, f64)], offset: f64, chosen: impl Fn(usize) -> bool) -> Perimeter {
        let mut perimeter = Perimeter::of(&square(), 0, 0, chosen);
        let slabs: Vec<Slab> = ends.iter().map(|&(start, end)| Slab { body: 0, start, end }).collect();
        perimeter.lay(&slabs, offset);
        perimeter.sections.iter_mut().for_each(|s| s.depth = 1.0);
        perimeter
    }

    fn edges(section: &Section) -> Vec<usize> {
        section.parts.iter().map(|p| p.edge).collect()
    }

    #[test]
    fn sections_go_round_corners_and_the_seam() {
        let perimeter = laid(&[(0.0, 12.0), (12.0, 35.0), (35.0, 40.0)], 7.0, |_| true);
        let all: Vec<Vec<usize>> = perimeter.sections.iter().map(edges).collect();
        assert_eq!(all, [vec![0, 1], vec![1, 2, 3, 0], vec![0]]);
        assert_eq!(perimeter.sections[1].parts[3].to, DVec2::new(2.0, 0.0));
        assert_eq!(perimeter.runs().len(), 1);
        let length: f64 = perimeter.sections.iter().flat_map(|s| &s.parts).map(|p| p.from.distance(p.to)).sum();
        assert!((length - 40.0).abs() < 1e-9);
    }

    #[test]
    fn open_chains_end() {
        let perimeter = laid(&[(0.0, 5.0), (5.0, 25.0)], 3.0, |i| i != 1 && i != 2);
        assert_eq!(perimeter.sections.iter().map(edges).collect::<Vec<_>>(), [vec![0], vec![0, 3]]);
        assert!(!perimeter.closed && perimeter.length() == 20.0);
    }
}
