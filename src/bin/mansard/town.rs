//! `mansard town`: a fictional town as map and elevation files.

use std::path::Path;

use mansard::pipeline::Progress;
use mansard::town::write_town;

use crate::progress::Reporter;
use crate::report::Failure;

pub fn run(seed: u64, buildings: u32, folder: &Path, name: &str, reporter: &Reporter) -> Result<(), Failure> {
    if name.is_empty() || name.contains(['/', '\\']) {
        return Err(Failure::unable(format!("`{name}` is not a file name")));
    }
    reporter.begin("town", Some(buildings.into()));
    match write_town(seed, buildings, folder, name, &|count| reporter.step(count)) {
        Ok(files) => {
            reporter.end(&format!("{buildings} buildings"));
            for file in files {
                reporter.say(&format!("wrote {}", file.display()));
            }
            Ok(())
        }
        Err(error) => Err(Failure::unable(error.to_string())),
    }
}
