//! Field: a function of the plan → a texture of it, evaluated on the CPU at the texels' centres.

use half::f16;
use rayon::prelude::*;

use crate::gpu::device::Gpu;
use crate::gpu::pools::Target;
use crate::plan::shading::{Field, FieldFrame};

pub fn upload(gpu: &Gpu, field: &Field, frame: &FieldFrame, map: &Target) {
    let size = frame.size;
    let rows = (0..size).into_par_iter().flat_map_iter(|row| {
        (0..size).map(move |column| f16::from_f64(field.value(frame.center(column, row))).to_bits())
    });
    let texels: Vec<u16> = rows.collect();
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(2 * size), rows_per_image: None };
    gpu.queue.write_texture(map.texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, map.texture.size());
}
