//! Take: what to draw for the window. In: a view that the recipe drew, a camera, a state and the layers that are on. Out: a
//! demand of the same kind as a dataset's: its light, effects and quality, its selections without the layers that are
//! off, and the images that the window needs besides: object numbers and distances.

use std::sync::Arc;

use glam::DVec3;

use crate::plan::demand::{
    Ambient, Camera, Look, Output, OutputDemand, Quality, Selection, Shadows, State, Sun, ViewDemand,
};
use crate::plan::view::{DrawnView, PlacedObject};
use crate::scene::{Presence, SceneClass};

/// Names of a demand's images; the colour image or mask is the first.
pub const PICTURE: &str = "picture";
pub const INSTANCES: &str = "instances";
pub const DISTANCES: &str = "distances";

/// What one picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    Before,
    After,
    Mask,
}

impl Kind {
    pub fn name(self) -> &'static str {
        match self {
            Kind::Before => "before",
            Kind::After => "after",
            Kind::Mask => "mask",
        }
    }

    /// Whose derivation a click is about.
    pub fn state(self) -> State {
        match self {
            Kind::Before => State::Before,
            Kind::After | Kind::Mask => State::After,
        }
    }
}

/// Classes that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layers(u16);

impl Default for Layers {
    fn default() -> Layers {
        Layers(u16::MAX)
    }
}

impl Layers {
    fn bit(class: SceneClass) -> u16 {
        1 << (class as u8)
    }

    pub fn shows(self, class: SceneClass) -> bool {
        self.0 & Layers::bit(class) != 0
    }

    pub fn set(&mut self, class: SceneClass, shown: bool) {
        self.0 = if shown { self.0 | Layers::bit(class) } else { self.0 & !Layers::bit(class) };
    }
}

/// How carefully.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Care {
    /// While hands move: fewer samples, hard shadows, open sky.
    Draft,
    /// As the dataset.
    Full,
}

/// What to draw.
pub fn demand(
    view: &DrawnView,
    objects: &[PlacedObject],
    kind: Kind,
    camera: Camera,
    layers: Layers,
    care: Care,
) -> ViewDemand {
    let (sun, quality, own) = find(view, kind);
    let mut picture = own.unwrap_or_else(|| made(view, objects, kind));
    picture.pass = PICTURE.to_owned();
    let seen = |flags: &[bool]| -> Arc<[bool]> {
        flags.iter().zip(objects).map(|(&flag, object)| flag && layers.shows(object.class)).collect()
    };
    picture.selection.objects = seen(&picture.selection.objects);
    picture.marked = picture.marked.as_ref().map(|marked| seen(marked));
    let label = |pass: &str, output: Output| OutputDemand {
        pass: pass.to_owned(),
        output,
        selection: picture.selection.clone(),
        marked: None,
        look: Look::none(),
    };
    let mut outputs = match care {
        Care::Full => vec![label(INSTANCES, Output::Instance), label(DISTANCES, Output::Depth)],
        Care::Draft => {
            picture.look = cheap(&picture.look);
            Vec::new()
        }
    };
    let sun = (picture.output == Output::Color).then(|| sun.unwrap_or(NOON));
    outputs.insert(0, picture);
    let quality = if care == Care::Draft { rough(quality) } else { quality };
    ViewDemand { name: view.name.clone(), camera, sun, quality, outputs }
}

/// The recipe's own image of this kind with the light and quality of its acquisition.
fn find(view: &DrawnView, kind: Kind) -> (Option<Sun>, Quality, Option<OutputDemand>) {
    let fits = |output: &OutputDemand| match kind {
        Kind::Before => output.output == Output::Color && output.selection.state == State::Before,
        Kind::After => output.output == Output::Color && output.selection.state == State::After,
        Kind::Mask => output.output == Output::Mask,
    };
    for demand in &view.demands {
        if let Some(output) = demand.outputs.iter().find(|output| fits(output)) {
            return (demand.sun, demand.quality, Some(output.clone()));
        }
    }
    let lit = view.demands.iter().find(|demand| demand.sun.is_some()).unwrap_or(&view.demands[0]);
    (lit.sun, lit.quality, None)
}

/// For recipes without an image of this kind: everything that is there in the state, in the light of another image.
fn made(view: &DrawnView, objects: &[PlacedObject], kind: Kind) -> OutputDemand {
    let lit = view.demands.iter().flat_map(|demand| &demand.outputs).find(|output| output.output == Output::Color);
    let there = |object: &PlacedObject| match (object.presence, kind) {
        (Presence::Both, _) | (_, Kind::Mask) => true,
        (Presence::BeforeOnly, _) => kind == Kind::Before,
        (Presence::AfterOnly, _) => kind == Kind::After,
    };
    let state = kind.state();
    let look = match lit {
        Some(output) => output.look.clone(),
        None => Look::plain(Shadows::Hard, Ambient::Constant([0.3, 0.3, 0.3])),
    };
    let marked = |object: &PlacedObject| object.change > 0 && object.level > 0;
    OutputDemand {
        pass: PICTURE.to_owned(),
        output: if kind == Kind::Mask { Output::Mask } else { Output::Color },
        selection: Selection { state, objects: objects.iter().map(there).collect() },
        marked: (kind == Kind::Mask).then(|| objects.iter().map(marked).collect()),
        look: if kind == Kind::Mask { Look::none() } else { look },
    }
}

/// For recipes that light nothing.
const NOON: Sun = Sun { direction: DVec3::new(0.4, 0.8, 0.447_213_595_499_958), disc_deg: 0.0, irradiance: [0.8; 3] };

fn cheap(look: &Look) -> Look {
    let shadows = if look.shadows == Shadows::Off { Shadows::Off } else { Shadows::Hard };
    let ambient = match look.ambient {
        Ambient::Sky { zenith, ground, .. } => Ambient::Sky { zenith, ground, occluded: false },
        other => other,
    };
    Look { shadows, ambient, ..look.clone() }
}

fn rough(quality: Quality) -> Quality {
    Quality {
        supersample: 1,
        shadow_map: quality.shadow_map.min(1024),
        shadow_samples: 1,
        sky_samples: quality.sky_samples.min(4),
        field_map: quality.field_map.min(256),
    }
}

#[cfg(test)]
mod tests;
