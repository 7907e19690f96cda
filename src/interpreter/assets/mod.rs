//! Files that rules name: geometry, textures, texts, tables, materials. In: a name written in a rule file and the
//! file's folder. Out: what the file holds, or a typed refusal.

mod cache;
mod contents;
mod files;
mod gltf_file;
mod image_file;
mod material_file;
mod mtl;
mod obj;
mod query;
mod table;
#[cfg(test)]
mod tests;
mod text_file;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use glam::DVec3;

use super::form::Form;
use super::tree::Scalar;
use super::value::Array;
pub use contents::Contents;
pub use files::FileAssets;
pub use image_file::{BUILTIN_IMAGES, ImageInfo, builtin_image};

/// A geometry file.
#[derive(Debug)]
pub struct Asset {
    /// In the file's coordinates, y up.
    pub form: Form,
    /// Least corner and size of its box.
    pub low: DVec3,
    pub size: DVec3,
    /// Single values that the file tells about itself.
    pub metadata: BTreeMap<Arc<str>, Scalar>,
    /// What of the file could not be used.
    pub notes: Vec<String>,
    /// This without what is numerically worthless, once `i` has asked for it; `None` if nothing is.
    pub cleaned: OnceLock<Option<Arc<Asset>>>,
}

/// Why a file cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AssetError {
    #[error("`{0}` was not found")]
    NotFound(String),
    #[error("`{0}`: {1}")]
    NotReadable(String, String),
    #[error("`{0}` is no geometry format that is read (.obj, .gltf, .glb)")]
    UnknownFormat(String),
    #[error("`{0}` is no {1} file")]
    WrongKind(String, &'static str),
    #[error("`{name}` line {line}: {message}")]
    Obj { name: String, line: usize, message: String },
    #[error("`{0}`: {1}")]
    Gltf(String, String),
    #[error("`{0}` is larger than {1} bytes")]
    TooLarge(String, u64),
    #[error("{0}")]
    Query(String),
}

/// Rows of a table, or why there is none.
pub type Table = Result<Arc<Array<Arc<str>>>, AssetError>;

/// Name and value pairs of a material, as `setMaterial` takes them.
pub type Pairs = Vec<(Arc<str>, Arc<str>)>;

/// How a reader gets at other files.
pub struct Files<'a> {
    /// The bytes of a file by its name in the one that is read.
    pub read: &'a dyn Fn(&str) -> Result<Vec<u8>, String>,
    /// The name that textures are loaded by, of a file by its name in the one that is read.
    pub place: &'a dyn Fn(&str) -> String,
    /// The same of an image inside the file, by its number.
    pub embedded: &'a dyn Fn(usize) -> String,
}

/// Where files come from. `folder` is that of the rule file that names them.
pub trait Assets: Sync {
    /// The path of an existing file as the host knows it, or `None`.
    fn locate(&self, folder: &Path, name: &str) -> Option<Arc<str>>;

    /// The geometry of a file.
    fn load(&self, folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError>;

    /// The path that rules see of a path that [`Assets::locate`] gave.
    fn shown(&self, _folder: &Path, located: &Arc<str>) -> Arc<str> {
        located.clone()
    }

    /// Workspace paths of all files that a query matches, sorted (reference 6.5).
    fn search(&self, _folder: &Path, _query: &str) -> Result<Arc<[Arc<str>]>, AssetError> {
        Ok(Arc::default())
    }

    /// Size and channels of an image.
    fn image(&self, _folder: &Path, name: &str) -> Result<ImageInfo, AssetError> {
        Err(AssetError::NotFound(name.to_owned()))
    }

    /// A text with line ends `\n`.
    fn text(&self, _folder: &Path, name: &str) -> Result<Arc<str>, AssetError> {
        Err(AssetError::NotFound(name.to_owned()))
    }

    /// A table of at most `most` cells.
    fn table(&self, _folder: &Path, name: &str, _most: usize) -> Table {
        Err(AssetError::NotFound(name.to_owned()))
    }

    /// A material file.
    fn material(&self, _folder: &Path, name: &str) -> Result<Arc<Pairs>, AssetError> {
        Err(AssetError::NotFound(name.to_owned()))
    }
}

/// A host without files: textures keep their names, everything else is refused.
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

impl Asset {
    pub fn new(form: Form) -> Self {
        let (low, high) = form.mesh.bounds().unwrap_or_default();
        Asset { form, low, size: high - low, metadata: BTreeMap::new(), notes: Vec::new(), cleaned: OnceLock::new() }
    }

    /// Names of the groups, in the order of their first faces.
    pub fn groups(&self) -> Vec<Arc<str>> {
        self.form.labels.as_ref().map_or_else(Vec::new, |labels| labels.group_names.to_vec())
    }

    /// Names of the materials, in the order of their first faces.
    pub fn materials(&self) -> Vec<Arc<str>> {
        let mut seen = std::collections::BTreeSet::new();
        let own = self.form.face_materials.iter().copied().filter(|&m| m > 0 && seen.insert(m));
        let used: Vec<u16> = own.collect();
        used.iter().filter_map(|&m| self.form.materials.get(usize::from(m) - 1)?.name.clone()).collect()
    }
}

impl From<Contents> for Asset {
    fn from(contents: Contents) -> Self {
        let Contents { form, metadata, notes, .. } = contents.finished();
        Asset { metadata, notes, ..Asset::new(form) }
    }
}
