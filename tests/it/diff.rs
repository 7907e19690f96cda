//! `mansard diff` as a user sees it. In: recipes with one thing changed, revisions, output folders. Out: that thing named,
//! in its place and nowhere else, and the exit code of diff(1).

use std::process::Command;

use serde_json::Value;

use crate::workshop::{Run, Workshop, has_adapter};

const RECIPE: &str = r#"
version 1
scene town {
  seed      11
  map       "town.osm"
  elevation "town.tif"
  rules "house.cga" for building { storeys = 2 }
  rules "mansard:street.cga" for highway
}
change burnt { of building  share 50%  effect demolished }
camera top  { size 96 x 96  gsd 4m  fov 20deg  off_nadir uniform(0deg, 10deg) }
sun     { elevation 40deg  azimuth uniform(100deg, 200deg) }
effects { shadows hard  ambient sky }
quality { preset draft }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show only burnt with burnt as mask }
pass labels { show all with burnt as class, instance, depth }
dataset d   { views 2 * top  layout plain }
"#;

const RULES: &str = "\
// A house with a gable.
@Range(min=1, max=9)
attr storeys = 1
const storeyHeight = 3
height = storeys * storeyHeight

@StartRule
Lot --> color(\"#c0a080\") extrude(height) comp(f) { top: Roof | side: Wall. }
Roof --> roofGable(30) comp(f) { side: Wall. | top: Tile. }
";

/// The same town, recipe and rules in folders `a` and `b`.
fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(20);
    for side in ["a", "b"] {
        for name in ["town.osm", "town.tif"] {
            shop.write(&format!("{side}/{name}"), std::fs::read(shop.path(name)).expect("the town is there"));
        }
        shop.write(&format!("{side}/r.render"), RECIPE);
        shop.write(&format!("{side}/house.cga"), RULES);
    }
    shop
}

fn diff(shop: &Workshop) -> Run {
    shop.run(&["diff", "a/r.render", "b/r.render", "--quiet"])
}

fn json(shop: &Workshop, args: &[&str]) -> Value {
    let run = shop.run(&[&["diff"], args, &["--quiet", "--format", "json"]].concat()).expect(1);
    serde_json::from_str(&run.stdout).expect("JSON")
}

#[test]
fn a_changed_number_in_a_rule() {
    let shop = shop();
    shop.write("b/house.cga", RULES.replace("roofGable(30)", "roofGable(35)"));
    insta::assert_snapshot!(diff(&shop).expect(1).stdout);
    let found = json(&shop, &["a/r.render", "b/r.render"]);
    let meshes = &found["scenes"][0]["meshes"];
    assert_eq!(meshes["features"].as_array().expect("a list").len(), 20, "every building has a roof, and no street");
    assert_eq!(meshes["ground"], Value::Null);
    assert_eq!(found["recipe"].as_array().expect("a list").len(), 0);
    let declarations = found["rules"][0]["declarations"].as_array().expect("a list");
    assert_eq!((declarations.len(), &declarations[0]["name"]), (1, &Value::from("Roof")));
}

#[test]
fn comments_layout_order_and_names_are_the_same() {
    let shop = shop();
    let (head, roof) = RULES.split_once("Roof -->").expect("the rules have a roof");
    let lines: Vec<&str> = head.lines().collect();
    shop.write("b/house.cga", format!("{}\n/* first */ Roof -->{roof}{}\n", lines[0], lines[1..].join("\n\n")));
    shop.write("b/r.render", RECIPE.replace("seed      11", "# any\n  seed 11").replace("40deg", "40.0deg"));
    insta::assert_snapshot!(diff(&shop).expect(0).stdout);
    std::fs::rename(shop.path("b/r.render"), shop.path("b/other.render")).expect("it is there");
    let run = shop.run(&["diff", "a/r.render", "b/other.render", "--quiet"]).expect(0);
    assert!(run.stdout.contains("r.render → other.render"), "{}", run.stdout);
}

#[test]
fn a_changed_seed_draws_anew() {
    let shop = shop();
    shop.write("b/r.render", RECIPE.replace("seed      11", "seed 12"));
    let found = json(&shop, &["a/r.render", "b/r.render"]);
    let properties = found["recipe"].as_array().expect("a list");
    assert_eq!(properties.len(), 1);
    assert_eq!(
        (&properties[0]["path"], &properties[0]["a"], &properties[0]["b"]),
        (&"scene town.seed".into(), &"11".into(), &"12".into())
    );
    assert_eq!(found["rules"].as_array().expect("a list").len(), 0);
    let features = found["scenes"][0]["features"]["features"].as_array().expect("a list");
    // As many burn as before: those that do no more are as many as those that do now.
    let turned = |to: &str| features.iter().filter(|f| f["differs"][0][2] == to).count();
    assert!(!features.is_empty() && turned("none") == turned("burnt, demolished"), "{features:?}");
    assert_eq!(turned("none") * 2, features.len());
    let draws = found["views"][0]["draws"].as_array().expect("a list");
    let paths: std::collections::BTreeSet<&str> = draws.iter().filter_map(|d| d["path"].as_str()).collect();
    assert_eq!(paths.into_iter().collect::<Vec<_>>(), ["camera.off_nadir", "sun.azimuth"]);
}

#[test]
fn properties_by_path_whatever_the_text_looks_like() {
    let shop = shop();
    let other = RECIPE
        .replace("gsd 4m", "gsd 400cm")
        .replace("fov 20deg", "fov 25deg")
        .replace("{ storeys = 2 }", "{ storeys = uniform(2, 4) }")
        .replace("  rules \"mansard:street.cga\" for highway\n", "")
        .replace("share 50%", "count 3")
        .replace("shadows hard", "shadows hard  atmosphere haze visibility 20km");
    shop.write("b/r.render", other);
    let run = diff(&shop).expect(1);
    let (_, recipe) = run.stdout.split_once("\nrecipe ").expect("a section");
    insta::assert_snapshot!(recipe.split_once("\nrules").expect("a section").0);
}

#[test]
fn inputs_and_features_that_came_and_went() {
    let shop = shop();
    let osm = std::fs::read_to_string(shop.path("b/town.osm")).expect("the town is there");
    // The first building is another kind of thing, and so not built.
    let other = osm.replacen("k=\"building\"", "k=\"was:building\"", 1);
    assert_ne!(osm, other);
    shop.write("b/town.osm", other);
    let found = json(&shop, &["a/r.render", "b/r.render"]);
    assert_eq!(found["inputs"].as_array().expect("a list").len(), 1);
    assert_eq!((&found["inputs"][0]["name"], &found["inputs"][0]["fate"]), (&"town.osm".into(), &"changed".into()));
    let features = found["scenes"][0]["features"]["features"].as_array().expect("a list");
    let removed: Vec<&Value> = features.iter().filter(|f| f["fate"] == "removed").collect();
    assert_eq!(removed.len(), 1, "{features:?}");
    let gone = removed[0]["feature"].as_str().expect("a name");
    let meshes = found["scenes"][0]["meshes"]["features"].as_array().expect("a list");
    let mesh = meshes.iter().find(|f| f["feature"] == gone).expect("its mesh went with it");
    assert_eq!((&mesh["before"]["kind"], &mesh["before"]["triangles_b"]), (&"shape".into(), &0.into()));
}

#[test]
fn two_revisions_of_a_repository() {
    let shop = shop();
    let git = |args: &[&str]| {
        let identity = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"];
        let run =
            Command::new("git").arg("-C").arg(shop.path("")).args(identity).args(args).output().expect("git is there");
        assert!(run.status.success(), "git {args:?}: {}", String::from_utf8_lossy(&run.stderr));
    };
    git(&["init", "--quiet"]);
    git(&["add", "a"]);
    git(&["commit", "--quiet", "-m", "one"]);
    shop.write("a/house.cga", RULES.replace("storeyHeight = 3", "storeyHeight = 4"));
    git(&["commit", "--quiet", "-am", "two"]);
    let run = shop.run(&["diff", "HEAD~1", "HEAD", "--recipe", "a/r.render", "--quiet"]).expect(1);
    insta::assert_snapshot!(run.stdout);
    let other = shop.run(&["diff", "HEAD~1:a/r.render", "HEAD:a/r.render", "--quiet"]).expect(1);
    assert_eq!(other.stdout, run.stdout);
    // What is not committed yet, against the last revision, from a folder below.
    shop.run(&["diff", "HEAD:./a/r.render", "a/r.render", "--quiet"]).expect(0);
    shop.run(&["diff", "HEAD~7", "HEAD", "--recipe", "a/r.render"]).expect(2).says(&["`HEAD~7` is no revision"]);
    shop.run(&["diff", "HEAD:x.render", "a/r.render"]).expect(2).says(&["revision `HEAD` has no file x.render"]);
}

#[test]
fn trouble_is_neither_same_nor_different() {
    let shop = shop();
    shop.run(&["diff", "a/r.render", "nothing"]).expect(2).says(&["no such file or folder"]);
    shop.run(&["diff", "a/r.render", "b"]).expect(2).says(&["b has no manifest.json"]);
    shop.write("b/house.cga", "Lot --> extrude(");
    diff(&shop).expect(2);
    shop.write("b/house.cga", RULES);
    shop.run(&["diff", "a/r.render", "b/r.render", "--set", "nothing"]).expect(2).says(&["NAME=VALUE"]);
}

#[test]
fn output_folders_with_pictures() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    shop.write("b/house.cga", RULES.replace("storeyHeight = 3", "storeyHeight = 5"));
    for side in ["a", "b"] {
        shop.run(&["render", &format!("{side}/r.render"), "-o", &format!("out_{side}"), "--quiet"]).expect(0);
    }
    shop.run(&["diff", "out_a", "out_a", "--quiet"]).expect(0);
    let run = shop.run(&["diff", "out_a", "out_b", "-o", "pages", "--quiet"]).expect(1);
    assert!(run.stdout.contains("recipe     not compared"), "{}", run.stdout);
    assert_eq!(
        shop.list("pages"),
        ["pages/diff.html", "pages/diff.json", "pages/town_top_1.png", "pages/town_top_2.png"]
    );
    let found: Value =
        serde_json::from_slice(&std::fs::read(shop.path("pages/diff.json")).expect("written")).expect("JSON");
    // No number of an object and no place on the ground moved: what is marked burnt leans a little more, that is all.
    let images = found["images"]["images"].as_array().expect("a list");
    assert_eq!(found["images"]["compared"], 12);
    let of = |name: &str| images.iter().find(|i| i["view"] == "town_top_1" && i["image"] == name).expect(name);
    assert_eq!(of("before")["kind"], "colour");
    assert!(of("before")["pixels"]["greatest"].as_f64().is_some_and(|greatest| greatest > 20.0), "{}", of("before"));
    let depth = of("labels_depth")["pixels"]["greatest"].as_f64().expect("metres");
    // Two storeys of two metres more, and eaves that hide the ground.
    assert!((4.0..40.0).contains(&depth), "{depth}");
    let turned = of("labels_class")["turned"].as_array().expect("a list");
    assert!(turned.iter().any(|t| t[1] == "building"), "{turned:?}");
    let picture = image::open(shop.path("pages/town_top_1.png")).expect("a picture");
    assert!(picture.width() > 3 * 288 && picture.height() > 5 * 288, "{} x {}", picture.width(), picture.height());
    let page = std::fs::read_to_string(shop.path("pages/diff.html")).expect("written");
    assert_eq!(page.matches("data:image/jpeg").count(), 2);
    assert!(!page.contains("<script") && page.contains("town_top_2"), "one page, no script");

    // A recipe against what was made of it: files hold less precision, and all of it is the same.
    let run = shop.run(&["diff", "a/r.render", "out_a", "--pixels", "--quiet"]).expect(0);
    assert!(run.stdout.ends_with("\nsame\n"), "{}", run.stdout);
}
