//! Files of projects. In: names written in rule files. Out: what the files hold, each read and looked for once per run,
//! from inside the allowed folders only, with bounded sizes.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use super::cache::Cache;
use super::query::Query;
use super::{Asset, AssetError, Assets, Files, ImageInfo, Pairs, gltf_file, image_file, material_file, obj, table};
use crate::interpreter::value::Array;
use crate::source::{Access, AccessError, Project, read_regular};

/// Larger files are refused, bytes.
const MOST_GEOMETRY: u64 = 64 << 20;
const MOST_IMAGE: u64 = 256 << 20;
const MOST_TEXT: u64 = 4 << 20;
const MOST_TABLE: u64 = 16 << 20;
/// Files and folders that a search looks at.
const MOST_LISTED: usize = 200_000;
const DEEPEST: usize = 32;
/// Stands between the path of a file and the number of an image inside it.
const IMAGE_MARK: &str = "#image:";

pub const GEOMETRY: &[&str] = &["obj", "gltf", "glb"];
pub const IMAGES: &[&str] = &["png", "jpg", "jpeg", "tif", "tiff", "tga", "bmp"];
pub const MATERIALS: &[&str] = &["cgamat", "mtl"];
const OTHERS: &[&str] = &["txt", "csv"];

type Found = Result<Arc<PathBuf>, AssetError>;
type Listed = Result<Arc<[Arc<str>]>, AssetError>;
type Table = Result<Arc<Array<Arc<str>>>, AssetError>;

/// Files inside the allowed folders.
#[derive(Debug)]
pub struct FileAssets {
    access: Access,
    folders: Cache<PathBuf, Arc<Folder>>,
    geometry: Cache<PathBuf, Result<Arc<Asset>, AssetError>>,
    images: Cache<PathBuf, Result<ImageInfo, AssetError>>,
    texts: Cache<PathBuf, Result<Arc<str>, AssetError>>,
    tables: Cache<PathBuf, Table>,
    materials: Cache<PathBuf, Result<Arc<Pairs>, AssetError>>,
    listing: OnceLock<Result<Vec<PathBuf>, AssetError>>,
    read: Mutex<BTreeSet<PathBuf>>,
}

/// What is known of a folder of rule files.
#[derive(Debug)]
struct Folder {
    project: Project,
    found: Cache<String, Found>,
    searched: Cache<String, Listed>,
    /// Workspace paths of all files, sorted.
    listed: OnceLock<Listed>,
}

impl FileAssets {
    pub fn new(access: Access) -> Self {
        FileAssets {
            access,
            folders: Cache::default(),
            geometry: Cache::default(),
            images: Cache::default(),
            texts: Cache::default(),
            tables: Cache::default(),
            materials: Cache::default(),
            listing: OnceLock::new(),
            read: Mutex::default(),
        }
    }

    /// The folders that may be read.
    pub fn access(&self) -> &Access {
        &self.access
    }

    /// Every file that was read, sorted.
    pub fn files(&self) -> Vec<PathBuf> {
        self.read.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
    }

    fn folder(&self, folder: &Path) -> Arc<Folder> {
        self.folders.get(folder, || {
            let project = Project::of(folder);
            Arc::new(Folder { project, found: Cache::default(), searched: Cache::default(), listed: OnceLock::new() })
        })
    }

    fn find(&self, folder: &Path, name: &str) -> Found {
        let folder = self.folder(folder);
        folder.found.get(name, || match folder.project.find(&self.access, name) {
            Ok(path) if path.is_file() => Ok(Arc::new(path)),
            Ok(_) => Err(AssetError::NotReadable(brief(name), "it is no regular file".into())),
            Err(error) => Err(refusal(name, error)),
        })
    }

    /// Finds a file of one of some kinds, given by their extensions.
    fn find_kind(&self, folder: &Path, name: &str, kinds: &[&str], what: &'static str) -> Found {
        let path = self.find(folder, name)?;
        match kinds.contains(&extension(&path).as_str()) {
            true => Ok(path),
            false => Err(AssetError::WrongKind(brief(name), what)),
        }
    }

    fn bytes(&self, path: &Path, name: &str, most: u64) -> Result<Vec<u8>, AssetError> {
        let bytes = read_regular(path, most).map_err(|error| refusal(name, error))?;
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned());
        Ok(bytes)
    }

    fn parse(&self, path: &Path, name: &str) -> Result<Asset, AssetError> {
        let bytes = self.bytes(path, name, MOST_GEOMETRY)?;
        let contents = self.with_files(path, |files| match extension(path).as_str() {
            "obj" => {
                obj::read(&bytes, files).map_err(|(line, message)| AssetError::Obj { name: brief(name), line, message })
            }
            "gltf" | "glb" => gltf_file::read(&bytes, files).map_err(|e| AssetError::Gltf(brief(name), e)),
            _ => Err(AssetError::UnknownFormat(brief(name))),
        })?;
        Ok(Asset::from(contents))
    }

    /// Gives a reader of the file at `path` a way to the files that it names, relative to its folder.
    fn with_files<T>(&self, path: &Path, read: impl FnOnce(&Files) -> T) -> T {
        let folder = path.parent().unwrap_or(Path::new("."));
        let bytes = |file: &str| {
            let path = self.access.resolve(folder, file).map_err(|e| e.to_string())?;
            self.bytes(&path, file, MOST_GEOMETRY).map_err(|e| e.to_string())
        };
        let place = |file: &str| {
            let found = self.access.resolve(folder, file).unwrap_or_else(|_| folder.join(file));
            found.to_string_lossy().into_owned()
        };
        let embedded = |number: usize| format!("{}{IMAGE_MARK}{number}", path.to_string_lossy());
        read(&Files { read: &bytes, place: &place, embedded: &embedded })
    }

    /// The encoded bytes of a texture by the name that [`Assets::locate`] or an asset's material gives, and the file
    /// they lie in.
    ///
    /// # Errors
    /// [`AssetError`], also for files that are no images.
    pub fn texture(&self, name: &str) -> Result<(PathBuf, Vec<u8>), AssetError> {
        let (file, number) = split_image(name);
        let path = self.access.resolve(self.access.root(), file).map_err(|error| refusal(name, error))?;
        let Some(number) = number else {
            let bytes = self.bytes(&path, name, MOST_IMAGE)?;
            return Ok((path, bytes));
        };
        let bytes = self.bytes(&path, name, MOST_GEOMETRY)?;
        let image = self.with_files(&path, |files| gltf_file::embedded_image(&bytes, number, files));
        Ok((path, image.map_err(|e| AssetError::Gltf(brief(name), e))?))
    }

    /// All files below the allowed folders, hidden ones left out.
    fn listing(&self) -> Result<&[PathBuf], AssetError> {
        let list = || {
            let mut listing = Listing { access: &self.access, files: BTreeSet::new(), seen: 0 };
            for root in self.access.roots() {
                listing.folder(root, &mut Vec::new())?;
            }
            Ok(listing.files.into_iter().collect())
        };
        self.listing.get_or_init(list).as_deref().map_err(Clone::clone)
    }
}

impl Assets for FileAssets {
    fn locate(&self, folder: &Path, name: &str) -> Option<Arc<str>> {
        let (file, number) = split_image(name);
        let path = self.find(folder, file).ok()?;
        let known = match number {
            Some(_) => GEOMETRY.contains(&extension(&path).as_str()),
            None => [GEOMETRY, IMAGES, MATERIALS, OTHERS].concat().contains(&extension(&path).as_str()),
        };
        let mark = number.map_or_else(String::new, |number| format!("{IMAGE_MARK}{number}"));
        known.then(|| (path.to_string_lossy() + mark.as_str()).into())
    }

    fn shown(&self, folder: &Path, located: &Arc<str>) -> Arc<str> {
        let path = Path::new(&**located);
        let inside = path.is_absolute() && self.access.allows(path);
        if inside { self.folder(folder).project.workspace_path(&self.access, path).into() } else { located.clone() }
    }

    fn load(&self, folder: &Path, name: &str) -> Result<Arc<Asset>, AssetError> {
        let path = self.find(folder, name)?;
        self.geometry.get(path.as_path(), || self.parse(&path, name).map(Arc::new))
    }

    fn image(&self, folder: &Path, name: &str) -> Result<ImageInfo, AssetError> {
        if let (file, Some(_)) = split_image(name) {
            let path = self.find(folder, file)?;
            let whole = PathBuf::from(name);
            return self.images.get(whole.as_path(), || {
                let located = name.replacen(file, &path.to_string_lossy(), 1);
                let (_, bytes) = self.texture(&located)?;
                image_file::read(&bytes, "").map_err(|e| AssetError::NotReadable(brief(name), e))
            });
        }
        let path = self.find_kind(folder, name, IMAGES, "image")?;
        self.images.get(path.as_path(), || {
            let bytes = self.bytes(&path, name, MOST_IMAGE)?;
            image_file::read(&bytes, &extension(&path)).map_err(|e| AssetError::NotReadable(brief(name), e))
        })
    }

    fn text(&self, folder: &Path, name: &str) -> Result<Arc<str>, AssetError> {
        let path = self.find_kind(folder, name, &["txt"], "text (.txt)")?;
        let read = || Ok(super::text_file::read(&self.bytes(&path, name, MOST_TEXT)?).into());
        self.texts.get(path.as_path(), read)
    }

    fn table(&self, folder: &Path, name: &str, most: usize) -> Table {
        let path = self.find_kind(folder, name, &["csv"], "table (.csv)")?;
        self.tables.get(path.as_path(), || {
            let text = super::text_file::read(&self.bytes(&path, name, MOST_TABLE)?);
            table::read(&text, most).map(Arc::new).map_err(|e| AssetError::NotReadable(brief(name), e))
        })
    }

    fn material(&self, folder: &Path, name: &str) -> Result<Arc<Pairs>, AssetError> {
        let path = self.find_kind(folder, name, MATERIALS, "material (.cgamat, .mtl)")?;
        self.materials.get(path.as_path(), || {
            let bytes = self.bytes(&path, name, MOST_TEXT)?;
            let pairs = self.with_files(&path, |files| match extension(&path).as_str() {
                "mtl" => material_file::read_mtl(&bytes, files.place),
                _ => material_file::read_cgamat(&bytes, files.place),
            });
            pairs.map(Arc::new).map_err(|e| AssetError::NotReadable(brief(name), e))
        })
    }

    fn search(&self, folder: &Path, query: &str) -> Listed {
        let folder = self.folder(folder);
        let listed = || {
            let shown = |path: &PathBuf| Arc::from(folder.project.workspace_path(&self.access, path));
            let mut paths: Vec<Arc<str>> = self.listing()?.iter().map(shown).collect();
            paths.sort();
            paths.dedup();
            Ok(paths.into())
        };
        folder.searched.get(query, || {
            let all = folder.listed.get_or_init(listed).clone()?;
            let project = folder.project.workspace_path(&self.access, folder.project.root());
            let query = Query::new(query, &project).map_err(AssetError::Query)?;
            Ok(all.iter().filter(|path| query.matches(path)).cloned().collect())
        })
    }
}

/// The walk through the allowed folders.
struct Listing<'a> {
    access: &'a Access,
    files: BTreeSet<PathBuf>,
    seen: usize,
}

impl Listing<'_> {
    /// `above` are the real paths of the folders on the way here: a link back to one of them is not followed.
    fn folder(&mut self, path: &Path, above: &mut Vec<PathBuf>) -> Result<(), AssetError> {
        let Ok(real) = path.canonicalize() else { return Ok(()) };
        if above.len() >= DEEPEST || above.contains(&real) || !self.access.allows(&real) {
            return Ok(());
        }
        // Folders that cannot be listed hold nothing that could be read.
        self.access.note(path);
        let Ok(entries) = std::fs::read_dir(path) else { return Ok(()) };
        above.push(real);
        for entry in entries.flatten() {
            self.seen += 1;
            if self.seen > MOST_LISTED {
                return Err(AssetError::Query(format!("the allowed folders hold more than {MOST_LISTED} files")));
            }
            let name = entry.file_name();
            if name.to_str().is_none_or(|name| name.starts_with('.')) {
                continue;
            }
            let path = entry.path();
            let Ok(metadata) = std::fs::metadata(&path) else { continue };
            if metadata.is_dir() {
                self.folder(&path, above)?;
            } else if metadata.is_file() && path.canonicalize().is_ok_and(|real| self.access.allows(&real)) {
                self.files.insert(path);
            }
        }
        above.pop();
        Ok(())
    }
}

/// The path of a file and the number of the image inside it.
fn split_image(name: &str) -> (&str, Option<usize>) {
    match name.rsplit_once(IMAGE_MARK).map(|(file, number)| (file, number.parse())) {
        Some((file, Ok(number))) => (file, Some(number)),
        _ => (name, None),
    }
}

fn extension(path: &Path) -> String {
    path.extension().and_then(|e| e.to_str()).unwrap_or("").to_ascii_lowercase()
}

/// A name for messages.
fn brief(name: &str) -> String {
    const MOST: usize = 120;
    let mut out: String = name.chars().take(MOST).flat_map(char::escape_debug).collect();
    if name.chars().nth(MOST).is_some() {
        out.push('…');
    }
    out
}

fn refusal(name: &str, error: AccessError) -> AssetError {
    let why = |why: &str| AssetError::NotReadable(brief(name), why.to_owned());
    match error {
        AccessError::Outside(_) => why("the path leaves the allowed folders"),
        AccessError::Name { why: reason, .. } => why(reason),
        AccessError::NotAFile(_) => why("it is no regular file"),
        AccessError::TooLarge { most, .. } => AssetError::TooLarge(brief(name), most),
        AccessError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            AssetError::NotFound(brief(name))
        }
        AccessError::Io { source, .. } => why(&source.to_string()),
    }
}
