//! Scenes, cameras and demands for tests: a level plane, boxes, gabled houses.

use std::sync::Arc;

use glam::{DVec3, Vec2};

use crate::frame::{Frame, Pixels};
use crate::gpu::Renderer;
use crate::interpreter::material::Material;
use crate::plan::demand::{
    Ambient, Camera, Look, Output, OutputDemand, Projection, Quality, Selection, Shadows, State, Sun, ViewDemand,
};
use crate::plan::{RenderPlan, schedule, summarize};
use crate::scene::{Group, Presence, Scene, SceneClass, SceneObject, TriMesh};

pub const GROUND: u32 = 0;
pub const WALL: u32 = 1;
pub const ROOF: u32 = 2;
pub const TEXTURED: u32 = 3;
pub const FENCE: u32 = 4;

/// A scene with the materials above and no objects.
pub fn empty() -> Scene {
    let material = |color: [f64; 3], colormap: Option<&str>| {
        Arc::new(Material { color, colormap: colormap.map(Arc::from), ..Material::default() })
    };
    let check = image::RgbaImage::from_fn(16, 16, |x, y| {
        image::Rgba(if (x / 8 + y / 8) % 2 == 0 { [230, 220, 200, 255] } else { [120, 110, 100, 255] })
    });
    let fence = image::RgbaImage::from_fn(16, 16, |x, _| image::Rgba([90, 60, 30, if x < 8 { 255 } else { 0 }]));
    Scene {
        materials: vec![
            material([0.55, 0.6, 0.5], None),
            material([0.9, 0.88, 0.8], None),
            material([0.7, 0.3, 0.25], None),
            material([1.0; 3], Some("check")),
            material([1.0; 3], Some("fence")),
        ],
        textures: vec![("check".into(), Arc::new(check)), ("fence".into(), Arc::new(fence))],
        ..Scene::default()
    }
}

/// Adds convex faces (counter-clockwise from outside), each with its material and its plan as texture coordinates.
pub fn add(scene: &mut Scene, class: SceneClass, presence: Presence, faces: &[(Vec<DVec3>, u32)]) -> usize {
    let mut mesh = TriMesh::default();
    let mut sorted: Vec<_> = faces.iter().collect();
    sorted.sort_by_key(|(_, material)| *material);
    for (corners, material) in sorted {
        let base = mesh.positions.len() as u32;
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize().as_vec3();
        for p in corners {
            mesh.positions.push(*p);
            mesh.normals.push(normal);
            let along = if normal.y.abs() > 0.5 { p.z } else { p.y };
            let across = if normal.x.abs() > 0.5 { p.z } else { p.x };
            mesh.uvs.push(Vec2::new(((across / 4.0) % 64.0) as f32, ((along / 4.0) % 64.0) as f32));
        }
        let first = mesh.triangles.len() as u32;
        let count = corners.len() as u32 - 2;
        mesh.triangles.extend((1..=count).map(|i| [base, base + i, base + i + 1]));
        match mesh.groups.last_mut() {
            Some(group) if group.material == *material => group.count += count,
            _ => mesh.groups.push(Group { material: *material, first, count }),
        }
    }
    let number = scene.objects.len();
    let (feature, change, level) = (None, 0, 0);
    let instance = number as u32 + 1;
    scene.objects.push(SceneObject { feature, instance, class, presence, change, level, mesh: mesh.into() });
    number
}

pub fn plane(scene: &mut Scene, low: (f64, f64), high: (f64, f64), material: u32) -> usize {
    let face = quad([(low.0, low.1), (low.0, high.1), (high.0, high.1), (high.0, low.1)], 0.0);
    add(scene, SceneClass::Terrain, Presence::Both, &[(face, material)])
}

fn quad(plan: [(f64, f64); 4], y: f64) -> Vec<DVec3> {
    plan.iter().map(|&(x, z)| DVec3::new(x, y, z)).collect()
}

fn block_walls(low: DVec3, high: DVec3) -> Vec<(Vec<DVec3>, u32)> {
    let ring = [(low.x, low.z), (low.x, high.z), (high.x, high.z), (high.x, low.z)];
    (0..4)
        .map(|i| {
            let ((ax, az), (bx, bz)) = (ring[i], ring[(i + 1) % 4]);
            let corners = [(ax, low.y, az), (bx, low.y, bz), (bx, high.y, bz), (ax, high.y, az)];
            (corners.map(DVec3::from).to_vec(), WALL)
        })
        .collect()
}

/// A box from `low` to `high`.
pub fn block(scene: &mut Scene, presence: Presence, low: DVec3, high: DVec3) -> usize {
    let mut faces = block_walls(low, high);
    faces.push((quad([(low.x, low.z), (low.x, high.z), (high.x, high.z), (high.x, low.z)], high.y), ROOF));
    add(scene, SceneClass::Building, presence, &faces)
}

/// A house with its ridge along x, with textured roof.
pub fn gable(scene: &mut Scene, presence: Presence, low: DVec3, high: DVec3) -> usize {
    let mut faces = block_walls(low, high);
    let (middle, top) = ((low.z + high.z) / 2.0, high.y + (high.z - low.z) * 0.4);
    let ridge = [DVec3::new(low.x, top, middle), DVec3::new(high.x, top, middle)];
    let eaves = |x: f64, z: f64| DVec3::new(x, high.y, z);
    faces.push((vec![eaves(low.x, high.z), eaves(high.x, high.z), ridge[1], ridge[0]], TEXTURED));
    faces.push((vec![eaves(high.x, low.z), eaves(low.x, low.z), ridge[0], ridge[1]], TEXTURED));
    faces.push((vec![eaves(low.x, low.z), eaves(low.x, high.z), ridge[0]], WALL));
    faces.push((vec![eaves(high.x, high.z), eaves(high.x, low.z), ridge[1]], WALL));
    add(scene, SceneClass::Building, presence, &faces)
}

/// `n × n` houses 16 m apart on a plane, every fifth a box; fractions of metres keep edges off pixel centres.
pub fn town(n: u32) -> Scene {
    let mut scene = empty();
    let half = f64::from(n) * 8.0;
    plane(&mut scene, (-half - 20.0, -half - 20.0), (half + 20.0, half + 20.0), GROUND);
    for i in 0..n * n {
        let (x, z) = (f64::from(i % n) * 16.0 - half + 2.3, f64::from(i / n) * 16.0 - half + 1.9);
        let height = 4.0 + f64::from(i * 7 % 11) * 0.7;
        let (low, high) = (DVec3::new(x, 0.0, z), DVec3::new(x + 9.1, height, z + 7.3));
        let presence = [Presence::Both, Presence::BeforeOnly, Presence::Both, Presence::AfterOnly][i as usize % 4];
        if i % 5 == 0 {
            block(&mut scene, presence, low, high)
        } else {
            gable(&mut scene, presence, low, high)
        };
    }
    scene
}

/// Straight down on the point (x, z), north up, square pixels of `gsd` metres on the ground at height 0.
pub fn nadir(x: f64, z: f64, gsd: f64, width: u32, height: u32) -> Camera {
    let altitude = 512.0;
    let tan = |pixels: u32| f64::from(pixels) * gsd / 2.0 / altitude;
    Camera {
        position: DVec3::new(x, altitude, z),
        right: DVec3::X,
        up: DVec3::NEG_Z,
        forward: DVec3::NEG_Y,
        projection: Projection::Perspective { tan_x: tan(width), tan_y: tan(height) },
        width,
        height,
        near: 256.0,
    }
}

/// Turns a nadir camera about the ground point below it, by `degrees` off nadir towards the south.
pub fn tilted(camera: Camera, degrees: f64) -> Camera {
    let (sin, cos) = (libm::sin(degrees.to_radians()), libm::cos(degrees.to_radians()));
    let target = DVec3::new(camera.position.x, 0.0, camera.position.z);
    let forward = DVec3::new(0.0, -cos, -sin);
    let up = DVec3::new(0.0, sin, -cos);
    Camera { position: target - forward * camera.position.y, forward, up, near: 64.0, ..camera }
}

pub fn sun(elevation_deg: f64, azimuth_deg: f64) -> Sun {
    let (e, a) = (elevation_deg.to_radians(), azimuth_deg.to_radians());
    let flat = libm::cos(e);
    let direction = DVec3::new(flat * libm::sin(a), libm::sin(e), -flat * libm::cos(a));
    Sun { direction, disc_deg: 0.533, irradiance: [0.9, 0.87, 0.8] }
}

fn is_present(object: &SceneObject, state: State) -> bool {
    match object.presence {
        Presence::Both => true,
        Presence::BeforeOnly => state == State::Before,
        Presence::AfterOnly => state == State::After,
    }
}

/// Asks for all objects of a state, and marks those that the other does not have.
pub fn demand(scene: &Scene, output: Output, state: State) -> OutputDemand {
    OutputDemand {
        pass: format!("{output:?} {state:?}").to_lowercase(),
        output,
        selection: Selection { state, objects: scene.objects.iter().map(|o| is_present(o, state)).collect() },
        marked: Some(scene.objects.iter().map(|o| o.presence != Presence::Both).collect()),
        look: Look::plain(
            Shadows::Soft,
            Ambient::Sky { zenith: [0.16, 0.19, 0.26], ground: [0.06, 0.06, 0.05], occluded: false },
        ),
    }
}

pub fn view(camera: Camera, sun: Sun, outputs: Vec<OutputDemand>) -> ViewDemand {
    let quality = Quality { supersample: 2, shadow_map: 1024, shadow_samples: 3, sky_samples: 4, field_map: 64 };
    ViewDemand { name: "test".into(), camera, sun: Some(sun), quality, outputs }
}

pub fn plan(scene: &Scene, view: ViewDemand) -> RenderPlan {
    schedule(&[view], &summarize(scene))
}

/// Uploads and renders one view.
pub fn render(renderer: &mut Renderer, scene: &Scene, view: ViewDemand) -> Frame {
    renderer.upload(scene).expect("the scene uploads");
    renderer.render(&plan(scene, view).views[0]).expect("the view renders")
}

pub fn rgb(frame: &Frame, image: usize) -> &[u8] {
    match &frame.images[image].pixels {
        Pixels::Rgb8(pixels) => pixels,
        other => panic!("a colour image, not {other:?}"),
    }
}

pub fn gray(frame: &Frame, image: usize) -> &[u8] {
    match &frame.images[image].pixels {
        Pixels::Gray8(pixels) => pixels,
        other => panic!("a label image, not {other:?}"),
    }
}

/// Writes the picture for people to look at when `MANSARD_KEEP_PICTURES` names a folder.
pub fn keep(frame: &Frame, image: usize, name: &str) {
    if let Ok(folder) = std::env::var("MANSARD_KEEP_PICTURES") {
        let path = std::path::Path::new(&folder).join(name);
        let pixels = rgb(frame, image).to_vec();
        let picture = image::RgbImage::from_raw(frame.width, frame.height, pixels).expect("the frame's size");
        picture.save(path).expect("the folder is writable");
    }
}
