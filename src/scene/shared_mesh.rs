//! A mesh that several scenes share. In: a [`TriMesh`]. Out: the same to read, without a copy for every scene; what is
//! computed from it once stays with it.

use std::ops::{Deref, DerefMut};
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::model::TriMesh;

/// Copies are cheap; a copy that is written to becomes a mesh of its own.
#[derive(Clone, Debug, Default)]
pub struct SharedMesh(Arc<Kept>);

#[derive(Debug, Default)]
struct Kept {
    mesh: TriMesh,
    bounds: OnceLock<Option<(DVec3, DVec3)>>,
    digest: OnceLock<[u8; 32]>,
}

impl Clone for Kept {
    fn clone(&self) -> Kept {
        Kept { mesh: self.mesh.clone(), ..Kept::default() }
    }
}

impl From<TriMesh> for SharedMesh {
    fn from(mesh: TriMesh) -> SharedMesh {
        SharedMesh(Arc::new(Kept { mesh, ..Kept::default() }))
    }
}

impl Deref for SharedMesh {
    type Target = TriMesh;

    fn deref(&self) -> &TriMesh {
        &self.0.mesh
    }
}

impl DerefMut for SharedMesh {
    fn deref_mut(&mut self) -> &mut TriMesh {
        let kept = Arc::make_mut(&mut self.0);
        (kept.bounds, kept.digest) = (OnceLock::new(), OnceLock::new());
        &mut kept.mesh
    }
}

impl SharedMesh {
    /// Whether both are the same mesh, not merely equal ones.
    pub fn is(&self, other: &SharedMesh) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Least and greatest corner; `None` for an empty mesh.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        *self.0.bounds.get_or_init(|| {
            let corners = self.positions.iter().map(|&p| (p, p));
            corners.reduce(|(low, high), (p, _)| (low.min(p), high.max(p)))
        })
    }

    /// What `make` makes of the mesh, made once.
    pub fn digest(&self, make: impl FnOnce(&TriMesh) -> [u8; 32]) -> [u8; 32] {
        *self.0.digest.get_or_init(|| make(&self.0.mesh))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_copy_that_is_written_to_forgets_what_was_computed() {
        let mesh = TriMesh { positions: vec![DVec3::ONE, DVec3::X], ..TriMesh::default() };
        let first = SharedMesh::from(mesh);
        assert_eq!(first.bounds(), Some((DVec3::X, DVec3::ONE)));
        let mut second = first.clone();
        assert!(second.is(&first));
        second.positions[0] = DVec3::ZERO;
        assert!(!second.is(&first));
        assert_eq!(second.bounds(), Some((DVec3::ZERO, DVec3::X)));
        assert_eq!(first.bounds(), Some((DVec3::X, DVec3::ONE)));
        assert_eq!(
            (first.digest(|_| [1; 32]), first.digest(|_| [2; 32]), second.digest(|_| [3; 32])),
            ([1; 32], [1; 32], [3; 32])
        );
    }
}
