//! `taper` (reference 4.8). In: a height. Out: a pyramid over the first face, its apex over the centroid, in an upright
//! scope. Like `extrude`, heights up to 0.001 change nothing, and below the face the faces still point outwards.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::shape::Shape;
use super::args::Args;
use super::auto_tags;
use super::extrude::replace_upright;
use super::plan_faces::texture_map;
use crate::geometry::extrude::LEAST_DISTANCE;
use crate::geometry::polygon::centroid;
use crate::geometry::transform::flip_face;
use crate::geometry::{Face, Mesh, PlaneFrame};

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let height = args.float_or(run, 0, 0.0);
    if height.abs() <= LEAST_DISTANCE {
        return;
    }
    shape.bake();
    let source = Arc::clone(&shape.form);
    let Some(first) = source.mesh.faces.first() else {
        run.warn("cga::no-face", args.span, || "there is no face to taper".into());
        return;
    };
    let Some(frame) = PlaneFrame::of_face(&source.mesh, first) else {
        run.warn("cga::no-face", args.span, || "the first face has no area to taper".into());
        return;
    };
    if !first.holes.is_empty() {
        run.warn("cga::taper-holes", args.span, || "a taper covers the holes".into());
    }
    let outer: Vec<DVec3> = first.outer.iter().map(|&v| source.mesh.positions[v as usize]).collect();
    let plan: Vec<DVec2> = outer.iter().map(|&p| frame.to_plan(p)).collect();
    let middle = centroid(&plan);
    let n = outer.len() as u32;
    let mut mesh = Mesh { positions: outer, ..Mesh::default() };
    // On a face that is not flat the apex stands over the mean height of the corners.
    let lift = mesh.positions.iter().map(|&p| (p - frame.origin).dot(frame.normal)).sum::<f64>() / f64::from(n);
    mesh.positions.push(frame.to_space(middle, lift + height));
    let mut bottom = Face::new((0..n).collect::<Vec<u32>>());
    let mut sides: Vec<Face> = (0..n).map(|i| Face::new(vec![i, (i + 1) % n, n])).collect();
    for (set, uv) in &first.uvs {
        let apex = texture_map(&plan, uv).map_or(uv[0], |map| map.transform_point2(middle));
        bottom.uvs.push((*set, uv[..n as usize].into()));
        for (i, side) in sides.iter_mut().enumerate() {
            side.uvs.push((*set, [uv[i], uv[(i + 1) % n as usize], apex].into_iter().collect()));
        }
    }
    if height > 0.0 {
        flip_face(&mut bottom);
    } else {
        sides.iter_mut().for_each(flip_face);
    }
    mesh.faces.push(bottom);
    mesh.faces.extend(sides);
    let mut form = source.derived(mesh, (0..=n).map(|_| Some(0)));
    auto_tags::taper(run.program, &source, &mut form);
    replace_upright(shape, form, frame.normal, height < 0.0);
}
