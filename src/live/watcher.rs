//! Following files. In: paths. Out: a wake-up whenever one of them may have changed.
//!
//! Folders are watched, not files: editors delete a file and put another in its place. Events are drained until none
//! came for [`QUIET`], at most for [`LONGEST`].

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use notify::{RecommendedWatcher, RecursiveMode, Watcher as _};

/// No event for this long ends a burst.
const QUIET: Duration = Duration::from_millis(30);
/// A burst ends after this long, even if events go on.
const LONGEST: Duration = Duration::from_millis(100);

/// Why files cannot be followed.
#[derive(Debug, thiserror::Error)]
#[error("files cannot be watched: {0}")]
pub struct WatchError(#[from] notify::Error);

/// Follows the folders of files.
pub struct Watcher {
    notify: RecommendedWatcher,
    events: Receiver<()>,
    folders: BTreeSet<PathBuf>,
    files: Arc<Mutex<BTreeSet<PathBuf>>>,
}

impl Watcher {
    /// `told` is called, from a thread of its own, as soon as a followed file may have changed.
    pub fn new(told: impl Fn() + Send + 'static) -> Result<Watcher, WatchError> {
        let (send, events) = channel();
        let files: Arc<Mutex<BTreeSet<PathBuf>>> = Arc::default();
        let followed = files.clone();
        let notify = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            let concerns = match event {
                Ok(event) if event.kind.is_access() => false,
                Ok(event) if event.need_rescan() || event.paths.is_empty() => true,
                Ok(event) => {
                    let files = followed.lock().unwrap_or_else(PoisonError::into_inner);
                    event.paths.iter().any(|path| is_about(path, &files))
                }
                // Events were lost: anything may have changed.
                Err(_) => true,
            };
            if concerns {
                told();
                // The receiver is gone when the loop has ended.
                let _ended = send.send(());
            }
        })?;
        Ok(Watcher { notify, events, folders: BTreeSet::new(), files })
    }

    /// Follows these files and no others. Files that do not exist are waited for, in the nearest folder that does.
    pub fn follow(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        let files: BTreeSet<PathBuf> = files.into_iter().collect();
        let folders: BTreeSet<PathBuf> = files.iter().filter_map(|file| nearest_folder(file)).collect();
        *self.files.lock().unwrap_or_else(PoisonError::into_inner) = files;
        for gone in self.folders.difference(&folders) {
            // A folder that was deleted is no longer watched anyway.
            let _gone = self.notify.unwatch(gone);
        }
        let watched = folders.into_iter().filter(|folder| {
            self.folders.contains(folder) || self.notify.watch(folder, RecursiveMode::NonRecursive).is_ok()
        });
        self.folders = watched.collect();
    }

    /// Waits for a change of a followed file, at most for `timeout`; whether there was one. Bursts are waited out.
    pub fn wait(&self, timeout: Duration) -> bool {
        if self.events.recv_timeout(timeout).is_err() {
            return false;
        }
        let burst = Instant::now();
        while burst.elapsed() < LONGEST && self.events.recv_timeout(QUIET).is_ok() {}
        // What came meanwhile is seen by the update that follows.
        while self.events.try_recv().is_ok() {}
        true
    }
}

/// Whether an event at a path may change a followed file: it is one, or a folder above one, or lies in a followed folder.
fn is_about(path: &Path, files: &BTreeSet<PathBuf>) -> bool {
    let below = files.range(path.to_owned()..).next().is_some_and(|file| file.starts_with(path));
    below || path.parent().is_some_and(|folder| files.contains(folder))
}

/// The folder to watch for a path: a folder itself, else the nearest one above that exists.
fn nearest_folder(path: &Path) -> Option<PathBuf> {
    path.ancestors().find(|folder| folder.is_dir()).map(Path::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOON: Duration = Duration::from_secs(10);
    const NOT: Duration = Duration::from_millis(200);

    #[test]
    fn files_that_are_written_replaced_and_made_are_told_of_and_others_are_not() {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let folder = folder.path().canonicalize().expect("it exists");
        let path = |name: &str| folder.join(name);
        let write = |name: &str, text: &str| std::fs::write(path(name), text).expect("writable");
        write("a.cga", "one");
        let mut watcher = Watcher::new(|| {}).expect("files can be watched");
        watcher.follow([path("a.cga"), path("sub/b.cga")]);
        assert!(!watcher.wait(NOT));
        write("a.cga", "two");
        assert!(watcher.wait(SOON));
        assert!(!watcher.wait(NOT));
        // As editors save: a new file is put in the old one's place.
        write("a.cga~", "three");
        assert!(!watcher.wait(NOT), "nobody follows it");
        std::fs::rename(path("a.cga~"), path("a.cga")).expect("writable");
        assert!(watcher.wait(SOON));
        std::fs::remove_file(path("a.cga")).expect("it is there");
        assert!(watcher.wait(SOON));
        write("a.cga", "four");
        assert!(watcher.wait(SOON));
        std::fs::create_dir(path("sub")).expect("writable");
        assert!(watcher.wait(SOON), "the folder of a followed file came");
        watcher.follow([path("a.cga"), path("sub/b.cga")]);
        write("sub/b.cga", "five");
        assert!(watcher.wait(SOON));
    }
}
