use carom_mesh::Matrix;
use pulp::Simd;

/// Cells that elements work on side by side: a multiple of the width of every SIMD register.
pub const LANES: usize = 8;
/// Quadrature points of a cell at most (hex27).
pub const MAX_POINTS: usize = 27;
/// Points at which a law is asked at once, at most.
pub const BATCH: usize = MAX_POINTS * LANES;

/// Deformation gradients or stresses at many points, component by component, so that neighbouring points fill a SIMD register.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub struct Batch<const S: usize> {
    /// Component (i, j) of every point.
    pub components: [[[f64; BATCH]; S]; S],
}

impl<const S: usize> Batch<S> {
    /// Zero at every point.
    #[inline(always)]
    #[must_use]
    pub fn zeros() -> Self {
        Self { components: [[[0.0; BATCH]; S]; S] }
    }

    /// The matrix of one point.
    #[inline]
    #[must_use]
    pub fn get(&self, point: usize) -> Matrix<S> {
        Matrix::from_fn(|i, j| self.components[i][j][point])
    }

    /// Writes the matrix of one point.
    #[inline]
    pub fn set(&mut self, point: usize, matrix: &Matrix<S>) {
        for i in 0..S {
            for j in 0..S {
                self.components[i][j][point] = matrix[(i, j)];
            }
        }
    }
}

impl<const S: usize> Batch<S> {
    /// The matrices at as many points as a register has lanes, from `point` on.
    #[inline(always)]
    pub(super) fn load<V: Simd>(&self, point: usize) -> [[V::f64s; S]; S] {
        let at = |row: &[f64; BATCH]| V::as_simd_f64s(&row[point..]).0[0];
        let mut matrices = [[at(&self.components[0][0]); S]; S];
        for (matrices, rows) in matrices.iter_mut().zip(&self.components) {
            for (matrix, row) in matrices.iter_mut().zip(rows) {
                *matrix = at(row);
            }
        }
        matrices
    }

    /// Writes the matrices at as many points as a register has lanes, from `point` on.
    #[inline(always)]
    pub(super) fn store<V: Simd>(&mut self, point: usize, matrices: [[V::f64s; S]; S]) {
        for (rows, matrices) in self.components.iter_mut().zip(matrices) {
            for (row, matrix) in rows.iter_mut().zip(matrices) {
                V::as_mut_simd_f64s(&mut row[point..]).0[0] = matrix;
            }
        }
    }
}
