//! What mesh checks found: the table people see and `NAME.validation.json` beside the output.

use std::path::Path;

use mansard::output::write_bytes;
use mansard::pipeline::Validation;

use crate::progress::Reporter;
use crate::report::Failure;

/// Features named for each defect; the file names all.
const NAMED: usize = 5;

/// Writes the file beside the output. False if something is invalid.
pub fn write_and_tell(validation: &Validation, output: &Path, reporter: &Reporter) -> Result<bool, Failure> {
    let file = output.with_extension("validation.json");
    let mut bytes = serde_json::to_vec_pretty(validation).expect("plain data is JSON");
    bytes.push(b'\n');
    write_bytes(&file, &bytes).map_err(|e| Failure::unable(e.to_string()))?;
    reporter.say(&format!(
        "{:>10} {}: {} features, {} closed bodies, {} open surfaces",
        "checked",
        validation.scene,
        validation.features.len(),
        validation.closed_bodies(),
        validation.open_surfaces()
    ));
    reporter.say(&format!("{:>10} {:<28} {:>8} {:>8}", "", "defect", "features", "findings"));
    for total in validation.totals() {
        let more = if total.features.len() > NAMED { ", …" } else { "" };
        let named = total.features[..total.features.len().min(NAMED)].join(", ");
        let line = format!("{:<28} {:>8} {:>8}  {named}{more}", total.defect, total.features.len(), total.findings);
        reporter.say(&format!("{:>10} {}", "", line.trim_end()));
    }
    Ok(validation.is_valid())
}
