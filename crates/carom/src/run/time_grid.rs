use crate::scenario::SLACK;

/// The nominal steps of an analysis: times are multiples of the step, not sums, so that they do not drift. All steps but a shorter last one have the
/// very same length, so that they share their factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeGrid {
    /// Length of a step [s].
    pub time_step: f64,
    /// When it starts [s].
    pub start_time: f64,
    /// When it ends [s].
    pub end_time: f64,
    /// All its nominal steps.
    pub steps: u64,
    /// Nominal steps done.
    pub step: u64,
}

impl TimeGrid {
    /// Steps of length `time_step` [s] from the start to the end of a `span` [s]. A last one that would only be round-off of the ratio does not
    /// count.
    pub fn new(time_step: f64, [start_time, end_time]: [f64; 2]) -> Self {
        let steps = ((end_time - start_time) / time_step - SLACK).ceil().max(1.0) as u64;
        Self { time_step, start_time, end_time, steps, step: 0 }
    }

    /// Whether all steps are done.
    pub fn has_ended(&self) -> bool {
        self.step >= self.steps
    }

    /// Whether there are steps left before time `until` [s], where the run has come to `time` [s].
    pub fn goes_on(&self, time: f64, until: f64) -> bool {
        !self.has_ended() && self.is_before(time, until)
    }

    /// Whether a moment `time` [s] is before `other` [s], by more than round-off.
    pub fn is_before(&self, time: f64, other: f64) -> bool {
        time < other - SLACK * self.time_step
    }

    /// Length and end of the next step [s].
    pub fn next_step(&self) -> (f64, f64) {
        let grid = |step: u64| self.start_time + step as f64 * self.time_step;
        let rest = self.end_time - grid(self.step);
        let length = if rest < (1.0 - SLACK) * self.time_step { rest } else { self.time_step };
        let last = self.step + 1 == self.steps;
        (length, if last { self.end_time } else { grid(self.step + 1) })
    }

    /// How many intervals of length `every` [s] have begun at `time` [s], the first at the start.
    pub fn intervals(&self, time: f64, every: f64) -> u64 {
        ((time - self.start_time + SLACK * self.time_step) / every).floor() as u64 + 1
    }
}
