//! In: a checked recipe and a summary of a derived scene. Out: what every view asks for, with all draws made.
//!
//! A draw is keyed by scene seed, camera name, the view's number among those of its camera, acquisition and property:
//! another view, pass or property never changes it. What lies on the ground is keyed by the scene alone.

use std::sync::Arc;

use glam::DVec3;
use serde::Serialize;

use super::demand::{Camera, Look, Output, OutputDemand, Projection, Quality, Selection, State, ViewDemand};
use super::look::{Surroundings, look};
use super::sun::light;
use crate::geodata::feature::FeatureId;
use crate::interpreter::seed::Seed;
use crate::scene::{Presence, Scene, SceneClass};
use crate::spec::draw::Distribution;
use crate::spec::render_spec::{
    AcquisitionSpec, CameraSpec, DatasetSpec, Lens, OutputSpec, PassSpec, RenderSpec, SetSpec, StateSpec, ViewSpec,
};

/// Metres; the near plane is never nearer.
const LEAST_NEAR: f64 = 0.1;

/// What planning needs to know of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSummary {
    /// Least and greatest corner of all objects, world metres.
    pub bounds: (DVec3, DVec3),
    /// What cameras look at: the scene's centre in the plan, on the terrain.
    pub centre: DVec3,
    /// In the order of [`Scene::objects`].
    pub objects: Vec<PlacedObject>,
}

/// What selections and effects need to know of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedObject {
    pub feature: Option<FeatureId>,
    pub class: SceneClass,
    pub presence: Presence,
    /// Number of the change, from 1; 0 for none.
    pub change: u16,
    /// Level of the change; 0 for what no change is about, such as ground that one takes over.
    pub level: u8,
    /// Least and greatest corner, world metres; `None` for an empty mesh.
    pub bounds: Option<(DVec3, DVec3)>,
}

impl SceneSummary {
    pub fn new(scene: &Scene, centre: DVec3) -> Self {
        let objects = scene.objects.iter().map(|object| PlacedObject {
            feature: object.feature,
            class: object.class,
            presence: object.presence,
            change: object.change,
            level: object.level,
            bounds: object.mesh.bounds(),
        });
        SceneSummary { bounds: scene.bounds, centre, objects: objects.collect() }
    }
}

/// A property of a view and the value it has, such as `camera.off_nadir`: degrees, metres or plain numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Draw {
    pub path: String,
    pub value: f64,
}

/// One view of the recipe, ready to render.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnView {
    /// Index into [`DatasetSpec::views`].
    pub view: usize,
    pub name: String,
    /// One for each acquisition that differs in camera or sun, all under the view's name; their images together are
    /// the view's.
    pub demands: Vec<ViewDemand>,
    /// Every property of camera, sun and effects; those of a named acquisition start with its name, those of a pass's own
    /// effects with the pass's.
    pub draws: Vec<Draw>,
}

/// All views that the dataset has of one scene (an index into [`RenderSpec::scenes`]).
pub fn views(spec: &RenderSpec, dataset: &DatasetSpec, scene: usize, summary: &SceneSummary) -> Vec<DrawnView> {
    let of_scene = dataset.views.iter().enumerate().filter(|(_, view)| view.scene == scene);
    let passes: Vec<&PassSpec> = dataset.passes.iter().map(|&pass| &spec.passes[pass]).collect();
    let outputs: Vec<Vec<OutputDemand>> = passes.iter().map(|pass| outputs(pass, spec, dataset, summary)).collect();
    let surroundings: Vec<Surroundings> =
        passes.iter().map(|pass| Surroundings::new(pass, spec, dataset, scene, summary)).collect();
    let prepared: Vec<Prepared> = passes
        .into_iter()
        .zip(outputs)
        .zip(surroundings)
        .map(|((pass, outputs), surroundings)| Prepared { pass, outputs, surroundings })
        .collect();
    of_scene.map(|(index, view)| drawn_view(index, view, spec, dataset, summary, &prepared)).collect()
}

/// A pass with what is the same for every view.
struct Prepared<'a> {
    pass: &'a PassSpec,
    /// Without looks.
    outputs: Vec<OutputDemand>,
    surroundings: Surroundings<'a>,
}

fn drawn_view(
    index: usize,
    view: &ViewSpec,
    spec: &RenderSpec,
    dataset: &DatasetSpec,
    summary: &SceneSummary,
    passes: &[Prepared],
) -> DrawnView {
    let seed = Seed::root(spec.scenes[view.scene].seed).named("view").named(&view.camera.name);
    let seed = seed.part(u64::from(view.number));
    let mut acquisitions: Vec<Option<&AcquisitionSpec>> = Vec::new();
    for prepared in passes {
        if !acquisitions.contains(&prepared.pass.acquisition.as_ref()) {
            acquisitions.push(prepared.pass.acquisition.as_ref());
        }
    }
    let mut draws = Vec::new();
    let mut demands = Vec::new();
    for acquisition in acquisitions {
        let mut drawer = Drawer { seed, acquisition, pass: None, draws: &mut draws };
        let camera = camera(&view.camera, summary, &mut drawer);
        let light = light(&dataset.sun, &mut drawer);
        let mut outputs = Vec::new();
        for own in passes.iter().filter(|prepared| prepared.pass.acquisition.as_ref() == acquisition) {
            let seen = own.outputs.iter().any(|output| output.output == Output::Color);
            let look = if seen { look(&own.surroundings, own.pass, &light, &mut drawer) } else { Look::none() };
            let look_of = |output: Output| if output == Output::Color { look.clone() } else { Look::none() };
            outputs.extend(own.outputs.iter().map(|o| OutputDemand { look: look_of(o.output), ..o.clone() }));
        }
        let lit = outputs.iter().any(|output| output.output == Output::Color);
        demands.push(ViewDemand {
            name: view.name.clone(),
            camera,
            sun: lit.then_some(light.sun),
            quality: Quality::from(&dataset.quality),
            outputs,
        });
    }
    DrawnView { view: index, name: view.name.clone(), demands, draws }
}

/// Draws properties of one view in one acquisition and writes them down.
pub(super) struct Drawer<'a> {
    pub(super) seed: Seed,
    acquisition: Option<&'a AcquisitionSpec>,
    /// The pass that overrides the effect that is being drawn.
    pub(super) pass: Option<&'a str>,
    draws: &'a mut Vec<Draw>,
}

impl Drawer<'_> {
    /// The value of a property; `path` starts with `camera.`, `sun.` or `effects.`.
    pub fn draw(&mut self, path: &str, distribution: &Distribution) -> f64 {
        let value = distribution.draw(self.seed_of(path));
        self.record(path, value);
        value
    }

    /// The seed of a property.
    pub fn seed_of(&self, path: &str) -> Seed {
        match self.redrawn_by(path) {
            Some(acquisition) => self.seed.named("acquisition").named(&acquisition.name),
            None => self.seed,
        }
        .named(path)
    }

    /// Writes down a value that follows from draws.
    pub fn record(&mut self, path: &str, value: f64) {
        let path = match self.redrawn_by(path) {
            Some(acquisition) => format!("{}.{path}", acquisition.name),
            None => path.to_owned(),
        };
        let path = match self.pass {
            Some(pass) => format!("{pass}.{path}"),
            None => path,
        };
        let draw = Draw { path, value };
        // Acquisitions that share a property meet it again, with the same value.
        if !self.draws.contains(&draw) {
            self.draws.push(draw);
        }
    }

    /// The acquisition, if it draws this property anew.
    fn redrawn_by(&self, path: &str) -> Option<&AcquisitionSpec> {
        let part = path.split('.').next().unwrap_or(path);
        self.acquisition.filter(|acquisition| match part {
            "sun" => acquisition.sun,
            "effects" => acquisition.effects,
            _ => acquisition.camera,
        })
    }
}

/// The camera of a view, looking at the scene's centre from the drawn direction and distance.
fn camera(spec: &CameraSpec, summary: &SceneSummary, drawer: &mut Drawer) -> Camera {
    let off_nadir = drawer.draw("camera.off_nadir", &spec.off_nadir);
    let azimuth = drawer.draw("camera.azimuth", &spec.azimuth);
    let heading = drawer.draw("camera.heading", &spec.heading);
    let (right, up, forward) = frame(off_nadir, azimuth, heading);
    let (distance, projection) = lens(spec, summary, drawer);
    let position = summary.centre - forward * distance;
    Camera {
        position,
        right,
        up,
        forward,
        projection,
        width: spec.width,
        height: spec.height,
        near: near(position, forward, summary),
    }
}

/// Right, up and forward of a camera that stands `azimuth` degrees clockwise from north of its target, `off_nadir`
/// degrees from the vertical above it, with the plan direction `heading` at the top of the image.
///
/// Nadir is no special case: the top is a direction of the plan, made perpendicular to the line of sight.
pub fn frame(off_nadir: f64, azimuth: f64, heading: f64) -> (DVec3, DVec3, DVec3) {
    let (aside, above) = libm::sincos(off_nadir.to_radians());
    let (east, north) = libm::sincos(azimuth.to_radians());
    let forward = -DVec3::new(aside * east, above, -aside * north).normalize();
    let (east, north) = libm::sincos(heading.to_radians());
    let top = DVec3::new(east, 0.0, -north);
    let up = (top - forward * top.dot(forward)).normalize();
    (forward.cross(up).normalize(), up, forward)
}

/// Distance from the target and projection, by `width · gsd = 2 · distance · tan(fov / 2)`.
fn lens(spec: &CameraSpec, summary: &SceneSummary, drawer: &mut Drawer) -> (f64, Projection) {
    let width = f64::from(spec.width);
    let aspect = f64::from(spec.height) / width;
    let (distance, tan_x) = match &spec.lens {
        Lens::Orthographic { gsd } => {
            let gsd = drawer.draw("camera.gsd", gsd);
            let (low, high) = summary.bounds;
            // Outside the sphere about the target that holds the scene.
            let reach = (high - summary.centre).abs().max((low - summary.centre).abs()).length();
            let half_x = 0.5 * width * gsd;
            return (reach + 1.0, Projection::Orthographic { half_x, half_y: half_x * aspect });
        }
        Lens::GsdFov { gsd, fov } => {
            let gsd = drawer.draw("camera.gsd", gsd);
            let tan_x = libm::tan(drawer.draw("camera.fov", fov).to_radians() / 2.0);
            let distance = width * gsd / (2.0 * tan_x);
            drawer.record("camera.altitude", distance);
            (distance, tan_x)
        }
        Lens::GsdAltitude { gsd, altitude } => {
            let gsd = drawer.draw("camera.gsd", gsd);
            let distance = drawer.draw("camera.altitude", altitude);
            let tan_x = width * gsd / (2.0 * distance);
            drawer.record("camera.fov", 2.0 * libm::atan(tan_x).to_degrees());
            (distance, tan_x)
        }
        Lens::FovAltitude { fov, altitude } => {
            let tan_x = libm::tan(drawer.draw("camera.fov", fov).to_radians() / 2.0);
            let distance = drawer.draw("camera.altitude", altitude);
            drawer.record("camera.gsd", 2.0 * distance * tan_x / width);
            (distance, tan_x)
        }
    };
    (distance, Projection::Perspective { tan_x, tan_y: tan_x * aspect })
}

/// A little nearer than the nearest corner of the scene's bounds.
fn near(position: DVec3, forward: DVec3, summary: &SceneSummary) -> f64 {
    let (low, high) = summary.bounds;
    let corner = DVec3::select(forward.cmpge(DVec3::ZERO), low, high);
    (0.99 * (corner - position).dot(forward)).max(LEAST_NEAR)
}

/// What a pass writes, the same for every view but for its look.
fn outputs(pass: &PassSpec, spec: &RenderSpec, dataset: &DatasetSpec, summary: &SceneSummary) -> Vec<OutputDemand> {
    let vegetation = dataset.effects.with(&pass.effects).vegetation;
    let shown = |object: &PlacedObject| {
        (vegetation || object.class != SceneClass::Vegetation)
            && visible(object, &pass.state)
            && member(object, &pass.show, spec)
    };
    let objects: Arc<[bool]> = summary.objects.iter().map(shown).collect();
    let marked: Arc<[bool]> = match &pass.mark {
        Some(mark) => summary.objects.iter().map(|object| shown(object) && member(object, mark, spec)).collect(),
        None => objects.clone(),
    };
    let state = if pass.state == StateSpec::Before { State::Before } else { State::After };
    let one = |(output, name): &(OutputSpec, String)| OutputDemand {
        pass: name.clone(),
        output: output_of(*output),
        selection: Selection { state, objects: objects.clone() },
        marked: (*output == OutputSpec::Mask).then(|| marked.clone()),
        look: Look::none(),
    };
    pass.outputs.iter().map(one).collect()
}

/// Whether an object is there in a state.
fn visible(object: &PlacedObject, state: &StateSpec) -> bool {
    let made = |changes: &[usize]| changes.iter().any(|&change| change + 1 == usize::from(object.change));
    match (object.presence, state) {
        (Presence::Both, _) | (Presence::BeforeOnly, StateSpec::Before | StateSpec::Both(_)) => true,
        (Presence::BeforeOnly, StateSpec::After(changes)) => !made(changes),
        (Presence::AfterOnly, StateSpec::Before) => false,
        (Presence::AfterOnly, StateSpec::After(changes) | StateSpec::Both(changes)) => made(changes),
    }
}

/// Whether an object belongs to a set.
fn member(object: &PlacedObject, set: &SetSpec, spec: &RenderSpec) -> bool {
    match set {
        SetSpec::All => true,
        SetSpec::Terrain => object.class == SceneClass::Terrain,
        SetSpec::Vegetation => object.class == SceneClass::Vegetation,
        SetSpec::Class(class) => object.class == SceneClass::from(*class),
        SetSpec::Change(change) => usize::from(object.change) == change + 1,
        SetSpec::Changed => {
            let change = usize::from(object.change).checked_sub(1).and_then(|change| spec.changes.get(change));
            change.is_some_and(|change| !change.non_target)
        }
        SetSpec::Any(sets) => sets.iter().any(|set| member(object, set, spec)),
        SetSpec::Every(sets) => sets.iter().all(|set| member(object, set, spec)),
        SetSpec::Not(set) => !member(object, set, spec),
    }
}

fn output_of(output: OutputSpec) -> Output {
    match output {
        OutputSpec::Colour => Output::Color,
        OutputSpec::Class => Output::Class,
        OutputSpec::Mask => Output::Mask,
        OutputSpec::Level => Output::Level,
        OutputSpec::Instance => Output::Instance,
        OutputSpec::Depth => Output::Depth,
    }
}

#[cfg(test)]
mod tests;
