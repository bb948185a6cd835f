//! The tests of contact as others use it, in one program: the code is generic, and every program that uses it compiles it anew.

mod common;
mod corners;
mod edges;
mod mortar;
mod on_its_own;
mod penetration;
mod smooth;
mod smooth_in_space;
mod witness;
