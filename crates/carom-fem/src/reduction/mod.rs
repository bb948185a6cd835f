//! Few shapes that stand for all motions of a body that deforms little: Craig & Bampton, AIAA J. 6, 1313 (1968).
//!
//! What is kept are the displacements of some nodes, with the shapes that the body takes where each of them moves alone, and the lowest modes of
//! the body where these nodes are held. Of all motions that they span, [`Reduction`] has the free vibrations: they are orthogonal to one another and
//! to rigid motions, in the mass and in the stiffness.

mod content;
mod lowest;
mod reader;
mod shapes;

use carom_mesh::compiled;
use carom_mesh::{Matrix, Vector};
use nalgebra::{Cholesky, DMatrix};

pub use self::content::Content;
use self::content::rigid_motions;
use self::lowest::lowest_modes;
use self::reader::Reader;
use self::shapes::Shapes;
use crate::sparse::{Factor, NodalMatrix, Precision};
use crate::{Body, FemError, Held};

/// A mode has no stiffness where it has less than this part of that of the stiffest one: the mesh is in pieces, or a mechanism.
const LOOSE: f64 = 1e-13;

/// Nodes hold a body where no rigid motion of the size of the body moves them by less than the root of this part of it, in the mean.
const HELD: f64 = 1e-12;

/// Rows of a block of [`products`].
const ROWS: usize = 512;

/// A body reduced to its rigid motions and some free vibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct Reduction<const D: usize> {
    /// ω² [1/s²] of every vibration, ascending.
    stiffness: Vec<f64>,
    shapes: Shapes<D>,
    reader: Reader<D>,
}

type Build<const D: usize> = fn(&Body<D>, usize) -> Result<Reduction<D>, FemError>;

impl<const D: usize> Reduction<D> {
    /// Of a `body`, which is free, keeping the nodes of its contact surface and as many `modes` with these held.
    ///
    /// # Errors
    /// If the nodes of the contact surface do not hold the body, or it is in pieces.
    pub fn new(body: &Body<D>, modes: usize) -> Result<Self, FemError> {
        compiled!(D, Reduction::build as Build)(body, modes)
    }

    fn build(body: &Body<D>, modes: usize) -> Result<Self, FemError> {
        let kept = body.surface().nodes();
        if !hold(body, kept) {
            return Err(FemError::NotPositiveDefinite);
        }
        let still = vec![Vector::zeros(); body.node_count()];
        let stiffness = body.stiffness(&still);
        let mut held = vec![[false; D]; body.node_count()];
        kept.iter().for_each(|&node| held[node as usize] = [true; D]);
        let held = Held::of(&held);
        let mut inside = stiffness.clone();
        held.uncouple(&mut inside);
        let mut factor = Factor::new(body.graph(), &[], &[])?;
        factor.factorize(Precision::Double, |entry| inside.values[entry])?;
        let mut columns = constraint_modes(&stiffness, &held, kept, &mut factor);
        columns.extend(lowest_modes(body.mass(), &held, &mut factor, modes)?);
        Self::of_columns(body, &stiffness, &columns)
    }

    /// The free vibrations of what these `columns` span.
    fn of_columns(
        body: &Body<D>,
        stiffness: &NodalMatrix<Matrix<D>>,
        columns: &[Vec<Vector<D>>],
    ) -> Result<Self, FemError> {
        let basis = matrix_of(columns);
        let mut product = vec![Vector::zeros(); body.node_count()];
        let mut times = |multiply: &dyn Fn(&[Vector<D>], &mut [Vector<D>])| {
            let mut all = DMatrix::zeros(basis.nrows(), basis.ncols());
            for (k, column) in columns.iter().enumerate() {
                multiply(column, &mut product);
                all.column_mut(k).copy_from_slice(bytemuck::cast_slice(&product));
            }
            let reduced = products(&basis, &all);
            (&reduced + reduced.transpose()) * 0.5
        };
        let mass = times(&|x, y| body.mass().multiply(x, y));
        let stiffness = times(&|x, y| stiffness.multiply(x, y));
        let rigid = coordinates_of_rigid_motions(body, columns.len());
        let root = Cholesky::new(mass).ok_or(FemError::NotPositiveDefinite)?;
        let scaled = |a: &DMatrix<f64>| root.l_dirty().solve_lower_triangular(a);
        let half = scaled(&stiffness).ok_or(FemError::NotPositiveDefinite)?;
        let whole = scaled(&half.transpose()).ok_or(FemError::NotPositiveDefinite)?;
        // What is orthogonal to rigid motions in the mass: the columns of an orthonormal basis that follow theirs.
        let size = columns.len();
        let momenta = root.l().transpose() * &rigid;
        let mut ordered = DMatrix::zeros(size, momenta.ncols() + size);
        ordered.columns_mut(0, momenta.ncols()).copy_from(&momenta);
        ordered.columns_mut(momenta.ncols(), size).fill_with_identity();
        let all = ordered.qr().q();
        let across = all.columns(momenta.ncols(), size - momenta.ncols());
        let vibrating = across.tr_mul(&(whole * across));
        let eigen = ((&vibrating + vibrating.transpose()) * 0.5).symmetric_eigen();
        let mut order: Vec<usize> = (0..eigen.eigenvalues.len()).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
        let values: Vec<f64> = order.iter().map(|&k| eigen.eigenvalues[k]).collect();
        if let (Some(&least), Some(&most)) = (values.first(), values.last()) {
            if least.is_nan() || least <= LOOSE * most {
                return Err(FemError::InPieces);
            }
        }
        let vectors =
            DMatrix::from_fn(size - momenta.ncols(), order.len(), |i, k| eigen.eigenvectors[(i, order[k])]);
        let coordinates = root
            .l()
            .transpose()
            .solve_upper_triangular(&(across * vectors))
            .ok_or(FemError::NotPositiveDefinite)?;
        let shapes = basis * coordinates;
        let kept = body.surface().nodes();
        let reader = Reader::new(body, kept, &columns[D * kept.len()..], &shapes);
        let reader = reader.ok_or(FemError::NotPositiveDefinite)?;
        let shapes = Shapes::new(values.len(), body.node_count(), |n, i, k| shapes[(n * D + i, k)]);
        Ok(Self { stiffness: values, shapes, reader })
    }

    /// ω² [1/s²] of every vibration, ascending.
    #[must_use]
    pub fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    /// Number of vibrations.
    #[must_use]
    pub fn count(&self) -> usize {
        self.stiffness.len()
    }

    /// The displacements of a node along every axis for an amplitude of one of every vibration [1/√kg].
    #[inline]
    #[must_use]
    pub fn shapes_at(&self, node: usize) -> [&[f64]; D] {
        self.shapes.at(node)
    }

    /// The displacement [m] of a node by these amplitudes [m √kg].
    #[inline]
    #[must_use]
    pub fn displacement(&self, node: usize, amplitudes: &[f64]) -> Vector<D> {
        let [displacement] = self.shapes.displacements(node, [amplitudes]);
        displacement
    }

    /// Those by several sets of amplitudes, for little more than one takes.
    #[inline]
    #[must_use]
    pub fn displacements<const K: usize>(&self, node: usize, amplitudes: [&[f64]; K]) -> [Vector<D>; K] {
        self.shapes.displacements(node, amplitudes)
    }

    /// Adds what a force [N] at a node is for the amplitudes, Φᵀ f.
    #[inline]
    pub fn add_force(&self, node: usize, force: &Vector<D>, out: &mut [f64]) {
        for (shapes, f) in self.shapes_at(node).into_iter().zip(force) {
            out.iter_mut().zip(shapes).for_each(|(out, shape)| *out += shape * f);
        }
    }

    /// The nodes, ascending, whose displacements say everything.
    #[must_use]
    pub fn read_nodes(&self) -> &[u32] {
        self.reader.nodes()
    }

    /// Reads what displacements [m] are made of, given those of [`Self::read_nodes`] in their order.
    pub fn read(&self, displacements: &[Vector<D>], content: &mut Content<D>) {
        self.reader.read(displacements, content);
    }

    /// The turn alone that [`Self::read`] reads.
    #[must_use]
    pub fn read_turn(&self, displacements: &[Vector<D>]) -> [f64; 3] {
        self.reader.read_turn(displacements)
    }
}

/// The shapes of the body where one displacement of a kept node is one and all others are zero.
fn constraint_modes<const D: usize>(
    stiffness: &NodalMatrix<Matrix<D>>,
    held: &Held,
    kept: &[u32],
    factor: &mut Factor<D>,
) -> Vec<Vec<Vector<D>>> {
    let count = stiffness.graph().node_count();
    let unit = |node: u32, i: usize| {
        let mut shape = vec![Vector::zeros(); count];
        for (entry, neighbour) in stiffness.graph().row(node as usize) {
            shape[neighbour] = -stiffness.values[entry].row(i).transpose();
        }
        held.clear(&mut shape);
        shape
    };
    let places = kept.iter().flat_map(|&node| (0..D).map(move |i| (node, i)));
    places
        .map(|(node, i)| {
            let mut shape = unit(node, i);
            factor.solve(&mut shape);
            held.clear(&mut shape);
            shape[node as usize][i] = 1.0;
            shape
        })
        .collect()
}

/// aᵀ b, block after block of rows: of tall matrices that is what fits into caches.
fn products(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let mut sum = DMatrix::zeros(a.ncols(), b.ncols());
    for first in (0..a.nrows()).step_by(ROWS) {
        let count = ROWS.min(a.nrows() - first);
        sum.gemm(1.0, &a.rows(first, count).transpose(), &b.rows(first, count), 1.0);
    }
    sum
}

/// These nodal vectors as the columns of a matrix.
fn matrix_of<const D: usize>(columns: &[Vec<Vector<D>>]) -> DMatrix<f64> {
    let rows = columns.first().map_or(0, |column| column.len() * D);
    let mut all = DMatrix::zeros(rows, columns.len());
    for (k, column) in columns.iter().enumerate() {
        all.column_mut(k).copy_from_slice(bytemuck::cast_slice(column));
    }
    all
}

/// The reduced coordinates of rigid motions: the displacements of kept nodes alone, which the inside follows without stress.
fn coordinates_of_rigid_motions<const D: usize>(body: &Body<D>, size: usize) -> DMatrix<f64> {
    let (nodes, kept) = (body.mesh().nodes(), body.surface().nodes());
    let centre = body.mean(nodes);
    let motions: Vec<_> = kept.iter().map(|&n| rigid_motions(&(nodes[n as usize] - centre))).collect();
    let value = |r: usize, c: usize| motions.get(r / D).map_or(0.0, |of_node| of_node[c][r % D]);
    DMatrix::from_fn(size, D * (D + 1) / 2, value)
}

/// Whether a body cannot move as a rigid one where these nodes do not move.
fn hold<const D: usize>(body: &Body<D>, kept: &[u32]) -> bool {
    let (nodes, size) = (body.mesh().nodes(), body.mesh().diameter());
    let count = D * (D + 1) / 2;
    let mut gram = DMatrix::<f64>::zeros(count, count);
    for &node in kept {
        let motions = rigid_motions(&((nodes[node as usize] - nodes[kept[0] as usize]) / size));
        gram += DMatrix::from_fn(count, count, |i, j| motions[i].dot(&motions[j]));
    }
    gram.symmetric_eigenvalues().min() > HELD * kept.len() as f64
}
