//! A git revision's files. In: a revision and a recipe's path. Out: the folder tree of the recipe as the revision has
//! it, unpacked into a temporary folder. A recipe reads nothing above its own folder, so no more is unpacked.

use std::path::{Component, Path, PathBuf};
use std::process::{Command, Stdio};

use super::error::ComparisonError;

/// An unpacked tree; removed when dropped.
#[derive(Debug)]
pub struct Unpacked {
    _folder: tempfile::TempDir,
    /// The recipe's file in it.
    pub recipe: PathBuf,
}

/// Unpacks what a revision has; see [`super::Operand::Revision`] for `path`.
pub fn unpack(revision: &str, path: &str) -> Result<Unpacked, ComparisonError> {
    let here = Path::new(path).ancestors().skip(1).find(|folder| folder.is_absolute() && folder.is_dir());
    let top = PathBuf::from(git(here, &["rev-parse", "--show-toplevel"])?);
    let tree =
        git(Some(&top), &["rev-parse", "--verify", "--quiet", "--end-of-options", &format!("{revision}^{{tree}}")])
            .map_err(|_| {
                ComparisonError::Operand(format!("`{revision}` is no revision of the repository {}", top.display()))
            })?;
    let recipe = from_top(path, &top)?;
    let named = recipe.iter().map(|part| part.to_string_lossy()).collect::<Vec<_>>().join("/");
    git(Some(&top), &["cat-file", "-e", &format!("{tree}:{named}")])
        .map_err(|_| ComparisonError::Operand(format!("revision `{revision}` has no file {named}")))?;

    // Projects are called by the names of their folders, so the tree keeps the name of the repository's.
    let folder = tempfile::tempdir().map_err(ComparisonError::read(&std::env::temp_dir()))?;
    let target = folder.path().join(top.file_name().unwrap_or("repository".as_ref()));
    let below = recipe.parent().filter(|parent| !parent.as_os_str().is_empty());
    archive(&top, &tree, below, &target)?;
    Ok(Unpacked { recipe: target.join(&recipe), _folder: folder })
}

fn archive(top: &Path, tree: &str, below: Option<&Path>, target: &Path) -> Result<(), ComparisonError> {
    let failed = |why: String| ComparisonError::Git { command: "git archive".to_owned(), why };
    let mut command = Command::new("git");
    command.arg("-C").arg(top).args(["archive", "--format=tar", tree, "--"]);
    command.args(below).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|error| failed(error.to_string()))?;
    let mut stdout = child.stdout.take().expect("the output is a pipe");
    let unpacked = tar::Archive::new(&mut stdout).unpack(target);
    // What fills the archive's last block is to be taken too, or git is told that nobody listens.
    let unpacked = unpacked.and_then(|()| std::io::copy(&mut stdout, &mut std::io::sink()).map(|_| ()));
    drop(stdout);
    let output = child.wait_with_output().map_err(|error| failed(error.to_string()))?;
    match (output.status.success(), unpacked) {
        (true, Ok(())) => Ok(()),
        (true, Err(error)) => Err(failed(error.to_string())),
        (false, _) => Err(failed(String::from_utf8_lossy(&output.stderr).trim().to_owned())),
    }
}

/// A path as git understands it in `REVISION:PATH`, from the top of the repository.
fn from_top(path: &str, top: &Path) -> Result<PathBuf, ComparisonError> {
    let written = Path::new(path);
    let from_here = path.starts_with("./") || path.starts_with("../");
    if !from_here && !written.is_absolute() {
        return Ok(written.to_owned());
    }
    let absolute = std::path::absolute(written).map_err(ComparisonError::read(written))?;
    // The file need not exist here, but its folder leads through the same links as the repository's.
    let mut parts: Vec<Component> = Vec::new();
    for part in absolute.components() {
        if part == Component::ParentDir {
            parts.pop();
        } else {
            parts.push(part);
        }
    }
    let plain: PathBuf = parts.iter().collect();
    let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let folder = plain.ancestors().skip(1).find(|folder| folder.is_dir()).unwrap_or(Path::new("/"));
    let rest = plain.strip_prefix(folder).expect("it is an ancestor");
    let whole = real(folder).join(rest);
    let below = whole.strip_prefix(real(top)).map(Path::to_owned);
    below.map_err(|_| ComparisonError::Operand(format!("{path} lies outside the repository {}", top.display())))
}

fn git(folder: Option<&Path>, args: &[&str]) -> Result<String, ComparisonError> {
    let failed = |why: String| ComparisonError::Git { command: format!("git {}", args.join(" ")), why };
    let mut command = Command::new("git");
    if let Some(folder) = folder {
        command.arg("-C").arg(folder);
    }
    let output = command.args(args).stdin(Stdio::null()).output().map_err(|error| failed(error.to_string()))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).trim_end().to_owned()),
        false => Err(failed(String::from_utf8_lossy(&output.stderr).trim().to_owned())),
    }
}
