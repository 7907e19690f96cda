//! Derivations for code lenses. In: a rule file and unsaved texts. Out: [`Lenses`]: how often each rule ran in the last
//! derivation, and how many leaves it left.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Instant;

use glam::DVec3;
use lsp_server::RequestId;

use super::uri;
use crate::cga::{self, CompileOptions};
use crate::diagnostics::Severity;
use crate::geometry::{Face, Mesh};
use crate::interpreter::seed::Seed;
use crate::interpreter::{FileAssets, Limits, StartShape, derive};
use crate::source::{Access, Overlay, SourceMap};

/// What a derivation counted, by the rule's name where it is declared.
#[derive(Clone, Debug, Default)]
pub struct Lenses {
    pub counts: BTreeMap<Rule, Count>,
    /// What was derived, such as `a lot of 10 m × 8 m`.
    pub subject: String,
}

/// A rule, whatever is written above it meanwhile.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rule {
    pub path: PathBuf,
    pub name: String,
    pub parameters: usize,
}

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    pub leaves: u64,
    /// Of the whole derivation, where the rule is its first.
    pub milliseconds: Option<f64>,
}

/// A derivation that another thread runs.
pub struct Work {
    pub rules: PathBuf,
    pub access: Access,
    pub overlay: Overlay,
}

/// What came of it; `id` is the request that waits for it.
pub struct Derived {
    pub id: Option<RequestId>,
    /// The counts and one line for the user, or why there are none.
    pub outcome: Result<(Lenses, String), String>,
}

/// The lot that a rule file is derived on where no recipe uses it, metres.
const LOT: (f64, f64) = (10.0, 8.0);

impl Work {
    /// Derives; takes as long as the rules do, within their limits.
    pub fn run(self) -> Derived {
        Derived { id: None, outcome: self.on_lot() }
    }

    /// As `mansard dump tree` does it.
    fn on_lot(&self) -> Result<(Lenses, String), String> {
        let access = self.access.clone().with_overlay(&self.overlay);
        let mut sources = SourceMap::default();
        let (program, diagnostics) = cga::compile(&self.rules, &access, &mut sources, &CompileOptions::default());
        let errors = |d: &crate::diagnostics::Diagnostics| {
            d.iter().find(|d| d.severity == Severity::Error).map(|d| d.message.clone())
        };
        let Some(program) = program else {
            return Err(errors(&diagnostics).unwrap_or_else(|| "the rules cannot be read".to_owned()));
        };
        let (x, z) = LOT;
        let positions = [(0.0, 0.0), (x, 0.0), (x, -z), (0.0, -z)].map(|(x, z)| DVec3::new(x, 0.0, z)).to_vec();
        let mesh = Mesh { positions, faces: vec![Face::new(vec![0, 1, 2, 3])] };
        let start = StartShape::new(mesh, Seed::root(0), "footprint");
        let begun = Instant::now();
        let tree = derive(&program, &start, &FileAssets::new(access.clone()), &Limits::default());
        let milliseconds = begun.elapsed().as_secs_f64() * 1000.0;
        if let Some(message) = errors(&tree.diagnostics) {
            return Err(message);
        }
        let path_of = |span: crate::source::Span| {
            let name = &sources.get(span.source).name;
            uri::real(&access.root().join(&**name))
        };
        let mut lenses = Lenses { counts: BTreeMap::new(), subject: format!("a lot of {x} m × {z} m") };
        for (number, rule) in program.rules().iter().enumerate() {
            let leaves = tree.leaves.iter().filter(|leaf| leaf.rule == rule.name).count() as u64;
            let is_first = program.start_rules().first().is_some_and(|id| id.0 as usize == number);
            let key = Rule::new(path_of(rule.span), &rule.name, rule.parameters.len());
            let count = lenses.counts.entry(key).or_default();
            count.leaves += leaves;
            if is_first {
                count.milliseconds = Some(milliseconds);
            }
        }
        let summary = format!("{} leaves in {milliseconds:.0} ms", grouped(tree.leaves.len() as u64));
        Ok((lenses, summary))
    }
}

impl Rule {
    /// `name` with or without import prefixes.
    pub fn new(path: PathBuf, name: &str, parameters: usize) -> Rule {
        Rule { path, name: super::symbols::last_part(name).to_owned(), parameters }
    }
}

/// `1,204`.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::grouped;

    #[test]
    fn numbers_are_grouped_by_thousands() {
        assert_eq!([0, 999, 1204, 1_234_567].map(grouped), ["0", "999", "1,204", "1,234,567"]);
    }
}
