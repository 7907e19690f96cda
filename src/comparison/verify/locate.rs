//! Where a dataset's inputs lie. In: its manifest and folders to look in. Out: the recipe with everything it reads in its
//! place: where it lies if all is there, else gathered by content in a temporary folder. What is missing or has another
//! content is refused, all of it at once.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use super::search::{Search, content_sha256};
use super::{VerifyOptions, another_content};
use crate::comparison::error::ComparisonError;
use crate::comparison::stored::{Stored, StoredInput};
use crate::dataset::writer::sha256;
use crate::pipeline::shipped;

/// A recipe ready to run.
pub struct Located {
    pub recipe: PathBuf,
    pub arguments: Vec<(String, String)>,
    pub allow: Vec<PathBuf>,
    /// Lines on inputs that were found elsewhere.
    pub gathered: Vec<String>,
    _folder: Option<tempfile::TempDir>,
}

/// What rule files that come with the program are called.
const SHIPPED: &str = "mansard:";

/// Finds everything; see the module.
pub fn locate(stored: &Stored, folder: &Path, options: &VerifyOptions) -> Result<Located, ComparisonError> {
    let main = main_input(stored, options)?;
    let folders = folders(folder, options);
    // Folders are listed only where something does not lie in its place.
    let search: OnceCell<Search> = OnceCell::new();
    let listed = || search.get_or_init(|| Search::new(&folders, folder));
    let recipe = match &options.recipe {
        Some(recipe) => recipe.clone(),
        None => {
            let nearby = folders.iter().map(|folder| folder.join(&main.name));
            let mut nearby = nearby.filter(|path| content_sha256("recipe", path).as_ref() == Some(&main.sha256));
            match nearby.next() {
                Some(found) => found,
                None => found_recipe(main, listed())?,
            }
        }
    };
    check_recipe(main, &recipe)?;

    // Every other input where the recipe would read it, else wherever its content lies.
    let root = recipe.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    let renamed = recipe.file_name().is_some_and(|name| name.to_string_lossy() != main.name);
    let mut lines = Vec::new();
    let mut places: Vec<(&StoredInput, PathBuf)> = vec![(main, recipe.clone())];
    let mut gathered = Vec::new();
    if renamed {
        gathered.push(format!("recipe {}: {}", main.name, recipe.display()));
    }
    for input in stored.inputs.iter().filter(|input| *input != main) {
        if let Some(name) = input.name.strip_prefix(SHIPPED) {
            lines.extend(check_shipped(input, name));
            continue;
        }
        let own = input.path.as_ref().map(|path| root.join(path));
        let own_content = own.as_ref().and_then(|own| content_sha256(&input.role, own));
        if let (Some(own), true) = (&own, own_content.as_ref() == Some(&input.sha256)) {
            places.push((input, own.clone()));
            continue;
        }
        let search = listed();
        match search.by_content(input) {
            Some(found) => {
                if own.is_some() {
                    gathered.push(format!("{} {}: {}", input.role, input.name, found.display()));
                }
                places.push((input, found));
            }
            None => lines.push(refusal(input, own.as_deref().zip(own_content), search)),
        }
    }
    if !lines.is_empty() {
        return Err(ComparisonError::Inputs(lines));
    }
    place(stored, (main, &root), places, gathered, options)
}

/// The main recipe among the inputs.
fn main_input<'a>(stored: &'a Stored, options: &VerifyOptions) -> Result<&'a StoredInput, ComparisonError> {
    let recipes = || stored.inputs.iter().filter(|input| input.role == "recipe");
    let given =
        options.recipe.as_ref().and_then(|path| path.file_name()).map(|name| name.to_string_lossy().into_owned());
    let named = stored.recipe.clone().or(given);
    let Some(name) = named else {
        let why = "its manifest does not say which recipe made it; `--recipe FILE` does".to_owned();
        return Err(ComparisonError::Unverifiable(why));
    };
    let beside = |input: &&StoredInput| input.name == name && input.path.as_ref().is_none_or(|path| *path == name);
    recipes()
        .find(beside)
        .or_else(|| recipes().find(|input| input.name == name))
        .ok_or_else(|| ComparisonError::Unverifiable(format!("its manifest has no recipe {name} among the inputs")))
}

/// Where inputs are looked for: what the command line names, about the dataset, here.
fn folders(dataset: &Path, options: &VerifyOptions) -> Vec<PathBuf> {
    let mut folders: Vec<PathBuf> = options.inputs.clone();
    folders.extend(options.recipe.as_ref().and_then(|recipe| recipe.parent()).map(|parent| match parent {
        parent if parent.as_os_str().is_empty() => PathBuf::from("."),
        parent => parent.to_owned(),
    }));
    if options.recipe.is_none() && options.inputs.is_empty() {
        folders.push(dataset.to_owned());
    }
    folders.push(PathBuf::from("."));
    folders.push(dataset.join(".."));
    folders
}

fn found_recipe(main: &StoredInput, search: &Search) -> Result<PathBuf, ComparisonError> {
    search.by_content(main).ok_or_else(|| {
        let why = match search.by_name(main) {
            Some(other) => {
                let found = content_sha256("recipe", other).unwrap_or_else(|| "no readable content".to_owned());
                another_content("recipe", &main.name, &main.sha256, &other.display().to_string(), &found)
            }
            None => format!("{}; `--recipe FILE` says where it lies", missing(main, search)),
        };
        ComparisonError::Inputs(vec![why])
    })
}

fn check_recipe(main: &StoredInput, recipe: &Path) -> Result<(), ComparisonError> {
    match content_sha256("recipe", recipe) {
        Some(found) if found == main.sha256 => Ok(()),
        Some(found) => {
            let place = recipe.display().to_string();
            Err(ComparisonError::Inputs(vec![another_content("recipe", &main.name, &main.sha256, &place, &found)]))
        }
        None => Err(ComparisonError::Operand(format!("{}: there is no such file", recipe.display()))),
    }
}

fn check_shipped(input: &StoredInput, name: &str) -> Option<String> {
    let own = shipped::text(name).map(|text| sha256(text.as_bytes()));
    match own {
        Some(own) if own == input.sha256 => None,
        Some(own) => Some(another_content(&input.role, &input.name, &input.sha256, "this program", &own)),
        None => Some(format!("{} {}: this program has no such rule file", input.role, input.name)),
    }
}

fn refusal(input: &StoredInput, own: Option<(&Path, String)>, search: &Search) -> String {
    let other = || {
        let path = search.by_name(input)?;
        Some((path.clone(), content_sha256(&input.role, path)?))
    };
    match own.map(|(path, sha256)| (path.to_owned(), sha256)).or_else(other) {
        Some((path, found)) => {
            another_content(&input.role, &input.name, &input.sha256, &path.display().to_string(), &found)
        }
        None => format!("{}; `--inputs DIR` says where to look", missing(input, search)),
    }
}

fn missing(input: &StoredInput, search: &Search) -> String {
    let StoredInput { role, name, bytes, sha256, .. } = input;
    let cut = if search.cut { ", though not all files were looked at" } else { "" };
    format!("{role} {name}: not found, {bytes} bytes with sha256 {sha256}{cut}")
}

/// Puts inputs where the recipe reads them, if they do not lie there.
fn place(
    stored: &Stored,
    (main, root): (&StoredInput, &Path),
    mut places: Vec<(&StoredInput, PathBuf)>,
    gathered: Vec<String>,
    options: &VerifyOptions,
) -> Result<Located, ComparisonError> {
    let mut folder = None;
    if !gathered.is_empty() {
        let made = tempfile::tempdir().map_err(ComparisonError::read(&std::env::temp_dir()))?;
        // Projects are called by the names of their folders.
        let real = root.canonicalize().map_err(ComparisonError::read(root))?;
        let target = made.path().join(real.file_name().unwrap_or("inputs".as_ref()));
        for (input, path) in &mut places {
            let below = if *input == main { Some(&main.name) } else { input.path.as_ref() };
            let Some(below) = below else { continue };
            let own = target.join(below);
            put(path, &own)?;
            *path = own;
        }
        folder = Some(made);
    }
    let recipe = places[0].1.clone();
    let outside = places.iter().filter(|(input, _)| input.path.is_none()).filter_map(|(_, path)| path.parent());
    let mut allow: Vec<PathBuf> = outside.map(Path::to_owned).chain(options.inputs.iter().cloned()).collect();
    allow.sort();
    allow.dedup();
    Ok(Located { arguments: arguments(stored, &places), recipe, allow, gathered, _folder: folder })
}

fn put(from: &Path, to: &Path) -> Result<(), ComparisonError> {
    let parent = to.parent().expect("it lies in the folder");
    std::fs::create_dir_all(parent).map_err(ComparisonError::read(parent))?;
    match std::fs::hard_link(from, to) {
        Ok(()) => Ok(()),
        // On another file system.
        Err(_) => std::fs::copy(from, to).map(|_| ()).map_err(ComparisonError::read(from)),
    }
}

/// The arguments, with the places of the files that they name.
fn arguments(stored: &Stored, places: &[(&StoredInput, PathBuf)]) -> Vec<(String, String)> {
    let data = |input: &StoredInput| matches!(input.role.as_str(), "map" | "elevation" | "rules");
    let item = |item: &str| {
        let named = places.iter().find(|(input, _)| data(input) && input.name == item);
        named.map_or_else(|| item.to_owned(), |(_, path)| path.display().to_string())
    };
    let whole = |value: &String| value.split(',').map(item).collect::<Vec<_>>().join(",");
    stored.arguments.iter().map(|(name, value)| (name.clone(), whole(value))).collect()
}
