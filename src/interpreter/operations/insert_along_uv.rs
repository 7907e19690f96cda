//! `insertAlongUV` (reference 4.11). In: a texture set of triangles and quads, a geometry file, a height. Out: the
//! asset repeated along u, one depth of it over v 0..1, bent onto the faces and cut along their edges.

use glam::{DMat3, DVec2, DVec3};

use super::super::assets::Asset;
use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::limits::Outcome;
use super::super::shape::Shape;
use super::super::topology::vertex_normals;
use super::args::Args;
use super::insert;
use crate::cga::builtins::Word;
use crate::geometry::cut::{Origin, cut};
use crate::geometry::polygon::signed_area;
use crate::geometry::transform::flip_face;
use crate::geometry::{Face, Mesh, Plane};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) -> Outcome<()> {
    let Some(set) = args.uv_set(run, 0) else { return Ok(()) };
    let height = args.float_or(run, 2, 0.0);
    shape.bake();
    let normals = (args.word(3) == Some(Word::VertexNormal)).then(|| vertex_normals(&shape.form.mesh));
    let up = shape.scope.frame.axes.y_axis;
    let cells = cells(&shape.form.mesh, set, |v| normals.as_ref().map_or(up, |list| list[v as usize]));
    if cells.is_empty() {
        run.warn("cga::no-uv", args.span, || format!("no triangle or quad here has an area in texture set {set}"));
        return Ok(());
    }
    let asset = insert::load(run, args, 1);
    let strip = flattened(&asset, height, args.word(4) == Some(Word::KeepPosition));
    let tiles: f64 = cells.iter().map(|cell| cell.tiles().1).sum();
    // The limit is far below what a usize holds.
    run.allow_vertices((tiles * strip.positions.len() as f64) as usize, args.span)?;
    let (mut mesh, mut sources) = (Mesh::default(), Vec::new());
    for cell in &cells {
        let (first, count) = cell.tiles();
        for k in 0..count as usize {
            cell.bend(&strip, first + k as f64, &mut mesh, &mut sources);
        }
    }
    if mesh.faces.is_empty() {
        run.warn("cga::no-uv", args.span, || format!("nothing here lies between 0 and 1 of v in texture set {set}"));
    }
    let form: Form = asset.form.derived(mesh, sources.into_iter());
    shape.replace(form);
    Ok(())
}

/// The asset with x as u, y as metres above the surface, z as -v; corner normals are not kept.
fn flattened(asset: &Asset, height: f64, keeps_position: bool) -> Mesh {
    let (low, size) = (asset.low, asset.size);
    let share = |x: f64, i: usize| if size[i] == 0.0 { 0.0 } else { x / size[i] };
    let floor = if keeps_position { 0.0 } else { low.y };
    let place =
        |p: &DVec3| DVec3::new(share(p.x - low.x, 0), share(p.y - floor, 1) * height, share(p.z - low.z, 2) - 1.0);
    let mut mesh = asset.form.mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p = place(p));
    mesh.faces.iter_mut().for_each(|face| face.normals.clear());
    if height < 0.0 {
        mesh.faces.iter_mut().for_each(flip_face);
    }
    mesh
}

/// A convex piece of the surface on which place and direction are affine in u and v.
struct Cell {
    /// Counter-clockwise in u and v.
    outline: Vec<DVec2>,
    position: Affine,
    direction: Affine,
}

/// `origin + u * along_u + v * along_v`.
struct Affine {
    origin: DVec3,
    along_u: DVec3,
    along_v: DVec3,
}

impl Affine {
    /// Through three values; the uvs do not lie on a line.
    fn through(uv: [DVec2; 3], values: [DVec3; 3]) -> Affine {
        let (d, e) = (uv[1] - uv[0], uv[2] - uv[0]);
        let (p, q) = (values[1] - values[0], values[2] - values[0]);
        let area = d.perp_dot(e);
        let (along_u, along_v) = ((p * e.y - q * d.y) / area, (q * d.x - p * e.x) / area);
        Affine { origin: values[0] - along_u * uv[0].x - along_v * uv[0].y, along_u, along_v }
    }

    fn at(&self, uv: DVec2) -> DVec3 {
        self.origin + self.along_u * uv.x + self.along_v * uv.y
    }
}

/// Differences below this share are rounding.
const SAME: f64 = 1e-9;

/// The triangles and quads that have an area in the texture; quads on which the map is not affine as two triangles.
fn cells(mesh: &Mesh, set: u8, direction: impl Fn(u32) -> DVec3) -> Vec<Cell> {
    let mut out = Vec::new();
    for face in mesh.faces.iter().filter(|f| f.holes.is_empty() && matches!(f.outer.len(), 3 | 4)) {
        let Some(uv) = face.uv(set) else { continue };
        let triangles: &[[usize; 3]] = if face.outer.len() == 3 { &[[0, 1, 2]] } else { &[[0, 1, 2], [0, 2, 3]] };
        let cell = |corners: [usize; 3]| {
            let uv = corners.map(|i| uv[i]);
            let vertices = corners.map(|i| face.outer[i]);
            if signed_area(&uv).abs() <= SAME * SAME {
                return None;
            }
            let position = Affine::through(uv, vertices.map(|v| mesh.positions[v as usize]));
            Some(Cell {
                outline: counter_clockwise(&uv),
                position,
                direction: Affine::through(uv, vertices.map(&direction)),
            })
        };
        let mut parts: Vec<Cell> = triangles.iter().filter_map(|&corners| cell(corners)).collect();
        if parts.len() == 2 && is_affine(&parts[0], mesh, face, uv, &direction) {
            parts.truncate(1);
            parts[0].outline = counter_clockwise(uv);
        }
        out.extend(parts);
    }
    out
}

/// Whether the map of a quad's first triangle fits its fourth corner too, and the quad is convex in the texture.
fn is_affine(first: &Cell, mesh: &Mesh, face: &Face, uv: &[DVec2], direction: impl Fn(u32) -> DVec3) -> bool {
    let (last, uv_last) = (face.outer[3], uv[3]);
    let place = mesh.positions[last as usize];
    let size = place.distance(mesh.positions[face.outer[1] as usize]);
    let ring = counter_clockwise(uv);
    let convex = (0..4).all(|i| (ring[(i + 1) % 4] - ring[i]).perp_dot(ring[(i + 2) % 4] - ring[(i + 1) % 4]) > 0.0);
    convex
        && first.position.at(uv_last).distance(place) <= SAME * size
        && first.direction.at(uv_last).distance(direction(last)) <= SAME
}

fn counter_clockwise(uv: &[DVec2]) -> Vec<DVec2> {
    let mut ring = uv.to_vec();
    if signed_area(&ring) < 0.0 {
        ring.reverse();
    }
    ring
}

impl Cell {
    /// The first whole u whose tile begins at or before the cell, and the number of tiles over it.
    fn tiles(&self) -> (f64, f64) {
        let us = || self.outline.iter().map(|p| p.x);
        let low = us().fold(f64::INFINITY, f64::min);
        let high = us().fold(f64::NEG_INFINITY, f64::max);
        let first = (low + SAME).floor();
        (first, ((high - SAME).ceil() - first).max(0.0))
    }

    /// Adds what the tile that begins at `u` leaves on the cell.
    fn bend(&self, strip: &Mesh, u: f64, mesh: &mut Mesh, sources: &mut Vec<Option<u32>>) {
        let mut tile = strip.clone();
        tile.positions.iter_mut().for_each(|p| p.x += u);
        let (tile, origins) = self.clipped(tile);
        let place = |p: &DVec3| {
            let uv = DVec2::new(p.x, -p.z);
            self.position.at(uv) + self.direction.at(uv).normalize_or_zero() * p.y
        };
        let mirrored = self.mirrors();
        let start = mesh.positions.len() as u32;
        mesh.positions.extend(tile.positions.iter().map(place));
        for (mut face, origin) in tile.faces.into_iter().zip(origins) {
            face.loops_mut().flatten().for_each(|v| *v += start);
            if mirrored {
                flip_face(&mut face);
            }
            mesh.faces.push(face);
            sources.push(Some(origin));
        }
    }

    /// Whether the texture lies mirrored on the surface, seen from where heights rise to.
    fn mirrors(&self) -> bool {
        let middle = self.outline.iter().sum::<DVec2>() / self.outline.len() as f64;
        let up = self.direction.at(middle);
        DMat3::from_cols(self.position.along_u, up, -self.position.along_v).determinant() < 0.0
    }

    /// The part of a tile over the cell, without faces that close cuts, and the asset's face of every face.
    fn clipped(&self, tile: Mesh) -> (Mesh, Vec<u32>) {
        let mut origins: Vec<u32> = (0..tile.faces.len() as u32).collect();
        let mut mesh = tile;
        for (i, &from) in self.outline.iter().enumerate() {
            let along = self.outline[(i + 1) % self.outline.len()] - from;
            let Some(inwards) = along.perp().try_normalize() else { continue };
            // v runs against z.
            let plane = Plane { normal: DVec3::new(inwards.x, 0.0, -inwards.y), offset: inwards.dot(from) };
            let front = cut(&mesh, &plane).front;
            let mut kept = Mesh { positions: front.mesh.positions, faces: Vec::new() };
            let mut sources = Vec::new();
            for (face, origin) in front.mesh.faces.into_iter().zip(front.origins) {
                if let Origin::Face(number) = origin {
                    kept.faces.push(face);
                    sources.push(origins[number as usize]);
                }
            }
            (mesh, origins) = (kept, sources);
        }
        (mesh, origins)
    }
}
