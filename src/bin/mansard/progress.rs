//! Progress of long work. In: phases and steps from the pipeline. Out: bars with rate and time left on a terminal, plain
//! lines elsewhere, nothing with `--quiet`.

use std::io::IsTerminal;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use mansard::pipeline::Progress;

/// How progress is shown.
enum Look {
    Bars,
    Lines,
    Nothing,
}

struct Running {
    bar: ProgressBar,
    name: &'static str,
    total: Option<u64>,
    done: u64,
    started: Instant,
    said: Instant,
}

/// Shows the progress of one command on standard error.
pub struct Reporter {
    look: Look,
    running: Mutex<Option<Running>>,
}

/// Plain lines come at most this often within a phase.
const LINE_EVERY: Duration = Duration::from_secs(5);

impl Reporter {
    pub fn new(quiet: bool) -> Self {
        let look = match (quiet, std::io::stderr().is_terminal()) {
            (true, _) => Look::Nothing,
            (false, true) => Look::Bars,
            (false, false) => Look::Lines,
        };
        Reporter { look, running: Mutex::new(None) }
    }

    pub fn is_quiet(&self) -> bool {
        matches!(self.look, Look::Nothing)
    }

    /// Prints a line above the bars.
    pub fn say(&self, line: &str) {
        match &self.look {
            Look::Nothing => {}
            Look::Bars | Look::Lines => eprintln!("{line}"),
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Option<Running>> {
        self.running.lock().expect("no thread panics while it reports")
    }
}

fn bar(name: &'static str, total: Option<u64>) -> ProgressBar {
    let (bar, template) = match total {
        Some(total) => {
            (ProgressBar::new(total), "{prefix:>10} [{bar:30}] {human_pos}/{human_len} {per_sec} {eta} left {msg}")
        }
        None => (ProgressBar::new_spinner(), "{prefix:>10} {spinner} {human_pos} {per_sec} {elapsed} {msg}"),
    };
    let style = ProgressStyle::with_template(template).expect("the template is well formed").progress_chars("=> ");
    bar.set_style(style);
    bar.set_prefix(name);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

impl Progress for Reporter {
    fn begin(&self, name: &'static str, total: Option<u64>) {
        let now = Instant::now();
        let bar = if matches!(self.look, Look::Bars) { bar(name, total) } else { ProgressBar::hidden() };
        *self.lock() = Some(Running { bar, name, total, done: 0, started: now, said: now });
    }

    fn step(&self, count: u64) {
        let mut lock = self.lock();
        let Some(running) = lock.as_mut() else { return };
        running.done += count;
        running.bar.inc(count);
        if matches!(self.look, Look::Lines) && running.said.elapsed() >= LINE_EVERY {
            running.said = Instant::now();
            let elapsed = running.started.elapsed().as_secs_f64();
            let rate = running.done as f64 / elapsed;
            let digits = usize::from(rate < 10.0);
            match running.total.filter(|_| rate > 0.0) {
                Some(total) => {
                    let left = total.saturating_sub(running.done) as f64 / rate;
                    eprintln!("{:>10} {}/{total}, {rate:.digits$}/s, {left:.0} s left", running.name, running.done);
                }
                None => eprintln!("{:>10} {}, {rate:.digits$}/s", running.name, running.done),
            }
        }
    }

    fn end(&self, summary: &str) {
        let Some(running) = self.lock().take() else { return };
        running.bar.finish_and_clear();
        let seconds = running.started.elapsed().as_secs_f64();
        self.say(&format!("{:>10} {summary} ({seconds:.2} s)", running.name));
    }

    fn warn(&self, message: &str) {
        self.say(&format!("warning: {message}"));
    }
}
