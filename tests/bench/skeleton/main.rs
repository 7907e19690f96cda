//! Straight skeletons per second on one core beside CGAL's, on the same polygons in the same run. In: numbers of vertices
//! and classes. Out: a Markdown table.
//!
//! `cargo bench --bench skeleton -- [least=4] [most=64] [class=stars] [seed=1] [limit=SECONDS] [ours]`
//! `limit` ends CGAL's time on one row; `ours` leaves CGAL out.

mod cgal;
mod shapes;
mod timing;

#[path = "../geometry/random.rs"]
#[allow(dead_code, reason = "shared with another benchmark, which uses more of it")]
mod random;

use std::time::Duration;

use mansard::geometry::Polygon;

use cgal::{Cgal, Outcome};
use random::Random;
use shapes::{Shape, circle, comb, plan, rectangle, star};
use timing::{Timing, ours};

// The program's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Polygons of one class and size.
struct Row {
    n: usize,
    class: &'static str,
    make: Shape,
    count: usize,
}

const fn row(n: usize, class: &'static str, make: Shape, count: usize) -> Row {
    Row { n, class, make, count }
}

const ROWS: &[Row] = &[
    row(4, "rectangles", rectangle, 1000),
    row(8, "plans", plan, 1000),
    row(8, "stars", star, 1000),
    row(12, "plans", plan, 500),
    row(12, "stars", star, 500),
    row(20, "plans", plan, 200),
    row(20, "stars", star, 200),
    row(30, "plans", plan, 100),
    row(30, "stars", star, 100),
    row(64, "plans", plan, 20),
    row(64, "stars", star, 20),
    row(1_000, "circle", circle, 1),
    row(1_000, "comb", comb, 1),
    row(1_000, "plans", plan, 1),
    row(1_000, "stars", star, 1),
    row(10_000, "circle", circle, 1),
    row(10_000, "comb", comb, 1),
    row(10_000, "plans", plan, 1),
    row(10_000, "stars", star, 1),
];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let value = |key: &str| arguments.iter().find_map(|a| a.strip_prefix(key)?.strip_prefix('='));
    let number = |key: &str| value(key).map(|v| v.parse::<u64>().expect("a number"));
    let (seed, limit) = (number("seed").unwrap_or(1), Duration::from_secs(number("limit").unwrap_or(120)));
    let cgal = if arguments.iter().any(|a| a == "ours") { Err("left out".to_owned()) } else { Cgal::build() };
    match &cgal {
        Ok(cgal) => println!("CGAL {}, at most {} s a row\n", cgal.version, limit.as_secs()),
        Err(why) => println!("CGAL: {why}\n"),
    }
    println!(
        "| n | class | polygons | best µs | median µs | per second | CGAL best µs | CGAL median µs | CGAL per second | ratio |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for row in ROWS {
        let wanted = (number("least").unwrap_or(0)..=number("most").unwrap_or(u64::MAX)).contains(&(row.n as u64))
            && value("class").is_none_or(|c| c == row.class);
        if wanted {
            print_row(row, seed, cgal.as_ref().ok(), limit);
        }
    }
}

fn print_row(row: &Row, seed: u64, cgal: Option<&Cgal>, limit: Duration) {
    let polygon = |k: usize| {
        let outer = (row.make)(&mut Random::new(seed << 48 | (row.n as u64) << 32 | k as u64), row.n);
        assert_eq!(outer.len(), row.n, "{}", row.class);
        Polygon { outer, holes: Vec::new() }
    };
    let polygons: Vec<Polygon> = (0..row.count).map(polygon).collect();
    let ours = ours(&polygons);
    let theirs = match cgal {
        Some(cgal) => cgal.run(&polygons, limit),
        None => Outcome::Missing,
    };
    let micros = |d: f64| format!("{:.2}", d * 1e6);
    let Timing { best, median, height } = ours;
    let start = format!("| {} | {} | {} | {} | {} |", row.n, row.class, row.count, micros(best), micros(median));
    let rest = match theirs {
        Outcome::Missing => "not run | | | |".to_owned(),
        Outcome::Cut { least } => {
            format!("over {} | | under {} | over {:.0} |", micros(least), per_second(least), least / best)
        }
        Outcome::Broke(why) => format!("{why} | | | |"),
        Outcome::Done { timing, failed } => {
            let failures = if failed > 0 { format!(" ({failed} without result)") } else { String::new() };
            let apart =
                if failed == 0 && (timing.height - height).abs() > 1e-6 * height { " (heights differ)" } else { "" };
            let (best_theirs, median) = (micros(timing.best), micros(timing.median));
            let ratio = timing.best / best;
            format!("{best_theirs}{failures}{apart} | {median} | {} | {ratio:.1} |", per_second(timing.best))
        }
    };
    println!("{start} {} | {rest}", per_second(best));
}

/// Polygons per second, from the seconds of one.
fn per_second(seconds: f64) -> String {
    if seconds > 0.1 { format!("{:.2}", 1.0 / seconds) } else { format!("{:.0}", 1.0 / seconds) }
}
