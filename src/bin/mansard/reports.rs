//! What rules reported: the table people see and the file they ask for with `--reports`.

use std::path::{Path, PathBuf};

use mansard::dataset::reports::{SceneReports, to_csv, to_json};
use mansard::interpreter::reports::{Report, table};
use mansard::output::write_bytes;

use crate::progress::Reporter;
use crate::report::Failure;

/// Refuses a file whose name tells no format, before the work.
pub fn check(file: Option<&PathBuf>) -> Result<(), Failure> {
    let Some(file) = file else { return Ok(()) };
    match encoder(file) {
        Some(_) => Ok(()),
        None => Err(Failure::unable(format!("--reports {}: write a name that ends in .csv or .json", file.display()))),
    }
}

pub fn write(file: Option<&PathBuf>, scenes: &[SceneReports]) -> Result<(), Failure> {
    let Some((file, encode)) = file.and_then(|file| Some((file, encoder(file)?))) else { return Ok(()) };
    write_bytes(file, &encode(scenes)).map_err(|e| Failure::unable(e.to_string()))
}

/// Says the table of a scene's sums.
pub fn tell(totals: &[Report], reporter: &Reporter) {
    for line in table(totals).lines() {
        reporter.say(&format!("{:>10} {line}", ""));
    }
}

type Encoder = fn(&[SceneReports]) -> Vec<u8>;

fn encoder(file: &Path) -> Option<Encoder> {
    match file.extension()?.to_str()? {
        "csv" => Some(to_csv),
        "json" => Some(to_json),
        _ => None,
    }
}
