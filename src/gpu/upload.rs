//! Upload: the scene's meshes as vertex buffers, its materials and textures; each object once.
//!
//! Attributes go to the device once; positions are written anew for each camera, relative to it (see [`GpuScene::place`]).

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::device::Gpu;
use super::mipmaps::{self, linear_from_srgb};
use crate::interpreter::material::{MapTransform, Material};
use crate::plan::pass::Surface;
use crate::plan::summary::material_surfaces;
use crate::scene::{Scene, SceneClass, SceneObject};

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
        let (mut chunks, mut indices) = (Vec::new(), Vec::new());
        for (number, object) in scene.objects.iter().enumerate() {
            let base = world.len() as u32;
            world.extend_from_slice(&object.mesh.positions);
            push_attributes(&mut attributes, number, object, &scene.materials);
            for group in object.mesh.groups.iter().filter(|g| g.count > 0) {
                let material = group.material as usize;
                let Some(surface) = surfaces[material] else { continue };
                let start = indices.len();
                let triangles = &object.mesh.triangles[group.first as usize..][..group.count as usize];
                indices.extend(triangles.iter().flatten().map(|i| i + base));
                let texture = texture_of(material).filter(|_| surface != Surface::Plain);
                chunks.push(Chunk { object: number, surface, texture, indices: start..indices.len() });
            }
        }
        chunks.sort_by_key(|c| (layer(scene.objects[c.object].class), c.surface, c.texture, c.object));
        let materials: Vec<[f32; 4]> = scene.materials.iter().map(|m| linear_color(m.color)).collect();
        let empty_positions = vec![0u8; world.len() * 12];
        GpuScene {
            chunks,
            indices,
            bounds: scene.objects.iter().map(bounds).collect(),
            attributes: gpu.buffer("attributes", bytemuck::cast_slice(&attributes), wgpu::BufferUsages::VERTEX),
            positions: gpu.buffer("positions", &empty_positions, wgpu::BufferUsages::VERTEX),
            materials: gpu.buffer("materials", bytemuck::cast_slice(&materials), wgpu::BufferUsages::STORAGE),
            textures: scene.textures.iter().map(|(_, t)| t.clone()).collect(),
            texture_groups: scene.textures.iter().map(|_| None).collect(),
            world,
            placed: None,
        }
    }

    /// Writes all positions as f32 metres from `eye`, subtracted in f64: equal points stay equal, so faces that meet
    /// in the scene meet on the image.
    pub fn place(&mut self, gpu: &Gpu, eye: DVec3, positions: Positions) {
        if self.placed == Some((eye, positions)) {
            return;
        }
        let from_eye = |&p: &DVec3| match positions {
            Positions::AboutCamera => (p - eye).as_vec3().to_array(),
            Positions::AboutOrigin => (p.as_vec3() - eye.as_vec3()).to_array(),
        };
        let relative: Vec<[f32; 3]> = self.world.iter().map(from_eye).collect();
        gpu.queue.write_buffer(&self.positions, 0, bytemuck::cast_slice(&relative));
        self.placed = Some((eye, positions));
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

/// Drawing order of the layers, the uppermost first.
fn layer(class: SceneClass) -> u8 {
    match class {
        SceneClass::Building => 0,
        SceneClass::Highway => 1,
        SceneClass::Water => 2,
        SceneClass::Leisure => 3,
        SceneClass::Natural => 4,
        SceneClass::Landuse => 5,
        SceneClass::Terrain => 6,
    }
}

fn push_attributes(attributes: &mut Vec<Attributes>, number: usize, object: &SceneObject, materials: &[Arc<Material>]) {
    let mesh = &object.mesh;
    let start = attributes.len();
    // Ground layers are seen from above alone; walls of ruins and open roofs from both sides.
    let two_sided = if object.class == SceneClass::Building { i16::MAX } else { 0 };
    attributes.extend(mesh.normals.iter().enumerate().map(|(i, n)| {
        let [x, y, z] = n.to_array().map(|c| (c.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16);
        // The scene's v runs up, as CGA's; that of images runs down.
        let uv = mesh.uvs.get(i).map_or([0.0; 2], |uv| [uv.x, 1.0 - uv.y]);
        Attributes { normal: [x, y, z, two_sided], uv, object: number as u32, material: 0 }
    }));
    for group in &mesh.groups {
        let triangles = mesh.triangles.iter().skip(group.first as usize).take(group.count as usize);
        for &vertex in triangles.clone().flatten() {
            attributes[start + vertex as usize].material = group.material;
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

fn linear_color(srgb: [f64; 3]) -> [f32; 4] {
    let [r, g, b] = srgb.map(|c| linear_from_srgb(c.clamp(0.0, 1.0)) as f32);
    [r, g, b, 1.0]
}
