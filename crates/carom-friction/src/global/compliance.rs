use super::incidence::Incidence;
use super::inverse::Inverse;
use super::trace::Trace;
use crate::residual::{Measured, Meter};
use crate::{GlobalProblem, Measure, SingularMatrix, Vector};

/// W = Hᵀ M⁻¹ H of a global problem, ready to be multiplied or written out, but not stored.
pub(super) struct Compliance<'a, const D: usize> {
    pub problem: &'a GlobalProblem<D>,
    pub inverse: Inverse,
    pub incidence: Incidence<D>,
}

/// What the measure needs without W: its trace, and q.
pub(super) struct Measurable<'a, const D: usize> {
    pub compliance: &'a Compliance<'a, D>,
    trace: Trace,
    squared_q: f64,
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

impl<'a, const D: usize> Measurable<'a, D> {
    pub fn new(compliance: &'a Compliance<'a, D>) -> Self {
        let q = compliance.motions(&compliance.velocities(&[]));
        let squared_q = q.iter().map(Vector::norm_squared).sum();
        Self { compliance, trace: compliance.trace(), squared_q }
    }
}

impl<const D: usize> Measured<D> for Measurable<'_, D> {
    fn meter(&self, unit: f64) -> Meter {
        let (n, trace) = (self.compliance.problem.len(), self.trace.value);
        let stiffness = if trace > 0.0 { (n * D) as f64 / trace } else { 1.0 };
        Meter { stiffness, unit, size_q: self.squared_q.sqrt() }
    }

    /// With the natural residual rounded up by what the trace may be wrong: the residual changes at most in proportion to ρ.
    fn measure(&self, meter: &Meter, r: &[Vector<D>]) -> Measure {
        let w = self.compliance.motions(&self.compliance.velocities(r));
        let mut measure = meter.measure(&self.compliance.problem.mu, r, |i| w[i]);
        measure.natural_residual *= 1.0 + self.trace.uncertainty;
        measure
    }
}
