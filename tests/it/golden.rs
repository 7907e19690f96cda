//! One small picture of the whole pipeline, held against drift. In: a town of 60 buildings. Out: images that must equal
//! those in `tests/golden/` within stated bounds; `MANSARD_BLESS=1` writes them anew.

use std::path::{Path, PathBuf};

use image::RgbImage;

use crate::workshop::{Workshop, has_adapter};

const RECIPE: &str = r#"
version 1
scene town {
  seed      5
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:industrial.cga"  for building[industrial | warehouse]
  rules "mansard:residential.cga" for building
  rules "mansard:street.cga"      for highway
  rules "mansard:landcover.cga"   for landuse, natural, leisure, water
}
change burnt { of building  share 40%  rules "mansard:damage.cga" }
camera low  { size 96 x 96  gsd 1.2m  fov 30deg  off_nadir 15deg  azimuth 200deg }
sun     { elevation 35deg  azimuth 230deg }
effects { shadows soft  ambient sky }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show all with burnt mark burnt as mask }
dataset d   { views 1 * low  layout plain }
"#;

/// Mean difference per channel that a picture may have, of 255: adapters differ in the last bits.
const MEAN: f64 = 0.5;
/// Share of mask pixels that may differ: edges that run through pixel centres.
const EDGES: f64 = 0.002;

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(name)
}

fn read(path: &Path) -> RgbImage {
    image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8()
}

#[test]
fn the_town_looks_as_it_did() {
    if !has_adapter() {
        return;
    }
    let shop = Workshop::new();
    shop.town(60);
    shop.write("r.render", RECIPE);
    shop.run(&["render", "r.render", "-o", "out", "--quiet"]).expect(0);
    for name in ["before.png", "after.png", "mask.png"] {
        let made = shop.path(&format!("out/town_low_1/{name}"));
        if std::env::var_os("MANSARD_BLESS").is_some() {
            std::fs::copy(&made, golden(name)).expect("tests/golden is writable");
        }
        let (made, wanted) = (read(&made), read(&golden(name)));
        assert_eq!(made.dimensions(), wanted.dimensions(), "{name}");
        let differences: Vec<u8> = made.as_raw().iter().zip(wanted.as_raw()).map(|(a, b)| a.abs_diff(*b)).collect();
        if name == "mask.png" {
            let share = differences.iter().filter(|d| **d > 0).count() as f64 / differences.len() as f64;
            assert!(share <= EDGES, "{name}: {:.2} % of the pixels differ", share * 100.0);
        } else {
            let mean = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / differences.len() as f64;
            assert!(mean <= MEAN, "{name}: differs by {mean:.3} on average");
        }
    }
}
