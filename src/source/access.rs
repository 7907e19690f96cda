//! In: a path written in a recipe or a rule file. Out: a real path inside the allowed folders, or a typed refusal.

use std::io;
use std::path::{Component, Path, PathBuf};

/// Why a path could not be used.
#[derive(Debug, thiserror::Error)]
pub enum AccessError {
    #[error("{0} leaves the recipe's folder tree")]
    Outside(String),
    #[error("{path}: {source}")]
    Io { path: String, source: io::Error },
}

/// The folders that a run may read: the tree of the file it was started with and those the command line adds.
#[derive(Clone, Debug)]
pub struct Access {
    /// Canonical folders.
    roots: Vec<PathBuf>,
}

impl Access {
    /// Allows `root` and everything below it.
    pub fn new(root: &Path) -> Result<Self, AccessError> {
        let mut access = Access { roots: Vec::new() };
        access.allow(root)?;
        Ok(access)
    }

    /// Allows one more folder tree.
    pub fn allow(&mut self, root: &Path) -> Result<(), AccessError> {
        let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
        self.roots.push(root.canonicalize().map_err(|source| io_error(root, source))?);
        Ok(())
    }

    /// The first allowed folder.
    pub fn root(&self) -> &Path {
        &self.roots[0]
    }

    /// Resolves `named`, relative to the folder `base`, to an existing path inside an allowed folder.
    /// Links are followed before the check, so a link cannot lead outside.
    pub fn resolve(&self, base: &Path, named: &str) -> Result<PathBuf, AccessError> {
        let joined = base.join(named);
        if !self.roots.iter().any(|root| lexical(base, named).starts_with(root)) {
            return Err(AccessError::Outside(named.to_owned()));
        }
        let real = joined.canonicalize().map_err(|source| io_error(&joined, source))?;
        if self.roots.iter().any(|root| real.starts_with(root)) {
            Ok(real)
        } else {
            Err(AccessError::Outside(named.to_owned()))
        }
    }

    /// Resolves and reads a file.
    pub fn read(&self, base: &Path, named: &str) -> Result<(PathBuf, Vec<u8>), AccessError> {
        let path = self.resolve(base, named)?;
        let bytes = std::fs::read(&path).map_err(|source| io_error(&path, source))?;
        Ok((path, bytes))
    }
}

/// `base/named` with `.` and `..` taken out as text, so that a missing file outside is refused as outside.
fn lexical(base: &Path, named: &str) -> PathBuf {
    let base = if base.as_os_str().is_empty() { Path::new(".") } else { base };
    let mut out = base.canonicalize().unwrap_or_else(|_| base.to_owned());
    for part in Path::new(named).components() {
        match part {
            Component::ParentDir => {
                out.pop();
            }
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => out = PathBuf::from(part.as_os_str()),
            Component::Normal(name) => out.push(name),
        }
    }
    out
}

fn io_error(path: &Path, source: io::Error) -> AccessError {
    AccessError::Io { path: path.display().to_string(), source }
}
