//! From a recipe to a dataset, end to end, on a small fictional town.

use std::path::Path;

use image::{GrayImage, RgbImage};

use crate::workshop::{Workshop, has_adapter};

const SIZE: u32 = 160;

const RECIPE: &str = r#"
version 1
scene town {
  seed      11
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:residential.cga" for building[house | detached | residential | yes | garage]
  rules "mansard:building.cga"    for building
  rules "mansard:street.cga"      for highway
  rules "mansard:landcover.cga"   for landuse, natural, leisure, water
}
change burnt { of building  share 50%  rules "mansard:damage.cga" }
camera top  { size 160 x 160  gsd 1.5m  fov 20deg }
camera tilt : top { off_nadir uniform(5deg, 10deg)  azimuth uniform(0deg, 360deg) }
sun     { elevation 40deg  azimuth 140deg }
effects { shadows soft  ambient sky }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show only burnt with burnt as mask }
pass ids    { show all with burnt as instance }
dataset d   { views 1 * top, 1 * tilt  layout levir }
"#;

fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(60);
    shop.write("r.render", RECIPE);
    shop
}

fn rgb(path: &Path) -> RgbImage {
    image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8()
}

fn gray(path: &Path) -> GrayImage {
    image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_luma8()
}

#[test]
fn a_recipe_becomes_a_dataset() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    shop.run(&["render", "r.render", "-o", "out", "--quiet"]).expect(0);
    let files = shop.list("out");
    let images: Vec<&String> = files.iter().filter(|f| f.ends_with(".png")).collect();
    assert_eq!(images.len(), 6, "{files:?}");
    for role in ["A", "B", "label"] {
        assert_eq!(images.iter().filter(|f| f.starts_with(&format!("out/train/{role}/"))).count(), 2, "{files:?}");
    }
    for file in ["out/manifest.json", "out/scene.glb"] {
        assert!(files.iter().any(|f| f == file), "{file} is missing from {files:?}");
    }
    assert!(files.iter().all(|f| !f.contains(".mansard-")), "temporary files stayed: {files:?}");

    let manifest = std::fs::read_to_string(shop.path("out/manifest.json")).expect("written");
    let manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
    let change = &manifest["scenes"][0]["changes"][0];
    let (changed, candidates) = (change["changed"].as_array().expect("a list").len(), change["candidates"].as_u64());
    assert_eq!(candidates, Some(60));
    assert_eq!(changed, 30, "half of the buildings");
    assert!(manifest["attribution"].as_str().expect("text").contains("OpenStreetMap"));
    assert_eq!(manifest["views"].as_array().expect("a list").len(), 2);

    for name in images.iter().filter(|f| f.contains("/label/")).map(|f| f.rsplit('/').next().expect("a name")) {
        let (a, b) = (rgb(&shop.path(&format!("out/train/A/{name}"))), rgb(&shop.path(&format!("out/train/B/{name}"))));
        let mask = gray(&shop.path(&format!("out/train/label/{name}")));
        assert_eq!(mask.dimensions(), (SIZE, SIZE));
        assert!(mask.pixels().all(|p| p.0[0] == 0 || p.0[0] == 255), "{name}: a mask is 0 or 255");
        let marked = mask.pixels().filter(|p| p.0[0] == 255).count();
        assert!(marked > 200, "{name}: {marked} pixels are marked");
        // Nearly every marked pixel shows a change.
        let differs = |x, y| a.get_pixel(x, y) != b.get_pixel(x, y);
        let seen = mask.enumerate_pixels().filter(|(x, y, p)| p.0[0] == 255 && differs(*x, *y)).count();
        assert!(seen as f64 > 0.98 * marked as f64, "{name}: {seen} of {marked} marked pixels differ");
    }
}

#[test]
fn two_runs_give_the_same_bytes_for_any_number_of_threads() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    shop.run(&["render", "r.render", "-o", "a", "--quiet", "--jobs", "1"]).expect(0);
    shop.run(&["render", "r.render", "-o", "b", "--quiet", "--jobs", "3"]).expect(0);
    let (a, b) = (shop.list("a"), shop.list("b"));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        let read = |f: &String| std::fs::read(shop.path(f)).expect("written");
        assert_eq!(read(a), read(b), "{a} and {b} differ");
    }
}

/// The same map as another mapper might have drawn it: ways in another order, rings of buildings begun elsewhere, every
/// other one the other way round.
fn redrawn(osm: &str) -> String {
    let (head, rest) = osm.split_once(" <way ").expect("the town has ways");
    let (ways, relations) = match rest.find(" <relation ") {
        Some(at) => rest.split_at(at),
        None => rest.split_at(rest.find("</osm>").expect("an end")),
    };
    let mut out = head.to_owned();
    for (number, way) in ways.split(" <way ").collect::<Vec<_>>().into_iter().enumerate().rev() {
        let (nodes, other): (Vec<&str>, Vec<&str>) = way.lines().partition(|line| line.contains("<nd "));
        let mut nodes = nodes;
        if way.contains("k=\"building\"") && nodes.first() == nodes.last() {
            nodes.pop();
            let start = number % nodes.len();
            nodes.rotate_left(start);
            if number % 2 == 0 {
                nodes.reverse();
            }
            nodes.push(nodes[0]);
        }
        let (first, tags) = other.split_first().expect("a way has an id");
        let lines: Vec<&str> = [*first].into_iter().chain(nodes).chain(tags.iter().copied()).collect();
        out += &format!(" <way {}\n", lines.join("\n"));
    }
    out + relations
}

#[test]
fn who_drew_the_map_and_in_which_order_changes_nothing() {
    let shop = shop();
    shop.run(&["build", "r.render", "-o", "a.glb", "--quiet"]).expect(0);
    let osm = std::fs::read_to_string(shop.path("town.osm")).expect("written");
    let other = redrawn(&osm);
    assert_ne!(osm, other);
    assert_eq!(osm.len(), other.len());
    shop.write("town.osm", other);
    shop.run(&["build", "r.render", "-o", "b.glb", "--quiet"]).expect(0);
    let read = |name: &str| std::fs::read(shop.path(name)).expect("written");
    assert!(read("a.glb") == read("b.glb"), "the meshes differ");
}

#[test]
fn unchanged_places_are_the_same_before_and_after() {
    if !has_adapter() {
        return;
    }
    let shop = Workshop::new();
    shop.town(60);
    shop.write("r.render", RECIPE.replace("shadows soft", "shadows off"));
    shop.run(&["render", "r.render", "-o", "out", "--quiet"]).expect(0);
    let name = "town_top_1.png";
    let (a, b) = (rgb(&shop.path(&format!("out/train/A/{name}"))), rgb(&shop.path(&format!("out/train/B/{name}"))));
    let mask = gray(&shop.path(&format!("out/train/label/{name}")));
    // Without shadows a change reaches no further than the building leaned: a few pixels around the mask.
    let near = |x: u32, y: u32| {
        let around = |v: u32| v.saturating_sub(6)..(v + 7).min(SIZE);
        around(y).any(|j| around(x).any(|i| mask.get_pixel(i, j).0[0] == 255))
    };
    for (x, y, pixel) in a.enumerate_pixels() {
        assert!(pixel == b.get_pixel(x, y) || near(x, y), "({x}, {y}) changed far from every changed building");
    }
}

#[test]
fn the_scene_is_valid_gltf_with_map_ids() {
    let shop = shop();
    shop.run(&["build", "r.render", "-o", "scene.glb", "--quiet"]).expect(0);
    let (document, buffers, images) = gltf::import(shop.path("scene.glb")).expect("someone else's parser reads it");
    assert_eq!(document.scenes().count(), 2);
    assert!(!buffers.is_empty() && !images.is_empty());
    let count = |name: &str| {
        let scene = document.scenes().find(|s| s.name() == Some(name)).expect("the scene is there");
        let extras = |n: &gltf::Node| n.extras().as_ref().map(|e| e.get().to_owned()).unwrap_or_default();
        scene.nodes().filter(|n| extras(n).contains("\"class\":\"building\"")).count()
    };
    assert_eq!((count("before"), count("after")), (60, 60));
    for node in document.nodes() {
        let mesh = node.mesh().expect("every node has a mesh");
        for primitive in mesh.primitives() {
            let reader = primitive.reader(|b| Some(&buffers[b.index()]));
            for normal in reader.read_normals().expect("normals") {
                let length: f32 = normal.iter().map(|c| c * c).sum();
                assert!((length - 1.0).abs() < 1e-3, "normal {normal:?}");
            }
            let vertices = reader.read_positions().expect("positions").len() as u32;
            assert!(reader.read_indices().expect("indices").into_u32().all(|i| i < vertices));
        }
    }
}

#[test]
fn a_mask_alone_needs_no_light() {
    let shop = shop();
    let all = shop.run(&["plan", "r.render", "--quiet"]).expect(0).stdout;
    assert!(all.contains("shadow_map") && all.contains("shade"), "{all}");
    let lines: Vec<&str> = RECIPE.lines().filter(|l| !l.starts_with("pass ") || l.starts_with("pass mask")).collect();
    shop.write("m.render", lines.join("\n").replace("layout levir", "layout plain"));
    let run = shop.run(&["plan", "m.render", "--quiet", "--format", "json"]).expect(0);
    let plan: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let text = plan.to_string();
    let passes = plan["datasets"][0]["plan"]["views"][0]["passes"].to_string();
    assert!(text.contains("ids"), "{text}");
    assert!(!passes.contains("shadow") && !passes.contains("shade") && !passes.contains("resolve"), "{passes}");
}
