//! Placing: trees, rows and stands of the map → plants. Stands are filled by a jittered grid of the plan: one candidate per
//! cell, moved by at most a third of it, so that two never stand in one place and gaps stay even.

use glam::DVec2;

use super::obstacles::Sites;
use super::{Form, Plant};
use crate::geodata::feature::{FeatureId, ObjectKind, Tags};
use crate::geodata::greenery::{Greenery, Row, RowKind, SinglePlant, Stand, StandKind};
use crate::geodata::tags::{first, length};
use crate::interpreter::seed::Seed;

/// The plants of one map object.
pub struct Group {
    pub id: FeatureId,
    pub plants: Vec<Plant>,
    /// A reason of its own to have none.
    pub why_bare: Option<String>,
}

/// One group per map object, in the order of the lists.
pub fn groups(greenery: &Greenery, sites: &Sites, seed: Seed) -> Vec<Group> {
    let single = greenery.single.iter().map(|plant| alone(plant, sites, of(seed, plant.id)));
    let rows = greenery.rows.iter().map(|row| along(row, sites, of(seed, row.id)));
    let stands = greenery.stands.iter().map(|stand| within(stand, sites, of(seed, stand.id)));
    single.chain(rows).chain(stands).collect()
}

fn of(seed: Seed, id: FeatureId) -> Seed {
    let kind = match id.kind {
        ObjectKind::Node => 0,
        ObjectKind::Way => 1,
        ObjectKind::Relation => 2,
        ObjectKind::Feature => 3,
    };
    // Parts of one object are cut by the area, their plants are not: the part has no say.
    seed.part(kind).part(id.id as u64)
}

/// A tree of the map stands where it is mapped, in the middle of a square too, if that is not inside a building.
fn alone(plant: &SinglePlant, sites: &Sites, seed: Seed) -> Group {
    let is_free = sites.taken.is_free(plant.at, 0.0);
    let form = if plant.tags.get("natural").is_some_and(|value| first(value) == "shrub") {
        Form::Bush
    } else {
        form(&plant.tags, 0.15, seed)
    };
    Group {
        id: plant.id,
        plants: if is_free { vec![grown(plant.at, form, &plant.tags, seed)] } else { Vec::new() },
        why_bare: Some("it stands in a building or in water".to_owned()),
    }
}

/// Metres between the plants of a row.
fn spacing(kind: RowKind) -> f64 {
    match kind {
        RowKind::Trees => 8.0,
        RowKind::Hedge => 0.9,
    }
}

fn along(row: &Row, sites: &Sites, seed: Seed) -> Group {
    let spacing = spacing(row.kind);
    let mut plants = Vec::new();
    let mut until_next = spacing / 2.0;
    let mut number = 0;
    for pair in row.line.windows(2) {
        let length = (pair[1] - pair[0]).length();
        let mut here = until_next;
        while here < length {
            let (at, seed) = (pair[0] + (pair[1] - pair[0]) * (here / length), seed.part(number));
            let is_free = match row.kind {
                RowKind::Trees => sites.taken.is_free(at, 0.0),
                RowKind::Hedge => sites.is_free(at, 0.0),
            };
            if is_free {
                let form = if row.kind == RowKind::Hedge { Form::Bush } else { form(&row.tags, 0.1, seed) };
                plants.push(grown(at, form, &row.tags, seed));
            }
            number += 1;
            here += spacing;
        }
        until_next = here - length;
    }
    Group { id: row.id, plants, why_bare: None }
}

/// How densely a kind of stand is grown: metres of a cell, share of cells with a tree, share with a bush, share of
/// conifers among the trees, jitter as a share of the cell.
fn density(kind: StandKind) -> (f64, f64, f64, f64, f64) {
    match kind {
        StandKind::Wood => (6.5, 0.92, 0.05, 0.3, 0.33),
        StandKind::Orchard => (6.0, 0.95, 0.0, 0.0, 0.05),
        StandKind::Park => (11.0, 0.38, 0.14, 0.2, 0.33),
        StandKind::Scrub => (3.5, 0.03, 0.75, 0.3, 0.33),
        StandKind::Grass => (9.0, 0.01, 0.12, 0.2, 0.33),
    }
}

fn within(stand: &Stand, sites: &Sites, seed: Seed) -> Group {
    let (cell, trees, bushes, conifers, jitter) = density(stand.kind);
    let mut plants = Vec::new();
    if let Some((low, high)) = stand.outline.bounds() {
        let (low, high) = ((low / cell).floor(), (high / cell).floor());
        for x in low.x as i64..=high.x as i64 {
            for y in low.y as i64..=high.y as i64 {
                let seed = seed.part(x as u64).part(y as u64);
                let moved = DVec2::new(seed.named("x").unit(), seed.named("y").unit()) - 0.5;
                let at = (DVec2::new(x as f64, y as f64) + 0.5 + moved * (2.0 * jitter)) * cell;
                let draw = seed.named("kind").unit();
                let form = if draw < trees {
                    form(&stand.tags, conifers, seed)
                } else if draw < trees + bushes {
                    Form::Bush
                } else {
                    continue;
                };
                let plant = grown(at, form, &Tags::new(), seed);
                if stand.outline.contains(at) && sites.is_free(at, 0.6 * plant.crown) {
                    plants.push(plant);
                }
            }
        }
    }
    Group { id: stand.id, plants, why_bare: None }
}

/// By `leaf_type`, else drawn.
fn form(tags: &Tags, conifers: f64, seed: Seed) -> Form {
    match tags.get("leaf_type").map(|value| first(value)) {
        Some("needleleaved") => Form::Conifer,
        Some("broadleaved") => Form::Broadleaved,
        _ if seed.named("conifer").unit() < conifers => Form::Conifer,
        _ => Form::Broadleaved,
    }
}

/// Size by `height` and `diameter_crown` where they are mapped, else drawn; the crown follows the height.
fn grown(at: DVec2, form: Form, tags: &Tags, seed: Seed) -> Plant {
    let draw = |name: &str, low: f64, high: f64| low + (high - low) * seed.named(name).unit();
    let mapped = |key: &str, high: f64| tags.get(key).and_then(|text| length(text)).filter(|m| *m > 0.2 && *m <= high);
    let ((low, high), (slim, wide)) = match form {
        Form::Broadleaved => ((6.0, 14.0), (0.28, 0.4)),
        Form::Conifer => ((8.0, 18.0), (0.15, 0.22)),
        Form::Bush => ((0.8, 2.2), (0.45, 0.75)),
    };
    let height = mapped("height", 120.0).unwrap_or_else(|| draw("height", low, high));
    let crown = mapped("diameter_crown", 60.0).map_or_else(|| height * draw("crown", slim, wide), |d| d / 2.0);
    Plant { at, form, height, crown, seed }
}
