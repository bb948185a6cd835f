//! The tests of elements and bodies, in one program: generic code is compiled once.

mod common;
mod consistency;
mod convergence;
mod generated_bodies;
mod growth;
mod impulse;
mod initial_stress;
mod locking;
mod patch_test;
mod reduction;
mod regions;
mod revolution;
mod threads;
mod vibration;
