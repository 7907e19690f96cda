//! Leaves as Wavefront OBJ (`mansard derive --format obj`). In: a tree. Out: text, one group per leaf, y up, metres.
//!
//! OBJ knows no holes: faces that have some are written as triangles. Texture set 0 only; normals where faces have
//! their own.

use std::fmt::Write;

use glam::DVec2;

use super::tree::{Leaf, ShapeTree};
use crate::geometry::Face;
use crate::geometry::triangulate::triangulate_face;

pub fn to_obj(tree: &ShapeTree) -> String {
    let mut out = String::from("# mansard derive\n");
    let mut vertices = 1;
    let mut corners = Corners { uvs: 1, normals: 1 };
    for (number, leaf) in tree.leaves.iter().enumerate() {
        add(&mut out, format_args!("g {}_{number}", leaf.rule));
        for p in &leaf.mesh.positions {
            add(&mut out, format_args!("v {} {} {}", p.x, p.y, p.z));
        }
        for face in &leaf.mesh.faces {
            write_face(&mut out, leaf, face, vertices, &mut corners);
        }
        vertices += leaf.mesh.positions.len();
    }
    out
}

fn add(out: &mut String, line: std::fmt::Arguments) {
    writeln!(out, "{line}").expect("writing to a string cannot fail");
}

/// Numbers of the next texture coordinates and the next normal.
struct Corners {
    uvs: usize,
    normals: usize,
}

fn write_face(out: &mut String, leaf: &Leaf, face: &Face, first: usize, corners: &mut Corners) {
    let uv: Option<&[DVec2]> = face.uv(0);
    for p in uv.unwrap_or(&[]) {
        add(out, format_args!("vt {} {}", p.x, p.y));
    }
    for n in &face.normals {
        add(out, format_args!("vn {} {} {}", n.x, n.y, n.z));
    }
    let vertex: Vec<u32> = face.corners().collect();
    let (texture, normal) = (corners.uvs, corners.normals);
    let corner = |i: usize| {
        let v = vertex[i] as usize + first;
        match (uv.is_some(), face.normals.is_empty()) {
            (true, true) => format!(" {v}/{}", texture + i),
            (true, false) => format!(" {v}/{}/{}", texture + i, normal + i),
            (false, true) => format!(" {v}"),
            (false, false) => format!(" {v}//{}", normal + i),
        }
    };
    if face.holes.is_empty() {
        let line: String = (0..vertex.len()).map(corner).collect();
        add(out, format_args!("f{line}"));
    } else {
        for triangle in triangulate_face(&leaf.mesh, face) {
            let line: String = triangle.iter().map(|&i| corner(i as usize)).collect();
            add(out, format_args!("f{line}"));
        }
    }
    if uv.is_some() {
        corners.uvs += vertex.len();
    }
    corners.normals += face.normals.len();
}
