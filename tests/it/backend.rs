//! Both renderers behind one command, and what happens where there is no adapter.

use image::{GrayImage, RgbImage};
use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};

const RECIPE: &str = r#"
version 1
scene town {
  seed      11
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:building.cga"    for building
  rules "mansard:street.cga"      for highway
}
change burnt { of building  share 50%  rules "mansard:damage.cga" }
camera top  { size 64 x 64  gsd 1.5m  fov 20deg }
sun     { elevation 40deg  azimuth 140deg }
effects { shadows soft  ambient sky }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show only burnt with burnt as mask }
dataset d   { views 1 * top  layout plain }
"#;

/// Vulkan's loader finds no driver then.
const NO_DRIVER: &[(&str, &str)] = &[("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];

fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(20);
    shop.write("r.render", RECIPE);
    shop
}

fn manifest(shop: &Workshop, folder: &str) -> Value {
    let bytes = std::fs::read(shop.path(&format!("{folder}/manifest.json"))).expect("written");
    serde_json::from_slice(&bytes).expect("JSON")
}

/// The image that the manifest's only view has under a name.
fn image(shop: &Workshop, folder: &str, name: &str) -> image::DynamicImage {
    let manifest = manifest(shop, folder);
    let path = manifest["views"][0]["images"][name]["path"].as_str().expect("the view has the image").to_owned();
    image::open(shop.path(&format!("{folder}/{path}"))).expect("an image")
}

#[test]
fn without_an_adapter_the_reference_draws_and_says_so() {
    let shop = shop();
    let run = shop.run_with(&["render", "r.render", "-o", "out"], NO_DRIVER).expect(0);
    run.says(&[
        "warning: no Vulkan, Metal or DirectX 12 adapter was found",
        "mesa-vulkan-drivers",
        "The reference renderer draws instead, slowly, with 8 samples per pixel",
        "wrote 3 images of 1 views",
    ]);
    let manifest = manifest(&shop, "out");
    assert_eq!(manifest["renderer"], serde_json::json!({ "backend": "reference", "samples_per_pixel": 8 }));
    let errors = manifest["views"][0]["standard_errors"].as_object().expect("colour images have errors");
    assert_eq!(errors.keys().collect::<Vec<_>>(), ["after", "before"]);
    assert!(errors.values().all(|e| e.as_f64().is_some_and(|e| e > 0.0 && e < 0.05)), "{errors:?}");
    let colors: std::collections::BTreeSet<[u8; 3]> =
        image(&shop, "out", "before").to_rgb8().pixels().map(|p| p.0).collect();
    assert!(colors.len() > 100, "{} colours", colors.len());

    // Who asks for the GPU's renderer gets it or nothing.
    shop.run_with(&["render", "r.render", "-o", "gpu", "--backend", "wgpu"], NO_DRIVER).expect(2).says(&["no Vulkan"]);
    assert!(shop.list("gpu").iter().all(|f| !f.ends_with(".png")));
}

#[test]
fn both_backends_draw_the_same_images() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    shop.run(&["render", "r.render", "-o", "gpu", "--quiet"]).expect(0);
    shop.run(&["render", "r.render", "-o", "rays", "--quiet", "--backend", "reference", "--samples", "30"]).expect(0);
    assert_eq!(manifest(&shop, "rays")["renderer"]["samples_per_pixel"], 36);
    assert!(manifest(&shop, "gpu")["views"][0].get("standard_errors").is_none());
    let masks: [GrayImage; 2] = ["gpu", "rays"].map(|folder| image(&shop, folder, "mask").to_luma8());
    let other = masks[0].pixels().zip(masks[1].pixels()).filter(|(a, b)| a != b).count();
    assert!(other <= 4, "{other} pixels of the mask differ");
    for name in ["before", "after"] {
        let [gpu, rays]: [RgbImage; 2] = ["gpu", "rays"].map(|folder| image(&shop, folder, name).to_rgb8());
        let off: f64 = gpu.iter().zip(rays.iter()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        let mean = off / gpu.len() as f64;
        assert!(mean < 4.0, "{name}: {mean} of 255 apart");
    }
}

#[test]
fn threads_change_no_byte_of_the_reference() {
    let shop = shop();
    for (folder, jobs) in [("a", "1"), ("b", "3")] {
        let args = ["render", "r.render", "-o", folder, "--backend", "reference", "--samples", "2", "--jobs", jobs];
        shop.run(&args).expect(0);
    }
    let (a, b) = (shop.list("a"), shop.list("b"));
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(&b) {
        let read = |f: &String| std::fs::read(shop.path(f)).expect("written");
        assert!(read(a) == read(b), "{a} and {b} differ");
    }
}
