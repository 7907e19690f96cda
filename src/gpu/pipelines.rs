//! Pipelines: compiled when a plan names them, kept by their keys; and the layouts and samplers they share.

use std::collections::BTreeMap;

use super::device::Gpu;
use super::passes::{depth, ids, resolve, shade, shadow_map};
use super::pools::texture_format;
use crate::plan::pass::PipelineKey;
use crate::plan::resource::Format;

/// Source of a pass's shader: the common part, then its own file.
pub fn shader_source(stem: &str) -> &'static str {
    macro_rules! joined {
        ($($file:literal),*) => { concat!($(include_str!(concat!("shaders/", $file, ".wgsl")), "\n"),*) };
    }
    match stem {
        "shadow_map" => joined!("common", "cutout", "shadow_map"),
        "shade" => joined!("common", "shade"),
        "ids" => joined!("common", "cutout", "ids"),
        "depth" => joined!("common", "cutout", "depth"),
        "resolve" => joined!("resolve"),
        _ => unreachable!("passes name their own stems"),
    }
}

/// Bind group layouts by their use, and samplers.
pub struct Layouts {
    pub view: wgpu::BindGroupLayout,
    pub texture: wgpu::BindGroupLayout,
    pub light: wgpu::BindGroupLayout,
    pub shadowed_light: wgpu::BindGroupLayout,
    pub resolve: wgpu::BindGroupLayout,
    pub texture_sampler: wgpu::Sampler,
    pub gather_sampler: wgpu::Sampler,
    pub linear_sampler: wgpu::Sampler,
}

pub struct Pipelines {
    pub layouts: Layouts,
    modules: BTreeMap<&'static str, wgpu::ShaderModule>,
    pipelines: BTreeMap<PipelineKey, wgpu::RenderPipeline>,
}

impl Pipelines {
    pub fn new(gpu: &Gpu) -> Pipelines {
        Pipelines { layouts: Layouts::new(gpu), modules: BTreeMap::new(), pipelines: BTreeMap::new() }
    }

    /// Compiles what is missing of `keys`.
    pub fn prepare(&mut self, gpu: &Gpu, keys: &[PipelineKey]) {
        for &key in keys {
            if !self.pipelines.contains_key(&key) {
                let stem = stem(key);
                let module = self.modules.entry(stem).or_insert_with(|| compile(gpu, stem));
                let pipeline = match key {
                    PipelineKey::ShadowMap { cutout } => shadow_map::pipeline(gpu, &self.layouts, module, cutout),
                    PipelineKey::Shade { surface, shadow } => {
                        shade::pipeline(gpu, &self.layouts, module, surface, shadow)
                    }
                    PipelineKey::Resolve { supersample } => resolve::pipeline(gpu, &self.layouts, module, supersample),
                    PipelineKey::Ids { cutout } => ids::pipeline(gpu, &self.layouts, module, cutout),
                    PipelineKey::Depth { cutout } => depth::pipeline(gpu, &self.layouts, module, cutout),
                };
                self.pipelines.insert(key, pipeline);
            }
        }
    }

    pub fn get(&self, key: PipelineKey) -> &wgpu::RenderPipeline {
        self.pipelines.get(&key).expect("a pass uses only the pipelines it declares")
    }

    pub fn set_texture_filter(&mut self, gpu: &Gpu, filter: TextureFilter) {
        self.layouts.texture_sampler = texture_sampler(gpu, filter);
    }

    pub fn created(&self) -> usize {
        self.pipelines.len()
    }
}

fn stem(key: PipelineKey) -> &'static str {
    match key {
        PipelineKey::ShadowMap { .. } => "shadow_map",
        PipelineKey::Shade { .. } => "shade",
        PipelineKey::Resolve { .. } => "resolve",
        PipelineKey::Ids { .. } => "ids",
        PipelineKey::Depth { .. } => "depth",
    }
}

fn compile(gpu: &Gpu, stem: &'static str) -> wgpu::ShaderModule {
    let source = wgpu::ShaderSource::Wgsl(shader_source(stem).into());
    gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(stem), source })
}

/// What differs between the pipelines that draw triangles of the scene.
pub struct GeometryPipeline<'a> {
    pub label: String,
    pub module: &'a wgpu::ShaderModule,
    pub vertex: &'a str,
    /// Entry point and target; `None` writes depth alone.
    pub fragment: Option<(&'a str, Option<Format>)>,
    /// Attributes besides the position.
    pub attributes: bool,
    /// Without gaps: pipelines that share a pass then agree on all groups but the last.
    pub groups: &'a [&'a wgpu::BindGroupLayout],
    pub constants: &'a [(&'a str, f64)],
}

impl GeometryPipeline<'_> {
    /// Reverse depth: greater is nearer. Nothing is culled, since ruins and open roofs are seen from inside.
    pub fn create(self, gpu: &Gpu) -> wgpu::RenderPipeline {
        let position = wgpu::vertex_attr_array![0 => Float32x3];
        let others = wgpu::vertex_attr_array![1 => Snorm16x4, 2 => Float32x2, 3 => Uint32, 4 => Uint32];
        let buffer = |array_stride, attributes| {
            Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes })
        };
        let buffers = [buffer(12, &position), buffer(24, &others)];
        let options = wgpu::PipelineCompilationOptions { constants: self.constants, ..Default::default() };
        let targets = self.fragment.and_then(|(_, format)| format).map(|f| [Some(texture_format(f).into())]);
        let targets = targets.as_ref().map_or(&[][..], |t| t);
        let fragment = self.fragment.map(|(entry, _)| wgpu::FragmentState {
            module: self.module,
            entry_point: Some(entry),
            compilation_options: options.clone(),
            targets,
        });
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&pipeline_layout(gpu, &self.label, self.groups)),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: Default::default(),
                buffers: if self.attributes { &buffers } else { &buffers[..1] },
            },
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment,
            multiview_mask: None,
            cache: None,
        })
    }
}

pub fn pipeline_layout(gpu: &Gpu, label: &str, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().copied().map(Some).collect();
    gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

impl Layouts {
    fn new(gpu: &Gpu) -> Layouts {
        use wgpu::{BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType};
        let group = |label: &str, bindings: &[(ShaderStages, wgpu::BindingType)]| {
            let entry = |(binding, &(visibility, ty)): (usize, &(ShaderStages, wgpu::BindingType))| {
                wgpu::BindGroupLayoutEntry { binding: binding as u32, visibility, ty, count: None }
            };
            let entries: Vec<_> = bindings.iter().enumerate().map(entry).collect();
            let descriptor = wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries };
            gpu.device.create_bind_group_layout(&descriptor)
        };
        let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        let texture = |sample_type| wgpu::BindingType::Texture {
            sample_type,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let filterable = texture(TextureSampleType::Float { filterable: true });
        let (vertex, fragment) = (ShaderStages::VERTEX, ShaderStages::FRAGMENT);
        let filtering = wgpu::BindingType::Sampler(SamplerBindingType::Filtering);
        let unfiltered = wgpu::BindingType::Sampler(SamplerBindingType::NonFiltering);
        let materials = buffer(BufferBindingType::Storage { read_only: true });
        let uniform = buffer(BufferBindingType::Uniform);
        let lighting = [
            (vertex | fragment, uniform),
            (vertex, materials),
            (fragment, texture(TextureSampleType::Depth)),
            (fragment, unfiltered),
        ];
        Layouts {
            view: group("view", &[(vertex, uniform)]),
            texture: group("color texture", &[(fragment, filterable), (fragment, filtering)]),
            light: group("light", &lighting[..2]),
            shadowed_light: group("shadowed light", &lighting),
            resolve: group("resolve", &[(fragment, filterable), (fragment, filtering)]),
            texture_sampler: texture_sampler(gpu, TextureFilter::default()),
            gather_sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor::default()),
            linear_sampler: gpu.device.create_sampler(&wgpu::SamplerDescriptor {
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }
}

/// How a texture is looked up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFilter {
    /// The nearest texel of the nearest level.
    Nearest,
    /// Four texels of the nearest level.
    Bilinear,
    /// Four texels of two levels.
    Trilinear,
    /// Trilinear; up to 8 places along the footprint on hardware, where that is nearly free.
    #[default]
    Usual,
    /// Trilinear at up to 8 places along the footprint.
    Anisotropic,
}

fn texture_sampler(gpu: &Gpu, filter: TextureFilter) -> wgpu::Sampler {
    use wgpu::{FilterMode, MipmapFilterMode};
    let smooth = filter != TextureFilter::Nearest;
    let between = !matches!(filter, TextureFilter::Nearest | TextureFilter::Bilinear);
    let places = match filter {
        TextureFilter::Anisotropic => 8,
        TextureFilter::Usual if !gpu.adapter.software => 8,
        _ => 1,
    };
    let filter = if smooth { FilterMode::Linear } else { FilterMode::Nearest };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        address_mode_u: wgpu::AddressMode::Repeat,
        address_mode_v: wgpu::AddressMode::Repeat,
        mag_filter: filter,
        min_filter: filter,
        mipmap_filter: if between { MipmapFilterMode::Linear } else { MipmapFilterMode::Nearest },
        anisotropy_clamp: places,
        ..Default::default()
    })
}
