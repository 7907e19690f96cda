//! In: a feature's class, tags and id. Out: whether a filter of the recipe takes it.

use crate::geodata::feature::{FeatureClass, FeatureId, ObjectKind, Tags};

/// Features, as in `building[house | garage], way/123`: those that at least one term takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Filter {
    pub terms: Vec<FilterTerm>,
}

/// One term of a [`Filter`].
#[derive(Clone, Debug, PartialEq)]
pub enum FilterTerm {
    /// A class (`None` for `all`) and what its tags must hold.
    Class { class: Option<FeatureClass>, tags: Option<TagTest> },
    /// All parts of one map object.
    Object { kind: ObjectKind, id: i64 },
}

/// A test of tags.
#[derive(Clone, Debug, PartialEq)]
pub enum TagTest {
    Any(Vec<TagTest>),
    All(Vec<TagTest>),
    Not(Box<TagTest>),
    /// The tag is there.
    Has(String),
    /// The class's own tag (such as `building=…`) has this value.
    Kind(String),
    /// The tag has this value.
    Is {
        tag: String,
        value: String,
    },
    /// The tag is there, is a number (a unit of length is understood) and compares so.
    Compares {
        tag: String,
        order: Order,
        value: f64,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Filter {
    /// The filter that takes everything.
    pub fn all() -> Self {
        Filter { terms: vec![FilterTerm::Class { class: None, tags: None }] }
    }

    /// Whether a feature is taken.
    pub fn matches(&self, class: FeatureClass, tags: &Tags, id: FeatureId) -> bool {
        self.terms.iter().any(|term| match term {
            FilterTerm::Class { class: wanted, tags: test } => {
                wanted.is_none_or(|wanted| covers(wanted, class))
                    && test.as_ref().is_none_or(|test| test.holds(class, tags))
            }
            FilterTerm::Object { kind, id: wanted } => *kind == id.kind && *wanted == id.id,
        })
    }
}

/// `building` takes building parts too; `building_part` takes only those.
pub fn covers(wanted: FeatureClass, class: FeatureClass) -> bool {
    wanted == class || (wanted == FeatureClass::Building && class == FeatureClass::BuildingPart)
}

impl TagTest {
    fn holds(&self, class: FeatureClass, tags: &Tags) -> bool {
        let get = |tag: &str| tags.get(tag).map(|value| &**value);
        match self {
            TagTest::Any(tests) => tests.iter().any(|test| test.holds(class, tags)),
            TagTest::All(tests) => tests.iter().all(|test| test.holds(class, tags)),
            TagTest::Not(test) => !test.holds(class, tags),
            TagTest::Has(tag) => get(tag).is_some(),
            TagTest::Kind(value) => own_tags(class).iter().any(|tag| get(tag) == Some(value)),
            TagTest::Is { tag, value } => get(tag) == Some(value),
            TagTest::Compares { tag, order, value } => {
                get(tag).and_then(leading_number).is_some_and(|number| match order {
                    Order::Less => number < *value,
                    Order::LessOrEqual => number <= *value,
                    Order::Greater => number > *value,
                    Order::GreaterOrEqual => number >= *value,
                })
            }
        }
    }
}

/// Class names of the recipe language.
pub const CLASSES: [(&str, FeatureClass); 7] = [
    ("building", FeatureClass::Building),
    ("building_part", FeatureClass::BuildingPart),
    ("highway", FeatureClass::Highway),
    ("landuse", FeatureClass::Landuse),
    ("natural", FeatureClass::Natural),
    ("leisure", FeatureClass::Leisure),
    ("water", FeatureClass::Water),
];

/// The class of a name.
pub fn class_named(name: &str) -> Option<FeatureClass> {
    CLASSES.iter().find(|(known, _)| *known == name).map(|(_, class)| *class)
}

/// The tags whose value says what kind of its class a feature is.
pub fn own_tags(class: FeatureClass) -> &'static [&'static str] {
    match class {
        FeatureClass::Building => &["building"],
        FeatureClass::BuildingPart => &["building:part", "building"],
        FeatureClass::Highway => &["highway"],
        FeatureClass::Landuse => &["landuse"],
        FeatureClass::Natural => &["natural"],
        FeatureClass::Leisure => &["leisure"],
        FeatureClass::Water => &["water", "waterway", "natural", "landuse"],
    }
}

/// The number of a tag value such as `14`, `14.5 m`, `12'` or `40 ft`, in metres where it is a length.
fn leading_number(value: &str) -> Option<f64> {
    let value = value.trim();
    let end = value.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+'))).unwrap_or(value.len());
    let number: f64 = value[..end].parse().ok()?;
    match value[end..].trim() {
        "" | "m" => Some(number),
        "ft" | "'" => Some(number * 0.3048),
        "km" => Some(number * 1000.0),
        "cm" => Some(number * 0.01),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tags(pairs: &[(&str, &str)]) -> Tags {
        pairs.iter().map(|(k, v)| ((*k).into(), (*v).into())).collect()
    }

    fn id(id: i64) -> FeatureId {
        FeatureId { kind: ObjectKind::Way, id, part: 0 }
    }

    fn class(class: FeatureClass, test: Option<TagTest>) -> Filter {
        Filter { terms: vec![FilterTerm::Class { class: Some(class), tags: test }] }
    }

    #[test]
    fn a_building_filter_takes_parts_but_not_the_other_way_round() {
        let (building, part) = (FeatureClass::Building, FeatureClass::BuildingPart);
        assert!(class(building, None).matches(part, &tags(&[]), id(1)));
        assert!(!class(part, None).matches(building, &tags(&[]), id(1)));
        assert!(!class(building, None).matches(FeatureClass::Highway, &tags(&[]), id(1)));
    }

    #[test]
    fn tag_tests_combine() {
        let test = TagTest::All(vec![
            TagTest::Any(vec![TagTest::Kind("house".into()), TagTest::Kind("garage".into())]),
            TagTest::Not(Box::new(TagTest::Has("ruins".into()))),
            TagTest::Compares { tag: "height".into(), order: Order::GreaterOrEqual, value: 12.0 },
        ]);
        let filter = class(FeatureClass::Building, Some(test));
        let matches = |t: &[(&str, &str)]| filter.matches(FeatureClass::Building, &tags(t), id(1));
        assert!(matches(&[("building", "house"), ("height", "12 m")]));
        assert!(matches(&[("building", "garage"), ("height", "40 ft")]));
        assert!(!matches(&[("building", "house"), ("height", "39 ft")]));
        assert!(!matches(&[("building", "house"), ("height", "tall")]));
        assert!(!matches(&[("building", "house"), ("height", "12"), ("ruins", "yes")]));
        assert!(!matches(&[("building", "yes"), ("height", "12")]));
    }

    #[test]
    fn an_object_term_takes_all_parts_of_the_object() {
        let filter = Filter { terms: vec![FilterTerm::Object { kind: ObjectKind::Way, id: -7 }] };
        assert!(filter.matches(FeatureClass::Highway, &tags(&[]), FeatureId { part: 3, ..id(-7) }));
        assert!(!filter.matches(FeatureClass::Highway, &tags(&[]), id(7)));
    }
}
