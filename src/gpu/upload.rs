//! Upload: the scene's meshes as vertex buffers, its materials and textures; each object once.
//!
//! Attributes go to the device once; positions are written anew for each camera, about its origin (see [`GpuScene::place`]).

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::GpuError;
use super::cutouts::Textures;
use super::device::Gpu;
use super::junctions;
use super::mipmaps::{self, linear_from_srgb};
use crate::interpreter::material::{MapTransform, Material};
use crate::plan::pass::Surface;
use crate::plan::summary::{least_alpha, material_surfaces};
use crate::scene::reflectance::near_infrared_gain;
use crate::scene::{Scene, SceneClass, SceneObject, TriMesh};

/// What a vertex carries besides its position.
#[repr(C)]
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Attributes {
    /// Signed 16-bit fractions; the last is 1 where both sides may be seen.
    pub normal: [i16; 4],
    pub uv: [f32; 2],
    pub object: u32,
    pub material: u32,
}

/// Triangles of one object with one surface.
#[derive(Clone, Debug)]
pub struct Chunk {
    pub object: usize,
    pub surface: Surface,
    pub texture: Option<usize>,
    /// Range of [`GpuScene::indices`].
    pub indices: Range<usize>,
}

pub struct GpuScene {
    /// In drawing order: near layers first, so that what lies beneath fails the depth test before it is shaded, and
    /// so that of surfaces at equal depth the upper layer wins; within a layer by texture.
    pub chunks: Vec<Chunk>,
    pub indices: Vec<u32>,
    /// Least and greatest corner of each object.
    pub bounds: Vec<Option<(DVec3, DVec3)>>,
    pub attributes: wgpu::Buffer,
    pub positions: wgpu::Buffer,
    pub materials: wgpu::Buffer,
    textures: Vec<Arc<image::RgbaImage>>,
    /// Made when a pass first samples them.
    texture_groups: Vec<Option<wgpu::BindGroup>>,
    world: Vec<DVec3>,
    placed: Option<(DVec3, Positions)>,
}

/// Where positions are rounded to 32-bit floats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Positions {
    /// As metres from the camera, subtracted in f64.
    #[default]
    AboutCamera,
    /// As metres from the scene's origin, as renderers of one precision do it; kept to be measured.
    AboutOrigin,
}

impl GpuScene {
    pub fn new(gpu: &Gpu, scene: &Scene) -> GpuScene {
        let surfaces = material_surfaces(scene);
        let texture_of = |m: usize| {
            let name = scene.materials[m].colormap.as_ref()?;
            scene.textures.binary_search_by(|(other, _)| other.cmp(name)).ok()
        };
        let (mut world, mut attributes) = (Vec::new(), Vec::<Attributes>::new());
        let mut numbers = MaterialNumbers::default();
        let mut textures = Textures::new(scene.textures.iter().map(|(_, texture)| texture.clone()));
        let (mut chunks, mut indices) = (Vec::new(), Vec::new());
        for (number, object) in scene.objects.iter().enumerate() {
            let mesh = junctions::conforming(&object.mesh);
            let base = world.len() as u32;
            world.extend_from_slice(&mesh.positions);
            push_attributes(&mut attributes, (number, object.class), &mesh, &scene.materials, &mut numbers);
            for group in mesh.groups.iter().filter(|g| g.count > 0) {
                let material = group.material as usize;
                let Some(surface) = surfaces[material] else { continue };
                let start = indices.len();
                let triangles = &mesh.triangles[group.first as usize..][..group.count as usize];
                indices.extend(triangles.iter().flatten().map(|i| i + base));
                let mut texture = texture_of(material).filter(|_| surface != Surface::Plain);
                if surface == Surface::Cutout {
                    let least = least_alpha(&scene.materials[material]);
                    texture = texture.map(|texture| textures.with_holes_below(texture, least));
                }
                chunks.push(Chunk { object: number, surface, texture, indices: start..indices.len() });
            }
        }
        let color = |&(class, material): &(SceneClass, u32)| {
            let material = &scene.materials[material as usize];
            let [r, g, b] = material.color.map(|c| linear_from_srgb(c.clamp(0.0, 1.0)) as f32);
            [r, g, b, near_infrared_gain(class, material) as f32]
        };
        let materials: Vec<[f32; 4]> = numbers.order.iter().map(color).collect();
        chunks.sort_by_key(|c| (layer(scene.objects[c.object].class), c.surface, c.texture, c.object));
        let empty_positions = vec![0u8; world.len() * 12];
        GpuScene {
            chunks,
            indices,
            bounds: scene.objects.iter().map(bounds).collect(),
            attributes: gpu.buffer("attributes", bytemuck::cast_slice(&attributes), wgpu::BufferUsages::VERTEX),
            positions: gpu.buffer("positions", &empty_positions, wgpu::BufferUsages::VERTEX),
            materials: gpu.buffer("materials", bytemuck::cast_slice(&materials), wgpu::BufferUsages::STORAGE),
            texture_groups: textures.images.iter().map(|_| None).collect(),
            textures: textures.images,
            world,
            placed: None,
        }
    }

    /// Writes all positions as f32 metres from `origin`, subtracted in f64: equal points stay equal, so faces that meet
    /// in the scene meet on the image.
    pub fn place(&mut self, gpu: &Gpu, origin: DVec3, positions: Positions) {
        if self.placed == Some((origin, positions)) {
            return;
        }
        let rounded = |&p: &DVec3| match positions {
            Positions::AboutCamera => (p - origin).as_vec3().to_array(),
            Positions::AboutOrigin => (p.as_vec3() - origin.as_vec3()).to_array(),
        };
        let relative: Vec<[f32; 3]> = self.world.iter().map(rounded).collect();
        gpu.queue.write_buffer(&self.positions, 0, bytemuck::cast_slice(&relative));
        self.placed = Some((origin, positions));
    }

    /// Makes the bind groups of these textures.
    pub fn load_textures(
        &mut self,
        gpu: &Gpu,
        layout: &wgpu::BindGroupLayout,
        sampler: &wgpu::Sampler,
        wanted: impl Iterator<Item = usize>,
    ) {
        for number in wanted {
            if self.texture_groups[number].is_none() {
                let view = mipmaps::upload(gpu, &self.textures[number]);
                let entries = [
                    wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) },
                    wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
                ];
                let descriptor = wgpu::BindGroupDescriptor { label: Some("color texture"), layout, entries: &entries };
                self.texture_groups[number] = Some(gpu.device.create_bind_group(&descriptor));
            }
        }
    }

    /// The bind groups of textures are made anew when they are next sampled.
    pub fn forget_textures(&mut self) {
        self.texture_groups.iter_mut().for_each(|group| *group = None);
    }

    pub fn texture_group(&self, number: usize) -> &wgpu::BindGroup {
        self.texture_groups[number].as_ref().expect("load_textures made it before the pass began")
    }
}

/// Fails on the first number of a mesh that is not finite.
pub fn check(scene: &Scene) -> Result<(), GpuError> {
    for (number, object) in scene.objects.iter().enumerate() {
        let mesh = &object.mesh;
        let first = [
            ("position", mesh.positions.iter().position(|p| !p.is_finite())),
            ("normal", mesh.normals.iter().position(|n| !n.is_finite())),
            ("texture coordinate", mesh.uvs.iter().position(|uv| !uv.is_finite())),
        ];
        if let Some((what, vertex)) = first.into_iter().find_map(|(what, at)| at.map(|at| (what, at))) {
            return Err(GpuError::NotFiniteMesh { object: number, instance: object.instance, what, vertex });
        }
    }
    Ok(())
}

/// Drawing order of the layers, the uppermost first.
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

/// Numbers of the materials as the device sees them: what one reflects depends on the class of its object, too.
#[derive(Default)]
struct MaterialNumbers {
    numbers: BTreeMap<(SceneClass, u32), u32>,
    order: Vec<(SceneClass, u32)>,
}

impl MaterialNumbers {
    fn number(&mut self, class: SceneClass, material: u32) -> u32 {
        *self.numbers.entry((class, material)).or_insert_with(|| {
            self.order.push((class, material));
            self.order.len() as u32 - 1
        })
    }
}

fn push_attributes(
    attributes: &mut Vec<Attributes>,
    (number, class): (usize, SceneClass),
    mesh: &TriMesh,
    materials: &[Arc<Material>],
    numbers: &mut MaterialNumbers,
) {
    let start = attributes.len();
    // Ground layers are seen from above alone; walls of ruins and open roofs from both sides.
    let two_sided = if class == SceneClass::Building { i16::MAX } else { 0 };
    attributes.extend(mesh.normals.iter().enumerate().map(|(i, n)| {
        let [x, y, z] = n.to_array().map(|c| (c.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16);
        // The scene's v runs up, as CGA's; that of images runs down.
        let uv = mesh.uvs.get(i).map_or([0.0; 2], |uv| [uv.x, 1.0 - uv.y]);
        Attributes { normal: [x, y, z, two_sided], uv, object: number as u32, material: 0 }
    }));
    for group in &mesh.groups {
        let triangles = mesh.triangles.iter().skip(group.first as usize).take(group.count as usize);
        let material = numbers.number(class, group.material);
        for &vertex in triangles.clone().flatten() {
            attributes[start + vertex as usize].material = material;
        }
        let transform = materials[group.material as usize].colormap_transform;
        if transform != MapTransform::IDENTITY {
            let vertices: BTreeSet<u32> = triangles.flatten().copied().collect();
            for vertex in vertices {
                let uv = &mut attributes[start + vertex as usize].uv;
                let [u, v] = transform.apply([f64::from(uv[0]), 1.0 - f64::from(uv[1])]);
                *uv = [u as f32, 1.0 - v as f32];
            }
        }
    }
}

fn bounds(object: &SceneObject) -> Option<(DVec3, DVec3)> {
    let mut positions = object.mesh.positions.iter().copied();
    let first = positions.next()?;
    Some(positions.fold((first, first), |(low, high), p| (low.min(p), high.max(p))))
}
