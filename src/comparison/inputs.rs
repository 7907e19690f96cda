//! Inputs. In: what both sides were made of, by content. Out: what came, went, was changed or only renamed.

use std::collections::BTreeMap;

use serde::Serialize;

use super::rules::Fate;
use super::snapshot::{InputSnapshot, Snapshot};

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct InputDifference {
    pub role: String,
    pub name: String,
    /// In A, where it has another name there.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub was: Option<String>,
    /// `None`: renamed only, which is no difference.
    pub fate: Option<Fate>,
    pub sha256_a: Option<String>,
    pub sha256_b: Option<String>,
}

/// The recipe itself is the same input on both sides, whatever its file is called.
const MAIN: &str = "";

/// Compares inputs by where they lie below their recipe's folder, or by name where that is not known.
pub fn compare_inputs(a: &Snapshot, b: &Snapshot) -> Vec<InputDifference> {
    let placed = a.inputs.iter().chain(&b.inputs).any(|input| input.path.is_some());
    let [of_a, of_b] = [a, b].map(|side| by_key(side, placed));
    let mut out = Vec::new();
    let (mut gone, mut new) = (Vec::new(), Vec::new());
    for (key, input) in &of_a {
        match of_b.get(key) {
            None => gone.push(*input),
            Some(other) if other.sha256 == input.sha256 => {
                if other.name != input.name {
                    out.push(difference(Some(input), Some(other), None));
                }
            }
            Some(other) => out.push(difference(Some(input), Some(other), Some(Fate::Changed))),
        }
    }
    new.extend(of_b.iter().filter(|(key, _)| !of_a.contains_key(*key)).map(|(_, input)| *input));
    for input in gone {
        let same = |other: &&InputSnapshot| other.role == input.role && other.sha256 == input.sha256;
        match new.iter().position(same) {
            Some(at) => out.push(difference(Some(input), Some(new.remove(at)), None)),
            None => out.push(difference(Some(input), None, Some(Fate::Removed))),
        }
    }
    out.extend(new.into_iter().map(|input| difference(None, Some(input), Some(Fate::Added))));
    out.sort_by(|x, y| (x.fate.is_none(), &x.role, &x.name).cmp(&(y.fate.is_none(), &y.role, &y.name)));
    out
}

fn by_key(side: &Snapshot, placed: bool) -> BTreeMap<(&str, &str), &InputSnapshot> {
    side.inputs.iter().map(|input| (key_of(side, input, placed), input)).collect()
}

fn key_of<'a>(side: &Snapshot, input: &'a InputSnapshot, placed: bool) -> (&'a str, &'a str) {
    let is_main = input.role == "recipe" && Some(&input.name) == side.recipe.as_ref();
    let path = input.path.as_deref().filter(|_| placed).unwrap_or(&input.name);
    (&input.role, if is_main { MAIN } else { path })
}

fn difference(a: Option<&InputSnapshot>, b: Option<&InputSnapshot>, fate: Option<Fate>) -> InputDifference {
    let input = b.or(a).expect("an input has a side");
    let was = a.filter(|a| a.name != input.name).map(|a| a.name.clone());
    let sha256 = |side: Option<&InputSnapshot>| side.map(|input| input.sha256.clone());
    let (role, name) = (input.role.clone(), input.name.clone());
    InputDifference { role, name, was, fate, sha256_a: sha256(a), sha256_b: sha256(b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn side(recipe: &str, inputs: &[(&str, &str, &str)]) -> Snapshot {
        let input = |(role, path, sha256): &(&str, &str, &str)| InputSnapshot {
            role: (*role).to_owned(),
            name: path.rsplit('/').next().unwrap_or(path).to_owned(),
            path: Some((*path).to_owned()),
            sha256: (*sha256).to_owned(),
        };
        let inputs = inputs.iter().map(input).collect();
        Snapshot { recipe: Some(recipe.to_owned()), inputs, ..Snapshot::default() }
    }

    #[test]
    fn inputs_are_paired_by_place_and_then_by_content() {
        let a = side(
            "a.render",
            &[
                ("recipe", "a.render", "1"),
                ("map", "x/town.osm", "2"),
                ("map", "y/town.osm", "3"),
                ("elevation", "old.tif", "4"),
                ("rules", "gone.cga", "5"),
            ],
        );
        let b = side(
            "b.render",
            &[
                ("recipe", "b.render", "1"),
                ("map", "x/town.osm", "2"),
                ("map", "y/town.osm", "33"),
                ("elevation", "new.tif", "4"),
                ("rules", "come.cga", "6"),
            ],
        );
        let found = compare_inputs(&a, &b);
        let told: Vec<_> = found.iter().map(|d| (d.name.as_str(), d.was.as_deref(), d.fate)).collect();
        let expected = [
            ("town.osm", None, Some(Fate::Changed)),
            ("come.cga", None, Some(Fate::Added)),
            ("gone.cga", None, Some(Fate::Removed)),
            ("new.tif", Some("old.tif"), None),
            ("b.render", Some("a.render"), None),
        ];
        assert_eq!(told, expected);
        assert_eq!(compare_inputs(&a, &a), []);
    }
}
