//! A session on a small town against cold builds of the same files.

mod adapter;
mod changes;
mod edits;
mod picking;
mod workshop;
