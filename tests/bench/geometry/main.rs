//! The geometry kernel on footprints it has not seen: hard, real and generated. In: the shared files, a seed. Out: a table
//! of outcomes per class, and every footprint whose roof has a defect.
//!
//! `cargo bench --bench geometry -- [hard] [extracts] [generated] [count=N] [seed=N] [only=CLASS]`

mod classes;
mod double_area;
mod extracts;
mod judge;
mod plans;
mod random;

use std::time::Duration;

use glam::DVec2;
use mansard::geometry::Ring;
use mansard::geometry::repair::{Options, Verdict};
use serde_json::Value;

use classes::{CLASSES, Class};
use judge::{Judgement, judge};
use random::Random;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// A row of the table.
#[derive(Default)]
struct Row {
    count: usize,
    ok: usize,
    repaired: usize,
    rejected: usize,
    fell_back: usize,
    invalid: usize,
    area_error: f64,
    time: Duration,
    greatest: Duration,
}

impl Row {
    fn add(&mut self, judged: &Judgement) {
        self.count += 1;
        match judged.verdict {
            Verdict::Ok => self.ok += 1,
            Verdict::Repaired => self.repaired += 1,
            Verdict::Rejected(_) => self.rejected += 1,
        }
        self.fell_back += usize::from(judged.fell_back > 0);
        self.invalid += usize::from(!judged.defects.is_empty());
        self.area_error = self.area_error.max(judged.area_error);
        self.time += judged.time;
        self.greatest = self.greatest.max(judged.time);
    }

    fn join(&mut self, other: &Row) {
        self.count += other.count;
        self.ok += other.ok;
        self.repaired += other.repaired;
        self.rejected += other.rejected;
        self.fell_back += other.fell_back;
        self.invalid += other.invalid;
        self.area_error = self.area_error.max(other.area_error);
        self.time += other.time;
        self.greatest = self.greatest.max(other.greatest);
    }

    fn print(&self, name: &str) {
        let micros = |d: Duration| d.as_secs_f64() * 1e6;
        println!(
            "| {name} | {} | {} | {} | {} | {} | {} | {:.1e} | {:.1} | {:.2} |",
            self.count,
            self.ok,
            self.repaired,
            self.rejected,
            self.fell_back,
            self.invalid,
            self.area_error,
            micros(self.time) / self.count.max(1) as f64,
            micros(self.greatest) / 1e3,
        );
    }
}

/// A table that is printed row by row; footprints with defects go to stderr.
struct Table {
    total: Row,
}

impl Table {
    fn new(title: &str) -> Table {
        println!(
            "\n| {title} | footprints | ok | repaired | rejected | fallback | invalid | area error | mean µs | greatest ms |"
        );
        println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
        Table { total: Row::default() }
    }

    fn row(&mut self, name: &str, footprints: impl Iterator<Item = (String, Vec<Ring>)>, options: &Options) {
        let mut row = Row::default();
        for (id, rings) in footprints {
            let judged = judge(&rings, options);
            if !judged.defects.is_empty() && row.invalid < 5 {
                eprintln!("{name} {id}: {}\n  {rings:?}", judged.defects.join(", "));
            }
            row.add(&judged);
        }
        row.print(name);
        self.total.join(&row);
    }

    fn close(self) {
        self.total.print("all");
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let value = |key: &str| arguments.iter().find_map(|a| a.strip_prefix(key)?.strip_prefix('='));
    let number = |key: &str, default: u64| value(key).map_or(default, |v| v.parse().expect("a number"));
    let all = !["hard", "extracts", "generated"].iter().any(|part| arguments.iter().any(|a| a == part));
    let wanted = |part: &str| all || arguments.iter().any(|a| a == part);
    if wanted("hard") {
        hard();
    }
    if wanted("extracts") {
        real(value("only"));
    }
    if wanted("generated") {
        generated(number("count", 120_000) as usize, number("seed", 1), value("only"));
    }
}

/// The named hard footprints.
fn hard() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/hard-cases/footprints.geojson");
    let Ok(text) = std::fs::read_to_string(path) else { return eprintln!("skipped: {path} is missing") };
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let features = file["features"].as_array().expect("features");
    let class = |f: &Value| f["properties"]["class"].as_str().expect("a class").to_owned();
    let mut names: Vec<String> = features.iter().map(class).collect();
    names.sort();
    names.dedup();
    let mut table = Table::new("hard case");
    for name in names {
        let members = features.iter().filter(|f| class(f) == name);
        let named = members.map(|f| (f["properties"]["name"].to_string(), rings(f)));
        table.row(&name, named, &Options { weld: 0.0, min_area: 0.0 });
    }
    table.close();
}

/// The rings of a feature, without the closing points of GeoJSON, with the values that JSON cannot hold.
fn rings(feature: &Value) -> Vec<Ring> {
    let number = |v: &Value| v.as_f64().expect("a coordinate");
    let point = |v: &Value| DVec2::new(number(&v[0]), number(&v[1]));
    let ring = |r: &Value| r.as_array().expect("a ring").iter().map(point).collect();
    let mut rings: Vec<Ring> = feature["geometry"]["coordinates"].as_array().expect("rings").iter().map(ring).collect();
    for r in &mut rings {
        r.pop();
    }
    for change in feature["properties"]["replace"].as_array().into_iter().flatten() {
        let at = |i: usize| change[i].as_u64().expect("an index") as usize;
        rings[at(0)][at(1)][at(2)] = change[3].as_str().expect("a value").parse().expect("NaN or Infinity");
    }
    rings
}

/// Every building of every extract.
fn real(only: Option<&str>) {
    let mut table = Table::new("extract");
    for (name, path) in extracts::files() {
        if only.is_none_or(|o| name.contains(o)) {
            table.row(&name, extracts::buildings(&path).into_iter(), &Options::default());
        }
    }
    table.close();
}

/// Generated footprints: the same for the same seed.
fn generated(count: usize, seed: u64, only: Option<&str>) {
    let shares: usize = CLASSES.iter().map(|c| c.share).sum();
    let mut table = Table::new("generated class");
    for (k, Class { name, share, make }) in CLASSES.iter().enumerate() {
        if only.is_some_and(|o| !name.contains(o)) {
            continue;
        }
        let members = (0..count * share / shares).map(|i| {
            // A stream per footprint: any one of them can be made again alone.
            let key = seed << 48 | (k as u64) << 32 | i as u64;
            (format!("{key:#x}"), make(&mut Random::new(key)))
        });
        table.row(name, members, &Options { weld: 0.0, min_area: 1e-9 });
    }
    table.close();
}
