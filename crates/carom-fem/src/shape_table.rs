use carom_mesh::{CellBlock, Mesh, Vector, tensor};

use crate::FemError;
use crate::quadrature::{Integrand, rule};

/// A block of cells in its mesh.
#[derive(Debug, Clone, Copy)]
pub struct Cells<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// The block.
    pub block: &'a CellBlock,
    /// Number of its first cell in the mesh.
    pub first: usize,
    /// Thickness [m]; 1 in 3D.
    pub thickness: f64,
}

/// Shape functions of a block of cells with `N` nodes, tabulated once at every quadrature point of every cell.
#[derive(Debug, Clone)]
pub struct ShapeTable<const D: usize, const N: usize> {
    /// Quadrature points of each cell.
    pub points_per_cell: usize,
    /// Gradients ∂N_a/∂X [1/m], cell by cell and point by point.
    pub gradients: Vec<[Vector<D>; N]>,
    /// Weights times Jacobian times thickness [m³].
    pub weights: Vec<f64>,
    /// Values N_a at the quadrature points of the reference cell.
    pub values: Vec<[f64; N]>,
}

/// A cell whose Jacobian is below this, relative to the cube of its size, is degenerate.
const DEGENERATE: f64 = 1e-10;

impl<const D: usize, const N: usize> ShapeTable<D, N> {
    /// The table for `cells`.
    ///
    /// # Errors
    /// If a cell is inverted or degenerate.
    pub fn new(cells: &Cells<'_, D>, integrand: Integrand) -> Result<Self, FemError> {
        let Cells { mesh, block, first, thickness } = *cells;
        let reference = block.kind.reference();
        let points = rule(block.kind, integrand);
        let mut values = vec![[0.0; N]; points.len()];
        let mut local_gradients = vec![[[0.0; 3]; N]; points.len()];
        for (p, point) in points.iter().enumerate() {
            (reference.shape)(&point.xi, &mut values[p]);
            (reference.gradient)(&point.xi, &mut local_gradients[p]);
        }
        let mut table =
            Self { points_per_cell: points.len(), gradients: Vec::new(), weights: Vec::new(), values };
        for (cell, nodes) in block.cells().enumerate() {
            let size = nodes
                .iter()
                .map(|&n| (mesh.nodes()[n as usize] - mesh.nodes()[nodes[0] as usize]).norm())
                .fold(0.0, f64::max);
            for (local, point) in local_gradients.iter().zip(&points) {
                // J_ij = ∂X_i/∂ξ_j, and ∂N/∂X = J⁻ᵀ ∂N/∂ξ.
                let mut jacobian = tensor::Matrix::<D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    let xi = Vector::<D>::from_fn(|j, _| local[a][j]);
                    jacobian += mesh.nodes()[node as usize] * xi.transpose();
                }
                let (inverse, det) = tensor::inverse(&jacobian);
                let volume = det / size.powi(D as i32);
                if volume.is_nan() || volume <= DEGENERATE {
                    return Err(FemError::InvertedCell {
                        cell: first + cell,
                        nodes: nodes.to_vec(),
                        at: mesh.nodes()[nodes[0] as usize].iter().copied().collect(),
                        volume,
                    });
                }
                let inverse_transposed = inverse.transpose();
                table.gradients.push(std::array::from_fn(|a| {
                    inverse_transposed * Vector::<D>::from_fn(|j, _| local[a][j])
                }));
                table.weights.push(point.weight * det * thickness);
            }
        }
        Ok(table)
    }
}
