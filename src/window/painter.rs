//! Painter: egui's triangles onto the window. In: what egui made of one pass. Out: pixels on the screen, or that the
//! adapter was lost. The window's own device; the scene is drawn elsewhere and comes as a picture.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor, wgpu};
use winit::event_loop::OwnedDisplayHandle;
use winit::window::Window;

use super::error::WindowError;

/// What became of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Painted {
    Shown,
    /// There was nothing to draw on just now (hidden, resized): ask again.
    Later,
    /// The adapter or the surface is gone: open another painter.
    Lost,
}

/// A surface on a window with egui's pipeline.
pub struct Painter {
    surface: wgpu::Surface<'static>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    config: wgpu::SurfaceConfiguration,
    renderer: Renderer,
    lost: Arc<AtomicBool>,
}

impl Painter {
    pub fn open(window: Arc<Window>, display: OwnedDisplayHandle) -> Result<Painter, WindowError> {
        let mut descriptor = wgpu::InstanceDescriptor::new_with_display_handle(Box::new(display));
        descriptor.backends = wgpu::Backends::PRIMARY;
        descriptor.flags = wgpu::InstanceFlags::empty();
        let instance = wgpu::Instance::new(descriptor);
        let size = window.inner_size();
        let no_surface = |reason: String| WindowError::NoSurface { reason };
        let surface = instance.create_surface(window).map_err(|error| no_surface(error.to_string()))?;
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::None,
            force_fallback_adapter: false,
            compatible_surface: Some(&surface),
            apply_limit_buckets: false,
        };
        let adapter = pollster::block_on(instance.request_adapter(&options)).map_err(|e| no_surface(e.to_string()))?;
        let info = adapter.get_info();
        let request = wgpu::DeviceDescriptor {
            label: Some("mansard window"),
            required_limits: adapter.limits(),
            memory_hints: wgpu::MemoryHints::MemoryUsage,
            ..Default::default()
        };
        let (device, queue) =
            pollster::block_on(adapter.request_device(&request)).map_err(|e| no_surface(e.to_string()))?;
        let lost = Arc::new(AtomicBool::new(false));
        device.set_device_lost_callback({
            let lost = lost.clone();
            move |_, _| lost.store(true, Ordering::Release)
        });
        device.on_uncaptured_error({
            let lost = lost.clone();
            Arc::new(move |_| lost.store(true, Ordering::Release))
        });
        let mut config = surface
            .get_default_config(&adapter, size.width.max(1), size.height.max(1))
            .ok_or_else(|| no_surface(format!("{} cannot show windows here", info.name)))?;
        config.present_mode = wgpu::PresentMode::AutoVsync;
        config.format = format(&surface.get_capabilities(&adapter).formats).unwrap_or(config.format);
        surface.configure(&device, &config);
        // The uniform branch of dithering is not worth its noise under text.
        let renderer =
            Renderer::new(&device, config.format, RendererOptions { dithering: false, ..RendererOptions::default() });
        Ok(Painter { surface, device, queue, config, renderer, lost })
    }

    /// Texels per side of the largest picture.
    pub fn max_texture(&self) -> usize {
        self.device.limits().max_texture_dimension_2d as usize
    }

    pub fn resize(&mut self, width: u32, height: u32) {
        if width > 0 && height > 0 && (width, height) != (self.config.width, self.config.height) {
            (self.config.width, self.config.height) = (width, height);
            self.surface.configure(&self.device, &self.config);
        }
    }

    /// Draws one pass of egui. Textures are taken over even where nothing can be shown, so that none is missed.
    pub fn paint(&mut self, shapes: &[egui::ClippedPrimitive], textures: egui::TexturesDelta, scale: f32) -> Painted {
        let mut textures = textures;
        let freed: Vec<_> = textures.free.drain().collect();
        for (id, changes) in textures.set.drain() {
            for change in changes {
                self.renderer.update_texture(&self.device, &self.queue, id, &change);
            }
        }
        let painted = self.present(shapes, scale);
        for id in freed {
            self.renderer.free_texture(&id);
        }
        if self.lost.load(Ordering::Acquire) { Painted::Lost } else { painted }
    }

    fn present(&mut self, shapes: &[egui::ClippedPrimitive], scale: f32) -> Painted {
        use wgpu::CurrentSurfaceTexture as Current;
        let (frame, worn) = match self.surface.get_current_texture() {
            Current::Success(frame) => (frame, false),
            Current::Suboptimal(frame) => (frame, true),
            Current::Timeout | Current::Occluded => return Painted::Later,
            Current::Outdated => {
                self.surface.configure(&self.device, &self.config);
                return Painted::Later;
            }
            Current::Lost | Current::Validation => return Painted::Lost,
        };
        let screen =
            ScreenDescriptor { size_in_pixels: [self.config.width, self.config.height], pixels_per_point: scale };
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut commands = self.renderer.update_buffers(&self.device, &self.queue, &mut encoder, shapes, &screen);
        let view = frame.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let target = wgpu::RenderPassColorAttachment {
            view: &view,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
            depth_slice: None,
        };
        let pass = wgpu::RenderPassDescriptor {
            label: Some("panels"),
            color_attachments: &[Some(target)],
            depth_stencil_attachment: None,
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        };
        let mut pass = encoder.begin_render_pass(&pass).forget_lifetime();
        self.renderer.render(&mut pass, shapes, &screen);
        drop(pass);
        commands.push(encoder.finish());
        self.queue.submit(commands);
        self.queue.present(frame);
        if worn {
            self.surface.configure(&self.device, &self.config);
        }
        Painted::Shown
    }
}

/// egui blends in sRGB numbers, so it wants a format that does not convert.
fn format(offered: &[wgpu::TextureFormat]) -> Option<wgpu::TextureFormat> {
    let plain = [wgpu::TextureFormat::Bgra8Unorm, wgpu::TextureFormat::Rgba8Unorm];
    offered.iter().copied().find(|format| plain.contains(format))
}
