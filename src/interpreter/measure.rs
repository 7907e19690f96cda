//! Measures of the current geometry (reference 6.6). In: a shape. Out: areas, angles, extents, counts in world metres.

use glam::{DVec2, DVec3};

use super::derivation::Derivation;
use super::form::Form;
use super::shape::Shape;
use super::streets;
use super::topology::{Topology, used_vertices};
use crate::cga::builtins::Word;
use crate::geometry::{Face, Mesh, mesh_checks};

/// Sum of the face areas; with a word only of faces that look that way.
pub fn area(run: &Derivation, shape: &Shape, word: Option<Word>) -> f64 {
    let form = shape.world_form();
    let mesh = &form.mesh;
    let counted = |face: &&Face| match word {
        None | Some(Word::All | Word::Surface) => true,
        Some(word) => streets::face_agrees(run, word, mesh, face, shape) == Some(true),
    };
    mesh.faces.iter().filter(counted).map(|face| mesh.area(face)).sum()
}

/// Sum of the face areas of a form in world positions.
pub fn form_area(form: &Form) -> f64 {
    form.mesh.faces.iter().map(|face| form.mesh.area(face)).sum()
}

/// Whether some face (or edge or vertex normal) looks that way.
pub fn is_oriented(run: &Derivation, shape: &Shape, word: Word) -> bool {
    let form = shape.world_form();
    let mesh = &form.mesh;
    let agrees = |at: DVec3, n: DVec3| word == Word::All || streets::agrees(run, word, at, n, shape) == Some(true);
    mesh.faces.iter().any(|face| agrees(streets::middle(mesh, face), mesh.normal(face)))
        || form.normals.iter().any(|&n| agrees(shape.scope.center(), n))
}

/// Steepest slope against the ground, degrees, with the normal of that face.
pub fn steepest(shape: &Shape) -> (f64, DVec3) {
    let form = shape.world_form();
    let mut best = (0.0, DVec3::Y);
    for face in &form.mesh.faces {
        let normal = form.mesh.normal(face);
        let slope = libm::atan2(libm::hypot(normal.x, normal.z), normal.y.abs()).to_degrees();
        if normal != DVec3::ZERO && slope > best.0 {
            best = (slope, normal);
        }
    }
    best
}

/// Compass direction, clockwise from north (-z), degrees in [0, 360); 0 for what looks straight up or down.
pub fn azimuth(normal: DVec3) -> f64 {
    if normal.x == 0.0 && normal.z == 0.0 {
        return 0.0;
    }
    let angle = libm::atan2(normal.x, -normal.z).to_degrees().rem_euclid(360.0);
    if angle >= 360.0 { 0.0 } else { angle }
}

/// Length of the edges with at most one face.
pub fn boundary_length(shape: &Shape) -> f64 {
    let form = shape.world_form();
    let length = |a: u32, b: u32| form.mesh.positions[a as usize].distance(form.mesh.positions[b as usize]);
    let topology = Topology::of(&form.mesh);
    let border: f64 = topology.edges.iter().filter(|e| e.is_border()).map(|e| length(e.from, e.to)).sum();
    border + form.edges.iter().map(|&[a, b]| length(a, b)).sum::<f64>()
}

/// Vertical extent in the world.
pub fn height(shape: &Shape) -> f64 {
    shape.world_form().mesh.bounds().map_or(0.0, |(low, high)| high.y - low.y)
}

/// Enclosed volume; open meshes are summed against the scope's origin.
pub fn volume(shape: &Shape) -> f64 {
    let mut mesh = shape.world_form().mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p -= shape.scope.frame.origin);
    mesh_checks::volume(&mesh).abs()
}

pub fn count_edges(form: &Form) -> usize {
    if form.mesh.faces.is_empty() { form.edges.len() } else { Topology::of(&form.mesh).edges.len() }
}

pub fn count_vertices(form: &Form) -> usize {
    if form.mesh.faces.is_empty() { form.mesh.positions.len() } else { used_vertices(&form.mesh).len() }
}

/// Some face has a hole or turns right somewhere; straight corners do not count.
pub fn is_concave(shape: &Shape) -> bool {
    let form = shape.world_form();
    let mesh = &form.mesh;
    mesh.faces.iter().any(|face| {
        let normal = mesh.normal(face);
        !face.holes.is_empty()
            || corners(mesh, face)
                .any(|[a, b, c]| (b - a).cross(c - b).dot(normal) < -BEND * (b - a).length() * (c - b).length())
    })
}

/// Sine of the least angle that counts as a bend.
const BEND: f64 = 1e-6;

/// Neighbour, corner, neighbour for every corner of the outer loop.
fn corners<'a>(mesh: &'a Mesh, face: &'a Face) -> impl Iterator<Item = [DVec3; 3]> + 'a {
    let n = face.outer.len();
    let at = move |i: usize| mesh.positions[face.outer[i % n] as usize];
    (0..n).map(move |i| [at(i + n - 1), at(i), at(i + 1)])
}

/// At least one face, all with four corners and right angles within `tolerance` degrees.
pub fn is_rectangular(shape: &Shape, tolerance: f64) -> bool {
    let form = shape.world_form();
    let mesh = &form.mesh;
    let least = libm::sin(tolerance.max(0.0).to_radians()) + BEND;
    let right = |[a, b, c]: [DVec3; 3]| {
        let (p, q) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero());
        p.dot(q).abs() <= least && p != DVec3::ZERO && q != DVec3::ZERO
    };
    let rectangle = |face: &Face| face.outer.len() == 4 && face.holes.is_empty() && corners(mesh, face).all(right);
    !mesh.faces.is_empty() && mesh.faces.iter().all(rectangle)
}

/// At least one face, and every corner's normal within `tolerance` degrees of its face's.
pub fn is_planar(shape: &Shape, tolerance: f64) -> bool {
    let form = shape.world_form();
    let mesh = &form.mesh;
    let least = libm::cos(tolerance.max(0.0).to_radians()) - 1e-9;
    let flat = |face: &Face| {
        let normal = mesh.normal(face);
        corners(mesh, face).all(|[a, b, c]| {
            let corner = (b - a).cross(c - b);
            corner.length() <= BEND * (b - a).length() * (c - b).length()
                || corner.normalize().dot(normal).abs() >= least
        })
    };
    !mesh.faces.is_empty() && mesh.faces.iter().all(flat)
}

pub fn is_closed(shape: &Shape) -> bool {
    Topology::of(&shape.form.mesh).is_closed()
}

/// Least and greatest texture coordinates of a set; `None` where no face has it.
pub fn uv_range(form: &Form, set: u8) -> Option<(DVec2, DVec2)> {
    let points = form.mesh.faces.iter().filter_map(|face| face.uv(set)).flatten();
    points.fold(None, |range: Option<(DVec2, DVec2)>, p| {
        Some(range.map_or((*p, *p), |(low, high)| (low.min(*p), high.max(*p))))
    })
}

/// Extent of a set in metres: its range times the area-weighted mean of metres per unit along u and v.
pub fn uv_extent_in_metres(shape: &Shape, set: u8) -> DVec2 {
    let form = shape.world_form();
    let Some((low, high)) = uv_range(&form, set) else { return DVec2::ZERO };
    let (mut metres, mut weight) = (DVec2::ZERO, 0.0);
    for face in &form.mesh.faces {
        let Some(uv) = face.uv(set) else { continue };
        let area = form.mesh.area(face);
        if let Some(scale) = metres_per_unit(&form.mesh, face, uv) {
            metres += scale * area;
            weight += area;
        }
    }
    if weight > 0.0 { (high - low) * metres / weight } else { DVec2::ZERO }
}

/// Lengths in space of a step of 1 in u and in v, from the corner triangle of greatest texture area.
fn metres_per_unit(mesh: &Mesh, face: &Face, uv: &[DVec2]) -> Option<DVec2> {
    let n = face.outer.len();
    let point = |i: usize| mesh.positions[face.outer[i] as usize];
    let texture_area = |i: usize| (uv[i] - uv[0]).perp_dot(uv[i + 1] - uv[0]).abs();
    let best = (1..n.saturating_sub(1)).max_by(|&a, &b| texture_area(a).total_cmp(&texture_area(b)))?;
    let (d1, d2) = (uv[best] - uv[0], uv[best + 1] - uv[0]);
    let (e1, e2) = (point(best) - point(0), point(best + 1) - point(0));
    let determinant = d1.perp_dot(d2);
    if determinant == 0.0 {
        return None;
    }
    let along_u = (e1 * d2.y - e2 * d1.y) / determinant;
    let along_v = (e2 * d1.x - e1 * d2.x) / determinant;
    Some(DVec2::new(along_u.length(), along_v.length()))
}
