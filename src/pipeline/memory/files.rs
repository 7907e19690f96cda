//! Files by content. In: paths. Out: what they held when they were last looked at, and whether that is still so.
//!
//! A file is read again only if its size, its time or its number changed, or if it was written so short a time before it
//! was looked at that the clock of the file system could not tell a second writing apart.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use sha2::{Digest, Sha256};

/// Writings closer together than this may have the same time.
const CLOCK_STEP: Duration = Duration::from_millis(50);

/// What lies at a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Content {
    Missing,
    /// Hash of the sorted names in it.
    Folder([u8; 32]),
    File {
        bytes: u64,
        sha256: [u8; 32],
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    modified: Option<SystemTime>,
    bytes: u64,
    number: u64,
    is_folder: bool,
}

#[derive(Clone, Copy, Debug)]
struct Known {
    stamp: Option<Stamp>,
    content: Content,
    /// The stamp may be that of a later writing, too.
    unsure: bool,
}

/// Contents that were seen.
#[derive(Debug, Default)]
pub struct FileTable {
    known: BTreeMap<PathBuf, Known>,
}

impl FileTable {
    /// What lies at a path now.
    pub fn content(&mut self, path: &Path) -> Content {
        let stamp = stamp(path);
        if let Some(known) = self.known.get(path)
            && known.stamp == stamp
            && !known.unsure
        {
            return known.content;
        }
        let known = look(path, stamp);
        self.known.insert(path.to_owned(), known);
        known.content
    }

    /// Those of the paths that hold something else than when they were last looked at.
    pub fn changed<'a>(&mut self, paths: impl IntoIterator<Item = &'a PathBuf>) -> Vec<PathBuf> {
        let is_changed = |path: &&PathBuf| {
            let before = self.known.get(*path).map(|known| known.content);
            before.is_some_and(|before| before != self.content(path))
        };
        paths.into_iter().filter(is_changed).cloned().collect()
    }

    /// Whether all paths that were looked at still hold what they held; asks only for sizes and times where that is enough.
    pub fn is_current<'a>(&self, paths: impl IntoIterator<Item = &'a PathBuf>) -> bool {
        paths.into_iter().all(|path| {
            let stamp = stamp(path);
            self.known.get(path).is_none_or(|known| match known.stamp == stamp && !known.unsure {
                true => true,
                false => look(path, stamp).content == known.content,
            })
        })
    }

    /// Whether nobody wrote to a path since it was last looked at.
    pub fn is_untouched(&self, path: &Path) -> bool {
        self.known.get(path).is_some_and(|known| known.stamp == stamp(path))
    }

    /// Looks at paths that were read since `since`. If one was written meanwhile, nobody knows which of its contents was
    /// read, and it counts as changed, even if it holds again what it held before.
    pub fn learn<'a>(&mut self, paths: impl IntoIterator<Item = &'a PathBuf>, since: SystemTime) {
        for path in paths {
            let is_known = self.known.contains_key(path);
            let is_doubtful = is_known && !self.is_untouched(path);
            if !is_known {
                self.content(path);
            }
            let known = self.known.get_mut(path).expect("it was looked at");
            let written = known.stamp.and_then(|stamp| stamp.modified);
            if is_doubtful || !is_known && written.is_some_and(|written| written >= since) {
                // No file has this content.
                known.content = Content::File { bytes: u64::MAX, sha256: [0; 32] };
                known.unsure = true;
            }
        }
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let metadata = std::fs::metadata(path).ok()?;
    #[cfg(unix)]
    let number = std::os::unix::fs::MetadataExt::ino(&metadata);
    #[cfg(not(unix))]
    let number = 0;
    let (modified, bytes) = (metadata.modified().ok(), metadata.len());
    Some(Stamp { modified, bytes, number, is_folder: metadata.is_dir() })
}

fn look(path: &Path, stamp: Option<Stamp>) -> Known {
    let now = SystemTime::now();
    let content = match stamp {
        None => Content::Missing,
        Some(stamp) if stamp.is_folder => folder(path),
        Some(_) => file(path),
    };
    let age = stamp.and_then(|stamp| now.duration_since(stamp.modified?).ok());
    Known { stamp, content, unsure: stamp.is_some() && age.is_none_or(|age| age < CLOCK_STEP) }
}

fn folder(path: &Path) -> Content {
    let Ok(entries) = std::fs::read_dir(path) else { return Content::Missing };
    let mut names: Vec<_> = entries.flatten().map(|entry| entry.file_name()).collect();
    names.sort();
    let mut hash = Sha256::new();
    for name in names {
        hash.update(name.as_encoded_bytes());
        hash.update([0]);
    }
    Content::Folder(hash.finalize().into())
}

fn file(path: &Path) -> Content {
    // Pipes and devices would be waited for.
    match path.is_file().then(|| hash_file(path)) {
        Some(Ok((bytes, sha256))) => Content::File { bytes, sha256 },
        Some(Err(_)) | None => Content::Missing,
    }
}

/// Length and SHA-256 of a file.
pub fn hash_file(path: &Path) -> std::io::Result<(u64, [u8; 32])> {
    let mut hash = Sha256::new();
    let bytes = std::io::copy(&mut std::fs::File::open(path)?, &mut Hashing(&mut hash))?;
    Ok((bytes, hash.finalize().into()))
}

/// Lets a hash be written to.
struct Hashing<'a>(&'a mut Sha256);

impl std::io::Write for Hashing<'_> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.update(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_seen_and_what_was_touched_is_not() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = folder.path().join("a.cga");
        let paths = [path.clone()];
        let write = |text: &str| std::fs::write(&path, text).expect("writable");
        let mut files = FileTable::default();
        assert_eq!(files.content(&path), Content::Missing);
        write("one");
        assert_eq!(files.changed(&paths), paths);
        assert!(files.changed(&paths).is_empty());
        // The same length within the same tick of the clock.
        write("two");
        assert_eq!(files.changed(&paths), paths);
        write("two");
        assert!(files.changed(&paths).is_empty());
        std::fs::remove_file(&path).expect("it is there");
        assert_eq!(files.changed(&paths), paths);
        write("two");
        assert_eq!(files.changed(&paths), paths);
    }

    #[test]
    fn what_was_written_while_it_was_read_counts_as_changed() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let path = folder.path().join("a.cga");
        let paths = [path.clone()];
        std::fs::write(&path, "one").expect("writable");
        let mut files = FileTable::default();
        files.learn(&paths, SystemTime::now() - Duration::from_secs(60));
        assert_eq!(files.changed(&paths), paths);
        assert!(files.changed(&paths).is_empty());
        let mut files = FileTable::default();
        files.learn(&paths, SystemTime::now() + Duration::from_secs(60));
        assert!(files.changed(&paths).is_empty());
        assert_eq!(files.changed(&[folder.path().join("never looked at")]), Vec::<PathBuf>::new());
        // Written twice, and as before in the end: what was read in between is not known.
        std::fs::write(&path, "two").expect("writable");
        std::thread::sleep(2 * CLOCK_STEP);
        std::fs::write(&path, "one").expect("writable");
        files.learn(&paths, SystemTime::now() + Duration::from_secs(60));
        assert_eq!(files.changed(&paths), paths);
        assert!(files.changed(&paths).is_empty());
    }
}
