//! What `report` collects (reference 4.17). In: keys and values in the order of their reporting. Out: statistics per key
//! and type, sums of groups, and a table of both for people.
//!
//! Dots in keys make groups: `area.*` is everything reported under `area.facade`, `area.roof` and so on. Reports of
//! shapes that end in `NIL` count like others.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Arc;

use super::value::{Value, format_float};

/// What was reported under a key: values of different types are told apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ReportKind {
    Float,
    Bool,
    String,
    /// All floats below a key.
    Group,
}

impl ReportKind {
    pub fn name(self) -> &'static str {
        match self {
            ReportKind::Float => "float",
            ReportKind::Bool => "bool",
            ReportKind::String => "string",
            ReportKind::Group => "group",
        }
    }
}

/// Statistics of one key and type. A bool counts as 0 or 1, a text as the number it begins with, or 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Of a group with `.*` at the end.
    pub name: Arc<str>,
    pub kind: ReportKind,
    /// At least 1.
    pub count: u64,
    pub sum: f64,
    pub min: f64,
    pub max: f64,
}

impl Report {
    pub fn average(&self) -> f64 {
        self.sum / self.count as f64
    }

    fn join(&mut self, other: &Report) {
        self.count += other.count;
        self.sum += other.sum;
        self.min = self.min.min(other.min);
        self.max = self.max.max(other.max);
    }
}

/// Reports by key and type. Sums depend on the order of joining, so features are joined in theirs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reports(BTreeMap<(Arc<str>, ReportKind), Report>);

impl Reports {
    /// Adds one value; `x` is its number.
    pub fn add(&mut self, name: Arc<str>, value: &Value, x: f64) {
        let kind = match value {
            Value::Bool(_) => ReportKind::Bool,
            Value::String(_) => ReportKind::String,
            _ => ReportKind::Float,
        };
        self.join(&Report { name, kind, count: 1, sum: x, min: x, max: x });
    }

    /// Joins what another shape or feature reported.
    pub fn merge(&mut self, others: &[Report]) {
        others.iter().for_each(|report| self.join(report));
    }

    fn join(&mut self, report: &Report) {
        match self.0.get_mut(&(report.name.clone(), report.kind)) {
            Some(known) => known.join(report),
            None => drop(self.0.insert((report.name.clone(), report.kind), report.clone())),
        }
    }

    /// Sorted by name, then by type.
    pub fn into_list(self) -> Vec<Report> {
        self.0.into_values().collect()
    }
}

/// The sums of every group of keys, sorted by name.
pub fn groups(reports: &[Report]) -> Vec<Report> {
    let mut sums = Reports::default();
    for report in reports.iter().filter(|r| r.kind == ReportKind::Float) {
        for (dot, _) in report.name.match_indices('.') {
            let name = format!("{}.*", &report.name[..dot]).into();
            sums.join(&Report { name, kind: ReportKind::Group, ..report.clone() });
        }
    }
    sums.into_list()
}

/// Groups and reports in columns, one per line; "" without reports.
pub fn table(reports: &[Report]) -> String {
    if reports.is_empty() {
        return String::new();
    }
    let mut rows: Vec<Report> = groups(reports).into_iter().chain(reports.iter().cloned()).collect();
    // A group stands before its members.
    rows.sort_by(|a, b| {
        let key = |r: &Report| r.name.strip_suffix('*').unwrap_or(&r.name).to_owned();
        key(a).cmp(&key(b)).then(a.kind.cmp(&b.kind))
    });
    let heading = ["report", "type", "count", "sum", "average", "min", "max"].map(str::to_owned).to_vec();
    let cells = |r: &Report| {
        let numbers = [r.sum, r.average(), r.min, r.max].map(short);
        let words = [r.name.to_string(), r.kind.name().to_owned(), r.count.to_string()];
        words.into_iter().chain(numbers).collect::<Vec<_>>()
    };
    let lines: Vec<Vec<String>> = std::iter::once(heading).chain(rows.iter().map(cells)).collect();
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
    let mut out = String::new();
    for line in &lines {
        for (column, (cell, &width)) in line.iter().zip(&widths).enumerate() {
            let written = match column {
                0 | 1 => write!(out, "{cell:<width$}  "),
                _ if column + 1 == line.len() => writeln!(out, "{cell:>width$}"),
                _ => write!(out, "{cell:>width$}  "),
            };
            written.expect("writing to a string cannot fail");
        }
    }
    out
}

/// Three decimals are enough to read.
fn short(x: f64) -> String {
    let rounded = (x * 1000.0).round() / 1000.0;
    format_float(if rounded == 0.0 || !rounded.is_finite() { x } else { rounded })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reported(values: &[(&str, f64)]) -> Vec<Report> {
        let mut reports = Reports::default();
        values.iter().for_each(|&(name, x)| reports.add(name.into(), &Value::Float(x), x));
        reports.into_list()
    }

    #[test]
    fn groups_add_up_what_lies_below() {
        let reports =
            reported(&[("area", 5.0), ("area.roof", 10.0), ("area.wall.north", 2.0), ("area.wall.south", 4.0)]);
        let sums: Vec<(String, u64, f64, f64)> =
            groups(&reports).iter().map(|g| (g.name.to_string(), g.count, g.sum, g.max)).collect();
        assert_eq!(sums, [("area.*".to_owned(), 3, 16.0, 10.0), ("area.wall.*".to_owned(), 2, 6.0, 4.0)]);
    }

    #[test]
    fn types_are_told_apart_and_parts_are_joined() {
        let mut reports = Reports::default();
        reports.add("a".into(), &Value::Bool(true), 1.0);
        reports.add("a".into(), &Value::Float(3.0), 3.0);
        let first = reports.clone().into_list();
        reports.merge(&first);
        let list = reports.into_list();
        assert_eq!(
            list.iter().map(|r| (r.kind.name(), r.count, r.sum)).collect::<Vec<_>>(),
            [("float", 2, 6.0), ("bool", 2, 2.0)]
        );
    }

    #[test]
    fn a_table_has_columns() {
        let reports = reported(&[("area.roof", 10.0), ("area.wall", 2.0), ("area.wall", 1.0), ("volume", 1.0 / 3.0)]);
        let expected = "\
report     type   count    sum  average    min    max
area.*     group      3     13    4.333      1     10
area.roof  float      1     10       10     10     10
area.wall  float      2      3      1.5      1      2
volume     float      1  0.333    0.333  0.333  0.333
";
        assert_eq!(table(&reports), expected);
        assert_eq!(table(&[]), "");
    }
}
