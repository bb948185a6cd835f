/// When a first-order method has its residual measured: a check costs as much as an iteration.
///
/// The length of a step costs nothing and falls as the residual does. A check is due when it promises that the residual is below the
/// tolerance, and now and then anyway.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Schedule {
    tolerance: f64,
    /// Residual over step length at the last check.
    per_length: f64,
    next: usize,
}

/// Iterations between two checks: a share of those made, within these bounds.
const BOUNDS: [usize; 2] = [5, 50];

impl Schedule {
    pub fn new(tolerance: f64, iteration: usize) -> Self {
        Self { tolerance, per_length: f64::INFINITY, next: iteration + 1 }
    }

    /// Whether to measure after this iteration, whose step had this length.
    pub fn is_due(&self, iteration: usize, length: f64) -> bool {
        iteration >= self.next || length * self.per_length <= self.tolerance || !length.is_finite()
    }

    /// Takes note of a check.
    pub fn checked(&mut self, iteration: usize, length: f64, residual: f64) {
        self.per_length = residual / length;
        let [shortest, longest] = BOUNDS;
        self.next = iteration + iteration.clamp(shortest, longest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn falling_steps_are_measured_when_they_promise_enough() {
        let mut schedule = Schedule::new(1e-8, 0);
        assert!(schedule.is_due(1, 1.0));
        schedule.checked(1, 1.0, 0.1);
        assert!(!schedule.is_due(2, 1e-6));
        assert!(schedule.is_due(2, 1e-7));
        assert!(schedule.is_due(6, 1.0));
        assert!(schedule.is_due(3, f64::NAN));
    }
}
