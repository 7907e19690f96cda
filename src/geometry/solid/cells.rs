//! The cells of a cut facet. In: a facet and the edges of its arrangement. Out: regions that no edge runs through,
//! each as triangles with a point inside.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use spade::handles::DirectedEdgeHandle;
use spade::{CdtEdge, ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::SolidError;
use super::facets::{Edge, Facet, Facets};
use crate::geometry::triangulate::triangulate_rings;

pub struct Cell {
    /// Counter-clockwise seen against the facet's normal, over pool vertices.
    pub triangles: Vec<[u32; 3]>,
    /// A point inside, well away from the border if there is room.
    pub inner: DVec3,
}

/// All cells inside the facet. `border` are the pieces of its own edges.
pub fn of(facets: &Facets, facet: &Facet, edges: &[Edge], border: &[Edge]) -> Result<Vec<Cell>, SolidError> {
    let vertices: Vec<u32> = {
        let mut all: Vec<u32> = edges.iter().flatten().copied().collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    // Spade refuses magnitudes below 1.8e-43.
    let plain = |x: f64| if x.abs() < 1e-40 { 0.0 } else { x };
    let flat = |v: u32| (facet.flat)(facets.position(v));
    let points: Vec<Point2<f64>> =
        vertices.iter().map(|&v| flat(v)).map(|p| Point2::new(plain(p.x), plain(p.y))).collect();
    let place = |v: u32| vertices.binary_search(&v).expect("the list was made of all edges");
    let constraints: Vec<[usize; 2]> = edges.iter().map(|e| e.map(place)).collect();
    let count = points.len();
    let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(points, constraints, |_| ())
        .map_err(|_| SolidError::NoCleanResult)?;
    if triangulation.num_vertices() != count || triangulation.num_constraints() < edges.len() {
        return Err(SolidError::NoCleanResult);
    }
    let mut odd: BTreeSet<[usize; 2]> = BTreeSet::new();
    for e in border {
        let [a, b] = e.map(place);
        if !odd.remove(&[a.min(b), a.max(b)]) {
            odd.insert([a.min(b), a.max(b)]);
        }
    }
    let regions = regions(&triangulation, &odd);
    let corners = |triangles: Vec<[usize; 3]>| triangles.into_iter().map(|t| t.map(|i| vertices[i])).collect();
    Ok(regions.into_iter().map(|r| cell(facets, facet, corners(r))).collect())
}

/// The facet as it is.
pub fn whole(facets: &Facets, facet: &Facet) -> Option<Cell> {
    let corners: Vec<u32> = facet.loops.iter().flatten().copied().collect();
    let flat: Vec<Vec<DVec2>> =
        facet.loops.iter().map(|l| l.iter().map(|&v| (facet.flat)(facets.position(v))).collect()).collect();
    let rings: Vec<&[DVec2]> = flat.iter().map(Vec::as_slice).collect();
    let triangles: Vec<[u32; 3]> =
        triangulate_rings(&rings).into_iter().map(|t| t.map(|c| corners[c as usize])).collect();
    (!triangles.is_empty()).then(|| cell(facets, facet, triangles))
}

fn cell(facets: &Facets, facet: &Facet, triangles: Vec<[u32; 3]>) -> Cell {
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| (facet.flat)(facets.position(v)));
        (b - a).perp_dot(c - a)
    };
    let widest = triangles.iter().copied().reduce(|best, t| if area(&t) > area(&best) { t } else { best });
    let [a, b, c] = widest.expect("a region has triangles").map(|v| facets.position(v));
    Cell { triangles, inner: (a + b + c) / 3.0 }
}

type Triangles = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Triangles inside the border (by an odd number of its edges from the outside), joined across edges that are no
/// constraints.
fn regions(triangulation: &Triangles, border: &BTreeSet<[usize; 2]>) -> Vec<Vec<[usize; 3]>> {
    let inside = inside(triangulation, border);
    let mut seen = vec![false; triangulation.num_all_faces()];
    let mut regions = Vec::new();
    for first in triangulation.inner_faces() {
        if !inside[first.fix().index()] || seen[first.fix().index()] {
            continue;
        }
        let mut triangles = Vec::new();
        let mut queue = vec![first];
        seen[first.fix().index()] = true;
        while let Some(face) = queue.pop() {
            triangles.push(face.vertices().map(|v| v.fix().index()));
            for side in face.adjacent_edges().into_iter().filter(|e| !e.is_constraint_edge()) {
                if let Some(next) = side.rev().face().as_inner()
                    && inside[next.fix().index()]
                    && !std::mem::replace(&mut seen[next.fix().index()], true)
                {
                    queue.push(next);
                }
            }
        }
        regions.push(triangles);
    }
    regions
}

fn inside(triangulation: &Triangles, border: &BTreeSet<[usize; 2]>) -> Vec<bool> {
    let is_border = |e: &DirectedEdgeHandle<'_, Point2<f64>, (), CdtEdge<()>, ()>| {
        let [a, b] = e.vertices().map(|v| v.fix().index());
        border.contains(&[a.min(b), a.max(b)])
    };
    let mut inside = vec![false; triangulation.num_all_faces()];
    let mut seen = vec![false; triangulation.num_all_faces()];
    seen[triangulation.outer_face().fix().index()] = true;
    let mut queue: Vec<_> = triangulation.directed_edges().filter(|e| e.is_outer_edge()).collect();
    while let Some(edge) = queue.pop() {
        let (from, to) = (edge.face().fix().index(), edge.rev().face());
        if !std::mem::replace(&mut seen[to.fix().index()], true) {
            inside[to.fix().index()] = inside[from] != is_border(&edge);
            let sides = to.as_inner().map(|f| f.adjacent_edges());
            queue.extend(sides.into_iter().flatten());
        }
    }
    inside
}
