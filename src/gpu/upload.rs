//! Upload: the scene's meshes as vertex buffers, its materials and textures; each object once.
//!
//! Other attributes go to the device once, when a pass first reads them; positions are written anew for each camera, about
//! its origin (see [`GpuScene::place`]).

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::GpuError;
use super::cutouts::Textures;
use super::device::Gpu;
use super::junctions::Conformed;
use super::mipmaps::{self, linear_from_srgb};
use super::streams::{Builder, Streams};
use crate::plan::attribute::Attribute;
use crate::plan::pass::Surface;
use crate::plan::summary::{least_alpha, material_surfaces};
use crate::scene::reflectance::near_infrared_gain;
use crate::scene::{Scene, SceneClass, TriMesh};

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
    pub streams: Streams,
    positions: wgpu::Buffer,
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
    /// With the attributes that will be read; positions are always there.
    pub fn new(gpu: &Gpu, scene: &Scene, wanted: &BTreeSet<Attribute>, conformed: &mut Conformed) -> GpuScene {
        let surfaces = material_surfaces(scene);
        let texture_of = |m: usize| {
            let name = scene.materials[m].colormap.as_ref()?;
            scene.textures.binary_search_by(|(other, _)| other.cmp(name)).ok()
        };
        let mut world = Vec::new();
        let mut builder = Builder::new(wanted, &scene.materials);
        let mut textures = Textures::new(scene.textures.iter().map(|(_, texture)| texture.clone()));
        let (mut chunks, mut indices) = (Vec::new(), Vec::new());
        let conforming = conformed.meshes(scene);
        for (number, (object, conforming)) in scene.objects.iter().zip(&conforming).enumerate() {
            let mesh: &TriMesh = conforming.as_deref().unwrap_or(&object.mesh);
            let base = world.len() as u32;
            world.extend_from_slice(&mesh.positions);
            builder.push(number, object.class, mesh);
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
        let (streams, order) = builder.finish();
        let materials: Vec<[f32; 4]> = order.iter().map(color).collect();
        chunks.sort_by_key(|c| (layer(scene.objects[c.object].class), c.surface, c.texture, c.object));
        let empty_positions = vec![0u8; world.len() * 12];
        GpuScene {
            chunks,
            indices,
            bounds: scene.objects.iter().map(|object| object.mesh.bounds()).collect(),
            streams,
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

    /// How many attributes are on the device.
    pub fn attributes(&self) -> usize {
        usize::from(self.placed.is_some()) + self.streams.loaded()
    }

    pub fn buffer(&self, attribute: Attribute) -> &wgpu::Buffer {
        if attribute == Attribute::Position { &self.positions } else { self.streams.buffer(attribute) }
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
