//! A sweep → `cost.csv`: one line per setting.

use crate::cost::errors::{Errors, Metric};
use crate::cost::sweep::Sweep;

/// Names of the columns.
pub fn header() -> Vec<String> {
    let fixed = ["kind", "knob", "value", "antialiasing", "shadow_map", "shadow_samples", "sky_samples", "field_map"];
    let times = ["time_ms", "time_least_ms", "time_most_ms", "repeats", "passes_ms"];
    let errors = Metric::ALL.map(column);
    let alone = Metric::ALL.map(|metric| format!("{}_alone", column(metric)));
    let frontier = Metric::ALL.map(|metric| format!("frontier_{}", column(metric)));
    let fixed = fixed.iter().chain(&times).map(|name| (*name).to_owned());
    fixed
        .chain(errors)
        .chain(["wrong_label_pixels".to_owned(), "truth_error".to_owned()])
        .chain(alone)
        .chain(frontier)
        .chain(["frontier".to_owned()])
        .collect()
}

fn column(metric: Metric) -> String {
    if metric == Metric::Shadow { "shadow_iou".to_owned() } else { metric.key().to_owned() }
}

/// The file's bytes.
pub fn to_csv(sweep: &Sweep) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(header()).expect("memory takes everything");
    let mut frontiers = Metric::ALL.map(|metric| sweep.frontier(metric)).to_vec();
    frontiers.push(sweep.joint_frontier());
    for (number, row) in sweep.rows.iter().enumerate() {
        let q = &row.setting.quality;
        let samples = q.supersample * q.supersample;
        let mut line = vec![row.kind.name().to_owned(), row.knob.to_owned(), row.value.clone()];
        line.extend([samples, q.shadow_map, q.shadow_samples, q.sky_samples, q.field_map].map(|n| n.to_string()));
        line.extend([row.times.median, row.times.least, row.times.most].map(|ms| format!("{ms:.3}")));
        line.push(row.times.repeats.to_string());
        let passes = row.times.passes.iter().map(|(pass, ms)| format!("{pass} {ms:.3}"));
        line.push(passes.collect::<Vec<_>>().join("; "));
        line.extend(values(Some(&row.errors)));
        line.extend([row.errors.differing.to_string(), format!("{:.6}", row.errors.noise)]);
        line.extend(values(row.alone.as_ref()));
        line.extend(frontiers.iter().map(|on| u8::from(on[number]).to_string()));
        writer.write_record(line).expect("memory takes everything");
    }
    writer.into_inner().expect("memory takes everything")
}

/// Empty where there is nothing to measure.
fn values(errors: Option<&Errors>) -> [String; 6] {
    Metric::ALL.map(|metric| {
        let value = errors.and_then(|errors| errors.get(metric));
        let value = if metric == Metric::Shadow { value.map(|miss| 1.0 - miss) } else { value };
        value.map_or(String::new(), |value| format!("{value:.6}"))
    })
}
