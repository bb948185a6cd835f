use std::sync::Arc;

use carom_mesh::Matrix;
use nalgebra::SMatrix;

use super::control::CONTROL;
use super::shared::Sharing;
use super::{NodalMatrix, NodeGraph};
use crate::ranks::Ranks;

/// Numbers that are read at once: a column of a block, and what follows it.
const LANES: usize = 4;
/// What stands for 1.
const ONE: f32 = i16::MAX as f32;

/// A value per component of a node, for C vectors at once.
pub(super) type Columns<const D: usize, const C: usize> = [[f32; C]; D];

/// A symmetric positive definite matrix A as L S Lᵀ, with L the lower triangles of the blocks of its diagonal, A_nn = L_n L_nᵀ.
///
/// No entry of S is larger than those of its diagonal, which are 1. Sixteen bits with a fixed point hold them to 1.5·10⁻⁵, much
/// less than the error of an approximate inverse. Products wait for memory, so half of single precision is half the time.
#[derive(Debug)]
pub(super) struct Scaled<const D: usize> {
    graph: Arc<NodeGraph>,
    /// L⁻¹ of every node.
    scales: Vec<Matrix<D>>,
    /// The blocks of S by entry of the graph, column by column, times [`ONE`]; behind the last one what is read beyond it.
    values: Vec<i16>,
    /// Who has the rest of the matrix, if others have.
    sharing: Option<Sharing>,
}

impl<const D: usize> Scaled<D> {
    /// None if a block of the diagonal is not positive definite, or a number is not finite.
    pub fn of(matrix: &NodalMatrix<Matrix<D>>, sharing: Option<&Sharing>) -> Option<Self> {
        let graph = Arc::clone(matrix.shared_graph());
        let own = |node: usize| matrix.values[graph.entry(node as u32, node as u32)];
        let mut diagonal: Vec<Matrix<D>> = (0..graph.node_count()).map(own).collect();
        if let Some(sharing) = sharing {
            sharing.ranks.sum(bytemuck::cast_slice_mut(&mut diagonal));
        }
        let scale = |block: Matrix<D>| nalgebra::Cholesky::new(block)?.l().try_inverse();
        let scales: Vec<Matrix<D>> = diagonal.into_iter().map(scale).collect::<Option<_>>()?;
        let values = scaled_values(matrix, &scales);
        // All ranks are to say the same.
        let mut refused = [f64::from(u8::from(values.is_none()))];
        sharing.iter().for_each(|sharing| sharing.ranks.sum(&mut refused));
        if refused[0] > 0.0 {
            return None;
        }
        Some(Self { graph, scales, values: values?, sharing: sharing.cloned() })
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.scales.len()
    }

    /// The graph of its nodes, whoever has the entries.
    pub fn graph(&self) -> &NodeGraph {
        self.sharing.as_ref().map_or(&self.graph, |sharing| &sharing.graph)
    }

    /// Who has the rest of it, if others have.
    pub fn ranks(&self) -> Option<&dyn Ranks> {
        self.sharing.as_ref().map(|sharing| &*sharing.ranks)
    }

    /// Memory [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..]) + size_of_val(&self.scales[..])
    }

    /// L⁻¹ v.
    #[inline]
    pub fn scale<const C: usize>(&self, node: usize, v: &SMatrix<f64, D, C>) -> Columns<D, C> {
        let scaled = self.scales[node] * v;
        std::array::from_fn(|i| std::array::from_fn(|c| scaled[(i, c)] as f32))
    }

    /// L⁻ᵀ v.
    #[inline]
    pub fn unscale<const C: usize>(&self, node: usize, v: &Columns<D, C>) -> SMatrix<f64, D, C> {
        self.scales[node].tr_mul(&SMatrix::from_fn(|i, c| f64::from(v[i][c])))
    }

    /// Lᵀ v of a uniform v.
    pub fn uniform(&self, node: usize) -> Columns<D, 1> {
        let upper = self.scales[node].transpose().try_inverse().unwrap_or_else(Matrix::identity);
        std::array::from_fn(|i| [upper.row(i).sum() as f32])
    }

    /// The row of a node of S x; of a shared matrix this process's part of it.
    #[inline(always)]
    pub fn row_times<const C: usize>(&self, node: usize, x: &[Columns<D, C>]) -> Columns<D, C> {
        let (range, neighbours) = self.graph.neighbours(node);
        let values = &self.values[range.start * D * D..range.end * D * D + LANES];
        // A sum per column of the blocks, so that one addition need not wait for the other.
        let mut sums = [[[0.0; LANES]; C]; D];
        for (k, &neighbour) in neighbours.iter().enumerate() {
            let block = &values[k * D * D..(k + 1) * D * D + LANES - D];
            let x = &x[neighbour as usize];
            for j in 0..D {
                let column: [f32; LANES] = std::array::from_fn(|i| f32::from(block[j * D + i]));
                for c in 0..C {
                    for i in 0..LANES {
                        sums[j][c][i] += column[i] * x[j][c];
                    }
                }
            }
        }
        let mut sum = [[0.0; LANES]; C];
        for part in &sums {
            for c in 0..C {
                for i in 0..LANES {
                    sum[c][i] += part[c][i];
                }
            }
        }
        // Nobody needs what is beyond D, but a compiler that knows computes each of three numbers apart, at half the speed.
        let sum = std::hint::black_box(sum);
        std::array::from_fn(|i| std::array::from_fn(|c| sum[c][i] / ONE))
    }
}

/// The blocks of S where L⁻¹ of every node is known; none if one is too large or not finite.
fn scaled_values<const D: usize>(matrix: &NodalMatrix<Matrix<D>>, scales: &[Matrix<D>]) -> Option<Vec<i16>> {
    let graph = matrix.graph();
    let mut values = Vec::with_capacity(graph.entry_count() * D * D + LANES);
    for node in 0..graph.node_count() {
        for (entry, neighbour) in graph.row(node) {
            let block = scales[node] * matrix.values[entry] * scales[neighbour].transpose();
            if !block.iter().all(|x| x.abs() <= CONTROL.largest) {
                return None;
            }
            values.extend(block.iter().map(|&x| (x * f64::from(ONE)).round() as i16));
        }
    }
    values.extend([0; LANES]);
    Some(values)
}
