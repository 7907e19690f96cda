//! Execute: the stages of a view's plan, tile by tile.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::time::Instant;

use super::device::Gpu;
use super::draws::{self, DrawList};
use super::passes::shade::Lit;
use super::passes::{Drawing, depth, field, ids, resolve, shade, shadow_bounds, shadow_map, sky_maps};
use super::pipelines::Pipelines;
use super::pools::{Target, TargetPool};
use super::readback::{Harvest, Picture, Readback};
use super::tiles::{self, Tile, ViewUniform, light_planes, light_view, panel, panel_view, tile_planes, tile_size};
use super::timing::{Recorder, Stopwatch};
use super::upload::{GpuScene, Positions};
use super::{GpuError, Renderer};
use crate::frame::{Frame, Image};
use crate::plan::ViewPlan;
use crate::plan::light::LightFrame;
use crate::plan::pass::{DrawSet, Pass, PassKind, PipelineKey, Stage, Surface};
use crate::plan::resource::ResourceId;

/// All of a view's images, or, unless `windows` is empty, those parts of them.
pub fn render(renderer: &mut Renderer, view: &ViewPlan, windows: &[Tile]) -> Result<Frame, GpuError> {
    let Renderer {
        gpu,
        pipelines,
        targets,
        scene,
        conformed: _,
        readback,
        max_tile,
        positions,
        passes,
        triangles,
        drawn,
        stopwatch,
    } = renderer;
    let counter = Cell::new(0);
    stopwatch.start_view();
    let scene =
        scene.as_mut().filter(|scene| fits(scene, view)).ok_or_else(|| GpuError::WrongScene(view.name.clone()))?;
    if let Some(what) = view.not_finite {
        return Err(GpuError::NotFinite { view: view.name.clone(), what });
    }
    check_sizes(gpu, view)?;
    targets.keep(view.resources.iter().map(|r| r.texture));
    let max_tile = (*max_tile).min(gpu.max_texture);
    let positions = *positions;
    let task = format!("rendering view {}", view.name);
    let images = gpu.checked(&task, || {
        let drawn = &counter;
        let mut execution = Execution {
            gpu,
            pipelines,
            targets,
            scene,
            readback,
            stopwatch,
            view,
            windows,
            max_tile,
            positions,
            drawn,
        };
        execution.run()
    })??;
    *passes += view.passes().count();
    *triangles += view.passes().filter_map(|pass| pass.kind.draw()).map(|draw| draw.triangles).sum::<u64>();
    *drawn += counter.get();
    Ok(Frame { view: view.name.clone(), width: view.camera.width, height: view.camera.height, images })
}

/// Whether the plan speaks of as many objects as the scene has, and of attributes that were uploaded.
fn fits(scene: &GpuScene, view: &ViewPlan) -> bool {
    view.passes().filter_map(|p| p.kind.draw()).all(|draw| draw.objects.len() == scene.bounds.len())
        && view.passes().flat_map(|p| &p.pipelines).all(|&key| scene.streams.have(key))
}

fn check_sizes(gpu: &Gpu, view: &ViewPlan) -> Result<(), GpuError> {
    let too_large = |what, wanted: u32| {
        let (adapter, view) = (gpu.adapter.name.clone(), view.name.clone());
        GpuError::TooLarge { adapter, view, what, wanted: wanted.into(), limit: gpu.max_texture.into() }
    };
    for pass in view.passes() {
        match &pass.kind {
            PassKind::ShadowMap { light, .. } if light.size > gpu.max_texture => {
                return Err(too_large("a shadow map", light.size));
            }
            PassKind::Resolve { supersample, .. } if *supersample > 64 => {
                return Err(too_large("a number of samples per pixel side", *supersample));
            }
            _ => {}
        }
    }
    Ok(())
}

/// A tile of the image, in render targets of `size` pixels.
#[derive(Clone, Copy)]
struct Place {
    tile: Tile,
    size: (u32, u32),
    supersample: u32,
}

struct Execution<'a> {
    gpu: &'a Gpu,
    pipelines: &'a mut Pipelines,
    targets: &'a mut TargetPool,
    scene: &'a mut GpuScene,
    readback: &'a mut Readback,
    stopwatch: &'a mut Stopwatch,
    view: &'a ViewPlan,
    windows: &'a [Tile],
    max_tile: u32,
    positions: Positions,
    /// Triangles drawn.
    drawn: &'a Cell<u64>,
}

impl Execution<'_> {
    fn run(&mut self) -> Result<Vec<Image>, GpuError> {
        let products = || self.view.stages.iter().flat_map(|stage| &stage.products);
        let count = products().map(|p| p.index + 1).max().unwrap_or(0);
        let mut images: Vec<Option<Picture>> = (0..count).map(|_| None).collect();
        for product in products() {
            images[product.index] = Some(Picture::blank(self.view, &product.encoding));
        }
        let names: BTreeMap<usize, &str> = products().map(|p| (p.index, p.pass.as_str())).collect();

        self.scene.place(self.gpu, self.view.camera.origin(), self.positions);
        for stage in &self.view.stages {
            for pass in &stage.passes {
                self.pipelines.prepare(self.gpu, &pass.pipelines);
                pass.pipelines.iter().for_each(|&key| self.scene.streams.load(self.gpu, key));
                self.load_textures(pass);
            }
            self.stage(stage, &mut images)?;
        }
        let image = |(picture, name): (Option<Picture>, &str)| {
            picture.map(|picture| Image { pass: name.to_owned(), pixels: picture.finish(self.view) })
        };
        Ok(images.into_iter().zip(names.into_values()).filter_map(image).collect())
    }

    /// Textures that a pass samples: all for shading, those with holes for the others.
    fn load_textures(&mut self, pass: &Pass) {
        let Some(draw) = pass.kind.draw() else { return };
        let shading = matches!(pass.kind, PassKind::Shade { .. });
        let sampled = |surface| surface == Surface::Cutout || (shading && surface == Surface::Textured);
        let mut wanted: Vec<usize> = self
            .scene
            .chunks
            .iter()
            .filter(|chunk| draw.objects[chunk.object] && sampled(chunk.surface))
            .filter_map(|chunk| chunk.texture)
            .collect();
        wanted.sort_unstable();
        wanted.dedup();
        let layouts = &self.pipelines.layouts;
        self.scene.load_textures(self.gpu, &layouts.texture, &layouts.texture_sampler, wanted.into_iter());
    }

    fn stage(&mut self, stage: &Stage, images: &mut [Option<Picture>]) -> Result<(), GpuError> {
        let written = stage.passes.iter().flat_map(|pass| &pass.writes);
        let supersample = written.map(|id| self.view.resources[id.0].texture.supersample).max().unwrap_or(1);
        let image = (self.view.camera.width, self.view.camera.height);
        let largest = |side: fn(&Tile) -> u32| self.windows.iter().map(side).max().unwrap_or(u32::MAX).max(1);
        let size = (
            tile_size(image.0.max(1), supersample, self.max_tile).min(largest(|w| w.width)),
            tile_size(image.1.max(1), supersample, self.max_tile).min(largest(|w| w.height)),
        );
        let all = Tile { x: 0, y: 0, width: image.0, height: image.1 };
        let tiles = if stage.tiled { tiles::within(tiles::tiles(image, size), self.windows) } else { vec![all] };
        for tile in tiles {
            let mut recorder = self.stopwatch.recorder(self.gpu);
            let targets = self.stage_targets(stage, size);
            for pass in &stage.passes {
                let start = Instant::now();
                self.pass(&mut recorder, pass, (tile, size), &targets);
                if self.stopwatch.waits(self.gpu) {
                    let next = self.stopwatch.recorder(self.gpu);
                    let recorded = std::mem::replace(&mut recorder, next);
                    self.stopwatch.submit(self.gpu, recorded, Some((pass.kind.stem(), start)))?;
                } else if let PassKind::Field { .. } = pass.kind {
                    self.stopwatch.add(pass.kind.stem(), start.elapsed());
                }
            }
            let harvest = Harvest { view: self.view, tile, products: &stage.products, targets: &targets };
            self.readback.collect(self.gpu, self.stopwatch, recorder, harvest, images)?;
        }
        Ok(())
    }

    /// Targets that the stage may touch: what its passes declare to read or write.
    fn stage_targets(&mut self, stage: &Stage, tile: (u32, u32)) -> BTreeMap<ResourceId, Target> {
        let declared = stage.passes.iter().flat_map(|pass| pass.reads.iter().chain(&pass.writes));
        declared
            .map(|&id| {
                let key = self.view.resources[id.0].texture;
                let size = if key.tiled { tile } else { (key.width, key.height) };
                (id, self.targets.get(self.gpu, key, (size.0 * key.supersample, size.1 * key.supersample)))
            })
            .collect()
    }

    fn pass(
        &mut self,
        recorder: &mut Recorder,
        pass: &Pass,
        (tile, size): (Tile, (u32, u32)),
        targets: &BTreeMap<ResourceId, Target>,
    ) {
        let target = |i: usize| &targets[&pass.writes[i]];
        let supersample = self.view.resources[pass.writes[0].0].texture.supersample;
        let at = Place { tile, size, supersample };
        let (gpu, pipelines) = (self.gpu, &*self.pipelines);
        match &pass.kind {
            PassKind::ShadowMap { draw, light } => self.draw_from(light, draw, |drawing| {
                shadow_map::encode(recorder, drawing, target(0));
            }),
            PassKind::ShadowBounds { light } => {
                let maps = (&targets[&pass.reads[0]], target(0), target(1));
                shadow_bounds::encode(recorder, gpu, pipelines, light, maps);
            }
            PassKind::SkyMaps { draw, frames } => {
                for (layer, light) in (0..).zip(frames.iter()) {
                    let layer = target(0).layer(layer);
                    self.draw_from(light, draw, |drawing| sky_maps::encode(recorder, drawing, &layer));
                }
            }
            PassKind::Field { field, frame } => field::upload(gpu, field, frame, target(0)),
            PassKind::Shade { draw, light } => {
                let terms = light.terms();
                let lit = Lit {
                    origin: self.view.camera.origin(),
                    light,
                    side: supersample,
                    materials: &self.scene.materials,
                    targets,
                };
                // Where nothing is drawn no pipeline was made, nor its layout.
                let layout = pipelines.light(terms).cloned().unwrap_or_else(|| shade::layout(gpu, terms));
                let group = shade::group(gpu, &pipelines.layouts, &layout, &lit);
                self.draw_tile(draw, at, true, |drawing| {
                    shade::encode(recorder, drawing, &group, (terms, light.bands), (target(0), target(1)));
                });
            }
            PassKind::Resolve { supersample, linear } => {
                let key = PipelineKey::Resolve { supersample: *supersample, linear: *linear };
                let (radiance, area) = (&targets[&pass.reads[0]], (tile.width, tile.height));
                resolve::encode(recorder, gpu, pipelines, key, (radiance, target(0)), area);
            }
            PassKind::Ids { draw } => {
                self.draw_tile(draw, at, false, |drawing| ids::encode(recorder, drawing, target(0), target(1)));
            }
            PassKind::Depth { draw } => {
                self.draw_tile(draw, at, false, |drawing| depth::encode(recorder, drawing, target(0)));
            }
        }
    }

    /// Draws what a map of depth shows of a selection.
    fn draw_from(&self, light: &LightFrame, draw: &DrawSet, encode: impl FnOnce(&Drawing)) {
        let (eye, origin) = (self.view.camera.position, self.view.camera.origin());
        let list = draws::gather(self.scene, &draw.objects, eye, &light_planes(light, eye), false);
        let viewport = [0.0, 0.0, light.size as f32, light.size as f32];
        self.draw(&list, &light_view(light, origin), viewport, (light.size, light.size), encode);
    }

    /// Draws what a tile shows of a selection; textures matter `by_texture`, or only where they have holes.
    fn draw_tile(&self, draw: &DrawSet, at: Place, by_texture: bool, encode: impl FnOnce(&Drawing)) {
        let Place { tile, size, supersample } = at;
        let camera = &self.view.camera;
        let planes = tile_planes(camera, tile);
        let list = draws::gather(self.scene, &draw.objects, camera.position, &planes, by_texture);
        let panel = panel((camera.width, camera.height), tile, size, supersample, self.gpu.max_texture);
        let uniform = panel_view(camera, self.view.far, panel, supersample);
        let scaled = |pixels: u32| (pixels * supersample) as f32;
        let corner = [-scaled(tile.x - panel.x), -scaled(tile.y - panel.y)];
        let viewport = [corner[0], corner[1], scaled(panel.width), scaled(panel.height)];
        self.draw(&list, &uniform, viewport, (tile.width * supersample, tile.height * supersample), encode);
    }

    fn draw(
        &self,
        list: &DrawList,
        uniform: &ViewUniform,
        viewport: [f32; 4],
        area: (u32, u32),
        encode: impl FnOnce(&Drawing),
    ) {
        let buffer = self.gpu.stored("view", uniform);
        let entries = [wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }];
        let layout = &self.pipelines.layouts.view;
        let descriptor = wgpu::BindGroupDescriptor { label: Some("view"), layout, entries: &entries };
        let view = &self.gpu.device.create_bind_group(&descriptor);
        self.drawn.set(self.drawn.get() + list.indices.len() as u64 / 3);
        let indices = &self.gpu.buffer("indices", bytemuck::cast_slice(&list.indices), wgpu::BufferUsages::INDEX);
        encode(&Drawing { pipelines: self.pipelines, scene: self.scene, list, indices, view, viewport, area });
    }
}
