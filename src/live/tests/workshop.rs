//! A folder with a town, a recipe and rules. In: texts. Out: sessions on it, and everything that a build tells.

use std::path::PathBuf;

use crate::live::{Overrides, Session, Update};
use crate::pipeline::{BuiltScene, Checks, PipelineError, RecipeOptions, Silent, build_scene, load_recipe};
use crate::scene::export::to_glb;
use crate::source::SourceMap;

pub const RECIPE: &str = r#"version 1
scene town {
  seed      3
  map       "town.osm"
  elevation "town.tif"
  rules "house.cga" for building[house | detached | residential | garage] { storey = 2.8m }
  rules "block.cga" for building
  rules "street.cga" for highway
  missing building[building:levels != *] { height = normal(6m, 1m) }
}
change burnt { of building[house | detached | residential]  share 40%  rules "ruin.cga" }
camera top { size 64 x 64  gsd 4m  fov 30deg }
sun     { elevation 50deg  azimuth 160deg }
effects { shadows hard  ambient constant(40%) }
quality { preset draft }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show all with burnt mark burnt as mask }
dataset d { views 1 * top }
"#;

pub const HOUSE: &str = r##"import lib : "lib.cga"
@Range(min=1, max=30)
attr height = 6
@Range(min=2, max=6)
attr storey = 3
attr garden = 0
wall = case height > 6 : "#ddccbb" else : "#bbccdd"
twice(x) = 2 * x
@StartRule
Lot --> extrude(height) Mass
Mass --> report("height", height) comp(f){ side : Facade | top : Roof }
Facade --> color(wall) split(y){ ~storey : Floor }*
Floor --> 60% : split(x){ ~twice(1.5) : Window }* else : Plain
Window --> color(0.2, 0.3, 0.5)
Plain --> color(wall)
Roof --> roofHip(30) lib.Tiles
"##;

pub const LIB: &str = r##"attr tile = 0.4
const dark = "#553322"
Tiles --> color(dark) Tile.
"##;

pub const BLOCK: &str = "attr height = 9\n@StartRule\nLot --> extrude(height) comp(f){ side : Side | top : Flat }\n\
    Side --> color(0.6, 0.6, 0.6)\nFlat --> color(0.3, 0.3, 0.3)\n";
pub const STREET: &str = "@StartRule\nLot --> color(0.2, 0.2, 0.2)\n";
pub const RUIN: &str = "attr left = 1\n@StartRule\nLot --> [ color(0.1, 0.1, 0.1) Ash. ] extrude(left) Stump\nStump --> color(0.2, 0.1, 0.1)\n";

/// A folder that is removed at the end of the test.
pub struct Workshop {
    folder: tempfile::TempDir,
}

impl Workshop {
    pub fn new() -> Workshop {
        let shop = Workshop { folder: tempfile::tempdir().expect("a temporary folder can be made") };
        crate::town::write_town(3, 24, shop.folder.path(), "town", &|_| {}).expect("the folder is writable");
        let files = [
            ("town.render", RECIPE),
            ("house.cga", HOUSE),
            ("lib.cga", LIB),
            ("block.cga", BLOCK),
            ("street.cga", STREET),
            ("ruin.cga", RUIN),
        ];
        files.iter().for_each(|(name, text)| shop.write(name, text));
        shop
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.path(name), text).expect("the folder is writable");
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).expect("it was written")
    }

    /// Replaces a piece of text that must be there.
    #[track_caller]
    pub fn edit(&self, name: &str, from: &str, to: &str) {
        let text = self.read(name);
        assert!(text.contains(from), "`{from}` is not in {name}");
        self.write(name, &text.replacen(from, to, 1));
    }

    pub fn session(&self) -> Session {
        Session::open(&self.path("town.render"), RecipeOptions::default())
    }

    /// What a cold build of the files as they are tells; the messages of its mistakes if there are any.
    pub fn cold(&self) -> Result<Told, Vec<String>> {
        let mut sources = SourceMap::default();
        let recipe = load_recipe(&self.path("town.render"), &RecipeOptions::default(), &mut sources);
        let built = recipe.and_then(|recipe| Ok((build_scene(&recipe, 0, Checks::Off, &Silent)?, recipe)));
        let (built, recipe) = built.map_err(|error| match error {
            PipelineError::Diagnostics(list) => list.iter().map(|d| d.message.clone()).collect(),
            other => vec![other.to_string()],
        })?;
        let found: Vec<String> = built.diagnostics.iter().map(|d| format!("{d:?}")).collect();
        if built.diagnostics.has_errors() {
            return Err(built.diagnostics.iter().map(|d| d.message.clone()).collect());
        }
        Ok(Told::new(&built, recipe.attribution(), found))
    }
}

/// Everything that a build tells, comparable.
#[derive(Clone, Debug, PartialEq)]
pub struct Told {
    pub record: String,
    pub reports: String,
    pub prints: Vec<String>,
    pub diagnostics: Vec<String>,
    pub files: String,
    pub glb: Vec<u8>,
}

impl Told {
    fn new(built: &BuiltScene, attribution: &str, diagnostics: Vec<String>) -> Told {
        Told {
            record: serde_json::to_string(&built.record).expect("plain values serialise"),
            reports: format!("{:?}", built.reports.features),
            prints: built.prints.clone(),
            diagnostics,
            files: format!("{:?}", built.files),
            glb: to_glb(&built.scene, attribution).expect("a built scene can be exported"),
        }
    }

    /// Of what a session shows.
    pub fn of(session: &Session) -> Told {
        let built = session.built().expect("something is shown");
        let found = built.diagnostics.iter().map(|d| format!("{d:?}")).collect();
        Told::new(built, session.recipe().expect("something is shown").attribution(), found)
    }
}

/// An update without overrides.
pub fn updated(session: &mut Session) -> Update {
    session.update(&Overrides::default())
}
