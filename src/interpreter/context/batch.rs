//! Many start shapes that see each other. In: their programs and meshes. Out: which of them need a first derivation, and
//! the second derivation of each; a host may run either in any order and on any number of threads.

use std::sync::Arc;

use super::super::assets::Assets;
use super::super::limits::Limits;
use super::super::tree::ShapeTree;
use super::super::{StartShape, derive, derive_among, survey};
use super::{Surroundings, Survey};
use crate::cga::program::Program;
use crate::geometry::box_tree::{Bounds, BoxTree};

/// Worlds a start shape is in, by bits: a scene before a change and after it are two. Who is in none of the worlds
/// another one sees is never met.
pub type Worlds = u8;

/// One start shape of a batch.
#[derive(Clone, Debug)]
pub struct Member<'a> {
    pub program: &'a Program,
    pub start: Arc<StartShape>,
    pub is_in: Worlds,
    pub sees: Worlds,
}

/// Start shapes whose boxes are within this of each other, seen from above, meet in occlusion queries, metres
/// (reference 6.8).
pub const REACH: f64 = 1.0;

/// Start shapes with who is near whom.
pub struct Batch<'a> {
    members: &'a [Member<'a>],
    assets: &'a dyn Assets,
    limits: &'a Limits,
    /// By member: those within reach, for members that ask.
    near: Vec<Vec<u32>>,
    surveyed: Vec<bool>,
}

impl<'a> Batch<'a> {
    pub fn new(members: &'a [Member<'a>], assets: &'a dyn Assets, limits: &'a Limits) -> Self {
        let mut batch = Batch { members, assets, limits, near: vec![Vec::new(); members.len()], surveyed: Vec::new() };
        batch.surveyed = members.iter().map(|member| member.program.needs().own).collect();
        if members.iter().any(|member| member.program.needs().near) {
            batch.find_neighbours();
        }
        if members.iter().any(|member| member.program.needs().far) {
            for (surveyed, member) in batch.surveyed.iter_mut().zip(members) {
                *surveyed |= member.program.needs().labels;
            }
        }
        batch
    }

    fn find_neighbours(&mut self) {
        let nowhere = Bounds { lo: glam::DVec3::INFINITY, hi: glam::DVec3::NEG_INFINITY };
        let level = |member: &Member| match Bounds::around(member.start.mesh.positions.iter().map(|p| p.with_y(0.0))) {
            Some(bounds) => bounds,
            None => nowhere,
        };
        let boxes: Vec<Bounds> = self.members.iter().map(level).collect();
        let tree = BoxTree::new(boxes.clone());
        for (i, member) in self.members.iter().enumerate().filter(|(_, member)| member.program.needs().near) {
            let around = tree.touching(&boxes[i].grown(REACH)).into_iter();
            let near = around.filter(|&j| j != i && self.members[j].is_in & member.sees != 0);
            self.near[i] = near.map(|j| j as u32).collect();
        }
        for &j in self.near.iter().flatten() {
            self.surveyed[j as usize] = true;
        }
    }

    /// Whether the start shape needs a first derivation.
    pub fn needs_survey(&self, number: usize) -> bool {
        self.surveyed[number]
    }

    /// The first derivation, where it is needed.
    pub fn survey(&self, number: usize) -> Option<Survey> {
        let Member { program, start, .. } = &self.members[number];
        self.needs_survey(number).then(|| survey(program, start, self.assets, self.limits))
    }

    /// The second derivation, or the only one. `surveys` holds [`Batch::survey`] of every member.
    pub fn derive(&self, number: usize, surveys: &[Option<Survey>], assets: &dyn Assets) -> ShapeTree {
        let Member { program, start, .. } = &self.members[number];
        match self.surroundings(number, surveys) {
            None => derive(program, start, assets, self.limits),
            Some(surroundings) => derive_among(program, start, assets, self.limits, &surroundings),
        }
    }

    /// What the queries of a member are answered from; `None` where it has none.
    pub fn surroundings<'s>(&self, number: usize, surveys: &'s [Option<Survey>]) -> Option<Surroundings<'s>> {
        let Member { program, sees, .. } = &self.members[number];
        let needs = program.needs();
        if !needs.asks() {
            return None;
        }
        let near = self.near[number].iter().filter_map(|&j| surveys[j as usize].as_ref()).collect();
        let others = (0..self.members.len()).filter(|&j| needs.far && j != number && self.members[j].is_in & sees != 0);
        let labelled = others.filter(|&j| self.members[j].program.needs().labels);
        let labelled = labelled.filter_map(|j| surveys[j].as_ref()).collect();
        Some(Surroundings { own: surveys[number].as_ref(), near, labelled })
    }

    /// Everything on this thread.
    pub fn derive_all(&self) -> Vec<ShapeTree> {
        let surveys: Vec<Option<Survey>> = (0..self.members.len()).map(|i| self.survey(i)).collect();
        (0..self.members.len()).map(|i| self.derive(i, &surveys, self.assets)).collect()
    }
}
