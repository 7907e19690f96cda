//! The window of `mansard watch`.
