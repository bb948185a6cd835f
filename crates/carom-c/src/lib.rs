//! Contact of carom for codes in C, C++ and Fortran: `carom.h` is made of this crate.
//!
//! It is thin. Contact is that of [`carom::PlantedContact`], friction that of [`carom_friction`]; here memory of others becomes arrays that are checked,
//! and errors become a status with a message. What C calls is in [`door`]; `memory` and `handle` are the only other places with unsafe code.

mod compliance;
mod contact;
pub mod door;
mod friction;
mod handle;
mod memory;
mod setup;
mod status;
mod steps;
