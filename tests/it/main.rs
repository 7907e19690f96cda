//! Integration tests, one binary. In: the built program and the repository. Out: what a user would see, held.

mod bad_input;
mod pipeline;
mod tidy;
mod workshop;
