//! Maps: the look of an image → the maps that its light is looked up in, each made once and only if it is read, and a
//! reason for each that is not.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::{Shading, ViewScheduler};
use crate::plan::demand::{Ambient, Look, Projection, Shadows, Sun};
use crate::plan::effects::{Bands, Clouds, GroundKind, GroundState};
use crate::plan::light::{self, LightFrame};
use crate::plan::pass::{DrawSet, Pass, PassKind, PipelineKey, Stage};
use crate::plan::resource::{Format, ResourceId, TextureKey};
use crate::plan::shading::{Field, FieldFrame, FieldLook, Illumination, ShadowLook, SkyLook, SoftLook};
use crate::plan::sky;

/// Texels of the shadow map per side of a block of its bounds.
pub const BLOCK: u32 = 8;

/// The maps that were made last, for looks that can share them.
#[derive(Default)]
pub struct Maps {
    shadow: Option<(DrawSet, LightFrame, ResourceId)>,
    /// Of which map.
    bounds: Option<(ResourceId, ResourceId)>,
    sky: Option<(DrawSet, SkyLook)>,
    fields: [Option<(Field, FieldLook)>; 3],
}

/// Which of the three maps of fields, that are alive together.
#[derive(Clone, Copy)]
enum FieldMap {
    CloudShadow,
    CloudCover,
    Ground,
}

impl ViewScheduler<'_> {
    /// What lights an image, with the passes for it.
    pub(super) fn illumination(&mut self, shading: &Shading, maps: &mut Maps) -> Illumination {
        let Look { ambient, haze, sensor, .. } = shading.look;
        let shadow = self.shadow(shading, maps);
        let sky = self.sky(shading, maps);
        if haze.is_none() {
            self.skip("haze", "not asked for");
        }
        let (cloud_shadow, cloud_cover) = self.clouds(&shading.look, maps);
        let ground = self.ground(&shading.look, maps);
        if sensor.is_none() {
            self.skip("sensor", "not asked for");
        }
        Illumination {
            sun: self.sun(),
            ambient,
            shadow,
            sky,
            haze,
            clouds: shading.look.clouds.filter(|_| cloud_shadow.is_some() || cloud_cover.is_some()),
            cloud_shadow,
            cloud_cover,
            ground,
            bands: sensor.map_or(Bands::Rgb, |sensor| sensor.bands),
        }
    }

    /// The shadow map of a look: the last one again if it shows the same.
    fn shadow(&mut self, shading: &Shading, maps: &mut Maps) -> Option<ShadowLook> {
        if shading.look.shadows == Shadows::Off {
            self.skip("shadow map", "shadows are off");
            return None;
        }
        let Some(sun) = self.sun() else {
            self.skip("shadow map", "no sun above the horizon");
            return None;
        };
        let soft = shading.look.shadows == Shadows::Soft && sun.disc_deg > 0.0;
        let size = self.view.quality.shadow_map;
        let fitted = self.bounds.and_then(|bounds| {
            let margin = if soft { penumbra(&sun, bounds) } else { 0.0 };
            light::fit(&self.view.camera, bounds, sun.direction, size, margin)
        });
        let (Some(frame), Some(bounds), true) = (fitted, self.bounds, shading.draw.triangles > 0) else {
            self.skip("shadow map", "nothing in view");
            return None;
        };
        let same = |(draw, other, _): &&(DrawSet, _, _)| draw.objects == shading.draw.objects && *other == frame;
        let map = match maps.shadow.as_ref().filter(same) {
            Some((_, _, id)) => *id,
            None => self.draw_shadow_map(&shading.draw, frame),
        };
        maps.shadow = Some((shading.draw.clone(), frame, map));
        if !soft {
            self.skip("bounds of the shadow map", "no soft shadows");
            return Some(ShadowLook { frame, map, soft: None });
        }
        let made = maps.bounds.filter(|(of, _)| *of == map);
        let bounds_map = made.map_or_else(|| self.shadow_bounds(frame, map), |(_, blocks)| blocks);
        maps.bounds = Some((map, bounds_map));
        let soft = SoftLook { bounds: bounds_map, samples: self.soft_samples(), top: bounds.1.y };
        Some(ShadowLook { frame, map, soft: Some(soft) })
    }

    fn soft_samples(&self) -> u32 {
        self.view.quality.shadow_samples.clamp(1, 16).pow(2)
    }

    fn draw_shadow_map(&mut self, draw: &DrawSet, light: LightFrame) -> ResourceId {
        let id = self.resource("shadow_map", Format::Depth32, (light.size, light.size), 1, false);
        let pipelines = self.cutouts(draw, |cutout| PipelineKey::ShadowMap { cutout });
        self.once(PassKind::ShadowMap { draw: draw.clone(), light }, vec![], &[id], pipelines);
        id
    }

    /// Blocks per side are a power of two, so that halving them loses none.
    fn shadow_bounds(&mut self, light: LightFrame, map: ResourceId) -> ResourceId {
        let blocks = light.size.div_ceil(BLOCK).next_power_of_two().max(2);
        let fine = self.texture("shadow_bounds", map_texture(Format::Bounds32, blocks));
        let all = TextureKey { width: 2 * blocks, number: 1, ..map_texture(Format::Bounds32, blocks) };
        let all = self.texture("shadow_bounds", all);
        let pipelines = [true, false].map(|first| PipelineKey::ShadowBounds { first }).to_vec();
        self.once(PassKind::ShadowBounds { light }, vec![map], &[fine, all], pipelines);
        all
    }

    fn sky(&mut self, shading: &Shading, maps: &mut Maps) -> Option<SkyLook> {
        let Ambient::Sky { occluded: true, .. } = shading.look.ambient else {
            self.skip("sky maps", "nothing hides the ambient light");
            return None;
        };
        let quality = self.view.quality;
        let count = quality.sky_samples.clamp(1, 256);
        let subsets = sky::subsets(count, self.supersample());
        let size = sky::map_size(quality.shadow_map, count);
        let directions = sky::directions(count, subsets);
        let frames: Option<Arc<[LightFrame]>> = self.bounds.and_then(|bounds| {
            directions.iter().map(|&d| light::fit(&self.view.camera, bounds, d, size, 0.0)).collect()
        });
        let (Some(frames), true) = (frames, shading.draw.triangles > 0) else {
            self.skip("sky maps", "nothing in view");
            return None;
        };
        if let Some((draw, look)) = &maps.sky
            && draw.objects == shading.draw.objects
        {
            return Some(look.clone());
        }
        let texture = TextureKey { layers: count, ..map_texture(Format::Depth32, size) };
        let id = self.texture("sky_maps", texture);
        let pipelines = self.cutouts(&shading.draw, |cutout| PipelineKey::ShadowMap { cutout });
        self.once(PassKind::SkyMaps { draw: shading.draw.clone(), frames: frames.clone() }, vec![], &[id], pipelines);
        let look = SkyLook { maps: id, frames, subsets };
        maps.sky = Some((shading.draw.clone(), look.clone()));
        Some(look)
    }

    /// Maps of the clouds towards the sun and towards the camera.
    fn clouds(&mut self, look: &Look, maps: &mut Maps) -> (Option<FieldLook>, Option<FieldLook>) {
        let Some(clouds) = look.clouds.filter(|clouds| clouds.cover > 0.0 && clouds.depth > 0.0) else {
            self.skip("clouds", "not asked for");
            return (None, None);
        };
        let points = self.receivers();
        if points.is_empty() {
            self.skip("clouds", "nothing in view");
            return (None, None);
        }
        let shadow = match self.sun() {
            Some(sun) => {
                let crossings = points.iter().map(|&p| p + sun.direction * (above(&clouds, p) / sun.direction.y));
                self.field(FieldMap::CloudShadow, Field::Clouds(clouds), crossings.collect(), maps)
            }
            None => {
                self.skip("shadows of clouds", "no sun above the horizon");
                None
            }
        };
        let camera = self.view.camera;
        if camera.position.y <= clouds.height {
            self.skip("clouds in view", "the camera is below them");
            return (shadow, None);
        }
        let crossing = |&p: &DVec3| {
            let up = match camera.projection {
                Projection::Perspective { .. } => camera.position - p,
                Projection::Orthographic { .. } => -camera.forward,
            };
            p + up * (above(&clouds, p) / up.y.max(1e-3))
        };
        let crossings = points.iter().map(crossing).collect();
        (shadow, self.field(FieldMap::CloudCover, Field::Clouds(clouds), crossings, maps))
    }

    /// The map of what lies on the ground around the changed features in view.
    fn ground(&mut self, look: &Look, maps: &mut Maps) -> Option<(GroundKind, FieldLook)> {
        let Some(ground) = look.ground.clone().filter(|ground| ground.strength > 0.0) else {
            self.skip("state of the ground", "not asked for");
            return None;
        };
        let kind = ground.kind;
        let Some(corners) = covered(&ground, &self.receivers()) else {
            self.skip("state of the ground", "no changed feature in view");
            return None;
        };
        let look = self.field(FieldMap::Ground, Field::Ground(ground), corners, maps)?;
        Some((kind, look))
    }

    /// A map of `field` over the rectangle around `points`, the last one again if it is the same.
    fn field(&mut self, which: FieldMap, field: Field, points: Vec<DVec3>, maps: &mut Maps) -> Option<FieldLook> {
        let size = self.view.quality.field_map.max(2);
        let plan = |p: &DVec3| DVec2::new(p.x, -p.z);
        let first = plan(points.first()?);
        let (low, high) = points.iter().map(plan).fold((first, first), |(l, h), p| (l.min(p), h.max(p)));
        // Blending reaches half a texel beyond what is seen.
        let margin = (high - low).max(DVec2::splat(1.0)) / f64::from(size - 1);
        let frame = FieldFrame { low: low - margin, high: high + margin, size };
        if let Some((other, look)) = &maps.fields[which as usize]
            && *other == field
            && look.frame == frame
        {
            return Some(*look);
        }
        let texture = TextureKey { number: which as u32, ..map_texture(Format::Field16, size) };
        let map = self.texture(field.stem(), texture);
        let look = FieldLook { frame, map };
        maps.fields[which as usize] = Some((field.clone(), look));
        self.once(PassKind::Field { field: Box::new(field), frame }, vec![], &[map], vec![]);
        Some(look)
    }

    /// World points whose hull holds all that the camera sees.
    fn receivers(&self) -> Vec<DVec3> {
        let Some(bounds) = self.bounds else { return Vec::new() };
        light::visible_corners(&self.view.camera, bounds).into_iter().map(|p| p + bounds.0).collect()
    }

    /// A stage of one pass that is not repeated per tile.
    fn once(&mut self, kind: PassKind, reads: Vec<ResourceId>, writes: &[ResourceId], pipelines: Vec<PipelineKey>) {
        let pass = Pass { kind, reads, writes: writes.to_vec(), pipelines };
        self.plan.stages.push(Stage { tiled: false, passes: vec![pass], products: vec![] });
    }
}

fn map_texture(format: Format, size: u32) -> TextureKey {
    TextureKey { format, width: size, height: size, supersample: 1, layers: 1, number: 0, tiled: false }
}

/// Metres, across the light, over which the scene's top may spread the shadow's edge on its bottom.
fn penumbra(sun: &Sun, (low, high): (DVec3, DVec3)) -> f64 {
    libm::tan((sun.disc_deg / 2.0).to_radians()) * (high.y - low.y) / sun.direction.y
}

/// Metres from a point up to the layer.
fn above(clouds: &Clouds, p: DVec3) -> f64 {
    (clouds.height - p.y).max(0.0)
}

/// Corners of the rectangle, in the plan, of what is both seen and covered.
fn covered(ground: &GroundState, seen: &[DVec3]) -> Option<Vec<DVec3>> {
    let first = *seen.first()?;
    let (low, high) = seen.iter().fold((first, first), |(l, h), &p| (l.min(p), h.max(p)));
    let discs = ground.around.iter().map(|&(center, radius)| {
        let (center, reach) = (DVec3::new(center.x, 0.0, -center.y), DVec3::splat(radius + ground.reach));
        (center - reach, center + reach)
    });
    let near = discs.filter(|(l, h)| l.x < high.x && l.z < high.z && h.x > low.x && h.z > low.z);
    let (l, h) = near.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))?;
    Some(vec![l.max(low), h.min(high)])
}
