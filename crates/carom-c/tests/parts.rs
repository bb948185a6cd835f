//! The parts of the border that have tests of their own, in a small program: one of the whole library would compile the core once more.

#![allow(dead_code, clippy::upper_case_acronyms)]

#[path = "../src/handle.rs"]
mod handle;
#[path = "../src/memory.rs"]
mod memory;
#[path = "../src/status.rs"]
mod status;
