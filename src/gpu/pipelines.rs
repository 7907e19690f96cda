//! Pipelines: compiled when a plan names them, kept by their keys; and the layouts and samplers they share.

use std::collections::BTreeMap;

use super::device::Gpu;
use super::passes::{depth, ids, resolve, shade, shadow_bounds, shadow_map};
use super::pools::texture_format;
use super::source::{module_name, shader_source};
use crate::plan::attribute::Attribute;
use crate::plan::pass::PipelineKey;
use crate::plan::resource::Format;
use crate::plan::shading::Terms;

/// Bind group layouts by their use, and samplers.
pub struct Layouts {
    pub view: wgpu::BindGroupLayout,
    pub texture: wgpu::BindGroupLayout,
    pub first_bounds: wgpu::BindGroupLayout,
    pub coarse_bounds: wgpu::BindGroupLayout,
    pub resolve: wgpu::BindGroupLayout,
    pub texture_sampler: wgpu::Sampler,
    pub gather_sampler: wgpu::Sampler,
    pub linear_sampler: wgpu::Sampler,
}

pub struct Pipelines {
    pub layouts: Layouts,
    lights: BTreeMap<Terms, wgpu::BindGroupLayout>,
    modules: BTreeMap<String, wgpu::ShaderModule>,
    pipelines: BTreeMap<PipelineKey, wgpu::RenderPipeline>,
}

impl Pipelines {
    pub fn new(gpu: &Gpu) -> Pipelines {
        let layouts = Layouts::new(gpu);
        Pipelines { layouts, lights: BTreeMap::new(), modules: BTreeMap::new(), pipelines: BTreeMap::new() }
    }

    /// Compiles what is missing of `keys`.
    pub fn prepare(&mut self, gpu: &Gpu, keys: &[PipelineKey]) {
        for &key in keys {
            if !self.pipelines.contains_key(&key) {
                let pipeline = self.compile(gpu, key);
                self.pipelines.insert(key, pipeline);
            }
        }
    }

    fn compile(&mut self, gpu: &Gpu, key: PipelineKey) -> wgpu::RenderPipeline {
        let layouts = &self.layouts;
        let name = module_name(key);
        let module = self.modules.entry(name.clone()).or_insert_with(|| {
            let source = wgpu::ShaderSource::Wgsl(shader_source(key).into());
            gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(&name), source })
        });
        match key {
            PipelineKey::ShadowMap { cutout } => shadow_map::pipeline(gpu, layouts, module, cutout),
            PipelineKey::ShadowBounds { first } => shadow_bounds::pipeline(gpu, layouts, module, first),
            PipelineKey::Shade { surface, terms } => {
                let light = self.lights.entry(terms).or_insert_with(|| shade::layout(gpu, terms));
                shade::pipeline(gpu, layouts, light, module, (surface, terms))
            }
            PipelineKey::Resolve { supersample, linear } => {
                resolve::pipeline(gpu, layouts, module, supersample, linear)
            }
            PipelineKey::Ids { cutout } => ids::pipeline(gpu, layouts, module, cutout),
            PipelineKey::Depth { cutout } => depth::pipeline(gpu, layouts, module, cutout),
        }
    }

    pub fn get(&self, key: PipelineKey) -> &wgpu::RenderPipeline {
        self.pipelines.get(&key).expect("a pass uses only the pipelines it declares")
    }

    pub fn set_texture_filter(&mut self, gpu: &Gpu, filter: TextureFilter) {
        self.layouts.texture_sampler = texture_sampler(gpu, filter);
    }

    /// Layout of the light of pipelines with these terms; `None` before any was made.
    pub fn light(&self, terms: Terms) -> Option<&wgpu::BindGroupLayout> {
        self.lights.get(&terms)
    }

    pub fn created(&self) -> usize {
        self.pipelines.len()
    }
}

/// What differs between the pipelines that draw triangles of the scene.
pub struct GeometryPipeline<'a> {
    pub label: String,
    pub module: &'a wgpu::ShaderModule,
    pub vertex: &'a str,
    /// Entry point and target; `None` writes depth alone.
    pub fragment: Option<(&'a str, Option<Format>)>,
    pub attributes: &'a [Attribute],
    /// Without gaps: pipelines that share a pass then agree on all groups but the last.
    pub groups: &'a [&'a wgpu::BindGroupLayout],
}

impl GeometryPipeline<'_> {
    /// Reverse depth: greater is nearer. Nothing is culled, since ruins and open roofs are seen from inside.
    pub fn create(self, gpu: &Gpu) -> wgpu::RenderPipeline {
        // One buffer per attribute, in slots without gaps, which some drivers do not survive.
        let attributes = self.attributes.iter().map(|attribute| {
            let (shader_location, format) = (attribute.location(), attribute.format());
            [wgpu::VertexAttribute { format, offset: 0, shader_location }]
        });
        let attributes: Vec<_> = attributes.collect();
        let strides = self.attributes.iter().map(|attribute| attribute.bytes());
        let buffers: Vec<_> = strides
            .zip(&attributes)
            .map(|(array_stride, attributes)| {
                Some(wgpu::VertexBufferLayout { array_stride, step_mode: wgpu::VertexStepMode::Vertex, attributes })
            })
            .collect();
        let targets = self.fragment.and_then(|(_, format)| format).map(|f| [Some(texture_format(f).into())]);
        let targets = targets.as_ref().map_or(&[][..], |t| t);
        let fragment = self.fragment.map(|(entry, _)| wgpu::FragmentState {
            module: self.module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets,
        });
        gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(&self.label),
            layout: Some(&pipeline_layout(gpu, &self.label, self.groups)),
            vertex: wgpu::VertexState {
                module: self.module,
                entry_point: Some(self.vertex),
                compilation_options: Default::default(),
                buffers: &buffers,
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
        let group = |label: &str, bindings: &[(u32, ShaderStages, wgpu::BindingType)]| {
            let entry = |&(binding, visibility, ty): &(u32, ShaderStages, wgpu::BindingType)| {
                wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None }
            };
            let entries: Vec<_> = bindings.iter().map(entry).collect();
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
        let stored = buffer(BufferBindingType::Storage { read_only: true });
        let blocks = texture(TextureSampleType::Float { filterable: false });
        Layouts {
            view: group("view", &[(0, vertex | fragment, stored)]),
            texture: group("color texture", &[(0, fragment, filterable), (1, fragment, filtering)]),
            first_bounds: group(
                "first bounds",
                &[
                    (0, fragment, stored),
                    (1, fragment, texture(TextureSampleType::Depth)),
                    (2, fragment, wgpu::BindingType::Sampler(SamplerBindingType::NonFiltering)),
                ],
            ),
            coarse_bounds: group("coarse bounds", &[(3, fragment, blocks)]),
            resolve: group("resolve", &[(0, fragment, filterable), (1, fragment, filtering)]),
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
