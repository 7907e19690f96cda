//! Read-back: tiles of render targets → pixels of the frame's images.

use std::collections::BTreeMap;

use super::GpuError;
use super::device::Gpu;
use super::pools::Target;
use super::tiles::Tile;
use super::timing::{Recorder, Stopwatch};
use crate::frame::Pixels;
use crate::plan::ViewPlan;
use crate::plan::demand::Projection;
use crate::plan::effects::Sensor;
use crate::plan::pass::{Encoding, Product};
use crate::plan::resource::{Format, ResourceId};
use crate::sensor::develop;

/// An image that tiles are written to.
pub enum Picture {
    Done(Pixels),
    /// What a sensor will take, row by row.
    Linear(Vec<[f32; 3]>, Sensor),
}

impl Picture {
    /// An image of the view's size for pixels of this encoding.
    pub fn blank(view: &ViewPlan, encoding: &Encoding) -> Picture {
        let pixels = view.camera.width as usize * view.camera.height as usize;
        Picture::Done(match encoding {
            Encoding::Sensor(sensor) => return Picture::Linear(vec![[0.0; 3]; pixels], *sensor),
            Encoding::Color => Pixels::Rgb8(vec![0; pixels * 3]),
            Encoding::Label(_) => Pixels::Gray8(vec![0; pixels]),
            Encoding::Number(_) => Pixels::Id32(vec![0; pixels]),
            Encoding::Distance => Pixels::Float32(vec![f32::INFINITY; pixels]),
        })
    }

    pub fn finish(self, view: &ViewPlan) -> Pixels {
        match self {
            Picture::Done(pixels) => pixels,
            Picture::Linear(linear, sensor) => develop(&linear, (view.camera.width, view.camera.height), &sensor),
        }
    }
}

/// Bytes per texel of what is read back.
fn texel_bytes(format: Format) -> u32 {
    if format == Format::Linear32 { 16 } else { 4 }
}

/// What is read of a stage: the products of one tile.
pub struct Harvest<'a> {
    pub view: &'a ViewPlan,
    pub tile: Tile,
    pub products: &'a [Product],
    pub targets: &'a BTreeMap<ResourceId, Target>,
}

/// A buffer that the CPU can read, grown as needed.
#[derive(Default)]
pub struct Readback {
    buffer: Option<wgpu::Buffer>,
}

impl Readback {
    fn reserve(&mut self, gpu: &Gpu, size: u64) -> &wgpu::Buffer {
        if self.buffer.as_ref().is_none_or(|b| b.size() < size) {
            self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("readback"),
                size,
                usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
                mapped_at_creation: false,
            }));
        }
        self.buffer.as_ref().expect("it was made above")
    }

    /// Submits what was recorded followed by copies of the targets, waits, and hands each product's rows
    /// to its image.
    pub fn collect(
        &mut self,
        gpu: &Gpu,
        stopwatch: &mut Stopwatch,
        mut recorder: Recorder,
        harvest: Harvest,
        images: &mut [Option<Picture>],
    ) -> Result<(), GpuError> {
        let Harvest { view, tile, products, targets } = harvest;
        // Depth can only be copied as a whole; the targets of a stage's products have one size, also per texel.
        let (width, height) = products.first().map_or((0, 0), |p| targets[&p.source].size);
        let texel = products.first().map_or(4, |p| texel_bytes(view.resources[p.source.0].texture.format));
        let stride = (width * texel).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let size = u64::from(stride) * u64::from(height);
        let mut sources: Vec<ResourceId> = products.iter().map(|p| p.source).collect();
        sources.sort();
        sources.dedup();
        let buffer = self.reserve(gpu, size * sources.len() as u64);
        for (i, source) in sources.iter().enumerate() {
            copy(&mut recorder.encoder, &targets[source], buffer, i as u64 * size, stride);
        }
        stopwatch.submit(gpu, recorder, None)?;
        if sources.is_empty() {
            return Ok(());
        }
        let range = ..size * sources.len() as u64;
        let (sender, receiver) = std::sync::mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, range, move |result| drop(sender.send(result)));
        let failed = |reason: &dyn std::fmt::Display| gpu.failed(&format!("rendering view {}", view.name), reason);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(&e))?;
        receiver.recv().map_err(|e| failed(&e))?.map_err(|e| failed(&e))?;
        let mapped = buffer.get_mapped_range(range).map_err(|e| failed(&e))?;
        for product in products {
            let place = sources.binary_search(&product.source).expect("every product's source is in the list");
            let rows = mapped[place * size as usize..][..size as usize].chunks_exact(stride as usize);
            let image = images[product.index].as_mut().expect("every product has a blank image");
            for (y, row) in rows.take(tile.height as usize).enumerate() {
                let at = (tile.y as usize + y) * view.camera.width as usize + tile.x as usize;
                write_row(view, &product.encoding, &row[..(tile.width * texel) as usize], image, at);
            }
        }
        drop(mapped);
        buffer.unmap();
        Ok(())
    }
}

fn copy(encoder: &mut wgpu::CommandEncoder, target: &Target, buffer: &wgpu::Buffer, offset: u64, stride: u32) {
    encoder.copy_texture_to_buffer(
        target.texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo {
            buffer,
            layout: wgpu::TexelCopyBufferLayout { offset, bytes_per_row: Some(stride), rows_per_image: None },
        },
        target.texture.size(),
    );
}

/// Writes a row of texels to the pixels of `image` from `at` on.
fn write_row(view: &ViewPlan, encoding: &Encoding, row: &[u8], image: &mut Picture, at: usize) {
    let pixels = match image {
        Picture::Linear(pixels, _) => {
            let float = |t: &[u8], c: usize| f32::from_le_bytes(std::array::from_fn(|i| t[4 * c + i]));
            let texels = row.chunks_exact(16).map(|t| [0, 1, 2].map(|c| float(t, c)));
            pixels[at..].iter_mut().zip(texels).for_each(|(p, t)| *p = t);
            return;
        }
        Picture::Done(pixels) => pixels,
    };
    let texels = row.chunks_exact(4).map(|t| [t[0], t[1], t[2], t[3]]);
    match (encoding, pixels) {
        (Encoding::Color, Pixels::Rgb8(pixels)) => {
            let pixels = pixels[at * 3..].chunks_exact_mut(3);
            pixels.zip(texels).for_each(|(p, t)| p.copy_from_slice(&t[..3]));
        }
        (Encoding::Label(table), Pixels::Gray8(pixels)) => {
            pixels[at..].iter_mut().zip(texels).for_each(|(p, t)| *p = table[u32::from_le_bytes(t) as usize]);
        }
        (Encoding::Number(table), Pixels::Id32(pixels)) => {
            pixels[at..].iter_mut().zip(texels).for_each(|(p, t)| *p = table[u32::from_le_bytes(t) as usize]);
        }
        (Encoding::Distance, Pixels::Float32(pixels)) => {
            pixels[at..].iter_mut().zip(texels).for_each(|(p, t)| *p = distance(view, f32::from_le_bytes(t)));
        }
        _ => unreachable!("`Picture::blank` made the image for this encoding"),
    }
}

/// Metres along the viewing direction from reverse depth.
fn distance(view: &ViewPlan, depth: f32) -> f32 {
    let (near, far) = (view.camera.near, view.far);
    if depth <= 0.0 {
        return f32::INFINITY;
    }
    match view.camera.projection {
        Projection::Perspective { .. } => (near * far / (near + f64::from(depth) * (far - near))) as f32,
        Projection::Orthographic { .. } => (far - f64::from(depth) * (far - near)) as f32,
    }
}
