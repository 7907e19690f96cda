//! What the command line names as one side. In: a word. Out: a recipe, a recipe in a revision, or an output folder.

use std::path::{Path, PathBuf};

use super::error::ComparisonError;

/// One side of a comparison, not looked into yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operand {
    /// A recipe's file.
    Recipe(PathBuf),
    /// A folder that `mansard render` wrote.
    Folder(PathBuf),
    /// A recipe as a git revision has it; `path` as git understands it: from the top of the repository, or from here if
    /// it begins with `./`.
    Revision { revision: String, path: String },
}

impl Operand {
    /// Reads a word of the command line; with `recipe` it names a revision, and the recipe's file lies at that path.
    pub fn new(word: &str, recipe: Option<&Path>) -> Result<Operand, ComparisonError> {
        let path = Path::new(word);
        if let Some(recipe) = recipe {
            let path =
                if recipe.is_absolute() { recipe.display().to_string() } else { format!("./{}", recipe.display()) };
            return Ok(Operand::Revision { revision: word.to_owned(), path });
        }
        if path.is_dir() {
            return Ok(Operand::Folder(path.to_owned()));
        }
        if path.is_file() {
            return Ok(Operand::Recipe(path.to_owned()));
        }
        match word.split_once(':').filter(|(revision, path)| !revision.is_empty() && !path.is_empty()) {
            Some((revision, path)) => Ok(Operand::Revision { revision: revision.to_owned(), path: path.to_owned() }),
            None => Err(ComparisonError::Operand(format!(
                "{word}: there is no such file or folder; a recipe of a revision is written REVISION:PATH, and two \
                 revisions want `--recipe FILE`"
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_files_folders_or_revisions() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let file = folder.path().join("r.render");
        std::fs::write(&file, "").expect("writable");
        let read = |word: &str| Operand::new(word, None);
        assert_eq!(read(&file.display().to_string()).expect("a file"), Operand::Recipe(file.clone()));
        let of_folder = read(&folder.path().display().to_string()).expect("a folder");
        assert_eq!(of_folder, Operand::Folder(folder.path().to_owned()));
        let revision = Operand::Revision { revision: "HEAD~1".to_owned(), path: "a/b.render".to_owned() };
        assert_eq!(read("HEAD~1:a/b.render").expect("a revision"), revision);
        assert!(read("nothing.render").is_err() && read("HEAD:").is_err() && read(":x").is_err());
        let with = Operand::new("v1", Some(Path::new("b.render"))).expect("a revision");
        assert_eq!(with, Operand::Revision { revision: "v1".to_owned(), path: "./b.render".to_owned() });
    }
}
