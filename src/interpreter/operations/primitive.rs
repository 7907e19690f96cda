//! The primitives (reference 4.10). In: dimensions, or none. Out: the primitive in the scope, with texture set 0.

use glam::{DMat3, DVec2, DVec3};

use super::super::assets::Asset;
use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::placement::sin_cos_degrees;
use super::super::shape::Shape;
use super::args::Args;
use super::insert::fit;
use crate::geometry::mesh::{CornerUvs, Loop};
use crate::geometry::{Face, Mesh};

/// Sides, corners, divisions of round primitives are kept to this many.
const MOST_PARTS: f64 = 1024.0;

fn parts(run: &mut Derivation, args: &Args, i: usize, least: f64) -> u32 {
    let wanted = args.float_or(run, i, 16.0).round();
    if wanted > MOST_PARTS {
        run.warn("cga::too-many-parts", args.span, || format!("primitives have at most {MOST_PARTS} parts around"));
    }
    wanted.clamp(least, MOST_PARTS) as u32
}

/// The form stretched to the scope, or at its own `size` centred in the scope's x and z on its floor.
fn place(shape: &mut Shape, form: Form, size: Option<DVec3>) {
    let mut asset = Asset::new(Form { instanced: true, ..form });
    if let Some(size) = size {
        let flat: Vec<usize> = (0..3).filter(|&i| shape.scope.size[i] == 0.0).collect();
        let turned = asset.size.y == 0.0 && matches!(flat.as_slice(), [0] | [2]);
        if turned {
            asset = Asset::new(upright(asset.form, flat[0]));
        }
        let size = match (turned, flat.first()) {
            (true, Some(0)) => DVec3::new(0.0, size.z, size.x),
            (true, _) => DVec3::new(size.x, size.z, 0.0),
            _ => size,
        };
        let mut spare = (shape.scope.size - size) / 2.0;
        if !turned {
            spare.y = 0.0;
        }
        shape.scope.frame.origin += shape.scope.frame.axes * spare;
        shape.scope.size = size;
        let scope = shape.scope;
        let factor = |i: usize| if asset.size[i] == 0.0 { 1.0 } else { size[i] / asset.size[i] };
        let factor = DVec3::new(factor(0), factor(1), factor(2));
        let mut form = asset.form;
        form.mesh.positions.iter_mut().for_each(|p| *p = scope.frame.world_from_local((*p - asset.low) * factor));
        form.turn_corner_normals(scope.frame.axes * DMat3::from_diagonal(factor));
        shape.replace_in_scope(form);
        return;
    }
    fit(shape, &asset);
}

/// A flat form of the xz-plane stood up in the plane across the flat axis, its front edge at the bottom.
fn upright(mut form: Form, flat: usize) -> Form {
    for p in &mut form.mesh.positions {
        *p = if flat == 0 { DVec3::new(0.0, 1.0 - p.z, 1.0 - p.x) } else { DVec3::new(p.x, 1.0 - p.z, 0.0) };
    }
    form
}

fn dimensions(run: &mut Derivation, args: &Args, first: usize) -> DVec3 {
    DVec3::new(
        args.float_or(run, first, 0.0).abs(),
        args.float_or(run, first + 1, 0.0).abs(),
        args.float_or(run, first + 2, 0.0).abs(),
    )
}

pub fn cube(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let size = (args.len() == 3).then(|| dimensions(run, args, 0));
    place(shape, unit_cube(), size);
}

pub fn quad(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let size = (args.len() == 2).then(|| {
        let d = dimensions(run, args, 0);
        DVec3::new(d.x, 0.0, d.y)
    });
    let mut mesh = Mesh::default();
    mesh.positions.extend([DVec3::Z, DVec3::new(1.0, 0.0, 1.0), DVec3::X, DVec3::ZERO]);
    mesh.faces.push(textured([0, 1, 2, 3], UNIT_UV));
    place(shape, Form::from_mesh(mesh), size);
}

pub fn disk(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let n = parts(run, args, 0, 3.0);
    let radius = args.float(run, 1);
    let mut mesh = Mesh { positions: ring(n, 0.0), faces: Vec::new() };
    let cap = cap((0..n).collect(), &mesh);
    mesh.faces.push(cap);
    place_round(shape, mesh, radius, 0.0);
}

pub fn cylinder(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let n = parts(run, args, 0, 3.0);
    let (radius, height) = (args.float(run, 1), args.float_or(run, 2, 1.0).abs());
    let mut mesh = Mesh { positions: ring(n, 0.0), faces: Vec::new() };
    mesh.positions.extend(ring(n, 1.0));
    let bottom = cap([1, 0].into_iter().chain((2..n).rev()).collect(), &mesh);
    let top = cap((n..2 * n).collect(), &mesh);
    mesh.faces.extend([bottom, top]);
    for i in 0..n {
        let (j, u0, u1) = ((i + 1) % n, around(i, n), around(i + 1, n));
        let uv = [DVec2::new(u0, 0.0), DVec2::new(u1, 0.0), DVec2::new(u1, 1.0), DVec2::new(u0, 1.0)];
        mesh.faces.push(smooth(textured([i, j, j + n, i + n], uv), &mesh, |p| p.with_y(0.0)));
    }
    place_round(shape, mesh, radius, height);
}

pub fn cone(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let n = parts(run, args, 0, 3.0);
    let (radius, height) = (args.float(run, 1), args.float_or(run, 2, 1.0).abs());
    let mut mesh = Mesh { positions: ring(n, 0.0), faces: Vec::new() };
    mesh.positions.push(DVec3::Y);
    let bottom = cap([1, 0].into_iter().chain((2..n).rev()).collect(), &mesh);
    mesh.faces.push(bottom);
    for i in 0..n {
        let (u0, u1) = (around(i, n), around(i + 1, n));
        let uv = vec![DVec2::new(u0, 0.0), DVec2::new(u1, 0.0), DVec2::new((u0 + u1) / 2.0, 1.0)];
        let middle = (mesh.positions[i as usize] + mesh.positions[(i + 1) as usize % n as usize]).normalize();
        let slope = |p: DVec3| if p == DVec3::Y { middle + DVec3::Y } else { p.with_y(1.0) };
        mesh.faces.push(smooth(textured([i, (i + 1) % n, n].as_slice(), uv), &mesh, slope));
    }
    place_round(shape, mesh, radius, height);
}

pub fn sphere(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let (n, m) = (parts(run, args, 0, 3.0), parts(run, args, 1, 2.0));
    let radius = args.float(run, 2);
    let mut mesh = Mesh { positions: vec![DVec3::NEG_Y], faces: Vec::new() };
    for k in 1..m {
        let (sin, cos) = sin_cos_degrees(180.0 * f64::from(k) / f64::from(m));
        mesh.positions.extend(ring(n, 0.0).iter().map(|p| DVec3::new(p.x * sin, -cos, p.z * sin)));
    }
    mesh.positions.push(DVec3::Y);
    let last = mesh.positions.len() as u32 - 1;
    let at = |k: u32, i: u32| {
        if k == 0 {
            0
        } else if k == m {
            last
        } else {
            1 + (k - 1) * n + i % n
        }
    };
    for k in 0..m {
        for i in 0..n {
            let (v0, v1) = (around(k, m), around(k + 1, m));
            let (u0, u1) = (around(i, n), around(i + 1, n));
            let mut corners =
                vec![(at(k, i), u0, v0), (at(k, i + 1), u1, v0), (at(k + 1, i + 1), u1, v1), (at(k + 1, i), u0, v1)];
            corners.dedup_by_key(|c| c.0);
            let uv: CornerUvs = corners.iter().map(|c| DVec2::new(c.1, c.2)).collect();
            let face = textured(corners.iter().map(|c| c.0).collect::<Loop>(), uv);
            mesh.faces.push(smooth(face, &mesh, |p| p));
        }
    }
    place_round(shape, mesh, radius, 2.0 * radius.unwrap_or(1.0).abs());
}

/// A round primitive of unit radius: stretched to the scope, or at `radius` and `height`.
fn place_round(shape: &mut Shape, mesh: Mesh, radius: Option<f64>, height: f64) {
    let size = radius.map(|r| {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let extent = (high - low) * r.abs();
        DVec3::new(extent.x, height, extent.z)
    });
    place(shape, Form::from_mesh(mesh), size);
}

const UNIT_UV: [DVec2; 4] = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];

fn textured(outer: impl Into<Loop>, uv: impl Into<CornerUvs>) -> Face {
    Face { uvs: [(0, uv.into())].into(), ..Face::new(outer) }
}

/// The face with normals in the directions given for its corners' positions.
fn smooth(face: Face, mesh: &Mesh, direction: impl Fn(DVec3) -> DVec3) -> Face {
    let normals = face.corners().map(|v| direction(mesh.positions[v as usize]).normalize_or(DVec3::Y)).collect();
    Face { normals, ..face }
}

fn around(i: u32, n: u32) -> f64 {
    f64::from(i) / f64::from(n)
}

/// Corners of a regular polygon of radius 1 at height y, counter-clockwise from above, the first edge in front (+z).
fn ring(n: u32, y: f64) -> Vec<DVec3> {
    let corner = |i: u32| {
        let (sin, cos) = sin_cos_degrees(-90.0 + 360.0 * (f64::from(i) - 0.5) / f64::from(n));
        DVec3::new(cos, y, -sin)
    };
    (0..n).map(corner).collect()
}

/// A level face with u = x and v = 1 - z over the bounding square.
fn cap(outer: Vec<u32>, mesh: &Mesh) -> Face {
    let uv = |&v: &u32| {
        let p = mesh.positions[v as usize];
        DVec2::new((p.x + 1.0) / 2.0, (1.0 - p.z) / 2.0)
    };
    let uv: CornerUvs = outer.iter().map(uv).collect();
    textured(outer, uv)
}

/// Faces: bottom, back, left, right, top, front; each maps 0..1 from its first corner.
pub fn unit_cube() -> Form {
    let corner = |i: u32| {
        let (x, z) = [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)][i as usize % 4];
        DVec3::new(x, f64::from(i / 4), z)
    };
    let faces = [[3, 2, 1, 0], [2, 3, 7, 6], [3, 0, 4, 7], [1, 2, 6, 5], [4, 5, 6, 7], [0, 1, 5, 4]];
    let faces = faces.into_iter().map(|f| textured(f, UNIT_UV)).collect();
    let mesh = Mesh { positions: (0..8).map(corner).collect(), faces };
    Form { instanced: true, ..Form::from_mesh(mesh) }
}
