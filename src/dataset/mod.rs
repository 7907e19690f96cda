//! Dataset: frames + labels → files.
