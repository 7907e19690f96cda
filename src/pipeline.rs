//! The phases in order, on one screen.
