//! What keeps the window from opening. None of it is the recipe's mistake.

/// Why there is no window.
#[derive(Debug, thiserror::Error)]
pub enum WindowError {
    #[error("there is no display to open a window on ({reason}); `mansard watch --headless` does the same without one")]
    NoDisplay { reason: String },
    #[error(
        "no graphics adapter can draw into a window here ({reason}); on Debian the package mesa-vulkan-drivers gives one \
         that runs on the CPU, and `mansard watch --headless` needs no window"
    )]
    NoSurface { reason: String },
    #[error("a thread could not be started: {0}")]
    Thread(#[from] std::io::Error),
    #[error(transparent)]
    Watch(#[from] crate::live::WatchError),
}
