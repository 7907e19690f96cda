//! Timing: how long the passes of a view took, by the device's clock if it has one, else by ours.

use std::time::{Duration, Instant};

use super::GpuError;
use super::device::Gpu;

/// Passes that one command buffer can time.
const MOST: u32 = 1024;
const STAMP: u64 = 8;

/// Commands of one submission, with the time stamps around its passes if they are wanted.
pub struct Recorder {
    pub encoder: wgpu::CommandEncoder,
    stamps: Option<wgpu::QuerySet>,
    timed: Vec<&'static str>,
}

impl Recorder {
    fn new(gpu: &Gpu, stamped: bool) -> Recorder {
        let stamps = stamped.then(|| {
            let descriptor =
                wgpu::QuerySetDescriptor { label: Some("timing"), ty: wgpu::QueryType::Timestamp, count: 2 * MOST };
            gpu.device.create_query_set(&descriptor)
        });
        Recorder { encoder: gpu.device.create_command_encoder(&Default::default()), stamps, timed: Vec::new() }
    }

    /// Begins a pass that clears its targets.
    pub fn begin(
        &mut self,
        stem: &'static str,
        color: Option<(&wgpu::TextureView, wgpu::Color)>,
        depth: Option<&wgpu::TextureView>,
    ) -> wgpu::RenderPass<'_> {
        let number = self.timed.len() as u32;
        let stamps = self.stamps.as_ref().filter(|_| number < MOST);
        if stamps.is_some() {
            self.timed.push(stem);
        }
        let color = color.map(|(view, value)| wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(value), store: wgpu::StoreOp::Store },
        });
        let depth_ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store };
        self.encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(stem),
            color_attachments: if color.is_some() { std::slice::from_ref(&color) } else { &[] },
            depth_stencil_attachment: depth.map(|view| wgpu::RenderPassDepthStencilAttachment {
                view,
                depth_ops: Some(depth_ops),
                stencil_ops: None,
            }),
            timestamp_writes: stamps.map(|query_set| wgpu::RenderPassTimestampWrites {
                query_set,
                beginning_of_pass_write_index: Some(2 * number),
                end_of_pass_write_index: Some(2 * number + 1),
            }),
            occlusion_query_set: None,
            multiview_mask: None,
        })
    }
}

/// Adds up the times of a view's passes.
#[derive(Default)]
pub struct Stopwatch {
    running: bool,
    /// Word of each pass and its seconds, in the order of their first runs.
    pub times: Vec<(String, f64)>,
}

impl Stopwatch {
    pub fn set(&mut self, running: bool) {
        *self = Stopwatch { running, times: Vec::new() };
    }

    pub fn start_view(&mut self) {
        self.times.clear();
    }

    pub fn recorder(&self, gpu: &Gpu) -> Recorder {
        Recorder::new(gpu, self.running && gpu.timestamps)
    }

    /// Whether passes must be waited for one by one to time them.
    pub fn waits(&self, gpu: &Gpu) -> bool {
        self.running && !gpu.timestamps
    }

    pub fn add(&mut self, stem: &str, time: Duration) {
        if self.running {
            match self.times.iter_mut().find(|(other, _)| other == stem) {
                Some((_, sum)) => *sum += time.as_secs_f64(),
                None => self.times.push((stem.to_owned(), time.as_secs_f64())),
            }
        }
    }

    /// Submits what was recorded and, if it is timed, waits and adds the times up; `stem` and `start` are those of the
    /// only pass in it where passes are waited for.
    pub fn submit(&mut self, gpu: &Gpu, recorder: Recorder, alone: Option<(&str, Instant)>) -> Result<(), GpuError> {
        let Recorder { mut encoder, stamps, timed } = recorder;
        let Some(set) = stamps.filter(|_| !timed.is_empty()) else {
            gpu.queue.submit([encoder.finish()]);
            if let Some((stem, start)) = alone {
                gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| gpu.failed("timing a pass", e))?;
                self.add(stem, start.elapsed());
            }
            return Ok(());
        };
        let count = 2 * timed.len() as u32;
        let buffer = |usage| {
            let size = u64::from(count) * STAMP;
            let descriptor = wgpu::BufferDescriptor { label: Some("timing"), size, usage, mapped_at_creation: false };
            gpu.device.create_buffer(&descriptor)
        };
        let resolved = buffer(wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC);
        let readable = buffer(wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ);
        encoder.resolve_query_set(&set, 0..count, &resolved, 0);
        encoder.copy_buffer_to_buffer(&resolved, 0, &readable, 0, u64::from(count) * STAMP);
        gpu.queue.submit([encoder.finish()]);
        readable.map_async(wgpu::MapMode::Read, .., |_| ());
        let failed = |reason: &dyn std::fmt::Display| gpu.failed("timing passes", reason);
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|e| failed(&e))?;
        let mapped = readable.get_mapped_range(..).map_err(|e| failed(&e))?;
        let tick = f64::from(gpu.queue.get_timestamp_period()) * 1e-9;
        let stamps: Vec<u64> = mapped
            .chunks_exact(STAMP as usize)
            .map(|bytes| u64::from_le_bytes(bytes.try_into().expect("chunks of eight")))
            .collect();
        for (stem, pair) in timed.iter().zip(stamps.chunks_exact(2)) {
            self.add(stem, Duration::from_secs_f64(pair[1].saturating_sub(pair[0]) as f64 * tick));
        }
        Ok(())
    }
}
