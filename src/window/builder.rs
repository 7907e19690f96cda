//! Builder: the thread that owns the session. In: overrides, saved files, clicks; only the newest of each counts. Out:
//! updates, good scenes, what was clicked. However long a build takes, the window and the drawing go on.

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use super::error::WindowError;
use super::mailbox::Mailbox;
use super::report::{Report, Tell};
use super::shown::Shown;
use crate::live::{Overrides, Ray, Session, Watcher};
use crate::plan::demand::State;

/// How long the watching thread waits before it looks whether other files are to be followed.
const LOOK_UP: Duration = Duration::from_millis(100);

/// What the builder is asked for.
#[derive(Debug, Default)]
struct Orders {
    /// Bring everything up to date.
    update: bool,
    overrides: Option<Overrides>,
    pick: Option<PickOrder>,
    quit: bool,
}

/// A click on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PickOrder {
    /// From the image of object numbers.
    pub instance: u32,
    pub state: State,
    pub ray: Ray,
}

/// The thread, from outside.
pub struct Builder {
    mailbox: Arc<Mailbox<Orders>>,
    stop: Arc<AtomicBool>,
    quit: Arc<AtomicBool>,
}

impl Builder {
    /// Starts the thread, and one that follows the session's files.
    pub fn start(session: Session, overrides: Overrides, tell: Tell) -> Result<Builder, WindowError> {
        let mailbox: Arc<Mailbox<Orders>> = Arc::default();
        let (stop, quit) = (session.stop(), Arc::new(AtomicBool::new(false)));
        let overtaken = stop.clone();
        let watcher = Watcher::new(move || overtaken.store(true, Ordering::Release))?;
        let builder = Builder { mailbox: mailbox.clone(), stop, quit: quit.clone() };
        let files: Files = Arc::default();
        let (saved, followed) = (builder.notifier(), files.clone());
        std::thread::Builder::new()
            .name("watch".to_owned())
            .spawn(move || follow(watcher, &followed, &quit, &saved))?;
        std::thread::Builder::new()
            .name("build".to_owned())
            .spawn(move || work(session, overrides, &mailbox, &files, &tell))?;
        builder.mailbox.post(|orders| orders.update = true);
        Ok(builder)
    }

    /// Other overrides: what is being built for the old ones is given up.
    pub fn choose(&self, overrides: Overrides) {
        self.stop.store(true, Ordering::Release);
        self.mailbox.post(|orders| (orders.overrides, orders.update) = (Some(overrides), true));
    }

    pub fn pick(&self, order: PickOrder) {
        self.mailbox.post(|orders| orders.pick = Some(order));
    }

    fn notifier(&self) -> impl Fn() + Send + use<> {
        let mailbox = self.mailbox.clone();
        move || mailbox.post(|orders| orders.update = true)
    }
}

impl Drop for Builder {
    fn drop(&mut self) {
        self.quit.store(true, Ordering::Release);
        self.stop.store(true, Ordering::Release);
        self.mailbox.post(|orders| orders.quit = true);
    }
}

/// Files that the watching thread shall follow from now on.
type Files = Arc<Mutex<Option<Vec<PathBuf>>>>;

fn follow(mut watcher: Watcher, files: &Files, quit: &AtomicBool, saved: &dyn Fn()) {
    while !quit.load(Ordering::Acquire) {
        if let Some(files) = files.lock().expect("no thread panics with the lock").take() {
            watcher.follow(files);
            // What was saved while nobody looked.
            saved();
        }
        if watcher.wait(LOOK_UP) {
            saved();
        }
    }
}

fn work(mut session: Session, mut overrides: Overrides, mailbox: &Mailbox<Orders>, files: &Files, tell: &Tell) {
    let mut followed = Vec::new();
    loop {
        let orders = mailbox.take();
        if orders.quit {
            return;
        }
        overrides = orders.overrides.unwrap_or(overrides);
        if orders.update {
            tell(Report::Building);
            let update = session.update(&overrides);
            let watched = session.watched();
            if watched != followed {
                followed.clone_from(&watched);
                *files.lock().expect("no thread panics with the lock") = Some(watched);
            }
            if !update.stands && !update.cancelled {
                let shown = Shown::of(&session, update.scene, update.number);
                shown.into_iter().for_each(|shown| tell(Report::Built(Arc::new(shown))));
            }
            tell(Report::Updated(Box::new(update)));
        }
        if let Some(PickOrder { instance, state, ray }) = orders.pick {
            let lot = session.lot(instance, state, Some(ray));
            tell(Report::Picked(lot.map(Box::new)));
        }
    }
}
