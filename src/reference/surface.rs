//! Surface: the scene's faces with what is seen of them. In: a scene. Out: what a ray finds where it meets a face.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec3};

use super::ReferenceError;
use super::color::{self, Light, Rgb};
use super::ray::{Crossing, Triangle};
use crate::interpreter::material::{MapTransform, Material};
use crate::plan::pass::Surface;
use crate::plan::summary::{least_alpha, material_surfaces};
use crate::scene::reflectance::near_infrared_gain;
use crate::scene::{Scene, SceneClass, SceneObject};

/// A triangle besides its corners.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    pub object: u32,
    material: u32,
    normals: [Vec3; 3],
    uvs: [Vec2; 3],
}

/// A material as light sees it.
struct Coat {
    albedo: Rgb,
    texture: Option<usize>,
    /// Alpha under which a texel is a hole, where the texture has holes.
    hole_below: Option<f64>,
    transform: MapTransform,
    /// Near-infrared gain by class.
    gains: [f64; CLASSES],
}

/// Numbers of classes, and one for the 0 that is none.
const CLASSES: usize = SceneClass::ALL.len() + 1;

/// Materials, textures and the properties of objects.
pub struct Surfaces {
    coats: Vec<Coat>,
    textures: Vec<Arc<image::RgbaImage>>,
    linear: [f64; 256],
    /// Per object.
    classes: Vec<SceneClass>,
    /// Per object: seen from both sides.
    two_sided: Vec<bool>,
    /// Per object: of faces in one place the lowest number is seen.
    layer: Vec<u8>,
}

/// What a ray finds. Both normals are of unit length and look to the side that is seen.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub position: DVec3,
    /// As the mesh says, smooth over curved ground.
    pub normal: DVec3,
    /// Of the flat triangle.
    pub face_normal: DVec3,
    pub albedo: Light,
}

impl Surfaces {
    pub fn new(scene: &Scene) -> Surfaces {
        let kinds = material_surfaces(scene);
        let coats = scene.materials.iter().zip(&kinds).map(|(material, kind)| Coat {
            albedo: material.color.map(|c| color::linear(c.clamp(0.0, 1.0))),
            texture: material
                .colormap
                .as_ref()
                .and_then(|name| scene.textures.binary_search_by(|(other, _)| other.cmp(name)).ok()),
            hole_below: (*kind == Some(Surface::Cutout)).then(|| least_alpha(material)),
            transform: material.colormap_transform,
            gains: gains(material),
        });
        Surfaces {
            coats: coats.collect(),
            textures: scene.textures.iter().map(|(_, texture)| texture.clone()).collect(),
            linear: color::table(),
            classes: scene.objects.iter().map(|o| o.class).collect(),
            two_sided: scene.objects.iter().map(|o| o.class == SceneClass::Building).collect(),
            layer: scene.objects.iter().map(|o| layer(o.class)).collect(),
        }
    }

    /// Rank of a face among those in one place.
    pub fn rank(&self, face: &Face) -> (u8, u32) {
        (self.layer[face.object as usize], face.object)
    }

    /// Whether the face is a hole where the ray meets it.
    pub fn is_hole(&self, face: &Face, weights: [f64; 3]) -> bool {
        let coat = &self.coats[face.material as usize];
        coat.hole_below.is_some_and(|least| {
            self.texel(coat, face, weights).is_some_and(|texel| f64::from(texel[3]) < least * 255.0)
        })
    }

    /// Texel under a point: the nearest, textures repeat, v runs up and rows run down.
    fn texel(&self, coat: &Coat, face: &Face, weights: [f64; 3]) -> Option<[u8; 4]> {
        let texture = &self.textures[coat.texture?];
        let along = |k: usize| (0..3).map(|i| weights[i] * f64::from(face.uvs[i][k])).sum::<f64>();
        let [u, v] = coat.transform.apply([along(0), along(1)]);
        let place = |at: f64, size: u32| (((at - at.floor()) * f64::from(size)) as u32).min(size.saturating_sub(1));
        let (x, y) = (place(u, texture.width()), place(1.0 - v, texture.height()));
        texture.get_pixel_checked(x, y).map(|pixel| pixel.0)
    }

    /// What a ray sees of a face that it meets.
    pub fn point(&self, face: &Face, triangle: &Triangle, crossing: &Crossing, direction: DVec3) -> Point {
        let weights = crossing.weights;
        let corners = triangle.map(DVec3::from_array);
        let mixed = |of: &dyn Fn(usize) -> DVec3| of(0) * weights[0] + of(1) * weights[1] + of(2) * weights[2];
        let mut face_normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
        let mut normal = mixed(&|i| face.normals[i].as_dvec3()).normalize_or(face_normal);
        if normal.dot(face_normal) < 0.0 {
            face_normal = -face_normal;
        }
        if self.two_sided[face.object as usize] && face_normal.dot(direction) > 0.0 {
            (normal, face_normal) = (-normal, -face_normal);
        }
        let coat = &self.coats[face.material as usize];
        let albedo = match self.texel(coat, face, weights) {
            Some(texel) => std::array::from_fn(|k| coat.albedo[k] * self.linear[usize::from(texel[k])]),
            None => coat.albedo,
        };
        let gain = coat.gains[self.classes[face.object as usize] as usize];
        let albedo = color::with_infrared(albedo, gain);
        Point { position: mixed(&|i| corners[i]), normal, face_normal, albedo }
    }
}

fn gains(material: &Material) -> [f64; CLASSES] {
    let mut gains = [0.0; CLASSES];
    for class in SceneClass::ALL {
        gains[class as usize] = near_infrared_gain(class, material);
    }
    gains
}

/// Uppermost first: what lies on the ground covers it.
fn layer(class: SceneClass) -> u8 {
    match class {
        SceneClass::Building | SceneClass::Vegetation => 0,
        SceneClass::Highway => 1,
        SceneClass::Water => 2,
        SceneClass::Leisure => 3,
        SceneClass::Natural => 4,
        SceneClass::Landuse => 5,
        SceneClass::Terrain => 6,
    }
}

/// All faces that are to be seen, with their corners about `origin`; those without area are left out.
pub fn faces(scene: &Scene, origin: DVec3) -> Result<(Vec<Triangle>, Vec<Face>), ReferenceError> {
    let kinds = material_surfaces(scene);
    let (mut triangles, mut faces) = (Vec::new(), Vec::new());
    for (number, object) in scene.objects.iter().enumerate() {
        check(number, object)?;
        let mesh = &object.mesh;
        for group in mesh.groups.iter().filter(|g| kinds[g.material as usize].is_some()) {
            for corners in mesh.triangles.iter().skip(group.first as usize).take(group.count as usize) {
                let at = corners.map(|i| i as usize);
                let [a, b, c] = at.map(|i| mesh.positions[i] - origin);
                if (b - a).cross(c - a) == DVec3::ZERO {
                    continue;
                }
                triangles.push([a, b, c].map(|p| p.to_array()));
                let uvs = at.map(|i| mesh.uvs.get(i).copied().unwrap_or_default());
                let normals = at.map(|i| mesh.normals[i]);
                faces.push(Face { object: number as u32, material: group.material, normals, uvs });
            }
        }
    }
    Ok((triangles, faces))
}

/// Every number of a mesh must be finite.
fn check(number: usize, object: &SceneObject) -> Result<(), ReferenceError> {
    let mesh = &object.mesh;
    let bad = |what: &'static str, vertex: Option<usize>| match vertex {
        Some(vertex) => Err(ReferenceError::NotFinite { object: number, instance: object.instance, what, vertex }),
        None => Ok(()),
    };
    bad("position", mesh.positions.iter().position(|p| !p.is_finite()))?;
    bad("normal", mesh.normals.iter().position(|n| !n.is_finite()))?;
    bad("texture coordinate", mesh.uvs.iter().position(|uv| !uv.is_finite()))
}
