//! Where a run looked. In: every path that it asked for, existing or not. Out: the paths whose change may change its
//! result.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A list of paths that may be written from any thread; copies write into the same list.
#[derive(Clone, Debug, Default)]
pub struct Looked(Arc<Mutex<BTreeSet<PathBuf>>>);

impl Looked {
    pub fn note(&self, path: &Path) {
        // A path without a working folder to be relative to stays as it is.
        let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(absolute);
    }

    /// All paths so far, absolute, sorted.
    pub fn paths(&self) -> BTreeSet<PathBuf> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}
