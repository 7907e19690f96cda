//! Numerical clean-up of inserted assets (reference 4.11, `numericalCleanup`). In: an asset's form. Out: the form
//! without edges too short to matter, spikes, and faces that have no area.

use std::sync::Arc;

use glam::DVec3;

use super::super::assets::Asset;
use super::super::form::Form;
use crate::geometry::{Face, Mesh};

/// Edges shorter than this share of the asset's extent are drawn together.
const SHORT: f64 = 1e-6;
/// Corners whose edges run back on each other within this sine are spikes.
const SPIKE: f64 = 1e-6;

/// The asset cleaned, which is done once for all its insertions.
pub fn once(asset: Arc<Asset>) -> Arc<Asset> {
    let clean = || cleaned(&asset.form).map(|form| Arc::new(Asset::new(form)));
    asset.cleaned.get_or_init(clean).clone().unwrap_or(asset)
}

/// `None` if there is nothing to clean.
fn cleaned(form: &Form) -> Option<Form> {
    let (lo, hi) = form.mesh.bounds()?;
    let places = drawn_together(&form.mesh, SHORT * (hi - lo).max_element());
    let mut out = form.clone();
    let mut kept = Vec::with_capacity(form.mesh.faces.len());
    for (i, face) in out.mesh.faces.iter_mut().enumerate() {
        face.loops_mut().flatten().for_each(|v| *v = places[*v as usize]);
        tidy(face, &form.mesh.positions);
        if face.outer.len() >= 3 && form.mesh.newell(face) != DVec3::ZERO {
            kept.push(i);
        }
    }
    if kept.len() == form.mesh.faces.len() && out.mesh.faces == form.mesh.faces {
        return None;
    }
    let instanced = form.instanced;
    Some(Form { instanced, ..out.part(&kept) })
}

/// For every vertex the first one reached from it over short edges.
fn drawn_together(mesh: &Mesh, short: f64) -> Vec<u32> {
    let mut place: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    fn root(place: &[u32], mut v: u32) -> u32 {
        while place[v as usize] != v {
            v = place[v as usize];
        }
        v
    }
    for (a, b) in mesh.faces.iter().flat_map(|f| f.edges()) {
        if mesh.positions[a as usize].distance(mesh.positions[b as usize]) < short {
            let (a, b) = (root(&place, a), root(&place, b));
            place[a.max(b) as usize] = a.min(b);
        }
    }
    (0..place.len() as u32).map(|v| root(&place, v)).collect()
}

/// Removes doubled corners and spikes, with their texture coordinates, until none is left.
fn tidy(face: &mut Face, positions: &[DVec3]) {
    loop {
        let mut start = 0;
        let found = face.loops().find_map(|ring| {
            let found = needless_corner(ring, positions).map(|i| start + i);
            start += ring.len();
            found
        });
        let Some(corner) = found else { break };
        remove_corner(face, corner);
    }
    let mut start = face.outer.len();
    for hole in std::mem::take(&mut face.holes) {
        if hole.len() >= 3 {
            start += hole.len();
            face.holes.push(hole);
        } else {
            (0..hole.len()).for_each(|_| remove_values(face, start));
        }
    }
}

fn needless_corner(ring: &[u32], positions: &[DVec3]) -> Option<usize> {
    let n = ring.len();
    let at = |i: usize| positions[ring[i % n] as usize];
    (0..n).filter(|_| n > 1).find(|&i| {
        let (before, after) = (at(i) - at(i + n - 1), at(i + 1) - at(i));
        let scale = before.length() * after.length();
        ring[i] == ring[(i + n - 1) % n] || (before.dot(after) < 0.0 && before.cross(after).length() <= SPIKE * scale)
    })
}

fn remove_corner(face: &mut Face, corner: usize) {
    remove_values(face, corner);
    let mut rest = corner;
    for ring in std::iter::once(&mut face.outer).chain(&mut face.holes) {
        if rest < ring.len() {
            ring.remove(rest);
            return;
        }
        rest -= ring.len();
    }
}

/// Removes what a face says of a corner, but not the corner.
fn remove_values(face: &mut Face, corner: usize) {
    for (_, uv) in &mut face.uvs {
        uv.remove(corner);
    }
    if !face.normals.is_empty() {
        face.normals.remove(corner);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_edges_spikes_and_slivers_go() {
        let p = |x: f64, y: f64| DVec3::new(x, y, 0.0);
        let positions = vec![p(0.0, 0.0), p(4.0, 0.0), p(4.0, 1e-7), p(4.0, 4.0), p(9.0, 4.0), p(0.0, 4.0)];
        let faces = vec![Face::new(vec![0, 1, 2, 3, 4, 5]), Face::new(vec![1, 2, 3])];
        let form = Form::from_mesh(Mesh { positions, faces });
        let clean = cleaned(&form).expect("there is something to clean");
        assert_eq!(clean.mesh.faces, [Face::new(vec![0, 1, 2, 3])]);
        assert_eq!(clean.mesh.area(&clean.mesh.faces[0]), 16.0);
        assert!(cleaned(&clean).is_none());
    }
}
