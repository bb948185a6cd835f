use faer::dyn_stack::{MemBuffer, StackReq};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};

use super::control::CONTROL;
use super::factor::Factor;
use super::parts::Parts;

/// M has no inverse, or none with a correct digit, at this unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingularMatrix {
    /// Index of the unknown.
    pub dof: usize,
}

impl std::fmt::Display for SingularMatrix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "M is singular, or too close to it to be inverted, at unknown {}", self.dof)
    }
}

impl std::error::Error for SingularMatrix {}

/// M⁻¹, part by part.
pub(super) struct Inverse {
    pub parts: Parts,
    factors: Vec<Factor>,
    /// Whether M is symmetric up to round-off.
    pub symmetric: bool,
}

impl Inverse {
    /// Factorises M.
    pub fn new(m: &SparseColMat<usize, f64>) -> Result<Self, SingularMatrix> {
        let parts = Parts::of(m.as_ref());
        let symmetric = is_symmetric(m);
        let factors = (0..parts.len())
            .map(|p| {
                Factor::new(&block(m, &parts, p), symmetric)
                    .map_err(|row| SingularMatrix { dof: parts.dofs(p)[row] as usize })
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { parts, factors, symmetric })
    }

    /// Numbers stored in the factor of `part`.
    pub fn fill(&self, part: usize) -> f64 {
        self.factors[part].fill()
    }

    /// Memory for solving for `columns` right-hand sides at once on any part.
    pub fn memory(&self, columns: usize) -> MemBuffer {
        MemBuffer::new(self.factors.iter().map(|f| f.scratch(columns)).fold(StackReq::EMPTY, StackReq::or))
    }

    /// Overwrites the right-hand sides in `x`, column after column over the unknowns of `part`, with the solutions.
    pub fn solve_part(&self, part: usize, x: &mut [f64], memory: &mut MemBuffer) {
        self.factors[part].solve(x, memory);
    }

    /// As [`Inverse::solve_part`], with Mᵀ.
    pub fn solve_part_transposed(&self, part: usize, x: &mut [f64], memory: &mut MemBuffer) {
        self.factors[part].solve_transposed(x, memory);
    }

    /// Overwrites the right-hand side `x` over all unknowns with the solution.
    pub fn solve(&self, x: &mut [f64]) {
        let mut memory = self.memory(1);
        let mut of_part = Vec::new();
        for part in 0..self.parts.len() {
            let dofs = self.parts.dofs(part);
            of_part.clear();
            of_part.extend(dofs.iter().map(|&d| x[d as usize]));
            self.solve_part(part, &mut of_part, &mut memory);
            for (&d, &value) in dofs.iter().zip(&of_part) {
                x[d as usize] = value;
            }
        }
    }
}

fn is_symmetric(m: &SparseColMat<usize, f64>) -> bool {
    let m = m.as_ref();
    let entry = |i: usize, j: usize| m.get(i, j).copied().unwrap_or(0.0);
    let diagonal: Vec<f64> = (0..m.ncols()).map(|j| entry(j, j).abs()).collect();
    (0..m.ncols()).all(|j| {
        m.symbolic().row_idx_of_col(j).zip(m.val_of_col(j)).all(|(i, &value)| {
            i == j || (value - entry(j, i)).abs() <= CONTROL.round_off * (diagonal[i] * diagonal[j]).sqrt()
        })
    })
}

/// M restricted to one part.
fn block(m: &SparseColMat<usize, f64>, parts: &Parts, part: usize) -> SparseColMat<usize, f64> {
    let dofs = parts.dofs(part);
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for &j in dofs {
        let j = j as usize;
        for (i, &value) in m.symbolic().row_idx_of_col(j).zip(m.val_of_col(j)) {
            if value != 0.0 {
                rows.push(parts.place_of(i));
                values.push(value);
            }
        }
        starts.push(rows.len());
    }
    let n = dofs.len();
    SparseColMat::new(SymbolicSparseColMat::new_checked(n, n, starts, None, rows), values)
}
