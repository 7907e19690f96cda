//! In: what a recipe says of effects, the light of a view, the scene. Out: the [`Look`] of a pass, its draws made.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::clear_sky::WAVELENGTHS;
use super::effects::{
    Ambient, Bands, BitDepth, Clouds, GroundKind, GroundState, Haze, Look, NirLight, Sensor, Shadows,
    with_red_as_infrared,
};
use super::sun::Light;
use super::view::{Drawer, PlacedObject, SceneSummary};
use crate::interpreter::seed::Seed;
use crate::spec::effects::{
    AmbientSpec, BandsSpec, CloudsSpec, EffectsSpec, ExposureSpec, GroundKindSpec, GroundSpec, HazeSpec, SensorSpec,
    ShadowsSpec,
};
use crate::spec::render_spec::{DatasetSpec, PassSpec, RenderSpec, StateSpec};

/// What is left of contrast at the visibility: ln 50 (Koschmieder 1924).
const KOSCHMIEDER: f64 = 3.912;
/// By which haze of air and fine dust thins out with the wavelength.
const HAZE_EXPONENT: f64 = 1.3;
/// Share of sunlight that haze turns towards a camera above, at the angles a camera looks from.
const TOWARDS_CAMERA: f64 = 0.1;
/// Of thick clouds seen from above.
const CLOUD_ALBEDO: f64 = 0.75;
/// Discs that stand for a long feature, at most.
const MOST_DISCS: usize = 16;

/// What the effects of a pass need of recipe and scene, the same for every view.
pub(super) struct Surroundings<'a> {
    effects: EffectsSpec,
    scene_seed: Seed,
    /// Discs about the features that the pass shows changed.
    changed: Arc<[(DVec2, f64)]>,
    summary: &'a SceneSummary,
}

impl<'a> Surroundings<'a> {
    pub fn new(
        pass: &PassSpec,
        spec: &RenderSpec,
        dataset: &DatasetSpec,
        scene: usize,
        summary: &'a SceneSummary,
    ) -> Surroundings<'a> {
        let effects = dataset.effects.with(&pass.effects);
        let changed = if effects.ground.is_some() { changed(pass, spec, summary) } else { Vec::new() };
        let scene_seed = Seed::root(spec.scenes[scene].seed);
        Surroundings { effects, scene_seed, changed: changed.into(), summary }
    }
}

/// Discs about the features whose labelled change is made in the state that a pass shows, sorted by x.
fn changed(pass: &PassSpec, spec: &RenderSpec, summary: &SceneSummary) -> Vec<(DVec2, f64)> {
    let (StateSpec::After(made) | StateSpec::Both(made)) = &pass.state else { return Vec::new() };
    let made = |object: &&PlacedObject| {
        let change = usize::from(object.change).checked_sub(1);
        object.level > 0 && change.is_some_and(|c| made.contains(&c) && !spec.changes[c].non_target)
    };
    let bounds = summary.objects.iter().filter(made).filter_map(|object| object.bounds);
    let mut discs: Vec<(DVec2, f64)> = bounds.flat_map(discs).collect();
    discs.sort_by(|a, b| (a.0.x, a.0.y, a.1).partial_cmp(&(b.0.x, b.0.y, b.1)).expect("bounds are finite"));
    discs.dedup();
    discs
}

/// Discs along the longer side of a box in the plan, as wide as the shorter one.
fn discs((low, high): (DVec3, DVec3)) -> Vec<(DVec2, f64)> {
    let (low, high) = (DVec2::new(low.x, -high.z), DVec2::new(high.x, -low.z));
    let size = high - low;
    let (long, short) = (size.max_element(), size.min_element());
    let count = if short > 0.0 { (long / short).ceil().min(MOST_DISCS as f64) as usize } else { 1 };
    let radius = 0.5 * (long / count as f64).max(short);
    let along = if size.x >= size.y { DVec2::X } else { DVec2::Y };
    let middle = (low + high) / 2.0;
    let place = |i: usize| middle + along * (long * ((i as f64 + 0.5) / count as f64 - 0.5));
    (0..count).map(|i| (place(i), radius)).collect()
}

/// The look of a pass of one view. Settings that the pass itself gives are recorded under its name.
pub(super) fn look<'a>(around: &Surroundings, pass: &'a PassSpec, light: &Light, drawer: &mut Drawer<'a>) -> Look {
    let effects = &around.effects;
    let (ambient, level) = (ambient(effects.ambient, light), light.sun.direction.y);
    let own = |drawer: &mut Drawer<'a>, given: bool| drawer.pass = given.then_some(pass.name.as_str());
    own(drawer, pass.effects.atmosphere.is_some());
    let haze = effects.atmosphere.as_ref().map(|spec| haze(spec, light, around.summary, drawer));
    own(drawer, pass.effects.clouds.is_some());
    let clouds = effects.clouds.as_ref().map(|spec| clouds(spec, light, around.summary, drawer));
    own(drawer, pass.effects.ground.is_some());
    let ground = effects.ground.as_ref().filter(|_| !around.changed.is_empty());
    let ground = ground.map(|spec| ground_state(spec, around, drawer));
    own(drawer, pass.effects.sensor.is_some());
    let infrared = NirLight {
        sun: light.beam[3],
        zenith: from_above(ambient, light)[3],
        ground: from_below(ambient, light)[3],
        extinction: haze.as_ref().map_or(0.0, |(_, bands)| bands[3]),
        airlight: if haze.is_some() { airlight(light)[3] } else { 0.0 },
    };
    let white: [f64; 4] = std::array::from_fn(|b| light.beam[b] * level + from_above(ambient, light)[b]);
    let sensor = effects.sensor.as_ref().map(|spec| sensor(spec, infrared, white, &pass.name, drawer));
    own(drawer, false);
    Look {
        shadows: match effects.shadows {
            ShadowsSpec::Off => Shadows::Off,
            ShadowsSpec::Hard => Shadows::Hard,
            ShadowsSpec::Soft => Shadows::Soft,
        },
        ambient,
        haze: haze.map(|(haze, _)| haze),
        clouds,
        ground,
        sensor,
    }
}

fn ambient(spec: AmbientSpec, light: &Light) -> Ambient {
    match spec {
        AmbientSpec::Off => Ambient::Off,
        AmbientSpec::Constant(radiance) => Ambient::Constant(radiance),
        AmbientSpec::Sky { occluded } => Ambient::Sky { zenith: rgb(light.sky), ground: rgb(light.ground), occluded },
    }
}

/// Ambient light on a surface that faces up, in four bands.
fn from_above(ambient: Ambient, light: &Light) -> [f64; 4] {
    match ambient {
        Ambient::Off => [0.0; 4],
        Ambient::Constant(radiance) => with_red_as_infrared(radiance),
        Ambient::Sky { .. } => light.sky,
    }
}

/// The same on one that faces down.
fn from_below(ambient: Ambient, light: &Light) -> [f64; 4] {
    match ambient {
        Ambient::Sky { .. } => light.ground,
        other => from_above(other, light),
    }
}

fn rgb([r, g, b, _]: [f64; 4]) -> [f64; 3] {
    [r, g, b]
}

/// The haze, and its extinction in four bands.
fn haze(spec: &HazeSpec, light: &Light, summary: &SceneSummary, drawer: &mut Drawer) -> (Haze, [f64; 4]) {
    let visibility = drawer.draw("effects.atmosphere.visibility", &spec.visibility);
    let scale_height = drawer.draw("effects.atmosphere.scale_height", &spec.scale_height);
    let extinction = WAVELENGTHS.map(|nm| KOSCHMIEDER / visibility * libm::pow(nm / 550.0, -HAZE_EXPONENT));
    let base = summary.bounds.0.y;
    (Haze { extinction: rgb(extinction), scale_height, base, airlight: rgb(airlight(light)) }, extinction)
}

/// Radiance of an endless way through haze: what sky and ground send into it, evenly, and a little of the sun.
fn airlight(light: &Light) -> [f64; 4] {
    std::array::from_fn(|b| 0.5 * (light.sky[b] + light.ground[b]) + TOWARDS_CAMERA * light.beam[b])
}

fn clouds(spec: &CloudsSpec, light: &Light, summary: &SceneSummary, drawer: &mut Drawer) -> Clouds {
    let lit: [f64; 4] = std::array::from_fn(|b| light.beam[b] * light.sun.direction.y + light.sky[b]);
    Clouds {
        key: drawer.seed_of("effects.clouds").bits(),
        cover: drawer.draw("effects.clouds.cover", &spec.cover),
        height: summary.centre.y + drawer.draw("effects.clouds.height", &spec.height),
        size: drawer.draw("effects.clouds.size", &spec.size),
        depth: drawer.draw("effects.clouds.depth", &spec.depth),
        color: rgb(lit.map(|band| CLOUD_ALBEDO * band)),
    }
}

/// The same in every view of a scene: it lies there.
fn ground_state(spec: &GroundSpec, around: &Surroundings, drawer: &mut Drawer) -> GroundState {
    let seed = around.scene_seed.named("effects.ground");
    let (strength, reach) = (spec.share.draw(seed.named("share")), spec.within.draw(seed.named("within")));
    drawer.record("effects.ground.share", strength);
    drawer.record("effects.ground.within", reach);
    GroundState {
        key: seed.bits(),
        kind: match spec.kind {
            GroundKindSpec::Ash => GroundKind::Ash,
            GroundKindSpec::Puddles => GroundKind::Puddles,
        },
        strength,
        reach,
        around: around.changed.clone(),
    }
}

/// `white` is the irradiance of level ground in four bands.
fn sensor(spec: &SensorSpec, infrared: NirLight, white: [f64; 4], pass: &str, drawer: &mut Drawer) -> Sensor {
    let bands = match spec.bands {
        BandsSpec::Rgb => Bands::Rgb,
        BandsSpec::Nir => Bands::Nir(infrared),
        BandsSpec::Panchromatic => Bands::Panchromatic(infrared),
        BandsSpec::FalseColour => Bands::FalseColor(infrared),
    };
    let exposure = match &spec.exposure {
        ExposureSpec::Factor(factor) => drawer.draw("effects.sensor.exposure", factor),
        ExposureSpec::Auto => {
            let mean = bands.of(white).iter().sum::<f64>() / 3.0;
            let exposure = if mean > 0.0 { 1.0 / mean } else { 1.0 };
            drawer.record("effects.sensor.exposure", exposure);
            exposure
        }
    };
    Sensor {
        // Two images of a view do not have the same noise.
        key: drawer.seed_of("effects.sensor").named(pass).bits(),
        psf: drawer.draw("effects.sensor.psf", &spec.psf),
        exposure,
        read_noise: drawer.draw("effects.sensor.noise", &spec.noise),
        full_well: spec.full_well.as_ref().map_or(0.0, |spec| drawer.draw("effects.sensor.full_well", spec)),
        depth: if spec.bits == 16 { BitDepth::Sixteen } else { BitDepth::Eight },
        bands,
    }
}
