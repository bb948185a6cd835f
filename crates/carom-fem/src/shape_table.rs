use carom_mesh::cell::MAX_FACET_NODES;
use carom_mesh::{CellBlock, CellKind, Facet, Mesh, Vector, tensor};

use crate::FemError;
use crate::elements::with_node_count;
use crate::quadrature::{Integrand, rule};

/// Cells of one kind and one material in their mesh.
#[derive(Debug, Clone, Copy)]
pub struct Cells<'a, const D: usize> {
    /// The mesh.
    pub mesh: &'a Mesh<D>,
    /// Their nodes.
    pub block: &'a CellBlock,
    /// The numbers of its cells in the mesh.
    pub numbers: &'a [u32],
    /// What it is in space.
    pub depth: Depth,
}

/// How far a body goes on beyond its D dimensions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Depth {
    /// As far everywhere [m]; 1 in 3D.
    Thickness(f64),
    /// All around the axis x = 0.
    Revolution,
}

impl Depth {
    /// The depth at a point [m]: 2πR in a body of revolution.
    #[inline]
    #[must_use]
    pub fn at<const D: usize>(self, x: &Vector<D>) -> f64 {
        match self {
            Depth::Thickness(thickness) => thickness,
            Depth::Revolution => std::f64::consts::TAU * x[0],
        }
    }
}

/// Shape functions of a block of cells with `N` nodes, tabulated once at every quadrature point of every cell.
#[derive(Debug, Clone)]
pub struct ShapeTable<const D: usize, const N: usize> {
    /// Quadrature points of each cell.
    pub points_per_cell: usize,
    /// Gradients ∂N_a/∂X [1/m], cell by cell and point by point.
    pub gradients: Vec<[Vector<D>; N]>,
    /// Weights times Jacobian times depth [m³].
    pub weights: Vec<f64>,
    /// 1/R [1/m] at every point of a body of revolution.
    pub curvatures: Vec<f64>,
    /// Values N_a at the quadrature points of the reference cell.
    pub values: Vec<[f64; N]>,
}

/// Area of a facet [m²] of a body of this depth.
#[must_use]
pub fn facet_area<const D: usize>(mesh: &Mesh<D>, facet: &Facet, depth: Depth) -> f64 {
    let reference = facet.kind.reference();
    let nodes = &facet.nodes;
    let (mut values, mut gradients) = ([0.0; MAX_FACET_NODES], [[0.0; 3]; MAX_FACET_NODES]);
    let mut area = 0.0;
    for point in rule(facet.kind, Integrand::Values, false) {
        (reference.shape)(&point.xi, &mut values[..nodes.len()]);
        (reference.gradient)(&point.xi, &mut gradients[..nodes.len()]);
        let position = |n: u32| mesh.nodes()[n as usize];
        let at: Vector<D> = nodes.iter().zip(&values).map(|(&n, &value)| position(n) * value).sum();
        let tangent = |k: usize| -> Vector<D> {
            nodes.iter().zip(&gradients).map(|(&n, gradient)| position(n) * gradient[k]).sum()
        };
        let size = if D == 2 {
            tangent(0).norm()
        } else {
            Vector::<3>::from(tensor::cross(&tangent(0), &tangent(1))).norm()
        };
        area += point.weight * size * depth.at(&at);
    }
    area
}

/// Volume of cells [m³].
///
/// # Errors
/// If a cell is inverted or degenerate.
pub fn volume_of<const D: usize>(cells: &Cells<'_, D>) -> Result<f64, FemError> {
    with_node_count!(D, cells.block.kind, N => {
        Ok(ShapeTable::<D, N>::new(cells, Integrand::Values)?.weights.iter().sum())
    })
}

/// A cell whose Jacobian is below this, relative to the cube of its size, is degenerate.
const DEGENERATE: f64 = 1e-10;

impl<const D: usize, const N: usize> ShapeTable<D, N> {
    /// The table for `cells`.
    ///
    /// # Errors
    /// If a cell is inverted or degenerate.
    pub fn new(cells: &Cells<'_, D>, integrand: Integrand) -> Result<Self, FemError> {
        let Cells { mesh, block, numbers, depth } = *cells;
        let reference = block.kind.reference();
        let points = rule(block.kind, integrand, depth == Depth::Revolution);
        let mut values = vec![[0.0; N]; points.len()];
        let mut local_gradients = vec![[[0.0; 3]; N]; points.len()];
        for (p, point) in points.iter().enumerate() {
            (reference.shape)(&point.xi, &mut values[p]);
            (reference.gradient)(&point.xi, &mut local_gradients[p]);
        }
        let count = block.cells().len() * points.len();
        let mut table = Self {
            points_per_cell: points.len(),
            // Of a large body they are most of the memory.
            gradients: Vec::with_capacity(if integrand == Integrand::Gradients { count } else { 0 }),
            weights: Vec::with_capacity(count),
            curvatures: Vec::new(),
            values,
        };
        let mut inverted: Option<FemError> = None;
        'cells: for (cell, nodes) in block.cells().enumerate() {
            let size = nodes
                .iter()
                .map(|&n| (mesh.nodes()[n as usize] - mesh.nodes()[nodes[0] as usize]).norm())
                .fold(0.0, f64::max);
            for ((local, point), values) in local_gradients.iter().zip(&points).zip(&table.values) {
                // J_ij = ∂X_i/∂ξ_j, and ∂N/∂X = J⁻ᵀ ∂N/∂ξ.
                let mut jacobian = tensor::Matrix::<D>::zeros();
                for (a, &node) in nodes.iter().enumerate() {
                    let xi = Vector::<D>::from_fn(|j, _| local[a][j]);
                    jacobian += mesh.nodes()[node as usize] * xi.transpose();
                }
                let (inverse, det) = tensor::inverse(&jacobian);
                let volume = det / size.powi(D as i32);
                if volume.is_nan() || volume <= DEGENERATE {
                    if let Some(FemError::InvertedCell { others, .. }) = &mut inverted {
                        others.push(numbers[cell] as usize);
                    } else {
                        inverted = Some(FemError::InvertedCell {
                            cell: numbers[cell] as usize,
                            nodes: nodes.to_vec(),
                            at: mesh.nodes()[nodes[0] as usize].iter().copied().collect(),
                            volume,
                            others: Vec::new(),
                        });
                    }
                    continue 'cells;
                }
                if integrand == Integrand::Gradients {
                    let inverse_transposed = inverse.transpose();
                    table.gradients.push(std::array::from_fn(|a| {
                        inverse_transposed * Vector::<D>::from_fn(|j, _| local[a][j])
                    }));
                }
                let at = nodes.iter().zip(values).map(|(&n, &value)| mesh.nodes()[n as usize] * value);
                let at: Vector<D> = at.sum();
                if depth == Depth::Revolution {
                    table.curvatures.push(1.0 / at[0]);
                }
                table.weights.push(point.weight * det * depth.at(&at));
            }
        }
        inverted.map_or(Ok(table), Err)
    }

    /// N_a/R [1/m] at a point; zero but in a body of revolution.
    #[must_use]
    pub fn hoop(&self, point: usize, node: usize) -> f64 {
        self.curvatures
            .get(point)
            .map_or(0.0, |curvature| self.values[point % self.points_per_cell][node] * curvature)
    }
}
