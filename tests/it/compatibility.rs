//! The compatibility report of a small folder of rule files: what is told of each, and that a file that cannot be
//! parsed does not stop the others. `MANSARD_BLESS=1` writes the expected text anew.

use std::path::Path;

use mansard::cga::compatibility::{Outcome, Report, report, summary, text};
use mansard::source::{Access, SourceMap};

fn reports(folder: &Path) -> Vec<Report> {
    let access = Access::new(folder).expect("the folder of the cases exists");
    let mut files: Vec<_> =
        std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("it can be listed").path()).collect();
    files.retain(|f| f.extension().is_some_and(|e| e == "cga"));
    files.sort();
    files.iter().map(|file| report(file, &access, &mut SourceMap::default())).collect()
}

#[test]
fn a_folder_is_reported_file_by_file() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/compatibility");
    let reports = reports(&folder);
    let fares: Vec<(String, Outcome)> =
        reports.iter().map(|r| (r.file.rsplit('/').next().expect("a name").to_owned(), r.outcome())).collect();
    let expected = [
        ("lacking.cga", Outcome::Lacks),
        ("mistaken.cga", Outcome::Broken),
        ("old.cga", Outcome::Differs),
        ("plain.cga", Outcome::Runs),
        ("unparsable.cga", Outcome::Broken),
    ];
    assert_eq!(fares, expected.map(|(name, outcome)| (name.to_owned(), outcome)));
    let here = format!("{}/", folder.display());
    let got = reports.iter().map(text).collect::<String>().replace(&here, "") + &summary(&reports) + "\n";
    let path = folder.join("report.txt");
    if std::env::var_os("MANSARD_BLESS").is_some() {
        std::fs::write(&path, &got).expect("the folder of the cases can be written");
    }
    assert_eq!(std::fs::read_to_string(&path).expect("the expected report"), got);
}

#[test]
fn a_file_that_is_not_there_is_reported() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let access = Access::new(folder.path()).expect("the folder exists");
    let missing = report(&folder.path().join("none.cga"), &access, &mut SourceMap::default());
    assert_eq!(missing.outcome(), Outcome::Broken);
}
