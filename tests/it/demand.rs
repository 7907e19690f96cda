//! Only what is asked for is made. In: recipes with more than they use. Out: the same bytes as without, and counters that
//! go down with the last user.

use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};

const SCENE: &str = r#"
version 1
scene town {
  seed      11
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:residential.cga" for building[house | detached | residential | yes | garage]
  rules "mansard:building.cga"    for building
  rules "mansard:street.cga"      for highway
}
change burnt { of building  share 50%  rules "mansard:damage.cga" }
camera top { size 96 x 96  gsd 2m  fov 20deg }
sun noon { elevation 50deg  azimuth 160deg }
effects plain { shadows hard  ambient sky }
quality quick { preset draft }
"#;

const PASSES: &str = r#"
pass before { show all }
pass mask   { show all with burnt mark burnt as mask }
dataset d   { views 1 * top  passes before, mask  sun noon  effects plain  quality quick }
"#;

/// Everything that a recipe can define and not use.
const UNUSED: &str = r#"
sun dusk        { elevation 4deg  azimuth 280deg }
effects crude   { shadows soft  ambient constant(40%) }
quality costly  { preset high  shadow_map 16384 }
camera oblique  { size 4000 x 4000  gsd 0.1m  fov 60deg  off_nadir 40deg }
pass shown_not  { show all with burnt as colour, class, depth, instance, level  shadows soft }
"#;

/// Files of a folder and their bytes; of the manifest all but what it says of the recipe's own text.
fn files(shop: &Workshop, folder: &str) -> Vec<(String, Vec<u8>)> {
    let read = |name: String| {
        let bytes = std::fs::read(shop.path(&name)).expect("written");
        let bytes = if name.ends_with("manifest.json") {
            let mut manifest: Value = serde_json::from_slice(&bytes).expect("JSON");
            let fields = manifest.as_object_mut().expect("an object");
            // Its name, and its content.
            fields.remove("recipe").expect("the recipe is named");
            fields.remove("inputs").expect("inputs are recorded");
            manifest.to_string().into_bytes()
        } else {
            bytes
        };
        (name.strip_prefix(folder).expect("inside").to_owned(), bytes)
    };
    shop.list(folder).into_iter().map(read).collect()
}

fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(30);
    shop
}

#[test]
fn what_a_recipe_defines_and_does_not_use_changes_no_byte() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    shop.write("lean.render", format!("{SCENE}{PASSES}"));
    shop.write("fat.render", format!("{SCENE}{UNUSED}{PASSES}"));
    for name in ["lean", "fat"] {
        shop.run(&["render", &format!("{name}.render"), "-o", name, "--quiet"]).expect(0);
    }
    let (lean, fat) = (files(&shop, "lean"), files(&shop, "fat"));
    assert!(lean.len() >= 4, "{:?}", shop.list("lean"));
    for (lean, fat) in lean.iter().zip(&fat) {
        assert!(lean == fat, "{} differs", lean.0);
    }
    assert_eq!(lean.len(), fat.len());
    let plan = |name: &str| shop.run(&["plan", &format!("{name}.render"), "--quiet"]).expect(0).stdout;
    assert_eq!(plan("lean"), plan("fat"));
}

/// What `mansard plan` counts of a recipe with these blocks behind the scene's.
fn counts(shop: &Workshop, blocks: &str) -> Value {
    shop.write("r.render", format!("{SCENE}{blocks}"));
    let run = shop.run(&["plan", "r.render", "--format", "json", "--quiet"]).expect(0);
    let plan: Value = serde_json::from_str(&run.stdout).expect("JSON");
    plan["datasets"][0]["plan"].clone()
}

#[test]
fn the_last_user_takes_passes_targets_pipelines_and_attributes_with_it() {
    let shop = shop();
    let dataset = "dataset d { views 1 * top  sun noon  effects plain  quality quick }\n";
    let mask = "pass mask { show all with burnt mark burnt as mask }\n";
    let lit = counts(&shop, &format!("pass before {{ show all }}\n{mask}{dataset}"));
    let unshadowed = counts(&shop, &format!("pass before {{ show all  shadows off }}\n{mask}{dataset}"));
    let masks = counts(&shop, &format!("{mask}{dataset}"));
    let number = |plan: &Value, key: &str| plan[key].as_u64().unwrap_or_else(|| panic!("{key} in {plan:#}"));
    for key in ["passes", "render_targets", "pipelines", "vertex_bytes", "texels"] {
        let (lit, unshadowed, masks) = (number(&lit, key), number(&unshadowed, key), number(&masks, key));
        assert!(masks < unshadowed && unshadowed <= lit, "{key}: {lit}, {unshadowed}, {masks}");
    }
    assert!(number(&unshadowed, "passes") < number(&lit, "passes"));
    assert_eq!(masks["attributes"], serde_json::json!(["position", "object"]));
    let drawn = |plan: &Value| number(plan, "triangles");
    assert!(drawn(&masks) < drawn(&unshadowed) && drawn(&unshadowed) < drawn(&lit));
    let reasons = masks["views"][0]["skipped"].to_string();
    assert!(reasons.contains("no output asks for colour"), "{reasons}");
    assert!(reasons.contains("texture coordinates"), "{reasons}");
}
