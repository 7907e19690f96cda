//! What runs here with another result than in CityEngine. In: nothing. Out: the constructs of each difference;
//! `docs/from-cityengine.md` has a paragraph for each under its code.

use crate::cga::check::release;

pub struct Difference {
    pub code: &'static str,
    pub message: &'static str,
    /// Operations, functions and attributes concerned.
    pub names: &'static [&'static str],
    /// Whether percentages are concerned.
    pub percentages: bool,
    /// Concerns files written before this release only.
    before: Option<(u32, u32)>,
}

/// Assets in formats that are not read.
pub const ASSET_FORMATS: &str = "asset-formats";

static ALL: &[Difference] = &[
    Difference {
        code: "random-numbers",
        message: "random numbers come from another generator: the same seed gives another model",
        names: &["rand", "p", "scatter", "fileRandom", "listRandom", "seedian"],
        percentages: true,
        before: None,
    },
    Difference {
        code: "street-sides",
        message: "streets are known where the host gives widths or neighbours; without them no side is a street side",
        names: &[
            "street.front",
            "street.back",
            "street.left",
            "street.right",
            "street.side",
            "streetSide",
            "noStreetSide",
        ],
        percentages: false,
        before: None,
    },
    Difference {
        code: "split-of-extrusions",
        message: "before 2025.1 splitting an extruded block only scaled it; now the geometry is cut",
        names: &["split"],
        percentages: false,
        before: Some((2025, 1)),
    },
];

pub fn all() -> impl Iterator<Item = &'static Difference> {
    ALL.iter()
}

impl Difference {
    /// A file without a version counts as one of 2009.1 (reference 1.10).
    pub fn concerns(&self, version: Option<&str>) -> bool {
        let written = version.and_then(release).unwrap_or((2009, 1));
        self.before.is_none_or(|before| written < before)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn every_difference_has_a_paragraph() {
        let document = include_str!("../../../docs/from-cityengine.md");
        for code in super::all().map(|d| d.code).chain([super::ASSET_FORMATS]) {
            assert!(document.contains(&format!("`{code}`")), "{code}");
        }
    }
}
