//! Desk: everything that the window shows and that its user has chosen. In: actions of the panels, reports of the threads.
//! Out: what to draw and what to build. No egui here.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::drawer::{Drawn, Wish};
use super::shown::Shown;
use super::take::{Care, Kind, Layers};
use super::viewpoint::{Pixel, Viewpoint, ray};
use crate::interpreter::tree::Scalar;
use crate::live::{AttributeOverride, LotInfo, Overrides, Ray, SunAngles, Update};
use crate::plan::demand::State;

/// What the picture area shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Show {
    Before,
    #[default]
    After,
    Mask,
    /// Before on the left, after on the right.
    Split,
}

impl Show {
    pub const ALL: [Show; 4] = [Show::Before, Show::After, Show::Mask, Show::Split];

    pub fn name(self) -> &'static str {
        match self {
            Show::Before => "Before",
            Show::After => "After",
            Show::Mask => "Mask",
            Show::Split => "Split",
        }
    }

    pub fn kinds(self) -> Vec<Kind> {
        match self {
            Show::Before => vec![Kind::Before],
            Show::After => vec![Kind::After],
            Show::Mask => vec![Kind::Mask],
            Show::Split => vec![Kind::Before, Kind::After],
        }
    }
}

/// How an update ended, for the banner and the status line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// Nothing was built yet.
    Empty,
    /// What is shown is what the files say.
    Current,
    /// The last good scene, while the files hold mistakes.
    Stands,
}

/// A click that was answered, or waits for its answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Picked {
    pub instance: u32,
    pub state: State,
    /// In the picture, pixels, and the size of the picture.
    pub at: (u32, u32),
    pub size: (u32, u32),
    pub ray: Ray,
    pub lot: Option<LotInfo>,
}

/// See the top of the file.
pub struct Desk {
    pub name: String,
    pub shown: Option<Arc<Shown>>,
    /// Index into [`Shown::views`] and its name, which outlives edits.
    pub view: usize,
    pub view_name: String,
    pub viewpoint: Option<Viewpoint>,
    pub show: Show,
    /// Where a split changes over, share of the width.
    pub bar: f64,
    pub layers: Layers,
    pub overrides: Overrides,
    pub flying: bool,
    pub help: bool,
    pub picked: Option<Picked>,
    pub update: Option<Update>,
    pub building: bool,
    pub drawn: Option<Drawn>,
    /// Number of the newest wish.
    pub wished: u64,
    pub drawing_failed: Option<String>,
    /// The last thing worth a word, such as where a screenshot lies.
    pub note: Option<String>,
    /// Pixels of the picture area.
    pub area: (u32, u32),
}

impl Desk {
    pub fn new(name: String) -> Desk {
        Desk {
            name,
            shown: None,
            view: 0,
            view_name: String::new(),
            viewpoint: None,
            show: Show::default(),
            bar: 0.5,
            layers: Layers::default(),
            overrides: Overrides::default(),
            flying: false,
            help: false,
            picked: None,
            update: None,
            building: true,
            drawn: None,
            wished: 0,
            drawing_failed: None,
            note: None,
            area: (0, 0),
        }
    }

    pub fn standing(&self) -> Standing {
        match (&self.shown, &self.update) {
            (None, _) => Standing::Empty,
            (Some(_), Some(update)) if update.stands && !update.cancelled => Standing::Stands,
            _ => Standing::Current,
        }
    }

    /// Takes over another good scene: the camera stays where hands put it, and follows the recipe where they did not.
    pub fn take_over(&mut self, shown: Arc<Shown>) {
        self.view = shown.view(&self.view_name);
        let other_scene = self.shown.as_ref().is_some_and(|old| old.scenes[old.scene] != shown.scenes[shown.scene]);
        let follows = self.viewpoint.as_ref().is_none_or(|viewpoint| viewpoint.given().is_some());
        self.shown = Some(shown);
        if other_scene {
            self.picked = None;
        }
        if follows || other_scene {
            self.go_to(self.view);
        }
    }

    /// Stands where a view of the recipe does, in its light.
    pub fn go_to(&mut self, view: usize) {
        let Some(shown) = &self.shown else { return };
        self.view = view;
        self.view_name.clone_from(&shown.views[view].name);
        self.viewpoint = Some(Viewpoint::of(&shown.views[view].demands[0].camera, shown.summary.centre));
    }

    /// Steps back until all of the scene is seen.
    pub fn frame_scene(&mut self) {
        if let (Some(shown), Some(viewpoint)) = (&self.shown, &mut self.viewpoint) {
            *viewpoint = viewpoint.framing(shown.summary.bounds);
        }
    }

    /// What is to be drawn now; counts up.
    pub fn wish(&mut self, care: Care) -> Option<Wish> {
        let (shown, viewpoint) = (self.shown.clone()?, self.viewpoint?);
        let (width, height) = self.area;
        if width < 16 || height < 16 {
            return None;
        }
        // Drafts have half the pixels per side.
        let size = if care == Care::Draft { (width / 2, height / 2) } else { (width, height) };
        self.wished += 1;
        let (view, layers, kinds) = (self.view, self.layers, self.show.kinds());
        Some(Wish { shown, view, viewpoint, kinds, layers, care, size, number: self.wished })
    }

    /// Whether the picture is the newest wish, with full care.
    pub fn is_current(&self) -> bool {
        self.drawn.as_ref().is_some_and(|drawn| drawn.wish.number == self.wished && drawn.wish.care == Care::Full)
    }

    /// Elevation and azimuth of the sun in the present view, degrees.
    pub fn sun(&self) -> Option<SunAngles> {
        if let Some(sun) = self.overrides.sun {
            return Some(sun);
        }
        let view = self.shown.as_ref()?.views.get(self.view)?;
        let direction = view.demands.iter().find_map(|demand| demand.sun)?.direction;
        let elevation = libm::asin(direction.y.clamp(-1.0, 1.0)).to_degrees();
        let azimuth = libm::atan2(direction.x, -direction.z).to_degrees().rem_euclid(360.0);
        Some(SunAngles { elevation, azimuth })
    }

    /// A number that nobody chose: the next of a full-period generator (Knuth's MMIX), five digits of it.
    pub fn reroll(&mut self) {
        let Some(shown) = &self.shown else { return };
        let now = self.overrides.seed.unwrap_or(shown.seed);
        let next = now.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.overrides.seed = Some((next >> 33) % 100_000);
    }

    /// The value that the user gave an attribute.
    pub fn overridden(&self, file: &str, name: &str) -> Option<&Scalar> {
        let own = self.overrides.attributes.iter().find(|own| own.file == file && own.name == name);
        own.map(|own| &own.value)
    }

    /// Gives an attribute a value, or takes it back.
    pub fn set_attribute(&mut self, file: &str, name: &str, value: Option<Scalar>) {
        self.overrides.attributes.retain(|own| own.file != file || own.name != name);
        let (file, name) = (file.to_owned(), name.to_owned());
        let own = value.map(|value| AttributeOverride { file, name, value });
        self.overrides.attributes.extend(own);
    }

    /// What a click at a point of the picture means: an object with a ray, `None` in the sky.
    pub fn pick(&mut self, kind: Kind, at: Pixel) -> Option<(u32, State, Ray)> {
        let picture = self.drawn.as_ref()?.pictures.iter().find(|picture| picture.kind == kind)?;
        let instance = picture.instance(at)?;
        let (size, state) = (picture.size(), kind.state());
        if instance == 0 {
            self.picked = None;
            return None;
        }
        let (origin, direction) = ray(&picture.camera, at);
        let ray = Ray { origin, direction };
        self.picked = Some(Picked { instance, state, at: (at.x as u32, at.y as u32), size, ray, lot: None });
        Some((instance, state, ray))
    }
}

/// `NAME-0001.png` in a folder, the first number that is free.
pub fn free_name(folder: &Path, name: &str) -> PathBuf {
    let path = |number: u32| folder.join(format!("{name}-{number:04}.png"));
    (1..).map(path).find(|path| !path.exists()).expect("some number is free")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_replaces_the_one_before_and_can_be_taken_back() {
        let mut desk = Desk::new("town".to_owned());
        desk.set_attribute("a.cga", "height", Some(Scalar::Float(3.0)));
        desk.set_attribute("b.cga", "height", Some(Scalar::Float(9.0)));
        desk.set_attribute("a.cga", "height", Some(Scalar::Float(4.0)));
        assert_eq!(desk.overridden("a.cga", "height"), Some(&Scalar::Float(4.0)));
        assert_eq!(desk.overrides.attributes.len(), 2);
        desk.set_attribute("a.cga", "height", None);
        assert_eq!(desk.overridden("a.cga", "height"), None);
        assert_eq!(desk.overridden("b.cga", "height"), Some(&Scalar::Float(9.0)));
    }

    #[test]
    fn screenshots_do_not_overwrite() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let first = free_name(folder.path(), "town");
        assert_eq!(first, folder.path().join("town-0001.png"));
        std::fs::write(&first, "").expect("the folder is writable");
        assert_eq!(free_name(folder.path(), "town"), folder.path().join("town-0002.png"));
    }

    #[test]
    fn every_way_to_show_has_its_pictures() {
        let kinds: Vec<Vec<Kind>> = Show::ALL.iter().map(|show| show.kinds()).collect();
        assert_eq!(kinds, [vec![Kind::Before], vec![Kind::After], vec![Kind::Mask], vec![Kind::Before, Kind::After]]);
    }
}
