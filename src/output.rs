//! Files appear under their names whole or not at all.
//!
//! In: a path and a function that writes. Out: the file, written aside in the same folder and then renamed; after a
//! failure or a kill no half-written file has the final name. Imports nothing of ours.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// A file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct OutputError {
    pub path: PathBuf,
    pub source: io::Error,
}

impl OutputError {
    pub fn new(path: &Path, source: io::Error) -> Self {
        OutputError { path: path.to_owned(), source }
    }
}

/// A temporary file beside `path`, with the permissions that a plain `File::create` would give.
pub fn aside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut builder = tempfile::Builder::new();
    builder.prefix(".mansard-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Gives a temporary file its final name.
pub fn keep(writer: BufWriter<NamedTempFile>, path: &Path) -> io::Result<()> {
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.persist(path).map(|_| ()).map_err(|e| e.error)
}

/// Writes a whole file through `write`.
pub fn write_with(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<NamedTempFile>) -> io::Result<()>,
) -> Result<(), OutputError> {
    let whole = || {
        let mut writer = BufWriter::new(aside(path)?);
        write(&mut writer)?;
        keep(writer, path)
    };
    whole().map_err(|source| OutputError::new(path, source))
}

/// Writes a whole file from bytes.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_with(path, |w| w.write_all(bytes))
}

/// Makes a folder and checks that it can be written to, before long work starts.
pub fn prepare_folder(folder: &Path) -> Result<(), OutputError> {
    let check = || {
        std::fs::create_dir_all(folder)?;
        aside(&folder.join("probe")).map(|_| ())
    };
    check().map_err(|source| OutputError::new(folder, source))
}

/// A nameless temporary file in the folder of `path`.
pub fn scratch(path: &Path) -> io::Result<File> {
    tempfile::tempfile_in(path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = folder.path().join("a.txt");
        let failed = write_with(&path, |w| {
            w.write_all(b"half")?;
            Err(io::Error::other("stop"))
        });
        assert!(failed.is_err());
        assert_eq!(std::fs::read_dir(folder.path()).expect("the folder exists").count(), 0);
        write_bytes(&path, b"whole").expect("the folder is writable");
        assert_eq!(std::fs::read(&path).expect("written"), b"whole");
    }
}
