//! Draws: the objects a pass shows, within what its view can see, as one index list and few draw calls.

use std::ops::Range;

use glam::DVec3;

use super::upload::GpuScene;
use crate::plan::pass::Surface;

/// Triangles of one kind of surface with one texture, as a range of a [`DrawList`]'s indices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    pub surface: Surface,
    /// Number of the texture in the scene, for textured surfaces.
    pub texture: Option<usize>,
    pub indices: Range<u32>,
}

#[derive(Debug, Default, PartialEq, Eq)]
pub struct DrawList {
    pub indices: Vec<u32>,
    pub runs: Vec<Run>,
}

/// Gathers the chosen objects that may reach into the half spaces `planes` (`n·p + d ≥ 0`, `p` from `eye`), in the
/// scene's drawing order. Texture changes split runs only where `by_texture`, or for cut-outs.
pub fn gather(scene: &GpuScene, objects: &[bool], eye: DVec3, planes: &[(DVec3, f64)], by_texture: bool) -> DrawList {
    let visible: Vec<bool> = objects
        .iter()
        .zip(&scene.bounds)
        .map(|(&chosen, bounds)| chosen && bounds.is_some_and(|b| reaches(b, eye, planes)))
        .collect();
    let mut list = DrawList::default();
    for chunk in scene.chunks.iter().filter(|chunk| visible[chunk.object]) {
        let start = list.indices.len() as u32;
        list.indices.extend_from_slice(&scene.indices[chunk.indices.clone()]);
        let end = list.indices.len() as u32;
        let separate = by_texture || chunk.surface == Surface::Cutout;
        let surface = if separate { chunk.surface } else { Surface::Plain };
        let texture = chunk.texture.filter(|_| separate);
        match list.runs.last_mut() {
            Some(run) if run.surface == surface && run.texture == texture => run.indices.end = end,
            _ => list.runs.push(Run { surface, texture, indices: start..end }),
        }
    }
    list
}

/// Whether any corner of the box may lie in all half spaces: false only if all corners are outside one of them.
fn reaches((low, high): (DVec3, DVec3), eye: DVec3, planes: &[(DVec3, f64)]) -> bool {
    let (low, high) = (low - eye, high - eye);
    planes.iter().all(|&(normal, offset)| {
        let farthest = DVec3::select(normal.cmpge(DVec3::ZERO), high, low);
        normal.dot(farthest) + offset >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_dropped_only_when_wholly_outside() {
        let plane = [(DVec3::X, -1.0)];
        let unit = (DVec3::ZERO, DVec3::ONE);
        assert!(reaches(unit, DVec3::ZERO, &plane));
        assert!(!reaches(unit, DVec3::new(0.1, 0.0, 0.0), &plane));
    }
}
