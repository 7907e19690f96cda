//! `cleanupGeometry` (reference 4.12). In: what to clean and a tolerance 0..1. Out: close vertices
//! merged, straight corners dropped, edges between coplanar faces dissolved, tiny and doubled faces gone. Tagged edges
//! and vertices stay, and so do edges between faces of different tags, groups or materials. Where an outline would cross
//! itself the tolerance is halved.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::super::derivation::Derivation;
use super::super::form::Form;
use super::super::labels::Tags;
use super::super::shape::Shape;
use super::super::topology::Topology;
use super::args::Args;
use crate::cga::builtins::Word;
use crate::geometry::polygon::ring_contains;
use crate::geometry::polygon_checks::crossing_edges;
use crate::geometry::{Face, Mesh, PlaneFrame};

/// Least merge distance, metres, and angle, degrees, at tolerance 0.
const NUMERICAL: f64 = 1e-6;

/// How often the tolerance is halved before it is given up.
const HALVINGS: usize = 4;

pub fn apply(run: &mut Derivation, args: &Args, shape: &mut Shape) {
    let word = args.word(0).unwrap_or(Word::All);
    let tolerance = args.float_or(run, 1, 0.0).clamp(0.0, 1.0);
    shape.bake();
    if shape.form.mesh.faces.is_empty() {
        return;
    }
    let asked = cleaned(&shape.form, word, tolerance);
    if !crosses_itself(&asked) {
        shape.replace(asked);
        return;
    }
    // The ends of a thin arm fell together, and its sides turned over.
    let less = (1..=HALVINGS).map(|k| tolerance / f64::from(1u32 << k)).chain([0.0]);
    let sound = less.map(|t| cleaned(&shape.form, word, t)).find(|form| !crosses_itself(form));
    shape.replace(sound.unwrap_or(asked));
}

/// Whether the loops of a face cross, seen along its normal.
fn crosses_itself(form: &Form) -> bool {
    form.mesh.faces.iter().filter(|face| face.corners().count() > 3).any(|face| {
        let frame = PlaneFrame::of_face(&form.mesh, face);
        frame.is_some_and(|frame| !crossing_edges(&frame.face_to_plan(&form.mesh, face)).is_empty())
    })
}

fn cleaned(form: &Form, word: Word, tolerance: f64) -> Form {
    let mut form = form.clone();
    let places = merge_vertices(&mut form.mesh, tolerance.max(NUMERICAL));
    if let Some(labels) = &mut form.labels {
        labels.tags = labels.tags.renumbered(|v| places[v as usize]);
    }
    let angle = (10.0 * tolerance).max(NUMERICAL);
    if matches!(word, Word::Edges | Word::All) {
        dissolve_edges(&mut form, angle);
    }
    let mut kept = Vec::with_capacity(form.mesh.faces.len());
    let least_area = if matches!(word, Word::Faces | Word::All) { tolerance.max(NUMERICAL * NUMERICAL) } else { 0.0 };
    for i in 0..form.mesh.faces.len() {
        let face = &form.mesh.faces[i];
        let doubled = least_area > 0.0 && kept.iter().any(|&k: &usize| same_corners(&form.mesh.faces[k], face));
        if face.outer.len() >= 3 && form.mesh.area(face) > least_area && !doubled {
            kept.push(i);
        }
    }
    let mut cleaned = form.part(&kept);
    if matches!(word, Word::Vertices | Word::All) {
        let marked = cleaned.tags().map(Tags::marked_vertices).unwrap_or_default();
        drop_straight_corners(&mut cleaned.mesh, angle, |v| marked.contains(&v));
    }
    let all: Vec<usize> = (0..cleaned.mesh.faces.len()).collect();
    cleaned.part(&all)
}

fn same_corners(a: &Face, b: &Face) -> bool {
    let sorted = |f: &Face| {
        let mut corners: Vec<u32> = f.corners().collect();
        corners.sort_unstable();
        corners
    };
    a.outer.len() == b.outer.len() && sorted(a) == sorted(b)
}

/// Vertices within `distance` become the first of them; corners that fall together become one, and an outline that
/// thereby runs there and back loses the way. Returns what each vertex became.
fn merge_vertices(mesh: &mut Mesh, distance: f64) -> Vec<u32> {
    let cell = |p: DVec3| (p / distance).floor().as_i64vec3().to_array();
    let mut cells: BTreeMap<[i64; 3], Vec<u32>> = BTreeMap::new();
    let mut place: Vec<u32> = Vec::with_capacity(mesh.positions.len());
    for (i, &p) in mesh.positions.iter().enumerate() {
        let [x, y, z] = cell(p);
        let near = (-1..=1).flat_map(|a| {
            (-1..=1).flat_map(move |b| {
                (-1..=1).map(move |c| [x.saturating_add(a), y.saturating_add(b), z.saturating_add(c)])
            })
        });
        let candidates = near.filter_map(|key| cells.get(&key)).flatten();
        let found = candidates.copied().filter(|&v| mesh.positions[v as usize].distance(p) <= distance).min();
        place.push(found.unwrap_or(i as u32));
        if found.is_none() {
            cells.entry([x, y, z]).or_default().push(i as u32);
        }
    }
    for face in &mut mesh.faces {
        face.outer.iter_mut().chain(face.holes.iter_mut().flatten()).for_each(|v| *v = place[*v as usize]);
        let mut before = usize::MAX;
        while face.corners().count() < before {
            before = face.corners().count();
            remove_corners(face, |ring, i| ring[i] == ring[(i + ring.len() - 1) % ring.len()] && ring.len() > 1);
            remove_corners(face, is_needle);
            remove_corners(face, |ring, _| ring.len() < 3);
        }
        face.holes.retain(|hole| !hole.is_empty());
    }
    place
}

/// Whether a loop comes to this corner and leaves it along one edge. Of two such corners in a row only the first.
fn is_needle(ring: &[u32], i: usize) -> bool {
    let at = |k: usize| ring[(i + ring.len() + k) % ring.len()];
    let tip = |k: usize| at(k + ring.len() - 1) == at(k + 1);
    ring.len() > 2 && tip(0) && !(i > 0 && tip(ring.len() - 1))
}

/// Removes the corners of every loop for which the test holds, with their texture coordinates.
pub fn remove_corners(face: &mut Face, test: impl Fn(&[u32], usize) -> bool) {
    let mut keep = Vec::new();
    for ring in face.loops() {
        keep.extend((0..ring.len()).map(|i| !test(ring, i)));
    }
    if keep.iter().all(|k| *k) {
        return;
    }
    let mut flags = keep.iter();
    face.outer.retain(|_| *flags.next().unwrap_or(&true));
    for hole in &mut face.holes {
        hole.retain(|_| *flags.next().unwrap_or(&true));
    }
    for (_, uv) in &mut face.uvs {
        let mut flags = keep.iter();
        uv.retain(|_| *flags.next().unwrap_or(&true));
    }
    let mut flags = keep.iter();
    face.normals.retain(|_| *flags.next().unwrap_or(&true));
}

/// Drops corners where every face that has the vertex runs straight on, except the ends of first edges and those to
/// keep.
fn drop_straight_corners(mesh: &mut Mesh, angle: f64, keep: impl Fn(u32) -> bool) {
    let least = libm::sin(angle.to_radians());
    let mut bent: Vec<bool> = (0..mesh.positions.len() as u32).map(keep).collect();
    for face in &mesh.faces {
        for ring in face.loops() {
            for (i, &v) in ring.iter().enumerate() {
                let at = |k: usize| mesh.positions[ring[k % ring.len()] as usize];
                let before = (at(i) - at(i + ring.len() - 1)).normalize_or_zero();
                let after = (at(i + 1) - at(i)).normalize_or_zero();
                bent[v as usize] |= before.cross(after).length() > least || before.dot(after) < 0.0;
            }
        }
        face.outer.iter().take(2).for_each(|&v| bent[v as usize] = true);
    }
    for face in &mesh.faces {
        keep_where_loops_would_cross(mesh, face, &mut bent);
    }
    for face in &mut mesh.faces {
        remove_corners(face, |ring, i| ring.len() > 3 && !bent[ring[i] as usize]);
    }
}

/// A run of corners stays if the straight line in its place would run past another corner of the face: a hole near a
/// wall that hardly bends.
fn keep_where_loops_would_cross(mesh: &Mesh, face: &Face, bent: &mut [bool]) {
    let Some(frame) = PlaneFrame::of_face(mesh, face) else { return };
    let plan = |&v: &u32| frame.to_plan(mesh.positions[v as usize]);
    for ring in face.loops() {
        let kept: Vec<usize> = (0..ring.len()).filter(|&i| bent[ring[i] as usize]).collect();
        for (k, &start) in kept.iter().enumerate() {
            let end = kept.get(k + 1).copied().unwrap_or(kept[0] + ring.len());
            let run: Vec<u32> = (start..=end).map(|i| ring[i % ring.len()]).collect();
            if run.len() < 3 {
                continue;
            }
            let around: Vec<DVec2> = run.iter().map(plan).collect();
            if face.corners().any(|v| !run.contains(&v) && ring_contains(&around, plan(&v))) {
                run.iter().for_each(|&v| bent[v as usize] = true);
            }
        }
    }
}

/// Joins neighbouring faces without texture coordinates, normals and holes that lie in one plane and share one stretch
/// of edge.
fn dissolve_edges(form: &mut Form, angle: f64) {
    let least = libm::cos(angle.to_radians());
    // What each face that is left was.
    let mut sources: Vec<usize> = (0..form.mesh.faces.len()).collect();
    let mut f = 0;
    while f < sources.len() {
        let topology = Topology::of(&form.mesh);
        let mesh = &form.mesh;
        let joined = topology.face_edges(f).iter().find_map(|&e| {
            let edge = &topology.edges[e as usize];
            let other = [Some(edge.first), edge.second].into_iter().flatten().find(|&o| o as usize != f)? as usize;
            let flat = mesh.normal(&mesh.faces[f]).dot(mesh.normal(&mesh.faces[other])) >= least;
            let alike = || same_names(form, sources[f], sources[other]) && !is_marked(form, &topology, f, other);
            let face = (edge.uses == 2 && flat && alike()).then(|| join(&mesh.faces[f], &mesh.faces[other]))??;
            Some((other, face))
        });
        match joined {
            Some((other, face)) => {
                form.mesh.faces[f] = face;
                form.mesh.faces.remove(other);
                sources.remove(other);
                f -= usize::from(other < f);
            }
            None => f += 1,
        }
    }
    if !form.face_materials.is_empty() {
        form.face_materials = sources.iter().map(|&source| form.face_material(source)).collect();
    }
    if let Some(labels) = &mut form.labels {
        labels.tags = labels.tags.with_faces(&sources);
        labels.face_groups = sources.iter().map(|&source| labels.group(source)).collect();
    }
}

/// Whether two faces, by what they were, have the same material, group and tags.
fn same_names(form: &Form, a: usize, b: usize) -> bool {
    let same_tags = form.tags().is_none_or(|tags| tags.face(a) == tags.face(b));
    same_tags && form.face_material(a) == form.face_material(b) && form.group(a) == form.group(b)
}

/// Whether a tagged edge, or a tagged vertex between two edges, lies between two faces.
fn is_marked(form: &Form, topology: &Topology, f: usize, other: usize) -> bool {
    let Some(tags) = form.tags().filter(|tags| tags.any_edges() || tags.any_vertices()) else { return false };
    let edges = topology.face_edges(f).iter().map(|&e| &topology.edges[e as usize]);
    let is_other = |face: u32| face as usize == other;
    let shared: Vec<[u32; 2]> =
        edges.filter(|e| is_other(e.first) || e.second.is_some_and(is_other)).map(|e| [e.from, e.to]).collect();
    let inner = |v: u32| shared.iter().filter(|ends| ends.contains(&v)).count() > 1;
    shared
        .iter()
        .any(|&edge| !tags.edge(edge).is_empty() || edge.into_iter().any(|v| inner(v) && !tags.vertex(v).is_empty()))
}

/// One loop around both faces; `None` if they share more than one stretch, or carry more than corners.
fn join(a: &Face, b: &Face) -> Option<Face> {
    let is_bare = |f: &Face| f.holes.is_empty() && f.uvs.is_empty() && f.normals.is_empty();
    if !is_bare(a) || !is_bare(b) {
        return None;
    }
    let (n, m) = (a.outer.len(), b.outer.len());
    let place = |v: u32| b.outer.iter().position(|&w| w == v);
    // Edge i of a is shared if b runs it backwards.
    let shared: Vec<bool> =
        (0..n).map(|i| place(a.outer[(i + 1) % n]).is_some_and(|k| b.outer[(k + 1) % m] == a.outer[i])).collect();
    let starts: Vec<usize> = (0..n).filter(|&i| shared[i] && !shared[(i + n - 1) % n]).collect();
    let &[start] = starts.as_slice() else { return None };
    let count = (0..n).take_while(|&k| shared[(start + k) % n]).count();
    let end = (start + count) % n;
    let mut outer: Vec<u32> = (0..n - count).map(|k| a.outer[(end + k) % n]).collect();
    let from = place(a.outer[start])?;
    outer.extend((0..m - count).map(|k| b.outer[(from + k) % m]));
    let first = outer.iter().position(|&v| v == a.outer[0]).unwrap_or(0);
    outer.rotate_left(first);
    Some(Face::new(outer))
}
