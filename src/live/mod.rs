//! The live loop: files change, and what depends on them is done again.
