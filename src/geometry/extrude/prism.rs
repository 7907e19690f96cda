//! The usual extrusion: one face without holes. In: a mesh, a direction and a distance. Out: what the general way gives,
//! to the bit, or nothing where the mesh is not that simple.

use glam::DVec3;

use super::{Direction, Extruded, Origin, Role, side_uvs};
use crate::geometry::plane::unit;
use crate::geometry::transform::flip_face;
use crate::geometry::{Face, Mesh};

/// `None` unless the mesh is one face with an area between all its vertices in order, which all move alike.
pub(super) fn prism(mesh: &Mesh, direction: Direction, distance: f64) -> Option<Extruded> {
    let [source] = &mesh.faces[..] else { return None };
    let n = mesh.positions.len() as u32;
    if !source.holes.is_empty() || !source.outer.iter().copied().eq(0..n) {
        return None;
    }
    let area = mesh.newell(source);
    unit(area)?;
    let along = match direction {
        // Adding 0 makes -0 and 0 one, as a sum over faces does.
        Direction::FaceNormal => DVec3::ZERO + area,
        Direction::Along(vector) => vector,
        Direction::VertexNormal | Direction::AlongToFlatTop(_) => return None,
    };
    let step = unit(along).unwrap_or(DVec3::ZERO) * distance;
    let total: DVec3 = mesh.positions.iter().map(|_| step).sum();
    let body_behind = total.dot(area) < 0.0;
    let mut positions = Vec::with_capacity(2 * mesh.positions.len());
    positions.extend_from_slice(&mesh.positions);
    positions.extend(mesh.positions.iter().map(|&p| p + step));
    let mut out = Extruded {
        mesh: Mesh { positions, faces: Vec::with_capacity(n as usize + 2) },
        origins: Vec::with_capacity(n as usize + 2),
    };
    let mut push = |mut face: Face, role: Role, edge: Option<u32>, turned: bool| {
        if turned {
            flip_face(&mut face);
        }
        out.mesh.faces.push(face);
        out.origins.push(Origin { role, face: 0, edge });
    };
    let moved = |lift: u32| Face {
        outer: (lift..lift + n).collect(),
        holes: Vec::new(),
        uvs: source.uvs.clone(),
        normals: Vec::new(),
    };
    push(moved(0), Role::Bottom, None, !body_behind);
    push(moved(n), Role::Top, None, body_behind);
    for i in 0..n {
        let j = if i + 1 == n { 0 } else { i + 1 };
        let uvs = if source.uvs.is_empty() { Default::default() } else { side_uvs(source, i as usize) };
        push(Face { uvs, ..Face::new([i, j, j + n, i + n]) }, Role::SideOuter, Some(i), body_behind);
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use glam::DVec2;
    use proptest::prelude::*;

    use super::super::extrude_groups;
    use super::*;

    proptest! {
        #[test]
        fn gives_what_the_general_way_gives(
            corners in prop::collection::vec((-10.0f64..10.0, -10.0f64..10.0, -1.0f64..1.0), 3..9),
            way in 0..4,
            distance in -9.0f64..9.0,
            textured in any::<bool>(),
        ) {
            let positions: Vec<DVec3> = corners.iter().map(|&(x, y, z)| DVec3::new(x, y, z)).collect();
            let mut face = Face::new((0..positions.len() as u32).collect::<Vec<_>>());
            if textured {
                face.uvs = [(2, positions.iter().map(|p| p.truncate() + DVec2::ONE).collect())].into_iter().collect();
            }
            let mesh = Mesh { positions, faces: vec![face] };
            let direction = match way {
                0 => Direction::FaceNormal,
                1 => Direction::Along(DVec3::Y),
                2 => Direction::Along(DVec3::new(0.3, -2.0, 0.5)),
                _ => Direction::VertexNormal,
            };
            let direct = prism(&mesh, direction, distance);
            prop_assert_eq!(direct.is_some(), way < 3);
            if let Some(direct) = direct {
                prop_assert_eq!(direct, extrude_groups(&mesh, direction, distance));
            }
        }
    }

    #[test]
    fn level_and_upright_faces_too() {
        for normal in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::NEG_Z] {
            let u = if normal.x == 0.0 { DVec3::X } else { DVec3::Y };
            let v = normal.cross(u);
            let positions = vec![-DVec3::ZERO, u * 4.0, u * 4.0 + v * 3.0, v * 3.0];
            let mesh = Mesh { positions, faces: vec![Face::new([0, 1, 2, 3])] };
            for direction in [Direction::FaceNormal, Direction::Along(DVec3::Y), Direction::Along(DVec3::ZERO)] {
                for distance in [2.5, -2.5] {
                    let direct = prism(&mesh, direction, distance).expect("simple");
                    // By its text, which tells -0 from 0.
                    let general = extrude_groups(&mesh, direction, distance);
                    assert_eq!(format!("{direct:?}"), format!("{general:?}"));
                }
            }
        }
    }
}
