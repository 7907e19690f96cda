//! What a host attaches to a start shape besides its mesh (reference 3.12).
//!
//! In: edge attributes, street widths and a place from map data or the command line. Out: [`HostData`], read by
//! `edgeAttr.*`, street selectors, `streetWidth(edge)` and `getGeoCoord`.

use std::fmt::Debug;
use std::sync::Arc;

use crate::geometry::Mesh;

/// Data of one start shape. Arrays have one element per edge of its mesh in face-edge order (reference 3.4): all edges
/// of face 0, outer loop first, then face 1. Elements that are missing read as 0, false or "".
#[derive(Clone, Debug, Default)]
pub struct HostData {
    pub edge_attributes: Vec<EdgeAttribute>,
    /// Metres; 0 where no street lies along the edge. Empty where nothing is known of streets.
    pub street_widths: Vec<f64>,
    /// Where the scene lies on Earth.
    pub place: Option<Arc<dyn Place>>,
}

/// The array `/edgeattr/NAME`.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgeAttribute {
    pub name: Arc<str>,
    pub values: EdgeValues,
}

/// One element per edge.
#[derive(Clone, Debug, PartialEq)]
pub enum EdgeValues {
    Floats(Vec<f64>),
    Bools(Vec<bool>),
    Strings(Vec<Arc<str>>),
}

/// A scene's place on Earth.
pub trait Place: Debug + Send + Sync {
    /// Longitude and latitude in degrees of a world position (x east, z south, metres); `None` where there is none.
    fn lon_lat(&self, x: f64, z: f64) -> Option<(f64, f64)>;
}

/// The numbers of the mesh's edges that are left when vertices that repeat their predecessor are dropped, in order.
/// Must follow what the start of a derivation drops.
pub fn edges_with_length(mesh: &Mesh) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut next = 0;
    for face in &mesh.faces {
        let face_start = kept.len();
        for (number, ring) in face.loops().enumerate() {
            let at = |i: usize| mesh.positions[ring[i % ring.len()] as usize];
            let ring_start = kept.len();
            kept.extend((0..ring.len()).filter(|&i| !face.uvs.is_empty() || at(i) != at(i + 1)).map(|i| next + i));
            if kept.len() - ring_start < 3 {
                kept.truncate(ring_start);
                if number == 0 {
                    next += face.loops().map(|l| l.len()).sum::<usize>();
                    kept.truncate(face_start);
                    break;
                }
            }
            next += ring.len();
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Face;
    use glam::DVec3;

    #[test]
    fn edges_of_no_length_are_left_out_and_the_others_keep_their_numbers() {
        let p = |x: f64, z: f64| DVec3::new(x, 0.0, z);
        let positions = vec![p(0.0, 0.0), p(0.0, 0.0), p(4.0, 0.0), p(4.0, -4.0), p(4.0, -4.0), p(0.0, 0.0)];
        let thin = Face::new(vec![0, 1, 2]);
        let faces = vec![Face::new(vec![0, 1, 2, 3, 4, 5]), thin, Face::new(vec![0, 2, 3])];
        assert_eq!(edges_with_length(&Mesh { positions, faces }), [1, 2, 4, 9, 10, 11]);
    }
}
