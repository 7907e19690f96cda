//! `splitAndSetbackPerimeter` (reference 4.5.5). In: lengths along the perimeter of every face, and a depth for each
//! section. Out: one shape per section of depth above 0, and one per polygon of what remains.
//!
//! Every loop of a face is a perimeter of its own. Where two sections overlap, the deeper one has the place, of equally
//! deep ones the earlier. Sections of equal depth that follow each other meet along the mitre at a corner and square to
//! the edge elsewhere.

use glam::DVec2;

use super::super::derivation::Derivation;
use super::super::environment::Env;
use super::super::limits::Outcome;
use super::super::shape::Shape;
use super::super::value::Value;
use super::Pieces;
use super::args::Args;
use super::perimeter::{Part, Perimeter, Section};
use super::regions::{InFace, region};
use super::setback_tags::{Cuts, Stretch};
use super::split_pattern::{self, size};
use super::split_sizes::Block;
use super::strips::{starting_near, starting_on};
use crate::cga::program::{Arg, Expr, PerimeterItem, SectionPattern, Successor};
use crate::geometry::offset::{Border, setback};
use crate::geometry::{PlaneFrame, Polygon, boolean};
use crate::source::Span;

/// Depth and block of a section of the pattern.
type Content<'p> = (&'p Expr, &'p Successor);

pub fn pieces<'p>(
    run: &mut Derivation<'p>,
    args: &'p [Arg],
    pattern: &'p SectionPattern,
    remainder: Option<&'p Successor>,
    span: Span,
    env: &Env,
) -> Outcome<Pieces<'p>> {
    let evaluated = run.eval_args(args, env)?;
    let args = Args::new(&evaluated, span);
    let mut parent = env.shape.clone();
    parent.bake();
    if parent.form.mesh.faces.is_empty() {
        run.warn("cga::no-face", span, || "there is no face with a perimeter: no pieces".into());
        return Ok(Vec::new());
    }
    let mut contents: Vec<Content<'p>> = Vec::new();
    let blocks = evaluate(run, pattern, &mut contents, env)?;
    let blocks = [Block::Group { blocks, repeat: pattern.repeat }];
    let mut faces = faces(run, &args, &parent, &blocks)?;
    let depths = depths(run, &parent, &faces, &contents, env)?;
    faces.iter_mut().flat_map(FacePlan::sections).zip(&depths).for_each(|(section, depth)| section.depth = *depth);
    let stretches: Vec<Stretch> = faces.iter().flat_map(FacePlan::stretches).collect();
    let cuts = run.program.observes_tags().then_some(Cuts::Stretches(&stretches));
    let mut out: Pieces<'p> = Vec::new();
    let total = depths.len() as u32;
    let mut rests: Vec<InFace> = Vec::new();
    let mut index = 0;
    for face in &faces {
        let cut = face.cut(run, span);
        for (section, polygons) in face.perimeters.iter().flat_map(|p| &p.sections).zip(cut.sections) {
            if !polygons.is_empty() {
                let group: Vec<InFace> = polygons.into_iter().map(|p| (face.number, p)).collect();
                let mut shape = region(&parent, &group, cuts, false);
                shape.split_index = index;
                shape.split_total = total;
                out.push((Box::new(shape), contents[section.content].1));
            }
            index += 1;
        }
        rests.extend(cut.rest.into_iter().map(|p| (face.number, p)));
    }
    if let Some(body) = remainder {
        out.extend(rests.into_iter().map(|rest| (Box::new(region(&parent, &[rest], cuts, true)), body)));
    }
    run.count_shapes(out.len(), span)?;
    Ok(out)
}

/// Every length once, in source order.
fn evaluate<'p>(
    run: &mut Derivation<'p>,
    pattern: &'p SectionPattern,
    contents: &mut Vec<Content<'p>>,
    env: &Env,
) -> Outcome<Vec<Block>> {
    let mut blocks = Vec::with_capacity(pattern.items.len());
    for item in &pattern.items {
        blocks.push(match item {
            PerimeterItem::Section { prefix, length, depth, body } => {
                let x = run.eval_finite(length, env)?;
                contents.push((depth, body));
                Block::Piece { size: size(*prefix, x), body: contents.len() - 1 }
            }
            PerimeterItem::Group(group) => {
                Block::Group { blocks: evaluate(run, group, contents, env)?, repeat: group.repeat }
            }
        });
    }
    Ok(blocks)
}

/// A face in plan, with its perimeters and their sections.
struct FacePlan {
    number: usize,
    frame: PlaneFrame,
    polygon: Polygon,
    perimeters: Vec<Perimeter>,
}

/// Polygons of every section, and of the rest.
struct Cut {
    sections: Vec<Vec<Polygon>>,
    rest: Vec<Polygon>,
}

fn faces(run: &mut Derivation, args: &Args, parent: &Shape, blocks: &[Block]) -> Outcome<Vec<FacePlan>> {
    let mesh = &parent.form.mesh;
    let all: usize = mesh.faces.iter().map(|face| face.edges().count()).sum();
    let start = libm::rint(args.float_or(run, 1, 0.0)).rem_euclid(all.max(1) as f64) as usize;
    let chosen = |edge: usize| match args.value(2) {
        Some(Value::Bools(list)) => list.items.get(edge).copied().unwrap_or(false),
        _ => true,
    };
    let mut out = Vec::with_capacity(mesh.faces.len());
    let mut first_edge = 0;
    for (number, face) in mesh.faces.iter().enumerate() {
        let edges = face.edges().count();
        if let Some(frame) = PlaneFrame::of_face(mesh, face) {
            let polygon = frame.face_to_plan(mesh, face);
            let mut perimeters = Vec::new();
            let mut before = 0;
            for ring in polygon.rings() {
                let own = first_edge + before..first_edge + before + ring.len();
                // `firstEdge` counts within a face that lies after others, too.
                let here = if own.contains(&start) { start - own.start } else { start % ring.len().max(1) };
                let mut perimeter = Perimeter::of(ring, before, here, |i| chosen(own.start + i));
                let offset = args.length(run, 0, perimeter.length());
                if perimeter.length() > 0.0 {
                    let slabs = split_pattern::slabs(run, blocks, perimeter.length(), args.span)?;
                    perimeter.lay(&slabs, offset);
                }
                perimeters.push(perimeter);
                before += ring.len();
            }
            out.push(FacePlan { number, frame, polygon, perimeters });
        }
        first_edge += edges;
    }
    if out.len() < mesh.faces.len() {
        run.warn("cga::no-face", args.span, || "a face without area has no pieces".into());
    }
    Ok(out)
}

/// The depth of every section, evaluated with its `split.index` and `split.total`.
fn depths<'p>(
    run: &mut Derivation<'p>,
    parent: &Shape,
    faces: &[FacePlan],
    contents: &[Content<'p>],
    env: &Env,
) -> Outcome<Vec<f64>> {
    let sections: Vec<usize> =
        faces.iter().flat_map(|f| &f.perimeters).flat_map(|p| &p.sections).map(|s| s.content).collect();
    let mut shape = parent.clone();
    let mut depths = Vec::with_capacity(sections.len());
    for (index, content) in sections.iter().enumerate() {
        shape.split_index = index as i32;
        shape.split_total = sections.len() as u32;
        depths.push(run.eval_finite(contents[*content].0, &env.on_shape(&shape))?.max(0.0));
    }
    Ok(depths)
}

impl FacePlan {
    fn sections(&mut self) -> impl Iterator<Item = &mut Section> {
        self.perimeters.iter_mut().flat_map(|p| &mut p.sections)
    }

    /// What is set back of its edges.
    fn stretches(&self) -> impl Iterator<Item = Stretch> + '_ {
        let stretch = |depth: f64, part: &Part| {
            let ends = [part.from, part.to].map(|p| self.frame.to_space(p, 0.0));
            Stretch { face: self.number, ends, distance: depth }
        };
        let sections = self.perimeters.iter().flat_map(|p| &p.sections).filter(|s| s.depth > 0.0);
        sections.flat_map(move |s| s.parts.iter().map(move |part| stretch(s.depth, part)))
    }

    /// Deeper sections first, each takes what is left of the face.
    fn cut(&self, run: &mut Derivation, span: Span) -> Cut {
        let mut runs: Vec<(f64, Vec<usize>)> = Vec::new();
        let mut before = 0;
        for perimeter in &self.perimeters {
            runs.extend(
                perimeter
                    .runs()
                    .into_iter()
                    .map(|(depth, list)| (depth, list.into_iter().map(|i| before + i).collect())),
            );
            before += perimeter.sections.len();
        }
        runs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let sections: Vec<&Section> = self.perimeters.iter().flat_map(|p| &p.sections).collect();
        let mut cut = Cut { sections: vec![Vec::new(); sections.len()], rest: Vec::new() };
        let mut taken: Vec<Polygon> = Vec::new();
        for (depth, members) in runs {
            let weights = self.weights(depth, members.iter().map(|&i| sections[i]));
            let borders = match setback(&self.polygon, &weights) {
                Ok(result) => result.borders,
                Err(error) => {
                    run.warn("cga::setback", span, || format!("a section was not set back: {error}"));
                    continue;
                }
            };
            for &i in &members {
                match self.section(sections[i], &borders, &taken) {
                    Ok(polygons) => cut.sections[i] = polygons,
                    Err(error) => run.warn("cga::setback", span, || format!("a section was not set back: {error}")),
                }
            }
            taken.extend(members.iter().flat_map(|&i| cut.sections[i].iter().cloned()));
        }
        cut.rest = match boolean::difference(std::slice::from_ref(&self.polygon), &taken) {
            _ if taken.is_empty() => vec![self.polygon.clone()],
            Ok(rest) => rest.into_iter().map(|p| starting_near(p, &self.polygon)).collect(),
            Err(error) => {
                run.warn("cga::setback", span, || format!("the remainder is lost: {error}"));
                Vec::new()
            }
        };
        cut
    }

    /// The depth on all edges of some sections, 0 elsewhere.
    fn weights<'s>(&self, depth: f64, sections: impl Iterator<Item = &'s Section>) -> Vec<f64> {
        let mut weights = vec![0.0; self.polygon.rings().map(Vec::len).sum()];
        sections.flat_map(|s| &s.parts).for_each(|part| weights[part.edge] = depth);
        weights
    }

    /// The strips of a section's edges between its ends, less what is taken.
    fn section(
        &self,
        section: &Section,
        borders: &[Border],
        taken: &[Polygon],
    ) -> Result<Vec<Polygon>, boolean::BooleanError> {
        let mut strips: Vec<Polygon> = Vec::new();
        for part in &section.parts {
            for border in borders.iter().filter(|b| b.edge == part.edge) {
                let whole = Polygon { outer: border.ring.clone(), holes: border.holes.clone() };
                match part.band(&self.polygon) {
                    None => strips.push(whole),
                    Some(band) => strips.extend(boolean::intersection(&[whole], &[band])?),
                }
            }
        }
        let polygons = boolean::difference(&strips, taken)?;
        let segments = || section.parts.iter().map(|part| (part.from, part.to));
        let on_outline = |p: Polygon| starting_on(p, segments().collect::<Vec<(DVec2, DVec2)>>().into_iter());
        Ok(polygons.into_iter().map(on_outline).collect())
    }
}
