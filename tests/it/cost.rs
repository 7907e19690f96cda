//! What accuracy costs, and budgets of error, as a user sees them. In: small towns. Out: tables and pages that hold what
//! they promise, budgets that are kept on windows they were not chosen by, and mistakes that are named.

use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};

/// A town with a view of 96 × 96 pixels; `quality` is the body of its block.
fn recipe(quality: &str) -> String {
    format!(
        r#"
version 1
scene town {{
  seed      5
  map       "town.osm"
  elevation "town.tif"
  rules "mansard:industrial.cga"  for building[industrial | warehouse]
  rules "mansard:residential.cga" for building
  rules "mansard:street.cga"      for highway
}}
camera low  {{ size 96 x 96  gsd 1m  fov 30deg  off_nadir 12deg  azimuth 200deg }}
sun     {{ elevation 38deg  azimuth 230deg }}
effects {{ shadows hard  ambient sky }}
quality {{ {quality} }}
pass image {{ show all }}
dataset d  {{ views low  layout plain }}
"#
    )
}

fn shop(quality: &str) -> Workshop {
    let shop = Workshop::new();
    shop.town(40);
    shop.write("r.render", recipe(quality));
    shop
}

#[test]
fn cost_of_a_small_view() {
    if !has_adapter() {
        return;
    }
    let shop = shop("preset draft");
    let args = ["cost", "r.render", "-o", "out", "--repeats", "1", "--windows", "2", "--side", "48", "--noise", "1"];
    let run = shop.run(&args).expect(0);
    assert!(run.stderr.contains("draft:") && run.stderr.contains("cost.html"), "{}", run.stderr);

    let mut table = csv::Reader::from_path(shop.path("out/cost.csv")).expect("it is a table");
    let header = table.headers().expect("it has a header").clone();
    insta::assert_snapshot!(header.iter().collect::<Vec<_>>().join("\n"));
    let column = |name: &str| header.iter().position(|h| h == name).expect(name);
    let rows: Vec<csv::StringRecord> = table.records().map(|row| row.expect("a row")).collect();
    let of = |knob: &str, name: &str| -> Vec<f64> {
        let rows = rows.iter().filter(|row| &row[column("knob")] == knob);
        rows.map(|row| row[column(name)].parse().expect("a number")).collect()
    };
    let edges = of("antialiasing", "edge_px_alone");
    assert!(edges.len() == 8 && edges[0] > 2.0 * edges[7], "samples sharpen edges: {edges:?}");
    let shadows = of("shadow_map", "shadow_iou_alone");
    assert!(shadows[4] > 0.95 && shadows[4] > shadows[0], "texels sharpen shadows: {shadows:?}");
    let heights = of("terrain tolerance", "height_m");
    assert!(heights.len() == 6 && heights.windows(2).all(|w| w[0] >= w[1]), "{heights:?}");
    assert!(of("tile", "wrong_label_pixels").windows(2).all(|w| w[0] == w[1]), "tiles change no label");
    let on = column("frontier_rmse");
    assert!(rows.iter().any(|row| &row[on] == "1") && rows.iter().any(|row| &row[on] == "0"));
    assert!(of("preset", "time_ms").iter().all(|ms| *ms > 0.0));

    let page = std::fs::read_to_string(shop.path("out/cost.html")).expect("it is text");
    for part in ["<svg", "data:image/png;base64,", "antialiasing", "Not swept", "roof method", "One more decimal"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("<script") && !page.contains("src=\"http"));
    assert!(shop.list("out").iter().any(|name| name == "out/frontier-rmse.svg"), "{:?}", shop.list("out"));
}

#[test]
fn budgets_are_kept() {
    if !has_adapter() {
        return;
    }
    let mut samples = Vec::new();
    for percent in [5.0, 2.0, 1.0, 0.5] {
        let shop = shop(&format!("error {percent}%"));
        shop.run(&["render", "r.render", "-o", "out", "--quiet"]).expect(0);
        let text = std::fs::read_to_string(shop.path("out/manifest.json")).expect("it was written");
        let manifest: Value = serde_json::from_str(&text).expect("it is JSON");
        let budget = &manifest["budgets"][0];
        let limit = &budget["limits"][0];
        assert_eq!((limit["of"].as_str(), limit["promised"].as_f64()), (Some("error"), Some(percent / 100.0)));
        let achieved = limit["achieved"].as_f64().expect("it was measured");
        assert!(achieved > 0.0 && achieved <= percent / 100.0, "{percent} %: {budget}");
        samples.push(budget["chosen"]["antialiasing"].as_u64().expect("a number"));
    }
    assert!(samples.is_sorted() && samples[0] < samples[3], "{samples:?}");
}

#[test]
fn budgets_of_edges_shadows_and_ground_stand_in_the_plan() {
    if !has_adapter() {
        return;
    }
    let shop = shop("edge 0.12px  shadow 92%  height 0.3m  shadow_map 4096");
    let plan = || shop.run(&["plan", "r.render", "--format", "json", "--quiet"]).expect(0).stdout;
    let text = plan();
    assert_eq!(text, plan(), "the same choice twice");
    let plan: Value = serde_json::from_str(&text).expect("it is JSON");
    let budget = &plan["datasets"][0]["budget"];
    assert_eq!(budget["chosen"]["shadow_map"], 4096, "what is given stays");
    let limits: Vec<(&str, f64)> = budget["limits"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|l| (l["of"].as_str().expect("a word"), l["achieved"].as_f64().expect("measured")))
        .collect();
    let [("edge", edge), ("shadow", shadow), ("height", height)] = limits[..] else { panic!("{limits:?}") };
    assert!(edge <= 0.12 && shadow >= 0.92 && height <= 0.3, "{limits:?}");
    let lines = shop.run(&["plan", "r.render", "--quiet"]).expect(0).stdout;
    assert!(
        lines.contains("quality chosen by its budget") && lines.contains("budget edge: 0.120 px promised"),
        "{lines}"
    );
}

#[test]
fn what_cannot_be_kept_names_the_best() {
    if !has_adapter() {
        return;
    }
    let shop = shop("error 0.1%  antialiasing 1");
    shop.run(&["render", "r.render", "-o", "out", "--quiet"])
        .expect(1)
        .says(&["no settings keep error 0.100 % in scene `town` of dataset `d`: the best there is has error"]);
}

#[test]
fn mistakes_in_budgets() {
    let mut said = Vec::new();
    for quality in [
        "preset high  error 1%",
        "error 1",
        "error 1px",
        "error 0%",
        "edge 5%",
        "edge 3px",
        "height 1%",
        "shadow 100%",
        "error 1%, 2%",
        "error uniform(1%, 2%)",
    ] {
        let shop = shop(quality);
        let run = shop.run(&["check", "r.render"]).expect(1);
        let lines = run.stderr.lines().filter(|line| !line.trim().is_empty() && !line.contains("╭─"));
        said.push(format!("{quality}\n{}\n", lines.collect::<Vec<_>>().join("\n")));
    }
    insta::assert_snapshot!(said.join("\n"));
}
