//! Bad input: a clear error that names file and place, exit code 1 or 2, nothing half-written.

use crate::workshop::{Workshop, shared};

const RECIPE: &str = r#"
version 1
scene town {
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:residential.cga" for building
}
change burnt { of building  share 40%  rules "mansard:damage.cga" }
camera low { size 64 x 64  gsd 4m  fov 30deg }
sun     { elevation 45deg  azimuth 135deg }
effects { shadows hard  ambient sky }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show only burnt with burnt as mask }
dataset d { views 1 * low  layout levir }
"#;

fn recipe(change: impl Fn(&str) -> String) -> Workshop {
    let shop = Workshop::new();
    shop.town(12);
    shop.write("r.render", change(RECIPE));
    shop
}

#[test]
fn a_truncated_pbf() {
    let Some(monaco) = shared("osm/monaco.osm.pbf") else { return };
    let bytes = std::fs::read(monaco).expect("the shared data can be read");
    let shop = recipe(|r| r.replace("town.osm", "cut.osm.pbf").replace("  elevation \"town.tif\"\n", ""));
    shop.write("cut.osm.pbf", &bytes[..bytes.len() / 2]);
    shop.run(&["render", "r.render", "-o", "out"]).expect(1).says(&["cut.osm.pbf"]);
    assert_eq!(shop.list("out"), Vec::<String>::new());
}

#[test]
fn a_missing_file_is_named_at_its_place() {
    let shop = recipe(|r| r.replace("town.tif", "gone.tif"));
    shop.run(&["render", "r.render", "-o", "out"]).expect(1).says(&["render::missing-file", "gone.tif", "r.render:5:"]);
    assert_eq!(shop.list("out"), Vec::<String>::new());
}

#[test]
fn a_missing_recipe() {
    Workshop::new().run(&["render", "no.render", "-o", "out"]).expect(1).says(&["no.render", "no such file"]);
}

#[test]
fn five_mistakes_are_five_diagnostics() {
    let shop = Workshop::new();
    let rules = "version \"2025.1\"\nattr h = 3\nLot --> extrude(sqroot(h)) A\nA --> color(\"#ff0000\", 1, 2, 3, 4, 5) B\n\
                 B --> s(1, 2) C.\nC2 --> extrude(heigth) D.\nE --> comp(f) { tpo : F. }\n";
    shop.write("r.cga", rules);
    let run = shop.run(&["check", "r.cga", "--format", "json"]).expect(1);
    let lines: Vec<serde_json::Value> =
        run.stdout.lines().map(|l| serde_json::from_str(l).expect("one JSON object per line")).collect();
    let errors: Vec<_> = lines.iter().filter(|d| d["severity"] == "error").collect();
    assert_eq!(errors.len(), 5, "{}", run.stdout);
    for (error, line) in errors.iter().zip([3, 4, 5, 6, 7]) {
        assert_eq!(error["line"], line, "{error}");
        assert_eq!(error["file"], "r.cga");
        for key in ["code", "message", "column", "end_line", "end_column", "help"] {
            assert!(error.get(key).is_some(), "{error} lacks {key}");
        }
    }
}

#[test]
fn a_sun_below_the_horizon() {
    let shop = recipe(|r| r.replace("elevation 45deg  azimuth", "elevation -3deg  azimuth"));
    shop.run(&["render", "r.render", "-o", "out"]).expect(1).says(&["horizon", "r.render:10:"]);
    assert_eq!(shop.list("out"), Vec::<String>::new());
}

#[test]
fn a_contradicting_camera_is_told_the_numbers() {
    let shop = recipe(|r| r.replace("fov 30deg", "fov 30deg  altitude 900m"));
    shop.run(&["check", "r.render"]).expect(1).says(&["900", "r.render:9:"]);
}

#[test]
fn an_unwritable_output() {
    let shop = recipe(str::to_owned);
    shop.write("file", "not a folder");
    shop.run(&["render", "r.render", "-o", "file/out"]).expect(2).says(&["cannot write", "file/out"]);
    shop.run(&["build", "r.render", "-o", "nowhere/x/scene.glb"]).expect(2).says(&["nowhere/x/scene.glb"]);
}

#[test]
fn paths_that_leave_the_tree() {
    let shop = recipe(|r| r.replace("\"town.osm\"", "\"../town.osm\""));
    shop.run(&["check", "r.render"]).expect(1).says(&["render::path-outside", "leaves the recipe's folder tree"]);
    let shop = Workshop::new();
    shop.write("sub/r.cga", "version \"2025.1\"\nimport x : \"../other.cga\"\nA --> x.B\n");
    shop.write("other.cga", "version \"2025.1\"\nB --> NIL\n");
    shop.run(&["check", "sub/r.cga"]).expect(1).says(&["leaves"]);
}

#[test]
fn endless_rules_stop_at_a_stated_limit() {
    let shop = Workshop::new();
    shop.write("deep.cga", "version \"2025.1\"\n@StartRule\nForEver --> t(1, 0, 0) ForEver\n");
    let footprint = ["--footprint", "0,0 10,0 10,-10 0,-10"];
    shop.run(&["derive", "deep.cga", footprint[0], footprint[1]]).expect(1).says(&["ForEver", "limit"]);
    shop.write("wide.cga", "version \"2025.1\"\n@StartRule\nMany --> split(x) { 0.00000001 : Crumb. }*\n");
    shop.run(&["derive", "wide.cga", footprint[0], footprint[1]]).expect(1).says(&["Many", "limit"]);
    shop.write("tree.cga", "version \"2025.1\"\n@StartRule\nTwo --> Two Two\n");
    shop.run(&["derive", "tree.cga", footprint[0], footprint[1]]).expect(1).says(&["Two", "limit"]);
}

#[test]
fn an_endless_rule_in_a_recipe_is_told_and_the_town_goes_on() {
    let shop = recipe(|r| r.replace("\"mansard:residential.cga\" for building", "\"deep.cga\" for building"));
    shop.write("deep.cga", "version \"2025.1\"\n@StartRule\nForEver --> ForEver\n");
    shop.run(&["build", "r.render", "-o", "scene.glb"]).expect(1).says(&[
        "ForEver",
        "0 ok",
        "skipped: its rules failed",
    ]);
    assert_eq!(shop.list("").iter().filter(|f| *f == "scene.glb").count(), 1, "the rest is written all the same");
}

#[test]
fn a_wrong_command_line_is_exit_code_two() {
    let shop = recipe(str::to_owned);
    shop.run(&["rendr"]).expect(2);
    shop.run(&["render", "r.render", "-o", "out", "--jobs", "0"]).expect(2);
    shop.run(&["render", "r.render", "-o", "out", "--set", "nonsense"]).expect(2);
    shop.run(&["render", "r.render", "-o", "out", "--views", "nothing_like_this"])
        .expect(2)
        .says(&["nothing_like_this"]);
    shop.run(&["check", "town.tif"]).expect(2);
}
