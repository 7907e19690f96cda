//! CGAL's straight skeleton in a process of its own. In: polygons. Out: its times, or why there are none.

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use mansard::geometry::Polygon;

use crate::timing::{ROUNDS, SECONDS, Timing};

const SOURCE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/bench/cgal/straight_skeleton.cpp");

/// The compiled program.
pub struct Cgal {
    pub version: String,
    program: PathBuf,
    folder: tempfile::TempDir,
}

pub enum Outcome {
    /// `failed` polygons got no skeleton.
    Done {
        timing: Timing,
        failed: usize,
    },
    /// Not one round ended in time: one polygon takes longer than `least` seconds on average.
    Cut {
        least: f64,
    },
    Broke(String),
    Missing,
}

impl Cgal {
    /// Compile the program; the error says what is missing.
    pub fn build() -> Result<Cgal, String> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let program = folder.path().join("straight_skeleton");
        let compiled = Command::new("g++")
            .args(["-O2", "-DNDEBUG", SOURCE, "-o"])
            .arg(&program)
            .args(["-lgmp", "-lmpfr"])
            .output();
        let compiled = compiled.map_err(|e| format!("not installed (g++: {e})"))?;
        if !compiled.status.success() {
            let words = String::from_utf8_lossy(&compiled.stderr);
            let first = words.lines().find(|l| l.contains("error")).unwrap_or("g++ failed").to_owned();
            return Err(format!("not installed ({first})"));
        }
        let version = Command::new(&program).arg("--version").output().map_err(|e| format!("not installed ({e})"))?;
        let version = String::from_utf8_lossy(&version.stdout).trim().to_owned();
        Ok(Cgal { version, program, folder })
    }

    /// Time it on `polygons`; it is stopped after `limit`.
    pub fn run(&self, polygons: &[Polygon], limit: Duration) -> Outcome {
        let file = self.folder.path().join("polygons.txt");
        std::fs::write(&file, text(polygons)).expect("the temporary folder can be written");
        let start = Instant::now();
        let arguments = [ROUNDS.to_string(), SECONDS.to_string()];
        let mut child = Command::new(&self.program)
            .arg(&file)
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program has just been compiled");
        let out = child.stdout.take().expect("piped");
        let reader = std::thread::spawn(move || BufReader::new(out).lines().map_while(Result::ok).collect::<Vec<_>>());
        let status = loop {
            if let Some(status) = child.try_wait().expect("it can be waited for") {
                break Some(status);
            }
            if start.elapsed() > limit {
                child.kill().and_then(|()| child.wait()).expect("it can be stopped");
                break None;
            }
            std::thread::sleep(Duration::from_millis(20));
        };
        let lines = reader.join().expect("lines are read without fault");
        match rounds(&lines, polygons.len()) {
            Some(done) => done,
            None if status.is_none() => Outcome::Cut { least: limit.as_secs_f64() / polygons.len() as f64 },
            None => Outcome::Broke(format!("ended with {}", status.expect("it ended by itself"))),
        }
    }
}

/// One polygon a line: the number of its vertices and their coordinates, to the last bit.
fn text(polygons: &[Polygon]) -> Vec<u8> {
    let mut text = Vec::new();
    for polygon in polygons {
        write!(text, "{}", polygon.outer.len()).expect("memory can be written");
        for p in &polygon.outer {
            write!(text, " {} {}", p.x, p.y).expect("memory can be written");
        }
        text.push(b'\n');
    }
    text
}

/// What the program printed, if a round ended.
fn rounds(lines: &[String], polygons: usize) -> Option<Outcome> {
    let numbers = |line: &String| -> Option<(f64, f64)> {
        let (seconds, height) = line.split_once(' ')?;
        Some((seconds.parse().ok()?, height.parse().ok()?))
    };
    let (seconds, heights): (Vec<f64>, Vec<f64>) = lines.iter().map_while(numbers).unzip();
    let failed = heights.iter().take(polygons).filter(|h| **h < 0.0).count();
    let timing = Timing::of_rounds(&seconds, polygons, heights.iter().take(polygons).sum())?;
    Some(Outcome::Done { timing, failed })
}
