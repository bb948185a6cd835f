use faer::dyn_stack::MemBuffer;
use faer::sparse::SymbolicSparseColMat;

use super::compliance::{Compliance, Measurable};
use crate::sparse_factor::{NoFactor, Size, SparseFactor};
use crate::splitting::{self, LinearLaw};
use crate::stopping::Monitor;
use crate::{SolveReport, SolveStatus, SolverKind, StoppingRule, Vector};

/// The pairs u = W a + q without W: with a + ρ u = sum, (M + ρ H Hᵀ) v = H (sum − ρ b) + f and u = Hᵀ v + b.
pub(super) struct Velocities<'a, const D: usize> {
    compliance: &'a Compliance<'a, D>,
    factor: SparseFactor,
    matrices: Matrices,
    sum: Vec<f64>,
    rho: f64,
    v: Vec<f64>,
    force: Vec<Vector<D>>,
    memory: MemBuffer,
}

impl<'a, const D: usize> Velocities<'a, D> {
    pub fn new(compliance: &'a Compliance<'a, D>) -> Result<Self, NoFactor> {
        let (pattern, matrices) = Matrices::new(compliance);
        let factor = if compliance.inverse.symmetric {
            SparseFactor::cholesky(pattern)
        } else {
            SparseFactor::lu(pattern)
        }?;
        Ok(Self {
            memory: MemBuffer::new(factor.scratch(1)),
            sum: vec![0.0; matrices.m.len()],
            rho: 0.0,
            v: vec![0.0; compliance.problem.m.ncols()],
            force: vec![Vector::zeros(); compliance.problem.len()],
            compliance,
            factor,
            matrices,
        })
    }

    /// What a factor of M + ρ H Hᵀ takes.
    pub fn size(&self) -> Size {
        self.factor.size()
    }

    /// Solves by ADMM from `r`.
    pub fn solve(&mut self, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let problem = Measurable::new(self.compliance);
        let mut monitor = Monitor::new(&problem, rule);
        let status = splitting::run(&mut monitor, self, &self.compliance.problem.mu, r);
        monitor.report(SolverKind::Admm, status.unwrap_or(SolveStatus::Stalled), r)
    }
}

impl<const D: usize> LinearLaw<D> for Velocities<'_, D> {
    fn prepare(&mut self, rho: f64) -> Result<(), NoFactor> {
        self.rho = rho;
        for (sum, (m, hh)) in self.sum.iter_mut().zip(self.matrices.m.iter().zip(&self.matrices.hh)) {
            *sum = m + rho * hh;
        }
        self.factor.factorize(&self.sum)
    }

    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]) {
        let (problem, incidence) = (self.compliance.problem, &self.compliance.incidence);
        for (force, (sum, b)) in self.force.iter_mut().zip(sum.iter().zip(&problem.b)) {
            *force = sum - b * self.rho;
        }
        self.v.copy_from_slice(&problem.f);
        incidence.add_forces(&self.force, &mut self.v);
        self.factor.solve(&mut self.v, &mut self.memory);
        for (i, (motion, b)) in motion.iter_mut().zip(&problem.b).enumerate() {
            *motion = b + incidence.motion(i, &self.v);
        }
    }
}

/// The values of M and H Hᵀ over their common pattern.
struct Matrices {
    m: Vec<f64>,
    hh: Vec<f64>,
}

impl Matrices {
    fn new<const D: usize>(compliance: &Compliance<'_, D>) -> (SymbolicSparseColMat<usize>, Self) {
        let (m, incidence) = (&compliance.problem.m, &compliance.incidence);
        let n = m.ncols();
        let mut contacts_at: Vec<Vec<(usize, Vector<D>)>> = vec![Vec::new(); n];
        for contact in 0..incidence.contacts() {
            for (dof, row) in incidence.rows_of_contact(contact) {
                contacts_at[dof].push((contact, *row));
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::with_capacity(m.compute_nnz()));
        let mut matrices = Self { m: Vec::with_capacity(m.compute_nnz()), hh: Vec::new() };
        // A column of H Hᵀ: in which rows it has numbers, and all of it.
        let (mut coupled, mut column) = (Vec::new(), vec![0.0; n]);
        let mut seen = vec![usize::MAX; n];
        for j in 0..n {
            let first = rows.len();
            rows.extend(m.symbolic().row_idx_of_col(j));
            matrices.m.extend_from_slice(m.val_of_col(j));
            rows[first..].iter().for_each(|&i| seen[i] = j);
            coupled.clear();
            for (contact, row) in &contacts_at[j] {
                for (i, other) in incidence.rows_of_contact(*contact) {
                    column[i] += row.dot(other);
                    if seen[i] != j {
                        seen[i] = j;
                        coupled.push(i);
                    }
                }
            }
            if !coupled.is_empty() {
                let mut entries: Vec<(usize, f64)> =
                    rows.drain(first..).zip(matrices.m.drain(first..)).collect();
                entries.extend(coupled.iter().map(|&i| (i, 0.0)));
                entries.sort_unstable_by_key(|&(i, _)| i);
                rows.extend(entries.iter().map(|e| e.0));
                matrices.m.extend(entries.iter().map(|e| e.1));
            }
            matrices.hh.extend(rows[first..].iter().map(|&i| std::mem::take(&mut column[i])));
            starts.push(rows.len());
        }
        (SymbolicSparseColMat::new_checked(n, n, starts, None, rows), matrices)
    }
}
