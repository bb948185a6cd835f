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
    pub const fn zeros() -> Self {
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

// Registers are filled by loops over numbers. Iterators over arrays of arrays went by the stack wherever the compiler chose not to unroll them, which
// doubled the instructions of a law.
impl<const S: usize> Batch<S> {
    /// The matrices at as many points as a register has lanes, from `point` on.
    #[inline(always)]
    pub(super) fn load<V: Simd>(&self, point: usize) -> [[V::f64s; S]; S] {
        let mut matrices = [[V::as_simd_f64s(&self.components[0][0][point..]).0[0]; S]; S];
        for i in 0..S {
            for j in 0..S {
                matrices[i][j] = V::as_simd_f64s(&self.components[i][j][point..]).0[0];
            }
        }
        matrices
    }

    /// Writes the matrices at as many points as a register has lanes, from `point` on.
    #[inline(always)]
    pub(super) fn store<V: Simd>(&mut self, point: usize, matrices: [[V::f64s; S]; S]) {
        for i in 0..S {
            for j in 0..S {
                V::as_mut_simd_f64s(&mut self.components[i][j][point..]).0[0] = matrices[i][j];
            }
        }
    }
}
