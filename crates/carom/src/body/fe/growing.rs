//! How a body grows, and the work of it.

use carom_mesh::Vector;

use super::part::ModelBody;
use crate::body::{Guess, Interval};
use crate::scheme::StressRule;

impl<const D: usize> ModelBody<D> {
    /// How it has grown by time `t` [s]. A run starts from bodies that have not.
    pub(crate) fn growth_at(&self, t: f64) -> f64 {
        self.growth.as_ref().filter(|_| t > 0.0).map_or(0.0, |growth| growth.at(t).value)
    }

    /// How it has grown at the start and at the end of a step.
    pub(crate) fn growth_of(&self, interval: &Interval) -> [f64; 2] {
        [interval.start, interval.end].map(|t| self.growth_at(t))
    }

    /// How it has grown where the forces of a step are evaluated: at its end, or with a force that does the work of the motion alone half way.
    pub(crate) fn growth_of_forces(&self, interval: &Interval) -> f64 {
        let [start, end] = self.growth_of(interval);
        match interval.map.stress {
            StressRule::Weighted => end,
            StressRule::Conserving => 0.5 * (start + end),
        }
    }

    /// The work of growth in a step [J]: the change of strain energy by it at fixed motion, by the first half of it where the step starts and by
    /// the second where it ends.
    ///
    /// With γ̄ half way, ΔE = E(u₁, γ₁) − E(u₁, γ̄) + [E(u₁, γ̄) − E(u₀, γ̄)] + E(u₀, γ̄) − E(u₀, γ₀). What stands in brackets is the work of
    /// the conserving force, for any law, and that of the mean of f(u₀, γ₀) and f(u₁, γ₁) for a linear one.
    pub(crate) fn work_of_growth(&self, guess: &Guess<'_, D>) -> f64 {
        let [start, end] = self.growth_of(guess.interval);
        if start == end {
            return 0.0;
        }
        let half_way = 0.5 * (start + end);
        let with_history = self.body.after(guess.start.history);
        let change = |u: &[Vector<D>], [from, to]: [f64; 2]| {
            with_history.grown(to).strain_energy(u) - with_history.grown(from).strain_energy(u)
        };
        change(guess.start.displacement, [start, half_way]) + change(guess.displacement, [half_way, end])
    }
}
