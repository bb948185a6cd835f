use super::compliance::Compliance;
use super::trace::Trace;
use crate::residual::{Measured, Meter};
use crate::{Measure, Vector};

/// What the measure needs without W: its trace, and q.
pub(super) struct Measurable<'a, const D: usize> {
    pub compliance: &'a Compliance<'a, D>,
    trace: Trace,
    squared_q: f64,
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
