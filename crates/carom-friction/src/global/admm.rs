use faer::dyn_stack::MemBuffer;
use faer::sparse::SymbolicSparseColMat;

use super::compliance::Compliance;
use super::measurable::Measurable;
use crate::clock::Clock;
use crate::sparse_factor::{NoFactor, Size, SparseFactor};
use crate::splitting::{self, LinearLaw};
use crate::stopping::Monitor;
use crate::{SolveReport, SolveStatus, SolverKind, StoppingRule, Vector};

/// The pairs u = W a + q without W: with a + ρ u = sum, (M + H ρ Hᵀ) v = H (sum − ρ b) + f and u = Hᵀ v + b.
pub(super) struct Velocities<'a, const D: usize> {
    compliance: &'a Compliance<'a, D>,
    /// Relative to their mean until the problem is solved.
    stiffness: Vec<f64>,
    factor: SparseFactor,
    matrices: Matrices,
    /// The mean stiffness, which the matrices do not contain.
    mean: f64,
    scale: f64,
    values: Vec<f64>,
    v: Vec<f64>,
    force: Vec<Vector<D>>,
    memory: MemBuffer,
    clock: Clock,
}

impl<'a, const D: usize> Velocities<'a, D> {
    /// Finds the structure of the factor.
    pub fn new(compliance: &'a Compliance<'a, D>, clock: Clock) -> Result<Self, NoFactor> {
        let stiffness = relative_stiffness(compliance);
        let (pattern, matrices) = Matrices::new(compliance, &stiffness);
        let factor = if compliance.inverse.symmetric {
            SparseFactor::cholesky(pattern, clock)
        } else {
            SparseFactor::lu(pattern, clock)
        }?;
        Ok(Self {
            memory: MemBuffer::new(factor.scratch(1)),
            values: vec![0.0; matrices.m.len()],
            mean: 1.0,
            scale: 1.0,
            v: vec![0.0; compliance.problem.m.ncols()],
            force: vec![Vector::zeros(); stiffness.len()],
            compliance,
            stiffness,
            factor,
            matrices,
            clock,
        })
    }

    /// What a factor of M + H ρ Hᵀ takes.
    pub fn size(&self) -> Size {
        self.factor.size()
    }

    /// Solves by ADMM from `r`.
    pub fn solve(mut self, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        let compliance = self.compliance;
        let problem = Measurable::new(compliance);
        let mut monitor = Monitor::new(&problem, rule, self.clock);
        self.mean = monitor.stiffness();
        self.stiffness.iter_mut().for_each(|k| *k *= self.mean);
        let status = splitting::run(&mut monitor, &mut self, &compliance.problem.mu, r, usize::MAX);
        monitor.report(SolverKind::Admm, status.unwrap_or(SolveStatus::Stalled), r)
    }
}

/// The stiffness of each contact over the mean one, as if M were diagonal.
fn relative_stiffness<const D: usize>(compliance: &Compliance<'_, D>) -> Vec<f64> {
    let m = compliance.problem.m.as_ref();
    let n = compliance.incidence.contacts();
    let share = |(dof, row): (usize, &Vector<D>)| {
        let diagonal = m.get(dof, dof).map_or(0.0, |d| d.abs());
        if diagonal > 0.0 { row.norm_squared() / diagonal } else { 0.0 }
    };
    let shares: Vec<f64> = (0..n).map(|i| compliance.incidence.rows_of_contact(i).map(share).sum()).collect();
    let mean = shares.iter().sum::<f64>() / n as f64;
    shares.iter().map(|&share| if share > 0.0 { mean / share } else { 1.0 }).collect()
}

impl<const D: usize> LinearLaw<D> for Velocities<'_, D> {
    /// On elastic bodies a contact feels itself more than its neighbours.
    fn first_scale(&self) -> f64 {
        1.0
    }

    fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    fn prepare(&mut self, scale: f64) -> Result<(), NoFactor> {
        self.scale = scale;
        let unit = scale * self.mean;
        for (value, (m, hkh)) in self.values.iter_mut().zip(self.matrices.m.iter().zip(&self.matrices.hkh)) {
            *value = m + unit * hkh;
        }
        self.factor.factorize(&self.values, self.clock)
    }

    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]) {
        let (problem, incidence) = (self.compliance.problem, &self.compliance.incidence);
        for i in 0..sum.len() {
            self.force[i] = sum[i] - problem.b[i] * (self.scale * self.stiffness[i]);
        }
        self.v.copy_from_slice(&problem.f);
        incidence.add_forces(&self.force, &mut self.v);
        self.factor.solve(&mut self.v, &mut self.memory);
        for (i, (motion, b)) in motion.iter_mut().zip(&problem.b).enumerate() {
            *motion = b + incidence.motion(i, &self.v);
        }
    }
}

/// The values of M and of H k Hᵀ, with the relative stiffness k of the contacts, over their common pattern.
struct Matrices {
    m: Vec<f64>,
    hkh: Vec<f64>,
}

impl Matrices {
    fn new<const D: usize>(
        compliance: &Compliance<'_, D>,
        stiffness: &[f64],
    ) -> (SymbolicSparseColMat<usize>, Self) {
        let (m, incidence) = (&compliance.problem.m, &compliance.incidence);
        let n = m.ncols();
        let mut contacts_at: Vec<Vec<(usize, Vector<D>)>> = vec![Vec::new(); n];
        for contact in 0..incidence.contacts() {
            for (dof, row) in incidence.rows_of_contact(contact) {
                contacts_at[dof].push((contact, row * stiffness[contact]));
            }
        }
        let (mut starts, mut rows) = (vec![0], Vec::with_capacity(m.compute_nnz()));
        let mut matrices = Self { m: Vec::with_capacity(m.compute_nnz()), hkh: Vec::new() };
        // A column of H k Hᵀ: in which rows it has numbers, and all of it.
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
            matrices.hkh.extend(rows[first..].iter().map(|&i| std::mem::take(&mut column[i])));
            starts.push(rows.len());
        }
        (SymbolicSparseColMat::new_checked(n, n, starts, None, rows), matrices)
    }
}
