//! Streams: what vertices carry besides their positions, one buffer for each attribute. In: meshes, object by object. Out:
//! buffers, made when a pass first reads them; attributes that nobody asked for are not even gathered.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::device::Gpu;
use crate::interpreter::material::{MapTransform, Material};
use crate::plan::attribute::Attribute;
use crate::plan::pass::PipelineKey;
use crate::scene::{SceneClass, TriMesh};

impl Attribute {
    /// In the shaders.
    pub fn location(self) -> u32 {
        match self {
            Attribute::Position => 0,
            Attribute::Normal => 1,
            Attribute::TextureCoordinates => 2,
            Attribute::Object => 3,
            Attribute::Material => 4,
        }
    }

    pub fn format(self) -> wgpu::VertexFormat {
        match self {
            Attribute::Position => wgpu::VertexFormat::Float32x3,
            Attribute::Normal => wgpu::VertexFormat::Snorm16x4,
            Attribute::TextureCoordinates => wgpu::VertexFormat::Float32x2,
            Attribute::Object | Attribute::Material => wgpu::VertexFormat::Uint32,
        }
    }
}

enum Stream {
    Gathered(Vec<u8>),
    OnDevice(wgpu::Buffer),
}

pub struct Streams(BTreeMap<Attribute, Stream>);

impl Streams {
    /// Whether everything that a pipeline reads was asked for.
    pub fn have(&self, key: PipelineKey) -> bool {
        key.attributes().iter().all(|a| *a == Attribute::Position || self.0.contains_key(a))
    }

    /// Puts what a pipeline reads on the device.
    pub fn load(&mut self, gpu: &Gpu, key: PipelineKey) {
        for attribute in key.attributes() {
            if let Some(stream) = self.0.get_mut(attribute)
                && let Stream::Gathered(bytes) = stream
            {
                *stream = Stream::OnDevice(gpu.buffer(attribute.name(), bytes, wgpu::BufferUsages::VERTEX));
            }
        }
    }

    /// How many are on the device.
    pub fn loaded(&self) -> usize {
        self.0.values().filter(|stream| matches!(stream, Stream::OnDevice(_))).count()
    }

    /// The buffer of an attribute other than the position.
    pub fn buffer(&self, attribute: Attribute) -> &wgpu::Buffer {
        match self.0.get(&attribute) {
            Some(Stream::OnDevice(buffer)) => buffer,
            _ => panic!("the attributes of a pipeline were loaded before its pass began"),
        }
    }
}

/// Gathers the wanted attributes of one object after the other.
pub struct Builder<'a> {
    wanted: &'a BTreeSet<Attribute>,
    materials: &'a [Arc<Material>],
    /// Signed 16-bit fractions; the last is 1 where both sides may be seen.
    normals: Vec<[i16; 4]>,
    uvs: Vec<[f32; 2]>,
    objects: Vec<u32>,
    numbers: Vec<u32>,
    table: BTreeMap<(SceneClass, u32), u32>,
    order: Vec<(SceneClass, u32)>,
}

impl<'a> Builder<'a> {
    pub fn new(wanted: &'a BTreeSet<Attribute>, materials: &'a [Arc<Material>]) -> Builder<'a> {
        let (normals, uvs, objects, numbers) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let (table, order) = (BTreeMap::new(), Vec::new());
        Builder { wanted, materials, normals, uvs, objects, numbers, table, order }
    }

    pub fn push(&mut self, number: usize, class: SceneClass, mesh: &TriMesh) {
        let wanted = |attribute| self.wanted.contains(&attribute);
        if wanted(Attribute::Object) {
            self.objects.resize(self.objects.len() + mesh.positions.len(), number as u32);
        }
        if wanted(Attribute::Normal) {
            // Ground layers are seen from above alone; walls of ruins and open roofs from both sides.
            let two_sided = if class == SceneClass::Building { i16::MAX } else { 0 };
            self.normals.extend(mesh.normals.iter().map(|n| {
                let [x, y, z] = n.to_array().map(|c| (c.clamp(-1.0, 1.0) * f32::from(i16::MAX)).round() as i16);
                [x, y, z, two_sided]
            }));
        }
        if self.wanted.contains(&Attribute::Material) {
            self.push_materials(class, mesh);
        }
        if self.wanted.contains(&Attribute::TextureCoordinates) {
            self.push_uvs(mesh);
        }
    }

    /// Numbers of materials as the device sees them: what one reflects depends on the class of its object, too.
    fn push_materials(&mut self, class: SceneClass, mesh: &TriMesh) {
        let start = self.numbers.len();
        self.numbers.resize(start + mesh.positions.len(), 0);
        for group in &mesh.groups {
            let number = *self.table.entry((class, group.material)).or_insert_with(|| {
                self.order.push((class, group.material));
                self.order.len() as u32 - 1
            });
            let triangles = mesh.triangles.iter().skip(group.first as usize).take(group.count as usize);
            triangles.flatten().for_each(|&vertex| self.numbers[start + vertex as usize] = number);
        }
    }

    fn push_uvs(&mut self, mesh: &TriMesh) {
        let start = self.uvs.len();
        // The scene's v runs up, as CGA's; that of images runs down.
        let turned = |i: usize| mesh.uvs.get(i).map_or([0.0; 2], |uv| [uv.x, 1.0 - uv.y]);
        self.uvs.extend((0..mesh.positions.len()).map(turned));
        for group in &mesh.groups {
            let transform = self.materials[group.material as usize].colormap_transform;
            if transform == MapTransform::IDENTITY {
                continue;
            }
            let triangles = mesh.triangles.iter().skip(group.first as usize).take(group.count as usize);
            let vertices: BTreeSet<u32> = triangles.flatten().copied().collect();
            for vertex in vertices {
                let uv = &mut self.uvs[start + vertex as usize];
                let [u, v] = transform.apply([f64::from(uv[0]), 1.0 - f64::from(uv[1])]);
                *uv = [u as f32, 1.0 - v as f32];
            }
        }
    }

    /// The streams, and the class and material of each number.
    pub fn finish(self) -> (Streams, Vec<(SceneClass, u32)>) {
        let bytes = |attribute: Attribute| match attribute {
            Attribute::Position => Vec::new(),
            Attribute::Normal => bytemuck::cast_slice(&self.normals).to_vec(),
            Attribute::TextureCoordinates => bytemuck::cast_slice(&self.uvs).to_vec(),
            Attribute::Object => bytemuck::cast_slice(&self.objects).to_vec(),
            Attribute::Material => bytemuck::cast_slice(&self.numbers).to_vec(),
        };
        let gathered = self.wanted.iter().filter(|a| **a != Attribute::Position);
        (Streams(gathered.map(|&a| (a, Stream::Gathered(bytes(a)))).collect()), self.order)
    }
}
