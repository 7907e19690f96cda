//! CityEngine projects on disk: where rules find assets and imports, what they cannot reach, what they report.

use crate::workshop::Workshop;

const FOOTPRINT: &str = "0,0 10,0 10,-8 0,-8";

/// `town` with `rules`, `assets` and `maps`, and `secret` beside it.
fn shop(rules: &str) -> Workshop {
    let shop = Workshop::new();
    shop.write("town/rules/x.cga", rules);
    shop.write("town/rules/y.cga", "version \"2025.1\"\nattr h = 3\nBox --> extrude(h) texture(\"wall.png\") Leaf.\n");
    shop.write("town/assets/tree.obj", "v 0 0 0\nv 2 0 0\nv 0 5 0\nf 1 2 3\n");
    image::RgbImage::new(2, 2).save(shop.path("town/assets/wall.png")).expect("the folder is writable");
    shop.write("town/maps/readme.txt", "a map");
    shop.write("secret/secret.txt", "secret");
    shop
}

fn derived(shop: &Workshop, code: i32) -> crate::workshop::Run {
    shop.run(&["derive", "town/rules/x.cga", "--footprint", FOOTPRINT, "--format", "json"]).expect(code)
}

#[test]
fn rules_find_the_assets_and_imports_of_their_project() {
    let shop = shop(
        "version \"2025.1\"\nimport y : \"/town/rules/y.cga\"\nimport z : \"rules/y.cga\"(h = 5)\n@StartRule\nLot -->\n\
         y.Box z.Box print(fileSearch(\"*.obj\")) print(readTextFile(\"/town/maps/readme.txt\"))\n\
         print(assetInfo(\"/town/assets/tree.obj\", sy)) i(\"tree.obj\") Tree.\n",
    );
    let run = derived(&shop, 0);
    let tree: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!(tree["diagnostics"], serde_json::json!([]));
    assert_eq!(tree["prints"], serde_json::json!(["/town/assets/tree.obj;", "a map", "5"]));
    let leaves = tree["leaves"].as_array().expect("a list");
    assert_eq!(leaves.len(), 3);
    assert!(leaves[0]["material"]["colormap"].as_str().is_some_and(|path| path.ends_with("town/assets/wall.png")));
    assert_eq!(leaves[2]["faces"].as_array().map(Vec::len), Some(1));
}

#[test]
fn what_lies_outside_the_project_needs_leave() {
    let rules = "version \"2025.1\"\n@StartRule\nLot --> print(readTextFile(\"/secret/secret.txt\")) A.\n";
    let shop = shop(rules);
    derived(&shop, 0).says(&["the path leaves the allowed folders"]);
    let allowed = ["--allow", "secret"];
    let run = shop
        .run(&["derive", "town/rules/x.cga", "--footprint", FOOTPRINT, "--format", "tree", allowed[0], allowed[1]])
        .expect(0);
    assert!(run.stdout.contains("print secret\n"), "{}", run.stdout);
    shop.write("town/rules/x.cga", "version \"2025.1\"\nimport s : \"/secret/s.cga\"\nLot --> A.\n");
    shop.write("secret/s.cga", "B --> C.\n");
    derived(&shop, 1).says(&["leaves"]);
}

#[test]
fn a_derivation_writes_its_reports() {
    let shop = shop(
        "version \"2025.1\"\n@StartRule\nLot --> extrude(3) comp(f) { side : Wall | top : Roof }\n\
         Wall --> report(\"area.wall\", geometry.area) NIL\nRoof --> report(\"area.roof\", geometry.area) Slab.\n",
    );
    let derive = ["derive", "town/rules/x.cga", "--footprint", FOOTPRINT];
    let run = shop.run(&[&derive[..], &["--reports", "r.csv"]].concat()).expect(0);
    let (leaf, table) = run.stdout.split_once('\n').expect("two parts");
    assert!(leaf.contains("Slab  #ffffff  4 vertices, 1 faces, box 0 3 -8 … 10 3 0"), "{leaf}");
    insta::assert_snapshot!(table, @r"
    report     type   count  sum  average  min  max
    area.*     group      5  188     37.6   24   80
    area.roof  float      1   80       80   80   80
    area.wall  float      4  108       27   24   30
    ");
    let csv = std::fs::read_to_string(shop.path("r.csv")).expect("written");
    insta::assert_snapshot!(csv, @r"
    scene,feature,report,type,count,sum,average,min,max
    x,footprint,area.roof,float,1,80,80,80,80
    x,footprint,area.wall,float,4,108,27,24,30
    x,total,area.roof,float,1,80,80,80,80
    x,total,area.wall,float,4,108,27,24,30
    x,total,area.*,group,5,188,37.6,24,80
    ");
    shop.write("town/rules/broken.cga", "Lot --> extrude(3, ) report(\"a\", )");
    let broken = ["derive", "town/rules/broken.cga", "--footprint", FOOTPRINT, "--reports", "none.csv"];
    shop.run(&broken).expect(1).says(&["cga::syntax"]);
    assert!(!shop.path("none.csv").exists(), "rules that do not run report nothing");
    shop.run(&[&derive[..], &["--reports", "r.xls"]].concat()).expect(2).says(&["r.xls", ".csv or .json"]);
    let run = shop.run(&[&derive[..], &["--format", "obj"]].concat()).expect(0);
    assert!(run.stderr.contains("area.roof  float      1   80"), "{}", run.stderr);
}

const RECIPE: &str = r#"
version 1
scene town {
  map       "town.osm"
  elevation "town.tif"
  rules "count.cga" for building
}
"#;

#[test]
fn reports_of_a_town_are_the_same_for_any_number_of_threads() {
    let shop = Workshop::new();
    shop.town(30);
    shop.write("r.render", RECIPE);
    let rules = "version \"2025.1\"\n@StartRule\nLot --> report(\"lot.area\", geometry.area) extrude(rand(3, 9)) \
                 report(\"lot.volume\", geometry.volume) A.\n";
    shop.write("count.cga", rules);
    let build = |jobs: &str, file: &str| {
        let args = ["build", "r.render", "-o", "scene.glb", "--jobs", jobs, "--reports", file];
        shop.run(&args).expect(0)
    };
    let run = build("1", "a.csv");
    run.says(&["lot.*", "lot.area", "lot.volume"]);
    build("3", "b.csv");
    build("2", "c.json");
    let read = |name: &str| std::fs::read_to_string(shop.path(name)).expect("written");
    let csv = read("a.csv");
    assert_eq!(csv, read("b.csv"));
    assert_eq!(csv.lines().count(), 1 + 30 * 2 + 3);
    let json: serde_json::Value = serde_json::from_str(&read("c.json")).expect("JSON");
    let total: f64 = csv.lines().filter(|l| l.contains(",lot.area,") && !l.contains(",total,")).map(sum).sum();
    let told = json.as_array().expect("a list").iter().find(|l| l["feature"] == "total" && l["report"] == "lot.area");
    assert_eq!(told.expect("there is a total")["sum"], total);
}

fn sum(line: &str) -> f64 {
    line.split(',').nth(5).and_then(|cell| cell.parse().ok()).expect("a sum")
}
