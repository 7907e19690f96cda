//! `scatter` (reference 4.13). In: a domain, a number and a distribution. Out: that many point shapes on the surface,
//! in the volume or in the scope's box.
//!
//! Point i depends on the shape's seed, the place of the operation and i alone, so asking for more points keeps the
//! first ones.

use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::form::Form;
use super::super::labels::Labels;
use super::super::limits::Outcome;
use super::super::placement::{Frame, perpendicular};
use super::super::seed::Seed;
use super::super::shape::{Scope, Shape};
use super::Pieces;
use super::args::Args;
use super::scatter_gauss::Bell;
use super::scatter_solid::Solid;
use crate::cga::builtins::Word;
use crate::cga::program::{Prefix, Successor};
use crate::geometry::Mesh;
use crate::geometry::plane::unit;
use crate::geometry::triangulate::triangles;

/// Kind of seed of a scatter's points below the operation's.
const POINTS: u64 = 5 << 40;

pub fn pieces<'p>(run: &mut Derivation<'p>, args: &Args, body: &'p Successor, env: &Env) -> Outcome<Pieces<'p>> {
    let n = libm::rint(args.float_or(run, 1, 0.0));
    if n <= 0.0 {
        run.warn("cga::scatter-count", args.span, || format!("{n} points are no points"));
        return Ok(Vec::new());
    }
    run.count_shapes(if n < usize::MAX as f64 { n as usize } else { usize::MAX }, args.span)?;
    let mut parent = env.shape.clone();
    parent.bake();
    let Some(domain) = domain(run, args, &parent) else { return Ok(Vec::new()) };
    let bell = (args.word(2) == Some(Word::Gaussian)).then(|| bell(run, args, &parent.scope));
    let seed = env.seed().part(POINTS);
    let place = |i: u64| {
        let dice = Dice { seed: seed.part(i), drawn: 0 };
        match &bell {
            None => domain.uniform(dice),
            Some(bell) => domain.gaussian(bell, dice),
        }
    };
    let group: Arc<[Arc<str>]> = Arc::new(["builtin:point".into()]);
    let labels = Labels { group_names: group, ..Labels::default() };
    Ok((0..n as u64).map(|i| (Box::new(point_shape(&parent, &labels, place(i))), body)).collect())
}

/// A point and, on a surface, its normal.
type Place = (DVec3, Option<DVec3>);

/// Numbers of one point, in order.
pub struct Dice {
    seed: Seed,
    drawn: u64,
}

impl Dice {
    /// In [0, 1).
    pub fn roll(&mut self) -> f64 {
        self.drawn += 1;
        self.seed.part(self.drawn).unit()
    }

    pub fn roll3(&mut self) -> DVec3 {
        DVec3::new(self.roll(), self.roll(), self.roll())
    }
}

enum Domain {
    Surface(Surface),
    Volume(Solid, Surface),
    Box(Scope),
}

/// What the points lie on or in; nothing and a warning where there is none.
fn domain(run: &mut Derivation, args: &Args, parent: &Shape) -> Option<Domain> {
    let word = args.word(0);
    if word == Some(Word::Scope) {
        return Some(Domain::Box(parent.scope));
    }
    let surface = Surface::of(&parent.form.mesh);
    if surface.area() <= 0.0 {
        run.warn("cga::scatter-empty", args.span, || "there is no surface to scatter points on".into());
        return None;
    }
    if word != Some(Word::Volume) {
        return Some(Domain::Surface(surface));
    }
    match Solid::of(&parent.form.mesh) {
        Some(solid) => Some(Domain::Volume(solid, surface)),
        None => {
            run.warn("cga::scatter-open", args.span, || "this geometry is not closed: its surface is used".into());
            Some(Domain::Surface(surface))
        }
    }
}

/// The distribution around a point of the scope's box; by default the middle and 0.16 of the box.
fn bell(run: &mut Derivation, args: &Args, scope: &Scope) -> Bell {
    let mean = match args.word(3) {
        Some(Word::Front) => DVec3::new(0.5, 0.5, 1.0),
        Some(Word::Back) => DVec3::new(0.5, 0.5, 0.0),
        Some(Word::Left) => DVec3::new(0.0, 0.5, 0.5),
        Some(Word::Right) => DVec3::new(1.0, 0.5, 0.5),
        Some(Word::Top) => DVec3::new(0.5, 1.0, 0.5),
        Some(Word::Bottom) => DVec3::new(0.5, 0.0, 0.5),
        _ => DVec3::splat(0.5),
    };
    const SHARE: f64 = 0.16;
    let given = args.float(run, 4);
    let deviation = match (given, args.prefix(4)) {
        (None, _) => scope.size.abs() * SHARE,
        (Some(x), Prefix::Absolute) => DVec3::splat(x.abs()),
        (Some(x), _) => scope.size.abs() * x.abs(),
    };
    Bell { scope: *scope, mean: mean * scope.size, deviation }
}

impl Domain {
    fn uniform(&self, mut dice: Dice) -> Place {
        match self {
            Domain::Surface(surface) => surface.uniform(&mut dice),
            Domain::Box(scope) => (scope.frame.world_from_local(dice.roll3() * scope.size), None),
            Domain::Volume(solid, _) => (solid.uniform(&mut dice), None),
        }
    }

    /// Points off the domain are drawn again; after [`TRIES`] the nearest point of the surface is taken (reference A37).
    fn gaussian(&self, bell: &Bell, mut dice: Dice) -> Place {
        match self {
            Domain::Box(_) => (bell.draw(&mut dice), None),
            Domain::Volume(solid, surface) => {
                let mut p = bell.draw(&mut dice);
                for _ in 0..TRIES {
                    if solid.contains(p) {
                        return (p, None);
                    }
                    p = bell.draw(&mut dice);
                }
                (surface.nearest(p).0, None)
            }
            Domain::Surface(surface) => {
                let mut found = surface.nearest(bell.draw(&mut dice));
                for _ in 0..TRIES {
                    // On a flat shape the points that had to be moved lie outside; on any other all are projected.
                    if !surface.flat || found.2 <= surface.tolerance {
                        break;
                    }
                    found = surface.nearest(bell.draw(&mut dice));
                }
                (found.0, Some(found.1))
            }
        }
    }
}

const TRIES: usize = 200;

/// Triangles with the area up to and with each.
struct Surface {
    triangles: Vec<[DVec3; 3]>,
    sums: Vec<f64>,
    /// All in one plane.
    flat: bool,
    tolerance: f64,
}

impl Surface {
    fn of(mesh: &Mesh) -> Surface {
        let list: Vec<[DVec3; 3]> = triangles(mesh).map(|(_, corners)| corners).collect();
        let mut total = 0.0;
        let mut sums = Vec::with_capacity(list.len());
        for [a, b, c] in &list {
            total += (b - a).cross(c - a).length() / 2.0;
            sums.push(total);
        }
        let extent = mesh.bounds().map_or(0.0, |(low, high)| (high - low).length());
        let tolerance = 1e-9 * extent;
        let first = list.first().map_or(DVec3::ZERO, |t| t[0]);
        let normal = list.first().map_or(DVec3::ZERO, normal_of);
        let flat = list.iter().flatten().all(|p| (p - first).dot(normal).abs() <= 1e-6 * extent);
        Surface { triangles: list, sums, flat, tolerance }
    }

    fn area(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    fn uniform(&self, dice: &mut Dice) -> Place {
        let wanted = dice.roll() * self.area();
        let number = self.sums.partition_point(|&sum| sum <= wanted).min(self.triangles.len() - 1);
        let [a, b, c] = self.triangles[number];
        // Turk 1990, "Generating random points in triangles".
        let (s, t) = (dice.roll().sqrt(), dice.roll());
        let p = a * (1.0 - s) + b * (s * (1.0 - t)) + c * (s * t);
        (p, Some(normal_of(&self.triangles[number])))
    }

    /// The nearest point, the normal there, and the distance to it.
    fn nearest(&self, p: DVec3) -> (DVec3, DVec3, f64) {
        let mut best = (p, DVec3::Y, f64::INFINITY);
        for triangle in &self.triangles {
            let q = nearest_in_triangle(p, triangle);
            let distance = p.distance(q);
            if distance < best.2 {
                best = (q, normal_of(triangle), distance);
            }
        }
        best
    }
}

fn normal_of([a, b, c]: &[DVec3; 3]) -> DVec3 {
    unit((b - a).cross(c - a)).unwrap_or(DVec3::Y)
}

/// Ericson 2005, "Real-Time Collision Detection", 5.1.5.
fn nearest_in_triangle(p: DVec3, &[a, b, c]: &[DVec3; 3]) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

/// A single vertex of group `builtin:point` in a scope of size 0; on a surface y is the normal and x as near to the old x as can be.
fn point_shape(parent: &Shape, labels: &Labels, (position, normal): Place) -> Shape {
    let old = parent.scope.frame.axes;
    let axes = normal.map_or(old, |y| {
        let x = perpendicular(y, old.x_axis, old.z_axis);
        DMat3::from_cols(x, y, x.cross(y))
    });
    let mut form = Form { labels: Some(Box::new(labels.clone())), ..Form::default() };
    form.mesh.positions.push(position);
    form.normals.push(normal.unwrap_or(old.y_axis));
    let mut shape = parent.clone();
    shape.scope = Scope { frame: Frame { origin: position, axes }, size: DVec3::ZERO };
    shape.binding = shape.scope;
    shape.form = Arc::new(form);
    shape
}
