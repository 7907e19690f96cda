//! The window of `mansard watch` on a display of its own: what is on the screen, and what hands do to it.

mod display;

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use image::{ImageBuffer, Luma, RgbImage};
use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};
use display::Display;

/// For a first build, a frame in software and a busy machine.
const PATIENCE: Duration = Duration::from_secs(240);

const RULES: &str = r##"
@Group("Size") @Range(min=3, max=30, stepsize=0.5) @Description("From the ground to the eaves.")
attr height = 8
@Group("Walls") @Color
attr wall = "#d02020"

@StartRule
Lot --> extrude(height) color(wall) Building
Building --> comp(f) { all : Face }
"##;

const RECIPE: &str = r#"
version 1
scene town {
  seed      11
  map       "town.osm"
  elevation "town.tif"
  rules "houses.cga"              for building
  rules "mansard:street.cga"      for highway
}
change burnt { of building  share 30%  rules "mansard:damage.cga" }
camera top  { size 200 x 150  gsd 1.2m  fov 20deg }
sun     { elevation 50deg  azimuth 140deg }
effects { shadows hard  ambient sky }
quality { preset draft }
pass before { show all }
pass after  { show all with burnt }
pass mask   { show only burnt with burnt as mask }
pass ids    { show all as instance }
dataset d   { views 1 * top  layout plain }
"#;

/// The program with its window, and the lines that it prints.
struct Watch {
    child: Child,
    lines: Receiver<Value>,
}

impl Watch {
    fn start(shop: &Workshop, display: &str) -> Watch {
        let mut child = Command::new(env!("CARGO_BIN_EXE_mansard"))
            .args(["watch", "r.render", "--json"])
            .current_dir(shop.path(""))
            .env("DISPLAY", display)
            .env_remove("WAYLAND_DISPLAY")
            .env_remove("WAYLAND_SOCKET")
            .stdout(Stdio::piped())
            .stderr(Stdio::inherit())
            .spawn()
            .expect("the program was built");
        let stdout = child.stdout.take().expect("it is piped");
        let (send, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines() {
                let line = line.expect("the program prints UTF-8");
                let value = serde_json::from_str(&line).unwrap_or_else(|e| panic!("{e}: {line}"));
                if send.send(value).is_err() {
                    return;
                }
            }
        });
        Watch { child, lines }
    }

    /// The first such line within `patience`.
    fn within(&mut self, patience: Duration, is: impl Fn(&Value) -> bool) -> Option<Value> {
        let end = Instant::now() + patience;
        std::iter::from_fn(|| self.lines.recv_timeout(end.saturating_duration_since(Instant::now())).ok()).find(is)
    }

    /// Waits for a line; everything before it is passed over.
    fn wait(&mut self, what: &str, is: impl Fn(&Value) -> bool) -> Value {
        let until = Instant::now() + PATIENCE;
        let mut seen = Vec::new();
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.lines.recv_timeout(left) {
                Ok(line) if is(&line) => return line,
                Ok(line) => seen.push(line),
                Err(error) => panic!("waiting for {what}: {error}; {:?}; so far {seen:#?}", self.child.try_wait()),
            }
        }
    }

    /// A whole picture of an update from `update` on.
    fn frame(&mut self, update: u64) -> Value {
        let is = |line: &Value| {
            line["event"] == "frame" && line["draft"] == false && line["update"].as_u64() >= Some(update)
        };
        self.wait("a frame", is)
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}

fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(20);
    shop.write("houses.cga", RULES);
    shop.write("r.render", RECIPE);
    shop
}

/// Object numbers, pixel by pixel.
type Numbers = ImageBuffer<Luma<u32>, Vec<u32>>;

/// The images of the recipe's view as `mansard render` makes them: after, object numbers.
fn dataset(shop: &Workshop) -> (RgbImage, Numbers) {
    shop.run(&["render", "r.render", "-o", "out"]).expect(0);
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(shop.path("out/manifest.json")).expect("written")).expect("JSON");
    let path = |name: &str| {
        let path = manifest["views"][0]["images"][name]["path"].as_str().expect("the view has the image");
        shop.path(&format!("out/{path}"))
    };
    let after = image::open(path("after")).expect("an image").to_rgb8();
    let file = std::fs::File::open(path("ids")).expect("written");
    let mut decoder = tiff::decoder::Decoder::new(file).expect("a TIFF file");
    let tiff::decoder::DecodingResult::U32(numbers) = decoder.read_image().expect("a whole image") else {
        panic!("object numbers have 32 bits");
    };
    (after.clone(), Numbers::from_vec(after.width(), after.height(), numbers).expect("a number per pixel"))
}

/// Where the picture is on the screen: left, top, width, height.
fn rect(frame: &Value) -> [f64; 4] {
    [0, 1, 2, 3].map(|i| frame["rect"][i].as_f64().expect("four numbers"))
}

/// The screen at a point of the picture, given in shares of its width and height.
fn screen_point(frame: &Value, x: f64, y: f64) -> (i16, i16) {
    let [left, top, width, height] = rect(frame);
    ((left + x * width) as i16, (top + y * height) as i16)
}

/// Share of the picture on the screen where red (or blue) is by far the strongest.
fn share_of(display: &Display, frame: &Value, channel: usize) -> f64 {
    let [left, top, width, height] = rect(frame).map(|v| v as u32);
    let screen = display.picture();
    let picture = image::imageops::crop_imm(&screen, left, top, width, height).to_image();
    let strong = |p: &&image::Rgb<u8>| {
        let own = i32::from(p.0[channel]);
        (0..3).filter(|&other| other != channel).all(|other| own > i32::from(p.0[other]) + 40)
    };
    picture.pixels().filter(strong).count() as f64 / f64::from(width * height)
}

/// Waits until the screen is as it shall be: the server shows a frame a little later than the program hands it over.
fn until(what: &str, holds: impl Fn() -> bool) {
    let end = Instant::now() + PATIENCE;
    while !holds() {
        assert!(Instant::now() < end, "{what}");
        std::thread::sleep(Duration::from_millis(50));
    }
}

/// A pixel in the middle of an object: it and all around it have one number, which more than one pixel has.
fn inside(ids: &Numbers, wanted: impl Fn(u32) -> bool) -> (u32, u32, u32) {
    let around = |x: u32, y: u32| (y - 2..=y + 2).flat_map(move |y| (x - 2..=x + 2).map(move |x| (x, y)));
    let all = (2..ids.height() - 2).flat_map(|y| (2..ids.width() - 2).map(move |x| (x, y)));
    let mut whole = all.filter(|&(x, y)| {
        let id = ids.get_pixel(x, y).0[0];
        wanted(id) && around(x, y).all(|(x, y)| ids.get_pixel(x, y).0[0] == id)
    });
    let (x, y) = whole.next().expect("some object is 5 pixels wide");
    (x, y, ids.get_pixel(x, y).0[0])
}

#[test]
fn the_window_shows_edits_and_answers_clicks() {
    let Some(display) = Display::open().filter(|_| has_adapter()) else { return };
    let shop = shop();
    let (after, ids) = dataset(&shop);
    let mut watch = Watch::start(&shop, &display.name);

    // The first picture is the recipe's view.
    let first = watch.frame(1);
    assert_eq!(
        (&first["exact"], &first["show"][0], &first["view"]),
        (&true.into(), &"after".into(), &"town_top_1".into())
    );
    let [_, _, width, height] = rect(&first);
    assert!((width / height - 200.0 / 150.0).abs() < 0.02, "the picture has the shape of the recipe's: {first}");
    until("red walls on the screen", || share_of(&display, &first, 0) > 0.01);
    assert!(share_of(&display, &first, 2) < 0.001, "nothing is blue yet");

    // A screenshot of an untouched view is the dataset's image.
    let (x, y) = screen_point(&first, 0.5, 0.5);
    display.move_to(x, y);
    display.focus();
    display.key('p');
    let saved = watch.wait("the screenshot", |line| line["event"] == "screenshot");
    let saved = image::open(shop.path(saved["path"].as_str().expect("a path"))).expect("a whole PNG").to_rgb8();
    assert_eq!(saved, after, "the screenshot is not what the dataset shows");

    // A click on a building tells what the image of object numbers says.
    shop.run(&["build", "r.render", "-o", "town.glb"]).expect(0);
    let buildings = building_instances(&shop);
    let (px, py, id) = inside(&ids, |id| buildings.contains(&id));
    let share = |pixel: u32, pixels: u32| (f64::from(pixel) + 0.5) / f64::from(pixels);
    let (x, y) = screen_point(&first, share(px, ids.width()), share(py, ids.height()));
    display.click(x, y);
    let picked = watch.wait("what was clicked", |line| line["event"] == "picked");
    let lot = &picked["lot"];
    assert_eq!((&picked["instance"], &lot["instance"]), (&id.into(), &id.into()), "{picked}");
    assert_eq!(lot["class"], "building");
    let leaf = &lot["leaf"];
    if lot["change"].is_null() {
        assert_eq!(lot["rule_file"], "houses.cga");
        assert_eq!(leaf["rules"], serde_json::json!(["Lot", "Building", "Face"]), "{picked}");
        assert!(leaf["file"].as_str().is_some_and(|file| file.ends_with("houses.cga")), "{picked}");
        assert_eq!(leaf["line"], 9, "the line of `Building --> comp(f) {{ all : Face }}`: {picked}");
    }

    // A saved rule file changes the picture.
    shop.write("houses.cga", RULES.replace("#d02020", "#2030d0"));
    let update = watch.wait("an update", |line| line["changed"].as_array().is_some_and(|files| !files.is_empty()));
    let second = watch.frame(update["number"].as_u64().expect("a number"));
    until("blue walls on the screen", || share_of(&display, &second, 2) > 0.01);
    assert!(share_of(&display, &second, 0) < 0.001, "nothing is red any more");

    // A mistake leaves the picture and says so; a fix clears it.
    shop.write("houses.cga", RULES.replace("extrude(height)", "extrude(height"));
    let update = watch.wait("a failed update", |line| line["stands"] == true && line["cancelled"] == false);
    let message = &update["diagnostics"][0];
    assert_eq!((&message["severity"], &message["line"]), (&"error".into(), &8.into()), "{update}");
    assert!(share_of(&display, &second, 2) > 0.01, "the last good picture stands");
    shop.write("houses.cga", RULES);
    let update = watch.wait("a good update", |line| line["stands"] == false);
    let third = watch.frame(update["number"].as_u64().expect("a number"));
    until("red walls again", || share_of(&display, &third, 0) > 0.01);
}

/// Object numbers of buildings, from the labels of the scene's glTF.
fn building_instances(shop: &Workshop) -> Vec<u32> {
    let (document, _, _) = gltf::import(shop.path("town.glb")).expect("a glTF file");
    let of = |node: gltf::Node<'_>| {
        let extras: Value = serde_json::from_str(node.extras().as_ref()?.get()).ok()?;
        (extras["class"] == "building").then(|| extras["instance"].as_u64().expect("a number") as u32)
    };
    document.nodes().filter_map(of).collect()
}

#[test]
fn states_views_and_hands() {
    let Some(display) = Display::open().filter(|_| has_adapter()) else { return };
    let shop = shop();
    let mut watch = Watch::start(&shop, &display.name);
    let first = watch.frame(1);
    let (x, y) = screen_point(&first, 0.5, 0.5);
    display.move_to(x, y);
    display.focus();
    for (key, shown) in
        [('1', vec!["before"]), ('3', vec!["mask"]), ('s', vec!["before", "after"]), ('2', vec!["after"])]
    {
        display.key(key);
        let is = |line: &Value| line["event"] == "frame" && line["show"] == serde_json::json!(shown);
        let frame = watch.wait("another state", is);
        assert_eq!(frame["exact"], true, "the camera stays");
    }
    // A drag orbits: drafts at first, then a whole picture of a free camera that fills the area.
    let is = |line: &Value| line["event"] == "frame" && line["draft"] == false && line["exact"] == false;
    let orbited = orbit(&display, &mut watch, (x, y), is);
    assert!(rect(&orbited)[2] > rect(&first)[2] || rect(&orbited)[3] > rect(&first)[3], "{orbited} after {first}");
    // Another seed is another update.
    display.key('r');
    let update = watch.wait("an update", |line| line["redone"]["lots_derived"].as_u64() > Some(0));
    watch.frame(update["number"].as_u64().expect("a number"));
    // A rule that loops keeps the builder busy; the camera goes on, and a fix ends it.
    shop.write("houses.cga", RULES.replace("extrude(height)", "split(x) { ~1 : Lot | ~1 : Lot }"));
    orbit(&display, &mut watch, (x, y), |line| line["event"] == "frame" && line["draft"] == false);
    shop.write("houses.cga", RULES);
    watch.wait("a good update", |line| line["stands"] == false && line["cancelled"] == false);
}

/// Drags until there is such a line. A hand that is faster than a pass of the window, on a busy machine, is not seen: it
/// tries again.
fn orbit(display: &Display, watch: &mut Watch, (x, y): (i16, i16), is: impl Fn(&Value) -> bool + Copy) -> Value {
    let mut tries = (0..12).map(|_| {
        display.drag((x, y), (x + 120, y + 60));
        watch.within(PATIENCE / 12, is)
    });
    tries.find_map(|line| line).expect("a drag frees the camera")
}

#[test]
fn without_a_display_the_headless_loop_is_named() {
    let shop = shop();
    let none: &[(&str, &str)] = &[("DISPLAY", ""), ("WAYLAND_DISPLAY", ""), ("WAYLAND_SOCKET", "")];
    shop.run_with(&["watch", "r.render"], none).expect(2).says(&["there is no display", "--headless"]);
}
