//! Device: opens a headless adapter, and turns wgpu's errors into [`GpuError`].

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::GpuError;

/// The adapter that rendered, for manifests and messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Adapter {
    pub name: String,
    /// Driver's name and version.
    pub driver: String,
    pub backend: String,
    /// True for renderers that run on the CPU.
    pub software: bool,
}

pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: Adapter,
    /// Texels per side of the largest texture.
    pub max_texture: u32,
    /// Whether passes can be timed by the device's clock.
    pub timestamps: bool,
    /// Set once the device is gone.
    lost: Arc<AtomicBool>,
}

impl Gpu {
    pub fn open() -> Result<Gpu, GpuError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
        descriptor.backends = wgpu::Backends::PRIMARY;
        descriptor.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(descriptor);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            force_fallback_adapter: false,
            compatible_surface: None,
            apply_limit_buckets: false,
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(GpuError::NoAdapter)?;
        let info = adapter.get_info();
        let limits = adapter.limits();
        let required_features = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        let request = wgpu::DeviceDescriptor {
            label: Some("mansard"),
            required_features,
            required_limits: limits.clone(),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&request))
            .map_err(|error| GpuError::NoDevice { adapter: info.name.clone(), reason: error.to_string() })?;
        let adapter = Adapter {
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            backend: info.backend.to_string(),
            software: info.device_type == wgpu::DeviceType::Cpu,
            name: info.name,
        };
        let timestamps = !required_features.is_empty();
        let lost = Arc::new(AtomicBool::new(false));
        let told = lost.clone();
        device.set_device_lost_callback(move |_, _| told.store(true, Ordering::Relaxed));
        Ok(Gpu { device, queue, adapter, max_texture: limits.max_texture_dimension_2d, timestamps, lost })
    }

    /// Whether the device is gone: nothing works on it any more.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Ordering::Relaxed)
    }

    /// Runs `work` and returns the first error that the device reported meanwhile, as one of ours.
    pub fn checked<T>(&self, task: &str, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        if self.is_lost() {
            return Err(self.failed(task, "the device is lost"));
        }
        let result = work();
        let errors = [internal, memory, validation].map(|scope| pollster::block_on(scope.pop()));
        match errors.into_iter().flatten().next() {
            Some(error) => Err(self.failed(task, error)),
            None => Ok(result),
        }
    }

    pub fn failed(&self, task: &str, reason: impl std::fmt::Display) -> GpuError {
        GpuError::Failed { adapter: self.adapter.name.clone(), task: task.to_owned(), reason: reason.to_string() }
    }

    /// What shaders read. Storage and never uniform: Mesa 22's llvmpipe crashes where branches depend on uniforms.
    pub fn stored<T: bytemuck::Pod>(&self, label: &str, value: &T) -> wgpu::Buffer {
        self.buffer(label, bytemuck::bytes_of(value), wgpu::BufferUsages::STORAGE)
    }

    /// A buffer with these bytes; never empty, since wgpu binds no empty buffers.
    pub fn buffer(&self, label: &str, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let size = (bytes.len() as u64).max(16).next_multiple_of(4);
        let usage = usage | wgpu::BufferUsages::COPY_DST;
        let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }
}
