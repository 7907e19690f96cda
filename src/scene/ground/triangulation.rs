//! In: segments that meet in common ends only. Out: the constrained Delaunay triangulation, vertices at terrain height.

use glam::DVec2;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation as _};

use super::GroundError;
use super::lattice::{Node, Segment, metres};
use crate::geodata::terrain::Terrain;

/// A vertex in the plan with its height, metres; NaN where the terrain has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    position: Point2<f64>,
    pub height: f64,
}

pub(super) type Triangulation = ConstrainedDelaunayTriangulation<Vertex>;

impl Vertex {
    pub(super) fn new(plan: DVec2, height: f64) -> Self {
        Vertex { position: Point2::new(plan.x, plan.y), height }
    }

    pub(super) fn plan(&self) -> DVec2 {
        DVec2::new(self.position.x, self.position.y)
    }
}

impl HasPosition for Vertex {
    type Scalar = f64;

    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// Triangulates the convex hull of the segments.
pub(super) fn triangulate(segments: &[Segment], terrain: &Terrain) -> Result<Triangulation, GroundError> {
    let mut nodes: Vec<Node> = segments.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let number = |n: &Node| nodes.binary_search(n).expect("every end was collected");
    let edges = segments.iter().map(|[a, b]| [number(a), number(b)]).collect();
    let vertices = nodes.iter().map(|&n| {
        let plan = metres(n);
        Vertex::new(plan, terrain.height(plan).unwrap_or(f64::NAN))
    });
    let mut conflicts = 0;
    let triangulation = Triangulation::try_bulk_load_cdt(vertices.collect(), edges, |_| conflicts += 1)
        .expect("lattice coordinates are finite");
    if conflicts == 0 { Ok(triangulation) } else { Err(GroundError::Unresolved) }
}

/// Corners of all triangles, counter-clockwise, in a fixed order.
pub(super) fn faces(triangulation: &Triangulation) -> impl Iterator<Item = [usize; 3]> {
    triangulation.inner_faces().map(|f| f.vertices().map(|v| v.index()))
}

pub(super) fn vertex(triangulation: &Triangulation, index: usize) -> Vertex {
    *triangulation.vertex(FixedVertexHandle::from_index(index)).data()
}

pub(super) fn vertex_count(triangulation: &Triangulation) -> usize {
    triangulation.num_vertices()
}
