//! Candidates → features. In: rings and lines of map positions. Out: repaired, cut features and their outcomes.

use glam::DVec2;

use super::gather::{Body, Candidate};
use super::multipolygon::{Combine, Group};
use super::ribbon::{Cap, ribbon};
use super::scene::Scene;
use crate::geodata::feature::{Feature, FeatureClass, FeatureId, Outline, Tags};
use crate::geodata::ledger::Outcome;
use crate::geodata::osm::Position;
use crate::geodata::tags::{first, length};
use crate::geometry::boolean::{symmetric_difference, union};
use crate::geometry::repair::{Note, Options, Verdict, repair};
use crate::geometry::{Polygon, Ring};

/// The features of one object and what became of it.
pub struct Built {
    pub id: FeatureId,
    pub features: Vec<Feature>,
    pub outcome: Outcome,
}

/// Makes the features of a candidate. Buildings are left whole, everything else is cut to the window.
pub fn build(scene: &Scene, candidate: &Candidate) -> Built {
    let mut notes = candidate.notes.clone();
    let made = match &candidate.body {
        Body::Area { groups, combine } => polygons(scene, groups, *combine, &mut notes),
        Body::Lines(lines) if candidate.class == FeatureClass::Water => {
            brook(scene, lines, &candidate.tags, &mut notes)
        }
        Body::Lines(lines) => Ok(lines_inside(scene, lines, &mut notes).into_iter().map(Outline::Line).collect()),
    };
    let is_building = matches!(candidate.class, FeatureClass::Building | FeatureClass::BuildingPart);
    let made = made.and_then(|outlines| if is_building { Ok(outlines) } else { clip(scene, outlines) });
    let id = FeatureId { kind: candidate.kind, id: candidate.id, part: 0 };
    match made {
        Err(why) => Built { id, features: Vec::new(), outcome: Outcome::Skipped(join(notes, why)) },
        Ok(outlines) => {
            let feature = |(part, outline)| Feature {
                id: FeatureId { part: part as u32, ..id },
                class: candidate.class,
                outline,
                tags: candidate.tags.clone(),
            };
            let features = outlines.into_iter().enumerate().map(feature).collect();
            let outcome = if notes.is_empty() { Outcome::Ok } else { Outcome::Repaired(notes.join("; ")) };
            Built { id, features, outcome }
        }
    }
}

fn join(mut notes: Vec<String>, why: String) -> String {
    notes.push(why);
    notes.join("; ")
}

fn polygons(
    scene: &Scene,
    groups: &[Group],
    combine: Combine,
    notes: &mut Vec<String>,
) -> Result<Vec<Outline>, String> {
    let mut all = Vec::new();
    let mut refusal = None;
    for group in groups {
        let rings: Vec<Ring> =
            std::iter::once(&group.outer).chain(&group.holes).map(|ring| scene.local_line(ring)).collect();
        let repaired = repair(&rings, &Options::default());
        if let Verdict::Rejected(why) = repaired.verdict {
            refusal = Some(why.to_string());
            continue;
        }
        notes.extend(repaired.notes.iter().filter_map(describe));
        all.extend(repaired.polygons);
    }
    match refusal {
        Some(why) if all.is_empty() => return Err(why),
        Some(why) => notes.push(format!("a part was left out: {why}")),
        None if all.is_empty() => return Err("the outline encloses no area".to_owned()),
        None => {}
    }
    let all = match combine {
        Combine::Side => Ok(all),
        Combine::Union => union(&all, &[]),
        Combine::EvenOdd => all.into_iter().try_fold(Vec::new(), |sum, ring| symmetric_difference(&sum, &[ring])),
    };
    let all = all.map_err(|e| e.to_string())?;
    Ok(all.into_iter().map(Outline::Area).collect())
}

/// What a repair did, if it is worth telling: map ways may run either way round.
fn describe(note: &Note) -> Option<String> {
    match note {
        Note::OutlineReversed | Note::HolesReversed(_) => None,
        Note::DoubledPointsRemoved(count) => Some(format!("{count} doubled points removed")),
        Note::CrossingsResolved => Some("crossing edges resolved".to_owned()),
        Note::SplitIntoParts(parts) => Some(format!("split into {parts} polygons")),
        Note::SmallPartsDropped(count) => Some(format!("{count} tiny parts dropped")),
        Note::EmptyHolesDropped(count) => Some(format!("{count} empty holes dropped")),
    }
}

/// The stretches of lines inside the window with at least two different points.
fn lines_inside(scene: &Scene, lines: &[Vec<Position>], notes: &mut Vec<String>) -> Vec<Vec<DVec2>> {
    let mut out = Vec::new();
    for line in lines {
        let mut points = scene.local_line(line);
        points.dedup();
        if !points.iter().all(|p| p.is_finite()) {
            notes.push("a stretch too far away for the projection was left out".to_owned());
        } else if points.len() > 1 {
            out.extend(scene.clip_line(points));
        }
    }
    out
}

/// Width of running water without `width`, metres; a choice after the usual drawing width of each kind.
fn water_width(tags: &Tags) -> f64 {
    let tagged = tags.get("width").and_then(|w| length(w)).filter(|w| (0.1..=1000.0).contains(w));
    tagged.unwrap_or(match tags.get("waterway").map_or("", |kind| first(kind)) {
        "river" => 12.0,
        "canal" => 8.0,
        "tidal_channel" => 5.0,
        "stream" => 2.0,
        _ => 1.5,
    })
}

fn brook(scene: &Scene, lines: &[Vec<Position>], tags: &Tags, notes: &mut Vec<String>) -> Result<Vec<Outline>, String> {
    let mut out = Vec::new();
    for line in lines_inside(scene, lines, notes) {
        let polygons = ribbon(&line, water_width(tags), [Cap::Round; 2]).map_err(|e| e.to_string())?;
        out.extend(polygons.into_iter().map(Outline::Area));
    }
    Ok(out)
}

fn clip(scene: &Scene, outlines: Vec<Outline>) -> Result<Vec<Outline>, String> {
    let mut out = Vec::new();
    let mut areas: Vec<Polygon> = Vec::new();
    for outline in outlines {
        match outline {
            Outline::Area(polygon) => areas.push(polygon),
            line @ Outline::Line(_) => out.push(line),
        }
    }
    let areas = scene.clip_polygons(areas).map_err(|e| e.to_string())?;
    out.extend(areas.into_iter().map(Outline::Area));
    Ok(out)
}
