//! Where the files of a rule file lie (reference 4.0.6). In: the folder of the rule file and a name written in it.
//! Out: a real path inside the allowed folders, and the other way round.
//!
//! A *project* is the folder that holds `rules`, `assets`, `maps` and so on; the folder above it is the *workspace*.
//! A name with a slash in front counts from the workspace (`/PROJECT/assets/tree.obj`); others are looked for in the
//! project's `assets`, in the project, and then, for rule files without a project, beside the rule file and in the
//! folder that the run was started in.

use std::path::{Path, PathBuf};

use super::access::{Access, AccessError};

/// The project of a rule file.
#[derive(Clone, Debug)]
pub struct Project {
    root: PathBuf,
    /// Folder of the rule file.
    folder: PathBuf,
}

/// Folders that CityEngine makes in a new project.
const PARTS: &[&str] = &["assets", "data", "images", "maps", "models", "scenes", "scripts"];

impl Project {
    /// The project that a folder of rule files belongs to: the parent of the nearest `rules` above, else the nearest
    /// folder of it and its parent that has `assets`, else the folder itself.
    pub fn of(folder: &Path) -> Project {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        let rules = folder.ancestors().find(|f| f.file_name().is_some_and(|n| n.eq_ignore_ascii_case("rules")));
        let root =
            rules.and_then(Path::parent).or_else(|| folder.ancestors().take(2).find(|f| f.join("assets").is_dir()));
        Project { root: root.unwrap_or(&folder).to_owned(), folder }
    }

    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The tree that rule files of this folder may read when nothing else is allowed: the project if it looks like one,
    /// else their own folder, so that a folder called `rules` does not open what happens to lie beside it.
    pub fn tree(&self) -> &Path {
        let is_project = self.root.join(".project").is_file() || PARTS.iter().any(|part| self.root.join(part).is_dir());
        if is_project { &self.root } else { &self.folder }
    }

    fn name(&self) -> Option<&str> {
        self.root.file_name()?.to_str()
    }

    /// The existing file or folder that a name written in the rule file means.
    pub fn find(&self, access: &Access, named: &str) -> Result<PathBuf, AccessError> {
        let mut failure: Option<AccessError> = None;
        for (base, below) in self.candidates(access, named) {
            match access.resolve(&base, &below) {
                Ok(path) => return Ok(path),
                // That a file is missing says less than that it was refused.
                Err(error @ AccessError::Outside(_)) => failure = Some(error),
                Err(error) => failure = failure.or(Some(error)),
            }
        }
        Err(failure.expect("there is at least one candidate"))
    }

    /// Folders with the name below each, in the order of the search.
    fn candidates(&self, access: &Access, named: &str) -> Vec<(PathBuf, String)> {
        let Some(absolute) = named.strip_prefix('/').filter(|rest| !rest.starts_with('/')) else {
            let project = [self.root.join("assets"), self.root.clone()];
            let others = [self.folder.clone(), self.folder.join("assets"), access.root().to_owned()];
            return project.into_iter().chain(others).map(|folder| (folder, named.to_owned())).collect();
        };
        let (first, below) = absolute.split_once('/').unwrap_or((absolute, ""));
        let is_called = |folder: &Path| folder.file_name().is_some_and(|name| name == first);
        let mut list = Vec::new();
        if is_called(&self.root) {
            list.push((self.root.clone(), below.to_owned()));
        }
        if let Some(workspace) = self.root.parent() {
            list.push((workspace.to_owned(), absolute.to_owned()));
        }
        let named_roots = access.roots().iter().filter(|root| is_called(root));
        list.extend(named_roots.map(|root| (root.clone(), below.to_owned())));
        list.extend(access.roots().iter().map(|root| (root.clone(), absolute.to_owned())));
        // A project may lie under another name than its rules call it by, as downloaded ones do.
        list.push((self.root.clone(), below.to_owned()));
        // The path as the file system has it.
        list.push((PathBuf::new(), named.to_owned()));
        list
    }

    /// The workspace path of a real path, `/PROJECT/assets/tree.obj`; [`Project::find`] leads back.
    pub fn workspace_path(&self, access: &Access, real: &Path) -> String {
        let below = |root: &Path, name: &str| {
            let rest = real.strip_prefix(root).ok()?;
            let parts = rest.iter().map(|part| part.to_string_lossy());
            Some(parts.fold(format!("/{name}"), |path, part| path + "/" + &part))
        };
        let own = self.name().and_then(|name| below(&self.root, name));
        let roots = || access.roots().iter().find_map(|root| below(root, root.file_name()?.to_str()?));
        own.or_else(roots).unwrap_or_else(|| real.to_string_lossy().into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(files: &[&str]) -> tempfile::TempDir {
        let shop = tempfile::tempdir().expect("a temporary folder can be made");
        for file in files {
            let path = shop.path().join(file);
            std::fs::create_dir_all(path.parent().expect("below the folder")).expect("writable");
            std::fs::write(path, file).expect("writable");
        }
        shop
    }

    #[test]
    fn names_are_looked_for_in_assets_then_in_the_project() {
        let shop =
            made(&["town/rules/sub/x.cga", "town/assets/a.png", "town/a.png", "town/rules/b.cga", "other/c.txt"]);
        let project = Project::of(&shop.path().join("town/rules/sub"));
        let access = Access::new(project.tree()).expect("it exists");
        let root = shop.path().canonicalize().expect("it exists").join("town");
        assert_eq!((project.root(), project.tree()), (root.as_path(), root.as_path()));
        for (named, found) in [
            ("a.png", "assets/a.png"),
            ("assets/a.png", "assets/a.png"),
            ("/town/a.png", "a.png"),
            ("rules/b.cga", "rules/b.cga"),
            ("/town/rules/b.cga", "rules/b.cga"),
            ("/town_by_another_name/rules/b.cga", "rules/b.cga"),
            ("x.cga", "rules/sub/x.cga"),
        ] {
            let path = project.find(&access, named).expect(named);
            assert_eq!(path, root.join(found), "{named}");
            let workspace_path = project.workspace_path(&access, &path);
            assert_eq!(workspace_path, format!("/town/{found}"));
            assert_eq!(project.find(&access, &workspace_path).expect("it leads back"), path);
        }
        assert!(matches!(project.find(&access, "/other/c.txt"), Err(AccessError::Outside(_))));
        assert!(matches!(project.find(&access, "../other/c.txt"), Err(AccessError::Outside(_))));
        assert!(matches!(project.find(&access, "c.txt"), Err(AccessError::Io { .. })));
        let mut both = access.clone();
        both.allow(&shop.path().join("other")).expect("it exists");
        let path = project.find(&both, "/other/c.txt").expect("its folder is allowed");
        assert_eq!(project.workspace_path(&both, &path), "/other/c.txt");
    }

    #[test]
    fn a_folder_called_rules_opens_nothing_beside_it() {
        let shop = made(&["home/rules/x.cga", "home/private.txt"]);
        let project = Project::of(&shop.path().join("home/rules"));
        let access = Access::new(project.tree()).expect("it exists");
        assert!(project.find(&access, "private.txt").is_err());
        assert!(project.find(&access, "/home/rules/x.cga").is_ok());
    }
}
