//! How the pipeline tells what it is doing. In: phases and steps. Out: whatever the host shows.

#[cfg(doc)]
use super::error::PipelineError;

/// Hears of phases that take long. Calls may come from any thread.
pub trait Progress: Sync {
    /// A phase begins; `total` steps are expected where that is known.
    fn begin(&self, name: &'static str, total: Option<u64>);
    /// Steps were done.
    fn step(&self, count: u64);
    /// The phase is over; `summary` says in a few words what came out.
    fn end(&self, summary: &str);
    /// Something goes on, but not as one would expect.
    fn warn(&self, message: &str);
    /// Whether what is made is no longer wanted; work then ends early with [`PipelineError::Stopped`].
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Shows nothing.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &'static str, _: Option<u64>) {}
    fn step(&self, _: u64) {}
    fn end(&self, _: &str) {}
    fn warn(&self, _: &str) {}
}
