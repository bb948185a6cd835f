//! What a scenario takes from elsewhere.

use std::collections::BTreeMap;

use carom_mesh::Mesh;

use super::obstacle::Surfaces;
use crate::body::foreign::law::ForeignLaw;

/// Meshes that a scenario does not describe, by the names of their bodies.
pub type Meshes<const D: usize> = BTreeMap<String, Mesh<D>>;

/// What other codes say of their bodies, by their names.
pub type Laws<const D: usize> = BTreeMap<String, ForeignLaw<D>>;

/// All of that; nothing by default.
#[derive(Debug, Clone, Default)]
pub struct Inputs<const D: usize> {
    /// Meshes of bodies.
    pub meshes: Meshes<D>,
    /// Surfaces of obstacles.
    pub surfaces: Surfaces<D>,
    /// Laws of bodies of other codes.
    pub laws: Laws<D>,
}

impl<const D: usize> From<Meshes<D>> for Inputs<D> {
    fn from(meshes: Meshes<D>) -> Self {
        Self { meshes, surfaces: Surfaces::new(), laws: Laws::new() }
    }
}
