//! `mansard verify` as a user sees it. In: datasets, as they were made and with one thing done to them. Out: that thing
//! told, and the exit code.

use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};

const RECIPE: &str = r#"
version 1
input map : file = "town.osm"
scene town {
  seed      11
  map       $map
  elevation "town.tif"
  rules "rules/house.cga" for building
  rules "mansard:street.cga" for highway
}
change burnt { of building  share 50%  effect demolished }
camera top  { size 64 x 64  gsd 1.5m  fov 20deg  off_nadir uniform(0deg, 10deg) }
sun     { elevation 40deg  azimuth 140deg }
effects { shadows hard  ambient sky }
quality { preset draft }
pass before { show all }
pass mask   { show only burnt with burnt as mask }
pass labels { show all as class, instance }
dataset d   { views 2 * top  layout plain }
"#;

const RULES: &str = "@StartRule\nLot --> extrude(6) color(\"#c0a080\") report(\"houses\", 1)\n";

/// A project with a dataset in `project/out`, made by the reference renderer so that no adapter is needed.
fn shop() -> Workshop {
    let shop = bare_shop();
    let args =
        ["render", "project/r.render", "-o", "project/out", "--quiet", "--backend", "reference", "--samples", "2"];
    shop.run(&args).expect(0);
    shop
}

fn bare_shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(12);
    for name in ["town.osm", "town.tif"] {
        let place = shop.write(&format!("project/{name}"), "");
        std::fs::rename(shop.path(name), place).expect("the town is there");
    }
    shop.write("project/r.render", RECIPE);
    shop.write("project/rules/house.cga", RULES);
    shop
}

/// Vulkan's loader finds no driver then.
const NO_DRIVER: &[(&str, &str)] = &[("VK_DRIVER_FILES", "/nonexistent"), ("VK_ICD_FILENAMES", "/nonexistent")];

/// Files that are not the same, with what became of them.
fn wrong(shop: &Workshop, args: &[&str], code: i32) -> Vec<(String, String)> {
    let run = shop.run_with(&[&["verify"], args, &["--quiet", "--format", "json"]].concat(), NO_DRIVER).expect(code);
    let found: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(found["verified"], code == 0);
    let files = found["datasets"][0]["files"].as_array().expect("a list").clone();
    let text = |value: &Value| value.as_str().expect("text").to_owned();
    files.iter().filter(|f| f["fate"] != "same").map(|f| (text(&f["path"]), text(&f["fate"]))).collect()
}

#[test]
fn a_dataset_is_what_its_recipe_makes() {
    let shop = shop();
    let run = shop.run_with(&["verify", "project/out", "--quiet"], NO_DRIVER).expect(0);
    let hashes = regex::Regex::new("[0-9a-f]{16}").expect("it is well formed");
    insta::assert_snapshot!(hashes.replace_all(&run.stdout, "[sha256]"));
}

#[test]
fn one_byte_and_exactly_that_file() {
    let shop = shop();
    let path = "town_top_1/mask.png";
    let mut bytes = std::fs::read(shop.path(&format!("project/out/{path}"))).expect("written");
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    shop.write(&format!("project/out/{path}"), bytes);
    assert_eq!(wrong(&shop, &["project/out"], 1), [(path.to_owned(), "altered".to_owned())]);
    let run = shop.run_with(&["verify", "project/out", "--quiet"], NO_DRIVER).expect(1);
    assert!(run.stdout.contains("made again it is as the manifest says"), "{}", run.stdout);
    assert!(run.stdout.ends_with("not verified\n"), "{}", run.stdout);
    // Without drawing it is seen too.
    assert!(wrong(&shop, &["project/out", "--no-images"], 1).contains(&(path.to_owned(), "altered".to_owned())));
}

#[test]
fn files_that_came_and_went() {
    let shop = shop();
    std::fs::remove_file(shop.path("project/out/scene.glb")).expect("it is there");
    shop.write("project/out/town_top_1/stray.png", "x");
    shop.write("project/out/.directory", "x");
    let expected = [("scene.glb", "missing"), ("town_top_1/stray.png", "extra")];
    assert_eq!(wrong(&shop, &["project/out"], 1), expected.map(|(path, fate)| (path.to_owned(), fate.to_owned())));
}

#[test]
fn a_manifest_that_says_otherwise() {
    let shop = shop();
    let path = shop.path("project/out/manifest.json");
    let text = std::fs::read_to_string(&path).expect("written");
    let mut manifest: Value = serde_json::from_str(&text).expect("JSON");
    manifest["views"][1]["draws"]["camera.off_nadir"] = 80.into();
    std::fs::write(&path, manifest.to_string()).expect("writable");
    let run = shop.run_with(&["verify", "project/out", "--quiet"], NO_DRIVER).expect(1);
    assert!(run.stdout.contains("views[1].draws.camera.off_nadir  80, made again"), "{}", run.stdout);
    // A manifest cannot have files outside its folder looked at.
    manifest["files"][0]["path"] = "../../secret".into();
    std::fs::write(&path, manifest.to_string()).expect("writable");
    shop.run(&["verify", "project/out"]).expect(2).says(&["`../../secret` leads out of its folder"]);
}

#[test]
fn inputs_are_found_by_content_or_refused() {
    let shop = shop();
    let manifest = std::fs::read(shop.path("project/out/manifest.json")).expect("written");
    let manifest: Value = serde_json::from_slice(&manifest).expect("JSON");
    let inputs = manifest["inputs"].as_array().expect("a list");
    let hash = |name: &str| {
        let input = inputs.iter().find(|input| input["name"] == name).expect(name);
        input["sha256"].as_str().expect("text").to_owned()
    };

    // Renamed, and the rules in another folder.
    let rename = |from: &str, to: &str| {
        let to = shop.write(to, "");
        std::fs::rename(shop.path(from), to).expect("it is there");
    };
    rename("project/town.osm", "project/old/map-2026.osm");
    rename("project/rules/house.cga", "elsewhere/house.cga");
    let run = shop.run_with(&["verify", "project/out", "--quiet"], NO_DRIVER).expect(0);
    assert!(run.stdout.contains("= map town.osm: ") && run.stdout.contains("map-2026.osm"), "{}", run.stdout);
    assert!(run.stdout.contains("= rules house.cga: "), "{}", run.stdout);

    // Another content: both hashes are told, of every input at once.
    let osm = std::fs::read_to_string(shop.path("project/old/map-2026.osm")).expect("it is there");
    shop.write("project/old/map-2026.osm", "");
    shop.write("project/town.osm", osm + "\n");
    std::fs::remove_file(shop.path("elsewhere/house.cga")).expect("it is there");
    let run = shop.run_with(&["verify", "project/out", "--quiet"], NO_DRIVER).expect(2);
    let found = mansard::pipeline::file_sha256(&shop.path("project/town.osm")).expect("it can be read").1;
    run.says(&[
        &format!("map town.osm: another content: the dataset was made of sha256 {}", hash("town.osm")),
        &format!("has {found}"),
        &format!("rules house.cga: not found, {} bytes with sha256 {}", RULES.len(), hash("house.cga")),
    ]);
}

#[test]
fn a_changed_recipe_is_refused_and_another_place_is_told() {
    let shop = shop();
    std::fs::create_dir(shop.path("away")).expect("the folder is writable");
    std::fs::rename(shop.path("project/out"), shop.path("away/out")).expect("it is there");
    std::fs::rename(shop.path("project"), shop.path("away/moved")).expect("it is there");
    shop.run_with(&["verify", "away/out", "--quiet", "--recipe", "away/moved/r.render"], NO_DRIVER).expect(0);
    shop.run_with(&["verify", "away/out", "--quiet", "--inputs", "away/moved"], NO_DRIVER).expect(0);
    shop.write("away/moved/r.render", RECIPE.replace("seed      11", "seed 12"));
    let args = ["verify", "away/out", "--quiet", "--recipe", "away/moved/r.render"];
    shop.run_with(&args, NO_DRIVER).expect(2).says(&["recipe r.render: another content"]);
    shop.run_with(&args[..3], NO_DRIVER).expect(2).says(&["recipe r.render: another content"]);
}

#[test]
fn arguments_of_the_command_line_are_given_again() {
    let shop = bare_shop();
    std::fs::rename(shop.path("project/town.osm"), shop.path("other.osm")).expect("it is there");
    let render = ["render", "project/r.render", "--set", "map=other.osm", "-o", "out", "--quiet"];
    shop.run(&[&render[..], &["--backend", "reference", "--samples", "2"]].concat()).expect(0);
    let manifest = std::fs::read_to_string(shop.path("out/manifest.json")).expect("written");
    let folder = shop.path("").canonicalize().expect("it is there");
    assert!(!manifest.contains(&folder.display().to_string()), "a manifest holds no absolute path");
    assert_eq!(wrong(&shop, &["out"], 0), []);
}

#[test]
fn the_adapter_draws_again_to_the_bit() {
    if !has_adapter() {
        return;
    }
    let shop = bare_shop();
    shop.run(&["render", "project/r.render", "-o", "out", "--quiet", "--views", "town_top_2"]).expect(0);
    shop.run(&["verify", "out", "--quiet"]).expect(0);
    // Where there is none, the images cannot be verified, and the rest can.
    let run = shop.run_with(&["verify", "out", "--quiet"], NO_DRIVER).expect(2);
    run.says(&["its images were drawn by", "`--no-images` verifies everything else"]);
    let run = shop.run_with(&["verify", "out", "--quiet", "--no-images"], NO_DRIVER).expect(0);
    assert!(run.stdout.ends_with("verified; images were not drawn again\n"), "{}", run.stdout);
    // Another adapter, and colours a little off: as the manifest of another machine would have it.
    let path = shop.path("out/manifest.json");
    let manifest = std::fs::read_to_string(&path).expect("written");
    let mut manifest: Value = serde_json::from_str(&manifest).expect("JSON");
    let name = manifest["views"][0]["images"]["before"]["path"].as_str().expect("text").to_owned();
    let mut image = image::open(shop.path(&format!("out/{name}"))).expect("a PNG").to_rgb8();
    image.pixels_mut().step_by(7).for_each(|pixel| pixel.0[1] = pixel.0[1].saturating_sub(1));
    image.save(shop.path(&format!("out/{name}"))).expect("writable");
    let hash = mansard::pipeline::file_sha256(&shop.path(&format!("out/{name}"))).expect("written").1;
    manifest["views"][0]["images"]["before"]["sha256"] = hash.into();
    let own = manifest["renderer"].clone();
    manifest["renderer"]["adapter"] = "another adapter".into();
    std::fs::write(&path, manifest.to_string()).expect("writable");
    let run = shop.run(&["verify", "out", "--quiet"]).expect(1);
    assert!(run.stdout.contains("different") && run.stdout.contains("by up to 1.0 of 255"), "{}", run.stdout);
    let run = shop.run(&["verify", "out", "--quiet", "--colours", "close"]).expect(0);
    assert!(run.stdout.ends_with("verified, colours the same within 1/255 on another adapter\n"), "{}", run.stdout);
    // On the same adapter there is no excuse.
    manifest["renderer"] = own;
    std::fs::write(&path, manifest.to_string()).expect("writable");
    shop.run(&["verify", "out", "--quiet", "--colours", "close"]).expect(1);
}
