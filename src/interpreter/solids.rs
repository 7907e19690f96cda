//! Booleans of forms (reference 4.16). In: forms with their materials. Out: their union, difference or intersection
//! with the materials, tags and texture coordinates of the faces it is made of.

use std::sync::Arc;

use super::derivation::Derivation;
use super::form::Form;
use super::merging::{Dressed, appended};
use crate::geometry::box_tree::{Bounds, BoxTree};
use crate::geometry::solid::{Combined, OpenMeshes, Operator, SolidError, combine};
use crate::source::Span;

/// The union of all components (faces joined by vertices) of a form. What cannot be united stays as it is, with a
/// warning.
pub fn unified(run: &mut Derivation, dressed: Dressed, span: Span) -> Dressed {
    let components = components(&dressed.form);
    if components.len() < 2 {
        return dressed;
    }
    let parts: Vec<Form> = components.iter().map(|faces| dressed.form.part(faces)).collect();
    let appearance = dressed.appearance;
    let dress = |form: Form| Dressed { form: Arc::new(form), appearance: appearance.clone() };
    let mut done: Vec<Dressed> = Vec::new();
    for cluster in clusters(&parts) {
        // A copy of a part adds nothing.
        let mut members: Vec<&Form> = Vec::new();
        for part in cluster.into_iter().map(|i| &parts[i]) {
            if !members.iter().any(|m| m.mesh == part.mesh) {
                members.push(part);
            }
        }
        let mut members = members.into_iter().cloned().map(dress);
        let Some(mut joined) = members.next() else { continue };
        let mut apart = Vec::new();
        for next in members {
            match united(&joined, &next) {
                Ok(form) => joined = dress(form),
                Err(error) => {
                    warn(run, error, span);
                    apart.push(next);
                }
            }
        }
        done.push(joined);
        done.extend(apart);
    }
    Dressed { form: appended(&done).form, appearance }
}

fn united(a: &Dressed, b: &Dressed) -> Result<Form, SolidError> {
    let combined = combine(&a.form.mesh, &b.form.mesh, Operator::Union, OpenMeshes::Surfaces)?;
    Ok(dressed_as(combined, a, b).0)
}

/// Combines two operands; tags tell which faces come from which, and where they meet. What cannot be combined leaves
/// the first operand, with a warning.
pub fn combined(run: &mut Derivation, a: &Dressed, b: &Dressed, operator: Operator, span: Span) -> Dressed {
    let combined = match combine(&a.form.mesh, &b.form.mesh, operator, OpenMeshes::HalfSpaces) {
        Ok(combined) => combined,
        Err(error) => {
            warn(run, error, span);
            return a.clone();
        }
    };
    let names: Vec<(bool, bool)> =
        combined.origins.iter().map(|o| (o.operand == 0 || o.is_shared, o.operand == 1 || o.is_shared)).collect();
    let cuts = combined.cuts.clone();
    let (mut form, appearance) = dressed_as(combined, a, b);
    if !form.mesh.faces.is_empty() {
        form.auto_tag_faces("bool", names.iter().map(|(a, _)| a.then_some("bool.A")));
        let second = names.iter().enumerate().filter(|(_, (_, b))| *b);
        second.for_each(|(face, _)| form.tags_mut().add_face(face, "bool.B".into()));
        form.auto_tag_edges("bool", cuts.into_iter().map(|e| (e, "bool.cut")));
    }
    Dressed { form: Arc::new(form), appearance }
}

fn warn(run: &mut Derivation, error: SolidError, span: Span) {
    run.warn("cga::boolean", span, || format!("the shapes cannot be combined: {error}"));
}

/// The result with what the operands say of its faces.
fn dressed_as(combined: Combined, a: &Dressed, b: &Dressed) -> (Form, Arc<super::appearance::Appearance>) {
    let both = appended(&[a.clone(), b.clone()]);
    let offset = a.form.mesh.faces.len() as u32;
    let sources = combined.origins.iter().map(|o| Some(if o.operand == 0 { o.face } else { o.face + offset }));
    (both.form.derived(combined.mesh, sources), both.appearance)
}

/// Face numbers of each component, by the first of them.
fn components(form: &Form) -> Vec<Vec<usize>> {
    let mut leader: Vec<u32> = (0..form.mesh.positions.len() as u32).collect();
    for face in &form.mesh.faces {
        let mut corners = face.corners();
        let Some(first) = corners.next() else { continue };
        for corner in corners {
            join(&mut leader, first, corner);
        }
    }
    let home = |leader: &mut [u32], face: &crate::geometry::Face| face.outer.first().map(|&v| find(leader, v));
    let mut groups: std::collections::BTreeMap<Option<u32>, Vec<usize>> = std::collections::BTreeMap::new();
    for (i, face) in form.mesh.faces.iter().enumerate() {
        let home = home(&mut leader, face);
        groups.entry(home).or_default().push(i);
    }
    let mut groups: Vec<Vec<usize>> = groups.into_values().collect();
    groups.sort_by_key(|faces| faces[0]);
    groups
}

/// Sets of parts whose boxes hang together.
fn clusters(parts: &[Form]) -> Vec<Vec<usize>> {
    let bounds = |f: &Form| Bounds::around(f.mesh.positions.iter().copied());
    let boxes: Vec<Bounds> = parts.iter().filter_map(bounds).collect();
    let tree = BoxTree::new(boxes.clone());
    let mut leader: Vec<u32> = (0..boxes.len() as u32).collect();
    for (i, b) in boxes.iter().enumerate() {
        let reach = b.grown(1e-9 * (b.hi - b.lo).max_element());
        tree.touching(&reach).into_iter().for_each(|j| join(&mut leader, i as u32, j as u32));
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); boxes.len()];
    (0..boxes.len()).for_each(|i| groups[find(&mut leader, i as u32) as usize].push(i));
    groups.retain(|g| !g.is_empty());
    groups
}

fn find(leader: &mut [u32], mut i: u32) -> u32 {
    while leader[i as usize] != i {
        leader[i as usize] = leader[leader[i as usize] as usize];
        i = leader[i as usize];
    }
    i
}

fn join(leader: &mut [u32], a: u32, b: u32) {
    let (a, b) = (find(leader, a), find(leader, b));
    leader[a.max(b) as usize] = a.min(b);
}
