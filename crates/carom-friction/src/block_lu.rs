use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::SymbolicSparseColMat;
use faer::sparse::linalg::amd;

use crate::clock::Clock;
use crate::{BlockMatrix, Matrix, Vector, small};

/// LU factor of a sparse matrix of D × D blocks with a symmetric pattern, whose pivots are its diagonal blocks.
///
/// Newton's method on contacts renews such a factor in every iteration, always with the pattern of W and always with a shift
/// that makes the diagonal strong. So ordering (AMD) and structure are found once, and no rows are exchanged. That makes it
/// several times faster than a general sparse LU (see ARCHITECTURE.md), and a pivot that is too small is an error, after
/// which the caller shifts more.
#[derive(Debug)]
pub(crate) struct BlockLu<const D: usize> {
    /// The row eliminated k-th, and its inverse.
    order: Vec<u32>,
    place: Vec<u32>,
    /// Rows of U right of the diagonal, by place.
    upper_starts: Vec<usize>,
    upper_columns: Vec<u32>,
    upper: Vec<Matrix<D>>,
    /// Rows of L left of the diagonal, by place.
    lower_starts: Vec<usize>,
    lower_columns: Vec<u32>,
    lower: Vec<Matrix<D>>,
    inverse_pivots: Vec<Matrix<D>>,
    row: Vec<Matrix<D>>,
    ordered: Vec<Vector<D>>,
}

/// Why there is no structure of a factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoStructure {
    /// The factor would need more blocks than are allowed.
    TooLarge,
    TimeIsUp,
}

/// Why there is no factor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum NoBlockFactor {
    /// A pivot was too small to divide by.
    SmallPivot,
    TimeIsUp,
}

/// Products of blocks, or entries of a structure, after which the clock is read.
const LOOK: usize = 1 << 16;

impl<const D: usize> BlockLu<D> {
    /// Finds the structure of factors of matrices with the pattern of `w`, of at most `max_blocks` blocks.
    pub fn new(w: &BlockMatrix<D>, max_blocks: usize, clock: Clock) -> Result<Self, NoStructure> {
        let n = w.row_count();
        clock.check().map_err(|_| NoStructure::TimeIsUp)?;
        let (order, place) = amd_order(w).ok_or(NoStructure::TooLarge)?;
        let mut seen_since = 0;
        // Row k of U has the pattern of row k of W and of the rows whose first entry is k.
        let mut upper_starts = Vec::with_capacity(n + 1);
        upper_starts.push(0);
        let mut upper_columns: Vec<u32> = Vec::new();
        let mut children: Vec<Vec<u32>> = vec![Vec::new(); n];
        let mut seen = vec![u32::MAX; n];
        let mut lower_counts = vec![0usize; n + 1];
        for k in 0..n {
            let first = upper_columns.len();
            let mut add = |j: u32, columns: &mut Vec<u32>| {
                if j as usize > k && seen[j as usize] != k as u32 {
                    seen[j as usize] = k as u32;
                    columns.push(j);
                }
            };
            for (j, _) in w.row(order[k] as usize) {
                add(place[j], &mut upper_columns);
            }
            for &child in &children[k] {
                seen_since += upper_starts[child as usize + 1] - upper_starts[child as usize];
                for e in upper_starts[child as usize]..upper_starts[child as usize + 1] {
                    add(upper_columns[e], &mut upper_columns);
                }
            }
            if 2 * upper_columns.len() + n > max_blocks {
                return Err(NoStructure::TooLarge);
            }
            if seen_since > LOOK {
                clock.check().map_err(|_| NoStructure::TimeIsUp)?;
                seen_since = 0;
            }
            upper_columns[first..].sort_unstable();
            if let Some(&parent) = upper_columns.get(first) {
                children[parent as usize].push(k as u32);
            }
            upper_columns[first..].iter().for_each(|&j| lower_counts[j as usize + 1] += 1);
            upper_starts.push(upper_columns.len());
        }
        let mut lower_starts = lower_counts;
        for k in 0..n {
            lower_starts[k + 1] += lower_starts[k];
        }
        let mut next = lower_starts.clone();
        let mut lower_columns = vec![0; upper_columns.len()];
        for k in 0..n {
            for &j in &upper_columns[upper_starts[k]..upper_starts[k + 1]] {
                lower_columns[next[j as usize]] = k as u32;
                next[j as usize] += 1;
            }
        }
        Ok(Self {
            upper: vec![Matrix::zeros(); upper_columns.len()],
            lower: vec![Matrix::zeros(); upper_columns.len()],
            inverse_pivots: vec![Matrix::zeros(); n],
            row: vec![Matrix::zeros(); n],
            ordered: vec![Vector::zeros(); n],
            order,
            place,
            upper_starts,
            upper_columns,
            lower_starts,
            lower_columns,
        })
    }

    /// Blocks of both factors.
    pub fn block_count(&self) -> usize {
        2 * self.upper_columns.len() + self.order.len()
    }

    /// Products of blocks in a factorisation.
    pub fn products(&self) -> usize {
        let rows = |j: u32| self.upper_starts[j as usize + 1] - self.upper_starts[j as usize];
        self.lower_columns.iter().map(|&j| 1 + rows(j)).sum()
    }

    /// Factorises the matrix with the rows A_i (W + shift I)_i + B_i.
    pub fn factorize(
        &mut self,
        w: &BlockMatrix<D>,
        shift: f64,
        a: &[Matrix<D>],
        b: &[Matrix<D>],
        clock: Clock,
    ) -> Result<(), NoBlockFactor> {
        let mut products = 0;
        for k in 0..self.order.len() {
            let i = self.order[k] as usize;
            let lower = self.lower_starts[k]..self.lower_starts[k + 1];
            let upper = self.upper_starts[k]..self.upper_starts[k + 1];
            if a[i] == Matrix::<D>::zeros() {
                // An open contact: its row is that of B alone.
                self.lower[lower].fill(Matrix::zeros());
                self.upper[upper].fill(Matrix::zeros());
                self.inverse_pivots[k] = small::inverse(&b[i]).ok_or(NoBlockFactor::SmallPivot)?;
                continue;
            }
            self.lower_columns[lower.clone()].iter().for_each(|&j| self.row[j as usize] = Matrix::zeros());
            self.upper_columns[upper.clone()].iter().for_each(|&j| self.row[j as usize] = Matrix::zeros());
            for (j, block) in w.row(i) {
                self.row[self.place[j] as usize] = a[i] * block;
            }
            self.row[k] += a[i] * shift + b[i];
            let size = self.row[k].amax();
            for e in lower {
                let j = self.lower_columns[e] as usize;
                let factor = self.row[j];
                if factor == Matrix::<D>::zeros() {
                    self.lower[e] = factor;
                    continue;
                }
                let factor = factor * self.inverse_pivots[j];
                self.lower[e] = factor;
                if a[self.order[j] as usize] == Matrix::<D>::zeros() {
                    // Its row has nothing right of the diagonal.
                    continue;
                }
                let range = self.upper_starts[j]..self.upper_starts[j + 1];
                products += 1 + range.len();
                if products > LOOK {
                    clock.check().map_err(|_| NoBlockFactor::TimeIsUp)?;
                    products = 0;
                }
                for (&column, block) in self.upper_columns[range.clone()].iter().zip(&self.upper[range]) {
                    self.row[column as usize] -= factor * block;
                }
            }
            let inverse = small::inverse(&self.row[k]).ok_or(NoBlockFactor::SmallPivot)?;
            if inverse.amax() * size > 1.0 / PIVOT {
                return Err(NoBlockFactor::SmallPivot);
            }
            self.inverse_pivots[k] = inverse;
            for e in upper {
                self.upper[e] = self.row[self.upper_columns[e] as usize];
            }
        }
        Ok(())
    }

    /// Overwrites the right-hand side `x` with the solution.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        let y = &mut self.ordered;
        for k in 0..self.order.len() {
            let mut sum = x[self.order[k] as usize];
            let range = self.lower_starts[k]..self.lower_starts[k + 1];
            for (&j, block) in self.lower_columns[range.clone()].iter().zip(&self.lower[range]) {
                sum -= block * y[j as usize];
            }
            y[k] = sum;
        }
        for k in (0..self.order.len()).rev() {
            let mut sum = y[k];
            let range = self.upper_starts[k]..self.upper_starts[k + 1];
            for (&j, block) in self.upper_columns[range.clone()].iter().zip(&self.upper[range]) {
                sum -= block * y[j as usize];
            }
            y[k] = self.inverse_pivots[k] * sum;
            x[self.order[k] as usize] = y[k];
        }
    }
}

/// Growth of the inverse of a pivot, relative to the block before the elimination, that is too much to trust.
const PIVOT: f64 = 1e-14;

/// Approximate minimum degree ordering: the row eliminated k-th and its inverse.
fn amd_order<const D: usize>(w: &BlockMatrix<D>) -> Option<(Vec<u32>, Vec<u32>)> {
    let n = w.row_count();
    let (mut starts, mut columns) = (vec![0], Vec::new());
    for i in 0..n {
        columns.extend(w.row(i).map(|(j, _)| j));
        starts.push(columns.len());
    }
    let graph = SymbolicSparseColMat::new_checked(n, n, starts, None, columns);
    let (mut order, mut place) = (vec![0usize; n], vec![0usize; n]);
    let mut memory = MemBuffer::new(amd::order_scratch::<usize>(n, graph.compute_nnz()));
    amd::order(&mut order, &mut place, graph.as_ref(), amd::Control::default(), MemStack::new(&mut memory))
        .ok()?;
    let narrow = |v: Vec<usize>| v.into_iter().map(|k| k as u32).collect();
    Some((narrow(order), narrow(place)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of contacts with an unsymmetric matrix over it.
    #[test]
    fn solution_satisfies_the_equations() {
        let n = 12;
        let mut w = BlockMatrix::<3>::default();
        for i in 0..n {
            let mut row: Vec<(usize, Matrix<3>)> =
                [(i + n - 1) % n, i, (i + 1) % n, (i + 5) % n, (i + 7) % n]
                    .into_iter()
                    .map(|j| {
                        let noise = Matrix::from_fn(|r, c| ((i * 7 + j * 3 + r * 5 + c * 11) as f64).sin());
                        (j, if j == i { Matrix::identity() * 6.0 + noise } else { noise })
                    })
                    .collect();
            row.sort_by_key(|&(j, _)| j);
            w.push_row(row);
        }
        let mut a: Vec<Matrix<3>> =
            (0..n).map(|i| Matrix::identity() * (1.0 + i as f64) + Matrix::from_element(0.3)).collect();
        let mut b = vec![Matrix::identity() * 0.2; n];
        (a[4], b[4]) = (Matrix::zeros(), Matrix::identity());
        let exact: Vec<Vector<3>> =
            (0..n).map(|i| Vector::from_fn(|k, _| ((i * 3 + k) as f64).cos())).collect();
        let mut x: Vec<Vector<3>> =
            (0..n).map(|i| a[i] * (w.row_times(i, &exact) + exact[i] * 0.5) + b[i] * exact[i]).collect();
        let clock = Clock::new(None);
        let mut lu = BlockLu::new(&w, 1000, clock).expect("few blocks");
        lu.factorize(&w, 0.5, &a, &b, clock).expect("strong diagonal");
        lu.solve(&mut x);
        for (x, e) in x.iter().zip(&exact) {
            assert!((x - e).norm() < 1e-12);
        }
        assert_eq!(BlockLu::new(&w, 60, clock).expect_err("few are allowed"), NoStructure::TooLarge);
    }
}
