//! A picture of one derivation, for `mansard derive --format png` and for the manual. In: the shape tree and the start
//! shape. Out: an RGB image: the leaves from the front right and above, in parallel projection, on a pale floor with the
//! start shape drawn on it, edges of faces as dark lines.

use std::sync::Arc;

use glam::{DVec3, Vec2};

use super::error::PipelineError;
use super::single::single_scene;
use crate::frame::Pixels;
use crate::geometry::{Face, Mesh};
use crate::gpu::Renderer;
use crate::interpreter::material::Material;
use crate::interpreter::tree::ShapeTree;
use crate::plan::demand::{
    Ambient, Camera, Look, Output, OutputDemand, Projection, Quality, Selection, Shadows, State, Sun, ViewDemand,
};
use crate::plan::{schedule, summarize, sun, view};
use crate::scene::{Group, Presence, Scene, SceneClass, SceneObject, TriMesh};
use crate::source::Access;

/// Degrees from the vertical, clockwise from north: from the front (south) right.
const OFF_NADIR: f64 = 58.0;
const AZIMUTH: f64 = 148.0;
/// Degrees above the horizon, clockwise from north.
const SUN: (f64, f64) = (48.0, 215.0);
/// Share of the image that stays free around the shape.
const MARGIN: f64 = 0.06;
/// Pixels on each side of an edge.
const LINE: f64 = 0.9;
/// Pixels that lines stand in front of their faces.
const LIFT: f64 = 0.12;
/// Pixels that the outer halves of lines stand behind their edges, seen only against what lies farther away.
const DEPTH: f64 = 1.0;
/// Pixels.
const POINT: f64 = 7.0;

const FLOOR: [f64; 3] = [0.93, 0.935, 0.93];
const LOT: [f64; 3] = [0.80, 0.83, 0.78];
const INK: [f64; 3] = [0.13, 0.14, 0.17];
const DOT: [f64; 3] = [0.80, 0.15, 0.12];

/// Draws a derivation; the sizes are pixels, at least 1.
///
/// # Errors
/// Textures that cannot be read, and everything [`crate::gpu`] refuses.
pub fn portrait(
    tree: &ShapeTree,
    start: &Mesh,
    access: &Access,
    (width, height): (u32, u32),
) -> Result<image::RgbImage, PipelineError> {
    let mut scene = single_scene(tree, access)?;
    let (low, high) = bounds(tree, start);
    let camera = camera((low, high), (width, height));
    let pixel = pixel_size(&camera);
    let sketch = Sketch { towards: -camera.forward, pixel };
    let floor = low.y - 2.0 * pixel;
    add(&mut scene, FLOOR, sketch.floor((low, high), floor));
    add(&mut scene, LOT, sketch.lot(start, floor + pixel));
    add(&mut scene, INK, sketch.lines(tree));
    add(&mut scene, DOT, sketch.points(tree));
    let mut renderer = Renderer::new()?;
    renderer.upload(&scene)?;
    let plan = schedule(&[demand(&scene, camera)], &summarize(&scene));
    let frame = renderer.render(&plan.views[0])?;
    let Pixels::Rgb8(pixels) = frame.images.into_iter().next().expect("one output was asked for").pixels else {
        unreachable!("a colour output gives an RGB image")
    };
    Ok(image::RgbImage::from_raw(width, height, pixels).expect("the image has the camera's size"))
}

/// Box of all leaves and the start shape.
fn bounds(tree: &ShapeTree, start: &Mesh) -> (DVec3, DVec3) {
    let meshes = tree.leaves.iter().map(|l| &l.mesh).chain([start]);
    let boxes = meshes.filter_map(Mesh::bounds);
    boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((DVec3::ZERO, DVec3::ONE))
}

fn camera((low, high): (DVec3, DVec3), (width, height): (u32, u32)) -> Camera {
    let (right, up, forward) = view::frame(OFF_NADIR, AZIMUTH, AZIMUTH + 180.0);
    let centre = (low + high) / 2.0;
    let half = (high - low) / 2.0;
    let reach = |axis: DVec3| half.dot(axis.abs()).max(0.5);
    let aspect = f64::from(height) / f64::from(width);
    let half_x = reach(right).max(reach(up) / aspect) * (1.0 + 2.0 * MARGIN);
    let distance = 4.0 * half.length() + 10.0;
    Camera {
        position: centre - forward * distance,
        right,
        up,
        forward,
        projection: Projection::Orthographic { half_x, half_y: half_x * aspect },
        width,
        height,
        near: 0.01,
    }
}

/// Metres.
fn pixel_size(camera: &Camera) -> f64 {
    match camera.projection {
        Projection::Orthographic { half_x, .. } => 2.0 * half_x / f64::from(camera.width),
        Projection::Perspective { tan_x, .. } => 2.0 * tan_x / f64::from(camera.width),
    }
}

fn demand(scene: &Scene, camera: Camera) -> ViewDemand {
    let direction = sun::from_angles(SUN.0, SUN.1);
    let output = OutputDemand {
        pass: "portrait".into(),
        output: Output::Color,
        selection: Selection { state: State::Before, objects: scene.objects.iter().map(|_| true).collect() },
        marked: None,
        look: Look::plain(
            Shadows::Soft,
            Ambient::Sky { zenith: [0.42, 0.43, 0.46], ground: [0.25, 0.25, 0.24], occluded: false },
        ),
    };
    ViewDemand {
        name: "portrait".into(),
        camera,
        sun: Some(Sun { direction, disc_deg: 0.53, irradiance: [0.72, 0.71, 0.68] }),
        quality: Quality { supersample: 4, shadow_map: 2048, shadow_samples: 3, sky_samples: 1, field_map: 64 },
        outputs: vec![output],
    }
}

fn add(scene: &mut Scene, color: [f64; 3], mut mesh: TriMesh) {
    if mesh.triangles.is_empty() {
        return;
    }
    mesh.groups = vec![Group { material: scene.materials.len() as u32, first: 0, count: mesh.triangles.len() as u32 }];
    scene.materials.push(Arc::new(Material { color, ..Material::default() }));
    let bounds = mesh.positions.iter().fold(scene.bounds, |(lo, hi), &p| (lo.min(p), hi.max(p)));
    scene.bounds = bounds;
    let instance = scene.objects.len() as u32 + 1;
    let (feature, change, level) = (None, 0, 0);
    let (class, presence) = (SceneClass::Terrain, Presence::Both);
    scene.objects.push(SceneObject { feature, instance, class, presence, change, level, mesh: mesh.into() });
}

/// Flat drawing that faces the camera.
struct Sketch {
    /// Unit vector to the camera.
    towards: DVec3,
    /// Metres.
    pixel: f64,
}

impl Sketch {
    fn floor(&self, (low, high): (DVec3, DVec3), height: f64) -> TriMesh {
        let reach = 20.0 * (high - low).length() + 100.0;
        let corner = |x: f64, z: f64| DVec3::new((low.x + high.x) / 2.0 + x, height, (low.z + high.z) / 2.0 + z);
        let mut mesh = TriMesh::default();
        let corners = [(-reach, reach), (reach, reach), (reach, -reach), (-reach, -reach)];
        quad(&mut mesh, corners.map(|(x, z)| corner(x, z)), DVec3::Y);
        mesh
    }

    /// The start shape's faces as seen from above, laid on the floor.
    fn lot(&self, start: &Mesh, height: f64) -> TriMesh {
        let mut mesh = TriMesh::default();
        for (_, corners) in crate::geometry::triangulate::triangles(start) {
            let flat = corners.map(|p| DVec3::new(p.x, height, p.z));
            push(&mut mesh, &flat, DVec3::Y, &[[0, 1, 2]]);
        }
        mesh
    }

    /// Strips along the edges of every face, on the face, so that what hides the face hides them.
    fn lines(&self, tree: &ShapeTree) -> TriMesh {
        let mut mesh = TriMesh::default();
        let faces = tree.leaves.iter().flat_map(|l| l.mesh.faces.iter().map(move |f| (&l.mesh, f)));
        for (body, face) in faces {
            let normal = body.normal(face);
            for (a, b) in Face::edges(face) {
                self.strip(&mut mesh, body.positions[a as usize], body.positions[b as usize], normal);
            }
        }
        mesh
    }

    /// A strip of [`LINE`] in the image on the left of an edge, and one on both sides behind it.
    fn strip(&self, mesh: &mut TriMesh, a: DVec3, b: DVec3, normal: DVec3) {
        let inwards = normal.cross(b - a).normalize_or_zero();
        let Some(across) = self.towards.cross(b - a).try_normalize() else { return };
        let (aside, back) = (across * (LINE * self.pixel), self.towards * (-DEPTH * self.pixel));
        quad(mesh, [a - aside, b - aside, b + aside, a + aside].map(|p| p + back), self.towards);
        // A face seen almost edge on is not made into a spike.
        let inwards = inwards * (LINE * self.pixel / inwards.dot(across).abs().max(0.2));
        let lift = self.towards * (LIFT * self.pixel);
        quad(mesh, [a, b, b + inwards, a + inwards].map(|p| p + lift), self.towards);
    }

    /// Leaves without faces: a dot at every point.
    fn points(&self, tree: &ShapeTree) -> TriMesh {
        let mut mesh = TriMesh::default();
        let bare = tree.leaves.iter().filter(|l| l.mesh.faces.is_empty());
        for &p in bare.flat_map(|l| &l.mesh.positions) {
            let (x, y) = self.towards.any_orthonormal_pair();
            let (x, y) = (x * (POINT * self.pixel / 2.0), y * (POINT * self.pixel / 2.0));
            let lift = self.towards * (3.0 * self.pixel);
            quad(&mut mesh, [p - x, p + y, p + x, p - y].map(|p| p + lift), self.towards);
        }
        mesh
    }
}

fn quad(mesh: &mut TriMesh, corners: [DVec3; 4], normal: DVec3) {
    push(mesh, &corners, normal, &[[0, 1, 2], [0, 2, 3]]);
}

/// Adds triangles over these corners, turned so that they face along the normal.
fn push(mesh: &mut TriMesh, corners: &[DVec3], normal: DVec3, triangles: &[[u32; 3]]) {
    let first = mesh.positions.len() as u32;
    let away = (corners[1] - corners[0]).cross(corners[2] - corners[0]).dot(normal) < 0.0;
    mesh.positions.extend(corners);
    mesh.normals.extend(corners.iter().map(|_| normal.as_vec3()));
    mesh.uvs.extend(corners.iter().map(|_| Vec2::ZERO));
    let turned = |t: [u32; 3]| if away { [t[0], t[2], t[1]] } else { t };
    mesh.triangles.extend(triangles.iter().map(|&t| turned(t).map(|i| first + i)));
}
