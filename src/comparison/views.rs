//! Views. In: what was drawn for each view on both sides, with its cameras and suns. Out: what differs, views that differ
//! alike told once.

use std::collections::BTreeMap;

use serde::Serialize;
use serde_json::Value;

use super::snapshot::{DatasetSnapshot, ViewSnapshot};

/// A drawn value, or a property of an acquisition, that differs.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrawDifference {
    pub view: String,
    /// Such as `camera.off_nadir`; `acquisition 1.position[0]` for what follows from draws.
    pub path: String,
    /// `null` where the side does not have it.
    pub a: Value,
    pub b: Value,
}

/// What differs between the views of a dataset.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ViewsDifference {
    pub dataset: String,
    pub compared: usize,
    pub removed: Vec<String>,
    pub added: Vec<String>,
    /// What was drawn.
    pub draws: Vec<DrawDifference>,
    /// What follows: cameras, suns, effects.
    pub acquisitions: Vec<DrawDifference>,
}

impl ViewsDifference {
    pub fn is_none(&self) -> bool {
        self.removed.is_empty() && self.added.is_empty() && self.draws.is_empty() && self.acquisitions.is_empty()
    }
}

/// Compares the views of a dataset.
pub fn compare_views(name: &str, a: &DatasetSnapshot, b: &DatasetSnapshot) -> ViewsDifference {
    let names = |of: &DatasetSnapshot, without: &DatasetSnapshot| {
        of.views.keys().filter(|view| !without.views.contains_key(*view)).cloned().collect()
    };
    let (removed, added) = (names(a, b), names(b, a));
    let mut out = ViewsDifference { dataset: name.to_owned(), removed, added, ..ViewsDifference::default() };
    for (view, of_a) in &a.views {
        let Some(of_b) = b.views.get(view) else { continue };
        out.compared += 1;
        out.draws.extend(differences(view, [&of_a.draws, &of_b.draws]));
        let [flat_a, flat_b] = [of_a, of_b].map(flat);
        out.acquisitions.extend(differences(view, [&flat_a, &flat_b]));
    }
    out
}

fn differences<'a>(view: &'a str, sides: [&'a BTreeMap<String, Value>; 2]) -> impl Iterator<Item = DrawDifference> {
    let [a, b] = sides;
    let mut paths: Vec<&String> = a.keys().chain(b.keys()).collect();
    paths.sort();
    paths.dedup();
    let value = |side: &BTreeMap<String, Value>, path: &str| side.get(path).cloned().unwrap_or(Value::Null);
    let one = |path: &String| DrawDifference {
        view: view.to_owned(),
        path: path.clone(),
        a: value(a, path),
        b: value(b, path),
    };
    paths.into_iter().map(one).filter(|d| d.a != d.b).collect::<Vec<_>>().into_iter()
}

fn flat(view: &ViewSnapshot) -> BTreeMap<String, Value> {
    let mut out = BTreeMap::new();
    for (number, acquisition) in view.acquisitions.iter().enumerate() {
        flatten(&format!("acquisition {}", number + 1), acquisition, &mut out);
    }
    out
}

/// The numbers and texts of a JSON value by their paths.
pub fn flatten(path: &str, value: &Value, out: &mut BTreeMap<String, Value>) {
    match value {
        Value::Object(fields) => fields.iter().for_each(|(key, inner)| {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            flatten(&path, inner, out);
        }),
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, inner)| flatten(&format!("{path}[{i}]"), inner, out));
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {
            out.insert(path.to_owned(), value.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn draws_and_what_follows_are_told_apart() {
        let view = |nadir: f64, x: f64| ViewSnapshot {
            draws: [("camera.off_nadir".to_owned(), json!(nadir))].into(),
            acquisitions: vec![json!({ "position": [x, 2.0], "images": ["a"] })],
            ..ViewSnapshot::default()
        };
        let dataset = |views: &[(&str, ViewSnapshot)]| DatasetSnapshot {
            views: views.iter().map(|(name, view)| ((*name).to_owned(), view.clone())).collect(),
            ..DatasetSnapshot::default()
        };
        let a = dataset(&[("v1", view(5.0, 1.0)), ("v2", view(5.0, 1.0))]);
        let b = dataset(&[("v1", view(6.0, 1.5)), ("v3", view(5.0, 1.0))]);
        let found = compare_views("d", &a, &b);
        assert_eq!((&found.removed[..], &found.added[..]), (&["v2".to_owned()][..], &["v3".to_owned()][..]));
        assert_eq!((found.draws.len(), found.draws[0].b.clone()), (1, json!(6.0)));
        assert_eq!(found.acquisitions[0].path, "acquisition 1.position[0]");
        assert!(compare_views("d", &a, &a).is_none());
    }
}
