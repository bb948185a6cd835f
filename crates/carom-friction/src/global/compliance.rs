use super::incidence::Incidence;
use super::inverse::{Inverse, SingularMatrix};
use super::problem::GlobalProblem;
use crate::Vector;

/// W = Hᵀ M⁻¹ H of a global problem, ready to be multiplied or written out, but not stored.
pub(super) struct Compliance<'a, const D: usize> {
    pub problem: &'a GlobalProblem<D>,
    pub inverse: Inverse,
    pub incidence: Incidence<D>,
}

impl<'a, const D: usize> Compliance<'a, D> {
    /// Factorises M.
    pub fn new(problem: &'a GlobalProblem<D>) -> Result<Self, SingularMatrix> {
        let inverse = Inverse::new(&problem.m)?;
        let incidence = Incidence::new(&problem.h, &inverse.parts);
        Ok(Self { problem, inverse, incidence })
    }

    /// The velocities M⁻¹ (H r + f).
    pub fn velocities(&self, r: &[Vector<D>]) -> Vec<f64> {
        let mut v = self.problem.f.clone();
        self.incidence.add_forces(r, &mut v);
        self.inverse.solve(&mut v);
        v
    }

    /// The relative motions Hᵀ v + b.
    pub fn motions(&self, v: &[f64]) -> Vec<Vector<D>> {
        self.problem.b.iter().enumerate().map(|(i, b)| b + self.incidence.motion(i, v)).collect()
    }
}
