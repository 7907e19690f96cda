//! `mansard fmt`: rule files in the house layout.

use std::io::Read;
use std::path::{Path, PathBuf};

use mansard::cga;
use mansard::diagnostics::Diagnostics;
use mansard::output::write_bytes;
use mansard::parsing::decode;
use mansard::source::{MOST_TEXT_BYTES, SourceFile, SourceMap, read_regular};

use crate::report::{self, Failure};

/// Formats files in place, or standard input to standard output. Files with syntax errors stay as they are; with `check`
/// all do, and those that would change are named.
pub fn run(files: &[PathBuf], check: bool, stdin: bool, quiet: bool) -> Result<(), Failure> {
    let mut sources = SourceMap::default();
    let mut wrong = Diagnostics::default();
    let mut failed: Option<u8> = None;
    let standard_input = stdin.then(|| PathBuf::from("-"));
    for path in files.iter().chain(&standard_input) {
        match format(path, check, &mut sources, &mut wrong) {
            Ok(true) => {}
            Ok(false) => failed = failed.max(Some(crate::WRONG)),
            Err(failure) => {
                failed = failed.max(Some(failure.code));
                failure.tell();
            }
        }
    }
    report::print(&wrong, &sources, quiet);
    match failed {
        Some(code) => Err(Failure { code, message: None }),
        None if wrong.has_errors() => Err(Failure::said()),
        None => Ok(()),
    }
}

/// Whether the file is in order now.
fn format(path: &Path, check: bool, sources: &mut SourceMap, wrong: &mut Diagnostics) -> Result<bool, Failure> {
    let is_input = path == Path::new("-");
    let bytes = if is_input { standard_input()? } else { read(path)? };
    let name = if is_input { "standard input".to_owned() } else { path.display().to_string() };
    let file: SourceFile = sources.add(name, decode(&bytes).text);
    let text = match cga::format(&file) {
        Ok(text) => text,
        Err(diagnostics) => {
            wrong.extend(diagnostics);
            return Ok(true);
        }
    };
    if check {
        let in_order = text.as_bytes() == bytes;
        if !in_order {
            report::out(&format!("{}\n", file.name))?;
        }
        return Ok(in_order);
    }
    if is_input {
        report::out(&text)?;
    } else if text.as_bytes() != bytes {
        // A link stays a link.
        let real = path.canonicalize().map_err(|e| Failure::wrong(format!("{}: {e}", path.display())))?;
        write_bytes(&real, text.as_bytes()).map_err(|e| Failure::unable(e.to_string()))?;
    }
    Ok(true)
}

fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    if path.extension().is_none_or(|extension| extension != "cga") {
        return Err(Failure::unable(format!("{}: not a .cga file", path.display())));
    }
    read_regular(path, MOST_TEXT_BYTES).map_err(|e| Failure::wrong(e.to_string()))
}

fn standard_input() -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let read = std::io::stdin().lock().take(MOST_TEXT_BYTES).read_to_end(&mut bytes);
    read.map_err(|e| Failure::unable(format!("standard input: {e}")))?;
    Ok(bytes)
}
