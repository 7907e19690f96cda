//! `mansard watch --headless`, driven as an editor would: files are saved, broken, replaced; lines of JSON and the picture
//! are read.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::workshop::{Workshop, has_adapter};

const RECIPE: &str = r#"version 1
scene town {
  seed      5
  map       "town.osm"
  rules     "lot.cga" for building
}
camera top { size 96 x 96  gsd 3m  fov 30deg }
sun     { elevation 50deg  azimuth 160deg }
effects { shadows hard  ambient constant(40%) }
quality { preset draft }
pass now { show all }
dataset d { views 1 * top }
"#;

const RULES: &str = "const tall = 9\n@StartRule\nLot --> extrude(tall) Mass\nMass --> color(0.2, 0.2, 0.2)\n";

/// Long enough for a loaded machine.
const SOON: Duration = Duration::from_secs(120);
const NOTHING: Duration = Duration::from_millis(700);

/// The program while it runs.
struct Watch {
    child: Child,
    lines: Receiver<Value>,
}

impl Watch {
    fn start(shop: &Workshop, args: &[&str]) -> Watch {
        let mut child = Command::new(env!("CARGO_BIN_EXE_mansard"))
            .args(["watch", "town.render", "--headless"])
            .args(args)
            .current_dir(shop.path("."))
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program was built");
        let stdout = child.stdout.take().expect("it is a pipe");
        let (send, lines) = channel();
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines() {
                let line = line.expect("the program prints UTF-8");
                // The test has ended.
                let _ended = send.send(serde_json::from_str(&line).expect("a line is a JSON value"));
            }
        });
        Watch { child, lines }
    }

    #[track_caller]
    fn next(&self) -> Value {
        self.lines.recv_timeout(SOON).expect("the program prints a line")
    }

    /// The next line that tells of a change: a save may be told in two bursts, of which the second changes nothing.
    #[track_caller]
    fn change(&self) -> Value {
        self.until(|line| line["changed"].as_array().is_some_and(|changed| !changed.is_empty()))
    }

    /// The first line that is so.
    #[track_caller]
    fn until(&self, is: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        loop {
            let line = self.next();
            if is(&line) {
                return line;
            }
            assert!(start.elapsed() < SOON, "{line}");
        }
    }

    /// Nothing changes any more.
    #[track_caller]
    fn is_quiet(&self) {
        while let Ok(line) = self.lines.recv_timeout(NOTHING) {
            assert_eq!(line["changed"].as_array().map(Vec::len), Some(0), "{line}");
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        // It may have ended already.
        let _ended = self.child.kill();
        let _status = self.child.wait();
    }
}

fn shop() -> Workshop {
    let shop = Workshop::new();
    shop.town(12);
    shop.write("town.render", RECIPE);
    shop.write("lot.cga", RULES);
    shop
}

#[track_caller]
fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

fn picture(path: &Path) -> Vec<u8> {
    image::open(path).expect("the picture is whole").to_rgb8().into_raw()
}

/// What a program that is started anew shows.
fn cold(shop: &Workshop) -> Value {
    let watch = Watch::start(shop, &["--once"]);
    watch.next()["geometry_sha256"].clone()
}

#[test]
fn saves_mistakes_and_fixes_are_seen_at_once() {
    if !has_adapter() {
        return;
    }
    let shop = shop();
    let png = shop.path("now.png");
    let watch = Watch::start(&shop, &["--png", "now.png"]);
    let first = watch.next();
    assert_eq!((&first["number"], &first["stands"]), (&Value::from(1), &Value::from(false)), "{first}");
    assert_eq!(first["picture"]["width"], 96);
    assert!(first["redone"]["lots_derived"].as_u64().expect("a number") >= 12);
    for phase in ["compile", "place", "derive", "ground", "assemble"] {
        let phases = list(&first["phases"]);
        assert!(phases.iter().any(|p| p["name"] == phase && p["ms"].is_number()), "{phase}: {first}");
    }
    let before = picture(&png);

    // Another colour.
    shop.write("lot.cga", RULES.replace("0.2, 0.2, 0.2", "1, 0, 0"));
    let red = watch.change();
    assert!(red["changed"][0].as_str().expect("a name").ends_with("lot.cga"), "{red}");
    assert_eq!((&red["redone"]["place"], &red["redone"]["lots_kept"]), (&Value::from(false), &Value::from(0)));
    let after = picture(&png);
    assert!(before.chunks(3).zip(after.chunks(3)).any(|(a, b)| b[0] > a[0].saturating_add(40)), "no red appeared");
    watch.is_quiet();

    // A mistake: the picture stands.
    shop.write("lot.cga", RULES.replace("color(0.2", "color((0.2"));
    let broken = watch.change();
    assert_eq!((&broken["stands"], &broken["picture"]), (&Value::from(true), &Value::Null), "{broken}");
    let is_told = |d: &Value| d["severity"] == "error" && d["line"] == 4;
    assert!(list(&broken["diagnostics"]).iter().any(is_told), "{broken}");
    assert_eq!(broken["geometry_sha256"], red["geometry_sha256"]);
    assert_eq!(picture(&png), after);
    shop.write("lot.cga", RULES);
    let fixed = watch.change();
    assert_eq!((&fixed["stands"], list(&fixed["diagnostics"]).len()), (&Value::from(false), 0));
    assert_eq!(fixed["geometry_sha256"], first["geometry_sha256"]);
    assert_eq!(picture(&png), before);

    // Deleted and made anew, as editors save.
    std::fs::remove_file(shop.path("lot.cga")).expect("it is there");
    let gone = watch.change();
    assert_eq!(gone["stands"], true, "{gone}");
    shop.write("lot.cga", RULES.replace("tall = 9", "tall = 14"));
    let back = watch.until(|line| line["stands"] == false);
    assert_ne!(back["geometry_sha256"], first["geometry_sha256"]);
    shop.write("new.cga", RULES);
    std::fs::rename(shop.path("new.cga"), shop.path("lot.cga")).expect("it is there");
    watch.until(|line| line["geometry_sha256"] == first["geometry_sha256"]);

    // The sun alone.
    shop.write("town.render", RECIPE.replace("50deg", "25deg"));
    let sun = watch.change();
    assert_eq!(
        (&sun["redone"]["lots_derived"], &sun["redone"]["scene"]),
        (&Value::from(0), &Value::from(false)),
        "{sun}"
    );
    assert!(list(&sun["picture"]["phases"]).iter().all(|p| p["name"] != "upload"), "{sun}");
    assert_ne!(picture(&png), before);
}

#[test]
fn rules_that_never_end_do_not_hold_the_loop() {
    let shop = shop();
    let watch = Watch::start(&shop, &[]);
    let first = watch.next();
    shop.write(
        "lot.cga",
        RULES
            .replace("extrude(tall) Mass", "extrude(tall) Again")
            .replace("Mass -->", "Again --> Again Again\nMass -->"),
    );
    let endless = watch.change();
    assert_eq!(endless["stands"], true, "{endless}");
    let codes: Vec<&str> = list(&endless["diagnostics"]).iter().filter_map(|d| d["code"].as_str()).collect();
    assert!(codes.iter().any(|code| code.starts_with("cga::limit")), "{codes:?}");
    shop.write("lot.cga", RULES);
    let fixed = watch.until(|line| line["stands"] == false);
    assert_eq!(fixed["geometry_sha256"], first["geometry_sha256"]);
}

#[test]
fn a_thousand_saves_end_in_the_last_one() {
    let shop = shop();
    let watch = Watch::start(&shop, &[]);
    watch.next();
    for number in 0..1_000 {
        shop.write("lot.cga", RULES.replace("tall = 9", &format!("tall = {}", 5 + number % 23)));
        std::thread::sleep(Duration::from_millis(4));
    }
    shop.write("lot.cga", RULES.replace("tall = 9", "tall = 31"));
    let last = cold(&shop);
    let line = watch.until(|line| line["geometry_sha256"] == last);
    assert!(line["number"].as_u64().expect("a number") < 1_000, "bursts are taken together");
    watch.is_quiet();
}

#[test]
fn one_update_and_a_recipe_that_is_not_there() {
    let shop = shop();
    shop.run(&["watch", "town.render", "--headless", "--once"]).expect(0);
    let elsewhere = shop.run(&["watch", "town.render", "--headless", "--once", "--scene", "elsewhere"]).expect(1);
    assert!(elsewhere.stdout.contains("has no scene `elsewhere`; it has "), "{}", elsewhere.stdout);
    shop.write("lot.cga", "Lot --> (");
    let run = shop.run(&["watch", "town.render", "--headless", "--updates", "1"]).expect(1);
    assert_eq!(run.stdout.lines().count(), 1);
    // It is waited for.
    std::fs::rename(shop.path("town.render"), shop.path("later")).expect("it is there");
    shop.write("lot.cga", RULES);
    let watch = Watch::start(&shop, &["--updates", "2"]);
    let missing = watch.next();
    assert_eq!((&missing["stands"], &missing["scene"]), (&Value::from(true), &Value::from(0)), "{missing}");
    std::fs::rename(shop.path("later"), shop.path("town.render")).expect("it is there");
    let there = watch.change();
    assert_eq!((&there["stands"], &there["scene"]), (&Value::from(false), &Value::from(1)), "{there}");
}
