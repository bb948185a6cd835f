//! Geometry that the other crates share: small tensors, reference cells, meshes, their boundary surfaces and generators.
//!
//! Nothing here knows of forces. `D` is the dimension of space (2 or 3); coordinates are in metres.

pub mod cell;
pub mod dimension;
mod error;
pub mod generate;
mod mesh;
mod naming;
pub mod nodal;
mod outline;
pub mod parallel;
pub mod sets;
mod surface;
pub mod tensor;

pub use cell::CellKind;
pub use error::MeshError;
pub use mesh::{CellBlock, Mesh, Tie};
pub use outline::OutlineDefect;
pub use sets::Sets;
pub use surface::{Facet, Surface};
pub use tensor::{Matrix, Vector};
