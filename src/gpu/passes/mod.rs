//! Passes: one file each, with the pipelines it compiles and the commands it records.

pub mod depth;
pub mod field;
pub mod ids;
pub mod resolve;
pub mod shade;
pub mod shadow_bounds;
pub mod shadow_map;
pub mod sky_maps;

use super::draws::DrawList;
use super::pipelines::Pipelines;
use super::upload::GpuScene;
use crate::plan::pass::{PipelineKey, Surface};

/// What a pass that draws the scene needs besides its targets.
pub struct Drawing<'a> {
    pub pipelines: &'a Pipelines,
    pub scene: &'a GpuScene,
    pub list: &'a DrawList,
    pub indices: &'a wgpu::Buffer,
    pub view: &'a wgpu::BindGroup,
    /// Corner and size, in samples, of the panel from the upper left corner of the targets.
    pub viewport: [f32; 4],
    /// Samples that are drawn, from the upper left corner of the targets.
    pub area: (u32, u32),
}

impl Drawing<'_> {
    /// Records all runs with the pipeline that `key` names for their surface. The groups are the view, the light if
    /// there is one, and the texture of the run.
    fn record(
        &self,
        pass: &mut wgpu::RenderPass,
        light: Option<&wgpu::BindGroup>,
        key: impl Fn(Surface) -> PipelineKey,
    ) {
        let [x, y, width, height] = self.viewport;
        pass.set_viewport(x, y, width, height, 0.0, 1.0);
        pass.set_scissor_rect(0, 0, self.area.0, self.area.1);
        pass.set_bind_group(0, self.view, &[]);
        if let Some(light) = light {
            pass.set_bind_group(1, light, &[]);
        }
        let texture_group = if light.is_some() { 2 } else { 1 };
        pass.set_vertex_buffer(0, self.scene.positions.slice(..));
        pass.set_vertex_buffer(1, self.scene.attributes.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        for run in &self.list.runs {
            pass.set_pipeline(self.pipelines.get(key(run.surface)));
            if let Some(texture) = run.texture {
                pass.set_bind_group(texture_group, self.scene.texture_group(texture), &[]);
            }
            pass.draw_indexed(run.indices.clone(), 0, 0..1);
        }
    }
}
