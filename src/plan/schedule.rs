//! Schedule: demands of all views → the passes that serve them, each made once, and nothing else.
//!
//! Colour outputs of equal selection and light share one shading; class, mask, level, instance and depth outputs of
//! equal selection share one pass of object numbers. A shadow map is made only for a shading that reads it.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::attribute::Attribute;
use super::demand::{Look, Output, OutputDemand, Shadows, Sun, ViewDemand};
use super::finite::not_finite;
use super::light::{self, LightFrame};
use super::pass::{
    DrawSet, Encoding, Pass, PassKind, PipelineKey, Product, RenderPlan, ShadowFilter, Skipped, Stage, Surface,
    ViewPlan,
};
use super::resource::{Format, Resource, ResourceId, TextureKey};
use super::summary::ObjectSummary;

/// Height, metres, of the wall whose penumbra the soft filter is as wide as: two storeys and a half.
const PENUMBRA_CASTER: f64 = 8.0;
/// Least width of a soft shadow's filter, texels.
const SOFTEST_BOX: u32 = 3;

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
        self.attributes();
        self.plan
    }

    /// Shadow map, shading and resolve for each look.
    fn colors(&mut self) {
        let looks =
            self.group(|o| o.output == Output::Color, |s, o| Shading { draw: s.draw_set(o), look: o.look.clone() });
        if looks.is_empty() {
            self.skip("shading", "no output asks for colour");
            self.skip("shadow map", "no output asks for colour");
        }
        let mut drawn: Option<(DrawSet, ResourceId)> = None;
        for (look, outputs) in looks {
            let shadow = self.shadow_map(&look, &mut drawn);
            self.shade(look, shadow, &outputs);
        }
    }

    /// The shadow map that `look` reads: the last one again if it shows the same objects.
    fn shadow_map(
        &mut self,
        look: &Shading,
        drawn: &mut Option<(DrawSet, ResourceId)>,
    ) -> Option<(LightFrame, ResourceId)> {
        if look.look.shadows == Shadows::Off {
            self.skip("shadow map", "shadows are off");
            return None;
        }
        let Some(sun) = self.sun() else {
            self.skip("shadow map", "no sun above the horizon");
            return None;
        };
        let size = self.view.quality.shadow_map;
        let fitted = self.bounds.and_then(|b| light::fit(&self.view.camera, b, sun.direction, size));
        let (Some(light), true) = (fitted, look.draw.triangles > 0) else {
            self.skip("shadow map", "nothing in view");
            return None;
        };
        if let Some((draw, id)) = drawn.as_ref()
            && draw.objects == look.draw.objects
        {
            return Some((light, *id));
        }
        let id = self.resource("shadow_map", Format::Depth32, (size, size), 1, false);
        let pipelines = self.cutouts(&look.draw, |cutout| PipelineKey::ShadowMap { cutout });
        let kind = PassKind::ShadowMap { draw: look.draw.clone(), light };
        let pass = Pass { kind, reads: vec![], writes: vec![id], pipelines };
        self.plan.stages.push(Stage { tiled: false, passes: vec![pass], products: vec![] });
        *drawn = Some((look.draw.clone(), id));
        Some((light, id))
    }

    fn shade(&mut self, look: Shading, shadow: Option<(LightFrame, ResourceId)>, outputs: &[usize]) {
        let supersample = self.view.quality.supersample.max(1);
        let radiance = self.resource("shade", Format::Radiance16, self.size(), supersample, true);
        let depth = self.resource("shade.depth", Format::Depth32, self.size(), supersample, true);
        let color = self.resource("resolve", Format::Srgb8, self.size(), 1, true);
        let filter = match (shadow, self.sun()) {
            (Some((frame, _)), Some(sun)) => self.filter(look.look.shadows, &frame, &sun),
            _ => ShadowFilter::Unshadowed,
        };
        let pipelines = self
            .surfaces(&look.draw)
            .into_iter()
            .map(|surface| PipelineKey::Shade { surface, shadow: filter })
            .collect();
        let light = shadow.map(|(frame, _)| frame);
        let shade = Pass {
            kind: PassKind::Shade { draw: look.draw, sun: self.sun(), ambient: look.look.ambient, light },
            reads: shadow.map(|(_, id)| id).into_iter().collect(),
            writes: vec![radiance, depth],
            pipelines,
        };
        let resolve = Pass {
            kind: PassKind::Resolve { supersample },
            reads: vec![radiance],
            writes: vec![color],
            pipelines: vec![PipelineKey::Resolve { supersample }],
        };
        let products = outputs.iter().map(|&i| self.product(i, color, Encoding::Color)).collect();
        self.plan.stages.push(Stage { tiled: true, passes: vec![shade, resolve], products });
    }

    /// Says which attributes of vertices no pass reads.
    fn attributes(&mut self) {
        let keys = self.plan.passes().flat_map(|pass| &pass.pipelines);
        let read: std::collections::BTreeSet<Attribute> = keys.flat_map(|key| key.attributes()).copied().collect();
        for attribute in Attribute::ALL.into_iter().filter(|a| !read.contains(a)) {
            let reason = match attribute {
                Attribute::Position => "nothing is drawn",
                Attribute::Normal | Attribute::Material => "nothing is shaded",
                Attribute::TextureCoordinates => "no pass sees a texture",
                Attribute::Object => "no output asks for labels",
            };
            self.skip(attribute.name(), reason);
        }
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

    /// A new resource. Equal ones share a texture: a tiled one does not outlive its stage, and a shadow map is read
    /// only until the next one is drawn.
    fn resource(&mut self, stem: &str, format: Format, size: (u32, u32), supersample: u32, tiled: bool) -> ResourceId {
        let made = self.made.entry(format).or_insert(0);
        let name = format!("{stem}#{made}");
        *made += 1;
        let texture = TextureKey { format, width: size.0, height: size.1, supersample, tiled };
        self.plan.resources.push(Resource { name, texture });
        ResourceId(self.plan.resources.len() - 1)
    }

    /// Box width in texels: the penumbra of a wall of [`PENUMBRA_CASTER`], at most what the quality allows.
    fn filter(&self, shadows: Shadows, frame: &LightFrame, sun: &Sun) -> ShadowFilter {
        if shadows == Shadows::Hard {
            return ShadowFilter::Box { gathers: 1 };
        }
        let disc = 2.0 * libm::tan((sun.disc_deg / 2.0).to_radians());
        let penumbra = disc * PENUMBRA_CASTER / sun.direction.y.max(0.01);
        let allowed = self.view.quality.shadow_samples.clamp(SOFTEST_BOX, 15);
        let texels = (penumbra / frame.texel.max_element()).ceil() as u32;
        ShadowFilter::Box { gathers: texels.clamp(SOFTEST_BOX, allowed) / 2 + 1 }
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
