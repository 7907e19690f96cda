//! What is under the cursor. In: an object's label and a ray. Out: the feature, and the leaf whose face the ray meets
//! first with the rules and the line that made it. The lot is derived once more, watched; a build pays nothing for it.

use glam::{DVec2, DVec3};
use serde::Serialize;

use super::session::assigned;
use crate::interpreter::tree::Scalar;
use crate::interpreter::watch::Origin;
use crate::pipeline::memory::Memory;
use crate::pipeline::{BuiltScene, Recipe, Traced, traced};
use crate::plan::demand::State;
use crate::scene::{Presence, SceneObject, TriMesh};
use crate::source::SourceMap;

/// From `origin` in `direction` (any length), world metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

/// One feature in one state.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LotInfo {
    /// `way/123`; `None` for the terrain.
    pub feature: Option<String>,
    pub instance: u32,
    pub class: &'static str,
    /// Name of the change that touches it, and of its level.
    pub change: Option<String>,
    pub level: Option<String>,
    /// Rule file as the recipe writes it; `None` where no rule made it.
    pub rule_file: Option<String>,
    /// Values that the derivation began with, by name.
    pub attributes: Vec<(String, String)>,
    pub leaves: usize,
    pub triangles: usize,
    /// Of its derivation in the last build that derived it.
    pub derivation_ms: f64,
    /// Where a ray was given and meets something.
    pub leaf: Option<LeafInfo>,
}

/// One leaf.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LeafInfo {
    /// Rules from the start rule to the leaf's own name.
    pub rules: Vec<String>,
    /// Child numbers from the root.
    pub path: Vec<u32>,
    pub faces: usize,
    pub material: String,
    /// Where the symbol that made it stands.
    pub file: String,
    pub line: usize,
    pub column: usize,
}

/// What is known of the object with this label in this state.
pub(super) fn lot(
    recipe: &Recipe,
    sources: &SourceMap,
    built: &BuiltScene,
    memory: &Memory,
    (instance, state): (u32, State),
    ray: Option<Ray>,
) -> Option<LotInfo> {
    let absent = match state {
        State::Before => Presence::AfterOnly,
        State::After => Presence::BeforeOnly,
    };
    let objects = built.scene.objects.iter().filter(|object| object.instance == instance);
    let shown: Vec<&SceneObject> = objects.filter(|object| object.presence != absent).collect();
    // Ground that a change takes over is an object of its own: the feature's is the one that is derived.
    let object = *shown.iter().max_by_key(|object| object.mesh.triangles.len())?;
    let state_of = |object: &SceneObject| traced(recipe, memory, &(object.feature?, object.presence), &built.terrain);
    let found = shown.iter().find_map(|object| Some((*object, state_of(object)?)));
    let change = found.as_ref().map_or(object, |(object, _)| object);
    let spec = recipe.spec.changes.get(usize::from(change.change).wrapping_sub(1));
    let level = spec.and_then(|change_spec| change_spec.levels.get(usize::from(change.level).wrapping_sub(1)));
    let mut info = LotInfo {
        feature: object.feature.map(|feature| feature.to_string()),
        instance,
        class: object.class.name(),
        change: spec.map(|change| change.name.clone()),
        level: level.map(|level| level.name.clone()),
        rule_file: None,
        attributes: Vec::new(),
        leaves: 0,
        triangles: shown.iter().map(|object| object.mesh.triangles.len()).sum(),
        derivation_ms: 0.0,
        leaf: None,
    };
    if let Some((_, traced)) = found {
        let is_own = |file: &&crate::spec::render_spec::FileRef| *recipe.programs.entry(file).0 == traced.program;
        info.rule_file = assigned(&recipe.spec).find(is_own).map(|file| file.written.clone());
        let values = traced.tree.leaves.first().map(|leaf| leaf.attributes.clone()).unwrap_or_default();
        info.attributes = values.iter().map(|(name, value)| (name.to_string(), text(value))).collect();
        info.leaves = traced.tree.leaves.len();
        info.derivation_ms = 1e3 * traced.seconds;
        let meshes: Vec<&TriMesh> = shown.iter().map(|object| &*object.mesh).collect();
        let number = ray.and_then(|ray| leaf_under(&traced, &meshes, ray));
        info.leaf = number.and_then(|number| leaf(&traced, number, sources));
    }
    Some(info)
}

fn text(value: &Scalar) -> String {
    match value {
        Scalar::Float(x) => x.to_string(),
        Scalar::Bool(b) => b.to_string(),
        Scalar::String(text) => text.to_string(),
    }
}

fn leaf(traced: &Traced, number: usize, sources: &SourceMap) -> Option<LeafInfo> {
    let (leaf, origin) = (traced.tree.leaves.get(number)?, traced.watch.origins.get(number)?);
    let Origin { rules, span } = origin;
    let span = (*span)?;
    let file = sources.get(span.source);
    let place = file.place(span.start);
    Some(LeafInfo {
        rules: rules.iter().map(|rule| rule.to_string()).collect(),
        path: leaf.path.to_vec(),
        faces: leaf.mesh.faces.len(),
        material: leaf.material.name.to_string(),
        file: file.name.to_string(),
        line: place.line,
        column: place.column,
    })
}

/// The leaf whose face the ray meets where it first meets the object: solid faces by the ray, flat ones, which the ground
/// has taken up, by their place in the plan.
fn leaf_under(traced: &Traced, meshes: &[&TriMesh], ray: Ray) -> Option<usize> {
    let first = meshes.iter().filter_map(|mesh| first_hit(mesh, ray)).reduce(f64::min)?;
    let at = ray.origin + ray.direction * first;
    let near = |distance: f64| ((distance - first) * ray.direction.length()).abs();
    let solid =
        traced.parts.iter().enumerate().filter_map(|(number, parts)| Some((number, first_hit(&parts.solid, ray)?)));
    let solid = solid.min_by(|a, b| near(a.1).total_cmp(&near(b.1))).filter(|(_, distance)| near(*distance) < 0.01);
    if let Some((number, _)) = solid {
        return Some(number);
    }
    let plan = DVec2::new(at.x, -at.z);
    let covers = |number: &usize| traced.parts[*number].flat.iter().any(|face| face.polygon.contains(plan));
    (0..traced.parts.len()).rev().find(covers)
}

/// Distance in lengths of the direction to the first triangle in front of the origin.
fn first_hit(mesh: &TriMesh, ray: Ray) -> Option<f64> {
    let corners = |triangle: &[u32; 3]| triangle.map(|i| mesh.positions[i as usize]);
    mesh.triangles.iter().filter_map(|triangle| hit(corners(triangle), ray)).reduce(f64::min)
}

/// Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection"; both sides count.
fn hit([a, b, c]: [DVec3; 3], Ray { origin, direction }: Ray) -> Option<f64> {
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let offset = origin - a;
    let u = offset.dot(p) / determinant;
    let q = offset.cross(ab);
    let v = direction.dot(q) / determinant;
    let distance = ac.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_meet_triangles_from_both_sides() {
        let triangle = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Z * -4.0];
        let ray =
            |x: f64, z: f64, down: f64| Ray { origin: DVec3::new(x, 3.0 * down, z), direction: DVec3::Y * -2.0 * down };
        assert_eq!(hit(triangle, ray(1.0, -1.0, 1.0)), Some(1.5));
        assert_eq!(hit(triangle, ray(1.0, -1.0, -1.0)), Some(1.5));
        assert_eq!(hit(triangle, ray(3.0, -3.0, 1.0)), None);
        assert_eq!(hit(triangle, Ray { origin: DVec3::Y, direction: DVec3::Y }), None);
        assert_eq!(hit(triangle, Ray { origin: DVec3::Y, direction: DVec3::X }), None);
    }
}
