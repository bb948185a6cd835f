use std::collections::BTreeMap;

use crate::{CellBlock, CellKind, Mesh, MeshError, Sets};

/// The same body in tri3 cells: every quad4 cell is cut along its shorter diagonal. Sets of cells are lost.
///
/// # Errors
/// Only those of [`Mesh::new`], which a valid mesh does not meet.
pub fn triangulate(mesh: &Mesh<2>) -> Result<Mesh<2>, MeshError> {
    let mut connectivity = Vec::new();
    for block in mesh.blocks() {
        for cell in block.cells() {
            if let &[a, b, c, d] = cell {
                let length =
                    |p: u32, q: u32| (mesh.nodes()[p as usize] - mesh.nodes()[q as usize]).norm_squared();
                connectivity.extend(if length(a, c) <= length(b, d) {
                    [a, b, c, a, c, d]
                } else {
                    [a, b, d, b, c, d]
                });
            } else {
                connectivity.extend_from_slice(cell);
            }
        }
    }
    let block = CellBlock { kind: CellKind::Tri3, connectivity };
    let sets = Sets { cells: BTreeMap::new(), ..mesh.sets().clone() };
    Mesh::new(mesh.nodes().to_vec(), vec![block])?.with_ties(mesh.ties().to_vec())?.with_sets(sets)
}
