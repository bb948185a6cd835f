//! What a scenario takes from elsewhere.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

use carom_fem::Share;
use carom_mesh::Mesh;

use super::obstacle::Surfaces;
use crate::body::foreign::law::ForeignLaw;

/// Meshes that a scenario does not describe, by the names of their bodies.
pub type Meshes<const D: usize> = BTreeMap<String, Mesh<D>>;

/// What other codes say of their bodies, by their names.
pub type Laws<const D: usize> = BTreeMap<String, ForeignLaw<D>>;

/// Shares out the cells of bodies among processes.
pub trait Engine: Debug + Send + Sync {
    /// This process's share of a body of this name, whose nodes [m] follow one another in `nodes`, and of each block the nodes of its cells,
    /// with how many each has. None if all processes are to have the whole of it, and to do the same.
    ///
    /// # Errors
    /// If there is none; says why.
    fn share(
        &self,
        body: &str,
        dimension: usize,
        nodes: &[f64],
        blocks: &[(usize, &[u32])],
    ) -> Result<Option<Share>, String>;
}

/// All of that; nothing by default.
#[derive(Debug, Clone, Default)]
pub struct Inputs<const D: usize> {
    /// Meshes of bodies.
    pub meshes: Meshes<D>,
    /// Surfaces of obstacles.
    pub surfaces: Surfaces<D>,
    /// Laws of bodies of other codes.
    pub laws: Laws<D>,
    /// Who shares out bodies among processes; none where this one has all of them.
    pub engine: Option<Arc<dyn Engine>>,
}

impl<const D: usize> From<Meshes<D>> for Inputs<D> {
    fn from(meshes: Meshes<D>) -> Self {
        Self { meshes, surfaces: Surfaces::new(), laws: Laws::new(), engine: None }
    }
}
