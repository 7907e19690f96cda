//! Geometry files for `i()` and texture paths. In: a name written in a rule file and its folder. Out: an [`Asset`] in
//! its own coordinates, read once per run, or a typed refusal.

mod gltf_file;
mod obj;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::form::Form;
use crate::source::{Access, AccessError};

/// A geometry file.
#[derive(Debug)]
pub struct Asset {
    /// In the file's coordinates, y up.
    pub form: Form,
    /// Least corner and size of its box.
    pub low: DVec3,
    pub size: DVec3,
}

/// Why a geometry file cannot be inserted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssetError {
    #[error("`{0}` was not found")]
    NotFound(String),
    #[error("`{0}`: {1}")]
    NotReadable(String, String),
    #[error("`{0}` is no geometry format that is read (.obj, .gltf, .glb)")]
    UnknownFormat(String),
    #[error("`{name}` line {line}: {message}")]
    Obj { name: String, line: usize, message: String },
    #[error("`{0}`: {1}")]
    Gltf(String, String),
    #[error("`{0}` is larger than {1} bytes")]
    TooLarge(String, u64),
}

/// Where assets come from.
pub trait Assets: Sync {
    /// The path of an existing file as the host knows it, or `None`.
    fn locate(&self, folder: &Path, name: &str) -> Option<Arc<str>>;

    /// The geometry of a file.
    ///
    /// # Errors
    /// See [`AssetError`].
    fn load(&self, folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError>;
}

/// A host without files: textures keep their names, geometry is refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoAssets;

impl Assets for NoAssets {
    fn locate(&self, _folder: &Path, name: &str) -> Option<Arc<str>> {
        Some(name.into())
    }

    fn load(&self, _folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError> {
        Err(AssetError::NotFound(name.to_owned()))
    }
}

/// Files inside the allowed folders; each is read once.
#[derive(Debug)]
pub struct FileAssets {
    access: Access,
    read: Mutex<BTreeMap<PathBuf, Result<Arc<Asset>, AssetError>>>,
}

/// Larger geometry files are refused.
const MOST_BYTES: u64 = 64 << 20;

impl FileAssets {
    pub fn new(access: Access) -> Self {
        FileAssets { access, read: Mutex::default() }
    }

    /// Reference 4.0.6: beside the rule file, in its `assets` folder, and the same one folder up; a leading `/` starts
    /// at the first allowed folder.
    fn resolve(&self, folder: &Path, name: &str) -> Result<PathBuf, AssetError> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let bases = match name.strip_prefix('/') {
            Some(_) => vec![self.access.root().to_owned()],
            None => vec![folder.to_owned(), folder.join("assets"), folder.join(".."), folder.join("../assets")],
        };
        let name = name.trim_start_matches('/');
        let mut refused = None;
        for base in bases {
            match self.access.resolve(&base, name) {
                Ok(path) if path.is_file() => return Ok(path),
                Ok(_) => {}
                Err(AccessError::Outside(path)) => refused = Some(path),
                Err(_) => {}
            }
        }
        Err(match refused {
            Some(path) => AssetError::NotReadable(path, "the path leaves the allowed folders".into()),
            None => AssetError::NotFound(name.to_owned()),
        })
    }

    fn parse(&self, path: &Path, name: &str) -> Result<Asset, AssetError> {
        let unreadable = |e: std::io::Error| AssetError::NotReadable(name.to_owned(), e.to_string());
        if std::fs::metadata(path).map_err(unreadable)?.len() > MOST_BYTES {
            return Err(AssetError::TooLarge(name.to_owned(), MOST_BYTES));
        }
        let bytes = std::fs::read(path).map_err(unreadable)?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase();
        let form = match extension.as_str() {
            "obj" => {
                let library = |file: &str| self.access.read(folder, file, MOST_BYTES).ok().map(|(_, bytes)| bytes);
                obj::read(name, &bytes, folder, &library)?
            }
            "gltf" | "glb" => gltf_file::read(name, &bytes, folder, &self.access)?,
            _ => return Err(AssetError::UnknownFormat(name.to_owned())),
        };
        Ok(Asset::new(form))
    }
}

impl FileAssets {
    /// Every geometry file that was read, sorted.
    pub fn files(&self) -> Vec<PathBuf> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).keys().cloned().collect()
    }
}

impl Asset {
    pub fn new(form: Form) -> Self {
        let (low, high) = form.mesh.bounds().unwrap_or_default();
        Asset { form, low, size: high - low }
    }
}

impl Assets for FileAssets {
    fn locate(&self, folder: &Path, name: &str) -> Option<Arc<str>> {
        self.resolve(folder, name).ok().map(|path| path.to_string_lossy().into())
    }

    fn load(&self, folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError> {
        let path = self.resolve(folder, name)?;
        // A thread that panicked while it held the lock left whole entries behind.
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.entry(path.clone()).or_insert_with(|| self.parse(&path, name).map(Arc::new)).clone()
    }
}
