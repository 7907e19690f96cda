//! In: a path written in a recipe or a rule file. Out: a real path inside the allowed folders, or a typed refusal.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::looked::Looked;

/// Why a path could not be used.
#[derive(Debug, thiserror::Error)]
pub enum AccessError {
    #[error("{0} leaves the recipe's folder tree")]
    Outside(String),
    #[error("{path}: {source}")]
    Io { path: String, source: io::Error },
    #[error("{name}: {why}")]
    Name { name: String, why: &'static str },
    #[error("{0} is no regular file")]
    NotAFile(String),
    #[error("{path} is larger than {most} bytes")]
    TooLarge { path: String, most: u64 },
}

/// Larger rule files and recipes are refused.
pub const MOST_TEXT_BYTES: u64 = 64 << 20;
/// Longest path that a text may name, bytes.
const LONGEST_NAME: usize = 4096;

/// Texts that stand for files by their real paths: what an editor shows and has not saved. A text may stand for a file
/// that does not exist.
#[derive(Clone, Debug, Default)]
pub struct Overlay(Arc<BTreeMap<PathBuf, Arc<str>>>);

impl Overlay {
    pub fn new(texts: BTreeMap<PathBuf, Arc<str>>) -> Self {
        Overlay(Arc::new(texts))
    }

    pub fn get(&self, real: &Path) -> Option<&Arc<str>> {
        self.0.get(real)
    }
}

/// The folders that a run may read: the tree of the file it was started with and those the command line adds.
#[derive(Clone, Debug)]
pub struct Access {
    /// Canonical folders.
    roots: Vec<PathBuf>,
    /// Where every path that is looked for is written down.
    looked: Option<Looked>,
    overlay: Overlay,
}

impl Access {
    /// Allows `root` and everything below it.
    pub fn new(root: &Path) -> Result<Self, AccessError> {
        let mut access = Access { roots: Vec::new(), looked: None, overlay: Overlay::default() };
        access.allow(root)?;
        Ok(access)
    }

    /// The same folders; every path that is looked for from now on is written down.
    pub fn noting(&self, looked: Looked) -> Access {
        Access { looked: Some(looked), ..self.clone() }
    }

    /// Writes down a path that is looked for, whether it exists or not, or a folder that is listed.
    pub fn note(&self, path: &Path) {
        if let Some(looked) = &self.looked {
            looked.note(path);
        }
    }

    /// Allows one more folder tree.
    pub fn allow(&mut self, root: &Path) -> Result<(), AccessError> {
        let root = if root.as_os_str().is_empty() { Path::new(".") } else { root };
        self.roots.push(root.canonicalize().map_err(|source| io_error(root, source))?);
        Ok(())
    }

    /// Reads these texts in the place of files.
    pub fn with_overlay(self, overlay: &Overlay) -> Self {
        Access { overlay: overlay.clone(), ..self }
    }

    /// The first allowed folder.
    pub fn root(&self) -> &Path {
        &self.roots[0]
    }

    /// Every allowed folder.
    pub fn roots(&self) -> &[PathBuf] {
        &self.roots
    }

    /// Whether a canonical path lies in an allowed folder.
    pub fn allows(&self, real: &Path) -> bool {
        self.roots.iter().any(|root| real.starts_with(root))
    }

    /// Resolves `named`, relative to the folder `base`, to an existing path inside an allowed folder.
    /// Links are followed before the check, so a link cannot lead outside; what lies outside is refused in the same
    /// words whether it exists or not.
    pub fn resolve(&self, base: &Path, named: &str) -> Result<PathBuf, AccessError> {
        check_name(named)?;
        let joined = if base.as_os_str().is_empty() { PathBuf::from(named) } else { base.join(named) };
        self.note(&joined);
        match joined.canonicalize() {
            Ok(real) if self.allows(&real) => Ok(real),
            Err(source) => match nearest_real(&joined) {
                real if !self.allows(&real) => Err(AccessError::Outside(shortened(named))),
                real if self.overlay.get(&real).is_some() => Ok(real),
                _ => Err(io_error(&joined, source)),
            },
            Ok(_) => Err(AccessError::Outside(shortened(named))),
        }
    }

    /// Resolves and reads a file of at most `most` bytes.
    pub fn read(&self, base: &Path, named: &str, most: u64) -> Result<(PathBuf, Vec<u8>), AccessError> {
        let path = self.resolve(base, named)?;
        let bytes = self.read_real(&path, most)?;
        Ok((path, bytes))
    }

    /// Reads what [`Access::resolve`] found: at most `most` bytes.
    pub fn read_real(&self, real: &Path, most: u64) -> Result<Vec<u8>, AccessError> {
        match self.overlay.get(real) {
            Some(text) => Ok(text.as_bytes().to_vec()),
            None => read_regular(real, most),
        }
    }
}

/// Reads a file of at most `most` bytes. Folders, pipes and devices are refused before they are opened: opening a pipe
/// would wait for its other end.
pub fn read_regular(path: &Path, most: u64) -> Result<Vec<u8>, AccessError> {
    let failed = |source| io_error(path, source);
    let is_file = |metadata: &std::fs::Metadata| match metadata.is_file() {
        true => Ok(()),
        false => Err(AccessError::NotAFile(path.display().to_string())),
    };
    let too_large = || AccessError::TooLarge { path: path.display().to_string(), most };
    is_file(&std::fs::metadata(path).map_err(failed)?)?;
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    is_file(&metadata)?;
    if metadata.len() > most {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    // A file may grow while it is read, or not tell its size.
    file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most { Err(too_large()) } else { Ok(bytes) }
}

/// Refuses names that no file of a project has, before the file system is asked: on Windows a name with two slashes in
/// front would ask another machine.
fn check_name(named: &str) -> Result<(), AccessError> {
    let why = if named.len() > LONGEST_NAME {
        "the path is too long"
    } else if named.contains('\0') {
        "a path cannot contain the character 0"
    } else if named.starts_with("//") || named.starts_with("\\\\") {
        "paths to other machines are not read"
    } else {
        return Ok(());
    };
    Err(AccessError::Name { name: shortened(named), why })
}

/// The real path of the deepest existing folder above a missing path, and the rest of it without `.` and `..`.
fn nearest_real(path: &Path) -> PathBuf {
    let parts: Vec<Component> = path.components().collect();
    let existing = (0..=parts.len()).rev().find_map(|n| {
        let head: PathBuf = if n == 0 { PathBuf::from(".") } else { parts[..n].iter().collect() };
        Some((n, head.canonicalize().ok()?))
    });
    let Some((n, mut out)) = existing else { return path.to_owned() };
    for part in &parts[n..] {
        match part {
            Component::ParentDir => drop(out.pop()),
            other => out.push(other),
        }
    }
    out
}

/// A name for messages: control characters are escaped, the end of a long one is left out.
fn shortened(named: &str) -> String {
    const MOST: usize = 120;
    let mut out: String = named.chars().take(MOST).flat_map(|c| c.escape_debug()).collect();
    if named.chars().nth(MOST).is_some() {
        out.push('…');
    }
    out
}

fn io_error(path: &Path, source: io::Error) -> AccessError {
    AccessError::Io { path: shortened(&path.display().to_string()), source }
}

#[cfg(test)]
mod tests;
