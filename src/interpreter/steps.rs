//! The tree of shapes a derivation has made. In: a child's parent, number and name. Out: ids, and paths from the root.
//!
//! Steps live in one list for the length of a derivation, so a shape holds a number instead of a chain of references.

use std::sync::Arc;

use smallvec::SmallVec;

/// Child numbers from the root, in place for trees of usual depth.
pub type Path = SmallVec<[u32; 8]>;

/// A shape's place in the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct StepId(u32);

#[derive(Debug)]
struct Step<'p> {
    parent: Option<StepId>,
    /// Number of this shape among its parent's children.
    index: u32,
    depth: u32,
    name: &'p Arc<str>,
}

#[derive(Debug, Default)]
pub struct Steps<'p> {
    list: Vec<Step<'p>>,
}

impl<'p> Steps<'p> {
    pub fn root(&mut self, name: &'p Arc<str>) -> StepId {
        self.add(Step { parent: None, index: 0, depth: 0, name })
    }

    pub fn child(&mut self, parent: StepId, index: u32, name: &'p Arc<str>) -> StepId {
        self.add(Step { parent: Some(parent), index, depth: self.depth(parent) + 1, name })
    }

    fn add(&mut self, step: Step<'p>) -> StepId {
        self.list.push(step);
        StepId(self.list.len() as u32 - 1)
    }

    fn step(&self, id: StepId) -> &Step<'p> {
        &self.list[id.0 as usize]
    }

    pub fn depth(&self, id: StepId) -> u32 {
        self.step(id).depth
    }

    pub fn name(&self, id: StepId) -> &'p Arc<str> {
        self.step(id).name
    }

    /// The step and those above it, without the root.
    fn below_root(&self, id: StepId) -> impl Iterator<Item = &Step<'p>> {
        let mut next = Some(id);
        std::iter::from_fn(move || {
            let step = self.step(next?);
            next = step.parent;
            next.map(|_| step)
        })
    }

    /// Child numbers from the root; none for the root.
    pub fn path(&self, id: StepId) -> Path {
        let mut path = Path::from_elem(0, self.depth(id) as usize);
        path.iter_mut().rev().zip(self.below_root(id)).for_each(|(place, step)| *place = step.index);
        path
    }

    /// The names that led here, from the root to the step's own.
    pub fn names(&self, id: StepId) -> Vec<Arc<str>> {
        let mut names: Vec<Arc<str>> = self.below_root(id).map(|step| step.name.clone()).collect();
        names.extend(self.list.first().map(|root| root.name.clone()));
        names.reverse();
        names
    }

    /// The rules that led here, shortened in the middle: `Lot > Mass > … > Mass > Mass`.
    pub fn chain(&self, id: StepId) -> String {
        const ENDS: usize = 3;
        let mut names: Vec<&str> = self.below_root(id).map(|step| &**step.name).collect();
        names.extend(self.list.first().map(|root| &**root.name));
        names.reverse();
        if names.len() > 2 * ENDS {
            names.splice(ENDS..names.len() - ENDS, ["…"]);
        }
        names.join(" > ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_run_from_the_root() {
        let names: [Arc<str>; 3] = ["Lot".into(), "Mass".into(), "Wall".into()];
        let mut steps = Steps::default();
        let root = steps.root(&names[0]);
        let mass = steps.child(root, 2, &names[1]);
        let wall = steps.child(mass, 5, &names[2]);
        assert!(steps.path(root).is_empty());
        assert_eq!(steps.path(wall)[..], [2, 5]);
        assert_eq!((steps.depth(wall), &**steps.name(wall)), (2, "Wall"));
        assert_eq!(steps.chain(wall), "Lot > Mass > Wall");
        let deep = (0..7).fold(wall, |parent, i| steps.child(parent, i, &names[2]));
        assert_eq!(steps.chain(deep), "Lot > Mass > Wall > … > Wall > Wall > Wall");
        assert_eq!(steps.path(deep)[..], [2, 5, 0, 1, 2, 3, 4, 5, 6]);
    }
}
