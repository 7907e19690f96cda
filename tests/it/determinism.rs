//! The stage case `determinism`: one, two and eight threads, three runs each, the same bytes.

use crate::workshop::{Workshop, has_adapter};

const RECIPE: &str = r#"
version 1
scene town {
  seed      5
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:residential.cga" for building[house | detached | residential | yes | garage]
  rules "mansard:building.cga"    for building
  rules "mansard:street.cga"      for highway
  rules "mansard:landcover.cga"   for landuse, natural, leisure, water
}
change burnt { of building  share 50%  rules "mansard:damage.cga" }
camera top { size 96 x 96  gsd 2m  fov 20deg }
sun        { elevation 40deg  azimuth 140deg }
effects    { shadows hard  ambient sky }
pass after { show all with burnt }
pass mask  { show all with burnt mark burnt as mask }
pass ids   { show all with burnt as instance }
dataset d  { views 1 * top }
"#;

#[test]
fn determinism() {
    if !has_adapter() {
        return;
    }
    let shop = Workshop::new();
    shop.town(40);
    shop.write("r.render", RECIPE);
    let mut first: Option<Vec<Vec<u8>>> = None;
    for (threads, run) in [1, 2, 8].into_iter().flat_map(|threads| (0..3).map(move |run| (threads, run))) {
        let folder = format!("{threads}_{run}");
        shop.run(&["render", "r.render", "-o", &folder, "--quiet", "--jobs", &threads.to_string()]).expect(0);
        let read = |name: &String| std::fs::read(shop.path(name)).expect("written");
        let files: Vec<Vec<u8>> = shop.list(&folder).iter().map(read).collect();
        assert!(files.len() >= 5, "{:?}", shop.list(&folder));
        match &first {
            Some(first) => assert!(*first == files, "{threads} threads, run {run}: other bytes"),
            None => first = Some(files),
        }
    }
}
