use std::sync::Arc;

use carom_mesh::Matrix;
use nalgebra::SMatrix;

use super::control::CONTROL;
use super::rows::Rows;
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
///
/// Of a matrix that processes share it has the rows that are here, and nodes are their places among these: see [`Rows`].
#[derive(Debug)]
pub(super) struct Scaled<const D: usize> {
    graph: Arc<NodeGraph>,
    /// L⁻¹ of every node.
    scales: Vec<Matrix<D>>,
    /// The blocks of S by entry of the graph, column by column, times [`ONE`]; behind the last one what is read beyond it.
    values: Vec<i16>,
    /// Who has the rest of the matrix, if others have.
    shared: Option<(Sharing, Rows)>,
}

impl<const D: usize> Scaled<D> {
    /// None if a block of the diagonal is not positive definite, or a number is not finite.
    pub fn of(matrix: &NodalMatrix<Matrix<D>>, sharing: Option<&Sharing>) -> Option<Self> {
        let shared = match sharing {
            None => None,
            Some(sharing) => Some((sharing.clone(), Rows::of(matrix, &sharing.ranks)?)),
        };
        let rows = shared.as_ref().map(|(_, rows)| rows);
        let whole = matrix.shared_graph();
        let graph = rows.map_or_else(|| Arc::clone(whole), |rows| Arc::new(rows.part_of(whole)));
        let own = |node: usize| matrix.values[whole.entry(node as u32, node as u32)];
        let mut diagonal: Vec<Matrix<D>> =
            (0..graph.node_count()).map(|place| own(node_at(rows, place))).collect();
        if let Some(rows) = rows {
            let sum = |ranks: &dyn Ranks, parts: &mut [Matrix<D>]| ranks.sum(bytemuck::cast_slice_mut(parts));
            rows.sum_split(&mut diagonal, Matrix::zeros(), sum);
        }
        let scale = |block: Matrix<D>| nalgebra::Cholesky::new(block)?.l().try_inverse();
        let scales: Option<Vec<Matrix<D>>> = diagonal.into_iter().map(scale).collect();
        let values = scales.as_ref().and_then(|scales| scaled_values(matrix, &graph, rows, scales));
        // All ranks are to say the same.
        let mut refused = [f64::from(u8::from(values.is_none()))];
        rows.iter().for_each(|rows| rows.ranks().sum(&mut refused));
        if refused[0] > 0.0 {
            return None;
        }
        Some(Self { graph, scales: scales?, values: values?, shared })
    }

    /// Number of nodes.
    pub fn node_count(&self) -> usize {
        self.scales.len()
    }

    /// The graph of the nodes of the body, whoever has their rows.
    pub fn graph(&self) -> &NodeGraph {
        self.shared.as_ref().map_or(&self.graph, |(sharing, _)| &sharing.graph)
    }

    /// The rows that are here, if others have some.
    pub fn rows(&self) -> Option<&Rows> {
        self.shared.as_ref().map(|(_, rows)| rows)
    }

    /// The number in the body of the node at a place.
    #[inline]
    pub fn node_at(&self, place: usize) -> usize {
        node_at(self.rows(), place)
    }

    /// The place of a node of the body, if its row is here.
    #[inline]
    pub fn place_of(&self, node: usize) -> Option<usize> {
        place_of(self.rows(), node)
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

    /// S x.
    pub fn times(&self, x: &[Columns<D, 1>]) -> Vec<Columns<D, 1>> {
        let mut products = (0..self.node_count()).map(|node| self.row_times(node, x)).collect::<Vec<_>>();
        if let Some(rows) = self.rows() {
            let sum = |ranks: &dyn Ranks, parts: &mut [Columns<D, 1>]| {
                ranks.sum_single(parts.as_flattened_mut().as_flattened_mut());
            };
            rows.sum_split(&mut products, [[0.0]; D], sum);
        }
        products
    }

    /// The row of a node of S x; of a split one this process's part of it.
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

#[inline]
fn node_at(rows: Option<&Rows>, place: usize) -> usize {
    rows.map_or(place, |rows| rows.nodes()[place] as usize)
}

#[inline]
fn place_of(rows: Option<&Rows>, node: usize) -> Option<usize> {
    rows.map_or(Some(node), |rows| rows.place(node))
}

/// The blocks of S where L⁻¹ of every node is known; none if one is too large or not finite.
fn scaled_values<const D: usize>(
    matrix: &NodalMatrix<Matrix<D>>,
    own: &NodeGraph,
    rows: Option<&Rows>,
    scales: &[Matrix<D>],
) -> Option<Vec<i16>> {
    let graph = matrix.graph();
    let mut values = Vec::with_capacity(own.entry_count() * D * D + LANES);
    for place in 0..scales.len() {
        for (entry, neighbour) in graph.row(node_at(rows, place)) {
            let Some(neighbour) = place_of(rows, neighbour) else { continue };
            let block = scales[place] * matrix.values[entry] * scales[neighbour].transpose();
            if !block.iter().all(|x| x.abs() <= CONTROL.largest) {
                return None;
            }
            values.extend(block.iter().map(|&x| (x * f64::from(ONE)).round() as i16));
        }
    }
    values.extend([0; LANES]);
    Some(values)
}
