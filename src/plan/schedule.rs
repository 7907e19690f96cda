//! Schedule: demands of all views → the passes that serve them, each made once, and nothing else.
//!
//! Colour outputs of equal selection and light share one shading; class, mask, level, instance and depth outputs of
//! equal selection share one pass of object numbers. A shadow map is made only for a shading that reads it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::demand::{Look, Output, OutputDemand, Sun, ViewDemand};
use super::finite::not_finite;
use super::light;
use super::pass::{
    DrawSet, Encoding, Pass, PassKind, PipelineKey, Product, RenderPlan, Skipped, Stage, Surface, ViewPlan,
};
use super::resource::{Format, Resource, ResourceId, TextureKey};
use super::shading::Illumination;
use super::summary::ObjectSummary;
use maps::Maps;

mod maps;

/// Plans every view. Demands must hold one selection flag (and mark) per object.
pub fn schedule(views: &[ViewDemand], objects: &[ObjectSummary]) -> RenderPlan {
    let bounds = objects.iter().filter_map(|o| o.bounds).reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let views = views.iter().map(|view| ViewScheduler::new(view, objects, bounds).schedule()).collect();
    RenderPlan { views }
}

/// What one shading depends on.
#[derive(Clone, PartialEq)]
struct Shading {
    draw: DrawSet,
    look: Look,
}

struct ViewScheduler<'a> {
    view: &'a ViewDemand,
    objects: &'a [ObjectSummary],
    bounds: Option<(DVec3, DVec3)>,
    plan: ViewPlan,
    /// How many resources of a kind were made, for their names.
    made: BTreeMap<Format, usize>,
}

impl<'a> ViewScheduler<'a> {
    fn new(view: &'a ViewDemand, objects: &'a [ObjectSummary], bounds: Option<(DVec3, DVec3)>) -> Self {
        let plan = ViewPlan {
            name: view.name.clone(),
            camera: view.camera,
            far: far_distance(view, bounds),
            not_finite: not_finite(view),
            resources: Vec::new(),
            stages: Vec::new(),
            skipped: Vec::new(),
        };
        ViewScheduler { view, objects, bounds, plan, made: BTreeMap::new() }
    }

    fn schedule(mut self) -> ViewPlan {
        self.colors();
        self.labels();
        self.plan
    }

    /// Maps, shading and resolve for each look.
    fn colors(&mut self) {
        let looks =
            self.group(|o| o.output == Output::Color, |s, o| Shading { draw: s.draw_set(o), look: o.look.clone() });
        if looks.is_empty() {
            self.skip("shading", "no output asks for colour");
            self.skip("shadow map", "no output asks for colour");
        }
        let mut maps = Maps::default();
        for (look, outputs) in looks {
            let light = self.illumination(&look, &mut maps);
            self.shade(look, light, &outputs);
        }
    }

    fn shade(&mut self, Shading { draw, look }: Shading, light: Illumination, outputs: &[usize]) {
        let supersample = self.supersample();
        let radiance = self.resource("shade", Format::Radiance16, self.size(), supersample, true);
        let depth = self.resource("shade.depth", Format::Depth32, self.size(), supersample, true);
        let linear = look.sensor.is_some();
        let format = if linear { Format::Linear32 } else { Format::Srgb8 };
        let color = self.resource("resolve", format, self.size(), 1, true);
        let terms = light.terms();
        let pipelines = self.surfaces(&draw).into_iter().map(|surface| PipelineKey::Shade { surface, terms }).collect();
        let reads = light.reads();
        let kind = PassKind::Shade { draw, light: Box::new(light) };
        let shade = Pass { kind, reads, writes: vec![radiance, depth], pipelines };
        let resolve = Pass {
            kind: PassKind::Resolve { supersample, linear },
            reads: vec![radiance],
            writes: vec![color],
            pipelines: vec![PipelineKey::Resolve { supersample, linear }],
        };
        let encoding = look.sensor.map_or(Encoding::Color, Encoding::Sensor);
        let products = outputs.iter().map(|&i| self.product(i, color, encoding.clone())).collect();
        self.plan.stages.push(Stage { tiled: true, passes: vec![shade, resolve], products });
    }

    /// One pass of object numbers (or of depth alone) for each selection.
    fn labels(&mut self) {
        let selections = self.group(|o| o.output != Output::Color, |s, o| s.draw_set(o).objects);
        if selections.is_empty() {
            self.skip("ids", "no output asks for labels or depth");
        }
        for (_, outputs) in selections {
            let draw = self.draw_set(&self.view.outputs[outputs[0]]);
            let depth_only = outputs.iter().all(|&i| self.view.outputs[i].output == Output::Depth);
            if depth_only { self.depth(draw, &outputs) } else { self.ids(draw, &outputs) }
        }
    }

    fn ids(&mut self, draw: DrawSet, outputs: &[usize]) {
        let ids = self.resource("ids", Format::Id32, self.size(), 1, true);
        let depth = self.resource("ids.depth", Format::Depth32, self.size(), 1, true);
        let pipelines = self.cutouts(&draw, |cutout| PipelineKey::Ids { cutout });
        let pass = Pass { kind: PassKind::Ids { draw }, reads: vec![], writes: vec![ids, depth], pipelines };
        let products = outputs
            .iter()
            .map(|&i| match self.view.outputs[i].output {
                Output::Depth => self.product(i, depth, Encoding::Distance),
                _ => self.product(i, ids, self.table(&self.view.outputs[i])),
            })
            .collect();
        self.plan.stages.push(Stage { tiled: true, passes: vec![pass], products });
    }

    fn depth(&mut self, draw: DrawSet, outputs: &[usize]) {
        self.skip("ids", "only depth is asked for of this selection");
        let depth = self.resource("depth", Format::Depth32, self.size(), 1, true);
        let pipelines = self.cutouts(&draw, |cutout| PipelineKey::Depth { cutout });
        let pass = Pass { kind: PassKind::Depth { draw }, reads: vec![], writes: vec![depth], pipelines };
        let products = outputs.iter().map(|&i| self.product(i, depth, Encoding::Distance)).collect();
        self.plan.stages.push(Stage { tiled: true, passes: vec![pass], products });
    }

    /// Outputs that `wanted` accepts, gathered by equal `key`, in order of first mention.
    fn group<K: PartialEq>(
        &self,
        wanted: impl Fn(&OutputDemand) -> bool,
        key: impl Fn(&Self, &OutputDemand) -> K,
    ) -> Vec<(K, Vec<usize>)> {
        let mut groups: Vec<(K, Vec<usize>)> = Vec::new();
        for (i, output) in self.view.outputs.iter().enumerate().filter(|(_, o)| wanted(o)) {
            let k = key(self, output);
            match groups.iter_mut().find(|(other, _)| *other == k) {
                Some((_, members)) => members.push(i),
                None => groups.push((k, vec![i])),
            }
        }
        groups
    }

    fn draw_set(&self, output: &OutputDemand) -> DrawSet {
        let state = output.selection.state;
        let shown = |(o, &flag): (&ObjectSummary, &bool)| flag && !o.surfaces.is_empty();
        let objects: Arc<[bool]> = self.objects.iter().zip(output.selection.objects.iter()).map(shown).collect();
        let triangles = objects.iter().zip(self.objects).filter(|(flag, _)| **flag).map(|(_, o)| o.triangles).sum();
        DrawSet { state, objects, triangles }
    }

    /// Kinds of surface among the drawn objects, sorted.
    fn surfaces(&self, draw: &DrawSet) -> Vec<Surface> {
        let drawn = draw.objects.iter().zip(self.objects).filter(|(flag, _)| **flag);
        let mut kinds: Vec<Surface> = drawn.flat_map(|(_, o)| o.surfaces.iter().copied()).collect();
        kinds.sort();
        kinds.dedup();
        kinds
    }

    /// Pipelines of a pass that only asks whether a surface has holes.
    fn cutouts(&self, draw: &DrawSet, key: impl Fn(bool) -> PipelineKey) -> Vec<PipelineKey> {
        let kinds = self.surfaces(draw);
        let holes = |wanted: bool| kinds.iter().any(|&k| (k == Surface::Cutout) == wanted);
        [false, true].into_iter().filter(|&cutout| holes(cutout)).map(key).collect()
    }

    /// Table from object number + 1 to label.
    fn table(&self, output: &OutputDemand) -> Encoding {
        let bytes = |label: &dyn Fn(usize, &ObjectSummary) -> u8| {
            let labels = self.objects.iter().enumerate().map(|(i, o)| label(i, o));
            Encoding::Label(std::iter::once(0).chain(labels).collect())
        };
        let marked = |i: usize| output.marked.as_ref().is_some_and(|m| m[i]);
        match output.output {
            Output::Class => bytes(&|_, o| o.class),
            Output::Level => bytes(&|_, o| o.level),
            Output::Mask => bytes(&|i, _| if marked(i) { 255 } else { 0 }),
            _ => Encoding::Number(std::iter::once(0).chain(self.objects.iter().map(|o| o.instance)).collect()),
        }
    }

    fn product(&self, index: usize, source: ResourceId, encoding: Encoding) -> Product {
        let demand = &self.view.outputs[index];
        Product { index, pass: demand.pass.clone(), output: demand.output, source, encoding }
    }

    /// A new resource. Equal ones share a texture: a tiled one does not outlive its stage, and a map is read only until
    /// the next one of its kind is made.
    fn resource(&mut self, stem: &str, format: Format, size: (u32, u32), supersample: u32, tiled: bool) -> ResourceId {
        let (width, height) = size;
        self.texture(stem, TextureKey { format, width, height, supersample, layers: 1, number: 0, tiled })
    }

    fn texture(&mut self, stem: &str, texture: TextureKey) -> ResourceId {
        let made = self.made.entry(texture.format).or_insert(0);
        let name = format!("{stem}#{made}");
        *made += 1;
        self.plan.resources.push(Resource { name, texture });
        ResourceId(self.plan.resources.len() - 1)
    }

    /// Samples per pixel side.
    fn supersample(&self) -> u32 {
        self.view.quality.supersample.max(1)
    }

    /// No light comes from below the horizon.
    fn sun(&self) -> Option<Sun> {
        self.view.sun.filter(|sun| sun.direction.y > 0.0)
    }

    fn size(&self) -> (u32, u32) {
        (self.view.camera.width, self.view.camera.height)
    }

    fn skip(&mut self, what: &str, reason: &str) {
        let skipped = Skipped { what: what.to_owned(), reason: reason.to_owned() };
        if !self.plan.skipped.contains(&skipped) {
            self.plan.skipped.push(skipped);
        }
    }
}

/// Distance to the farthest corner of the scene along the viewing direction, beyond the near plane.
fn far_distance(view: &ViewDemand, bounds: Option<(DVec3, DVec3)>) -> f64 {
    let camera = &view.camera;
    let corners = bounds.map(|(low, high)| light::box_corners(low, high));
    let farthest = corners.into_iter().flatten().map(|p| (p - camera.position).dot(camera.forward));
    farthest.fold(camera.near, f64::max) + 1.0
}

#[cfg(test)]
mod tests;
