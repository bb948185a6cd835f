/// Moments closer than this to one another, in nominal steps, differ by round-off alone.
const SLACK: f64 = 1e-6;

/// The nominal steps of a run: times are multiples of the step, not sums, so that they do not drift. All steps but a shorter last one have the
/// very same length, so that they share their factors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TimeGrid {
    /// Length of a step [s].
    pub time_step: f64,
    /// When the run ends [s].
    pub end_time: f64,
    /// Nominal steps of the whole run.
    pub steps: u64,
    /// Nominal steps done.
    pub step: u64,
}

impl TimeGrid {
    /// Steps of length `time_step` [s] until `end_time` [s]. A last one that would only be round-off of the ratio does not
    /// count.
    pub fn new(time_step: f64, end_time: f64) -> Self {
        let steps = (end_time / time_step - SLACK).ceil().max(1.0) as u64;
        Self { time_step, end_time, steps, step: 0 }
    }

    /// Whether there are steps left before time `until` [s], where the run has come to `time` [s].
    pub fn goes_on(&self, time: f64, until: f64) -> bool {
        self.step < self.steps && self.is_before(time, until)
    }

    /// Whether a moment `time` [s] is before `other` [s], by more than round-off.
    pub fn is_before(&self, time: f64, other: f64) -> bool {
        time < other - SLACK * self.time_step
    }

    /// Length and end of the next step [s].
    pub fn next_step(&self) -> (f64, f64) {
        let start = self.step as f64 * self.time_step;
        let rest = self.end_time - start;
        let length = if rest < (1.0 - SLACK) * self.time_step { rest } else { self.time_step };
        let last = self.step + 1 == self.steps;
        (length, if last { self.end_time } else { (self.step + 1) as f64 * self.time_step })
    }

    /// How many intervals of length `every` [s] have begun at `time` [s].
    pub fn intervals(&self, time: f64, every: f64) -> u64 {
        ((time + SLACK * self.time_step) / every).floor() as u64 + 1
    }
}
