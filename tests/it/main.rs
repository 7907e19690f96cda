//! Integration tests, one binary. In: the built program and the repository. Out: what a user would see, held.

mod backend;
mod bad_input;
mod compatibility;
mod cost;
mod coverage;
mod demand;
mod determinism;
mod diagnostics;
mod diff;
mod golden;
mod hard_cases;
mod highlighting;
mod language_server;
mod manual;
mod pipeline;
mod projects;
mod stage_cases;
mod syncw;
mod tidy;
mod validation;
mod verify;
mod watch;
mod window;
mod workshop;
