//! A material as texts. In: an [`Appearance`]. Out: names (without `material.`) and values, as `setMaterial` takes them.

use std::sync::Arc;

use super::{Appearance, name_of};
use crate::cga::builtins::{Attr, MaterialAttr};

impl Appearance {
    /// What was set explicitly, in the order of the table of attributes.
    pub fn pairs(&self) -> Vec<(Arc<str>, Arc<str>)> {
        let pair = |attr| Some((name_of(attr).into(), self.get(attr)?.to_text()));
        attributes().filter_map(pair).collect()
    }

    /// Every attribute, with its default where it was not set.
    pub fn all_pairs(&self) -> Vec<(Arc<str>, Arc<str>)> {
        let value = |attr| self.get(attr).unwrap_or_else(|| Appearance::default_value(attr)).to_text();
        attributes().map(|attr| (name_of(attr).into(), value(attr))).collect()
    }
}

/// Every attribute once: colours by their channels.
fn attributes() -> impl Iterator<Item = MaterialAttr> {
    Attr::table().filter(|row| !row.deprecated).filter_map(|row| match row.attr {
        Attr::Material(attr) if attr != MaterialAttr::ColorRgb => Some(attr),
        _ => None,
    })
}
