//! Following files. In: paths. Out: a wake-up whenever one of them may have changed.
//!
//! Folders are watched, not files: editors delete a file and put another in its place. Events are drained until none
//! came for [`QUIET`], at most for [`LONGEST`].

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
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
    events: Receiver<Event>,
    folders: BTreeSet<PathBuf>,
    files: BTreeSet<PathBuf>,
}

/// What the notifier's thread sends.
enum Event {
    Paths(Vec<PathBuf>),
    /// Events were lost: anything may have changed.
    Unknown,
}

impl Watcher {
    pub fn new() -> Result<Watcher, WatchError> {
        let (send, events) = channel();
        let notify = notify::recommended_watcher(move |event: notify::Result<notify::Event>| {
            let event = match event {
                Ok(event) if event.kind.is_access() => return,
                Ok(event) if event.need_rescan() || event.paths.is_empty() => Event::Unknown,
                Ok(event) => Event::Paths(event.paths),
                Err(_) => Event::Unknown,
            };
            // The receiver is gone when the loop has ended.
            let _ended = send.send(event);
        })?;
        Ok(Watcher { notify, events, folders: BTreeSet::new(), files: BTreeSet::new() })
    }

    /// Follows these files and no others. Files that do not exist are waited for, in the nearest folder that does.
    pub fn follow(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.files = files.into_iter().collect();
        let folders: BTreeSet<PathBuf> = self.files.iter().filter_map(|file| nearest_folder(file)).collect();
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
        let until = Instant::now() + timeout;
        loop {
            let left = until.saturating_duration_since(Instant::now());
            match self.events.recv_timeout(left) {
                Ok(event) if self.concerns(&event) => break,
                Ok(_) => {}
                Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => return false,
            }
        }
        let burst = Instant::now();
        while burst.elapsed() < LONGEST && self.events.recv_timeout(QUIET).is_ok() {}
        true
    }

    /// Whether a change is waiting to be told, without waiting.
    pub fn is_pending(&self) -> bool {
        std::iter::from_fn(|| self.events.try_recv().ok()).fold(false, |any, event| any | self.concerns(&event))
    }

    fn concerns(&self, event: &Event) -> bool {
        match event {
            Event::Unknown => true,
            // Folders that come or go may hold a followed file.
            Event::Paths(paths) => paths.iter().any(|path| self.files.iter().any(|file| file.starts_with(path))),
        }
    }
}

fn nearest_folder(file: &Path) -> Option<PathBuf> {
    let above = file.ancestors().skip(1).map(|p| if p.as_os_str().is_empty() { Path::new(".") } else { p });
    above.into_iter().find(|folder| folder.is_dir()).map(Path::to_owned)
}
