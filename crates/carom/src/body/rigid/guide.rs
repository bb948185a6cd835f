use carom_mesh::Vector;

use super::equation::Prescribed;
use super::pose::Pose;
use crate::body::Interval;
use crate::signal::Signal;

/// The part of the motion of a rigid body that is given as functions of time; the rest is free.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Guide {
    /// The number of the motion in the model.
    pub number: usize,
    /// Displacements of the centre of mass since it began, along the axes of space [m].
    pub along: [Option<Signal>; 3],
    /// Angles by which the body has turned about them since then [rad].
    pub about: [Option<Signal>; 3],
}

impl Guide {
    /// Which displacements of its nodes are prescribed: those of the centre, where the body cannot turn but as prescribed.
    pub fn holds<const D: usize>(&self, turns_about: [bool; 3]) -> [bool; D] {
        let is_free_to_turn = (0..3).any(|i| turns_about[i] && self.about[i].is_none());
        std::array::from_fn(|i| !is_free_to_turn && self.along[i].is_some())
    }

    /// Whether it is where it was at another time [s], and stands still at both.
    pub fn stands_still(&self, times: [f64; 2]) -> bool {
        self.along.iter().chain(&self.about).flatten().all(|signal| signal.stands_still(times))
    }

    /// The velocity [m/s] and the angular velocity [rad/s] at time `t` [s], where they are prescribed.
    pub fn rates(&self, t: f64) -> [[Option<f64>; 3]; 2] {
        [&self.along, &self.about]
            .map(|signals| std::array::from_fn(|i| signals[i].as_ref().map(|signal| signal.at(t).rate)))
    }

    /// What it prescribes in a step that starts at one place, where it began at `anchor`. None if a function of time is not finite.
    pub fn prescribe(&self, interval: &Interval, start: &Pose, anchor: &Pose) -> Option<Prescribed> {
        let at = |signal: &Option<Signal>, t| signal.as_ref().map(|signal| signal.at(t));
        let mut prescribed = Prescribed::default();
        for i in 0..3 {
            if let Some(end) = at(&self.along[i], interval.end) {
                prescribed.shift[i] = Some(anchor.shift[i] + end.value - start.shift[i]);
                prescribed.velocity[i] = if interval.is_load_step { 0.0 } else { end.rate };
            }
            if let Some(end) = at(&self.about[i], interval.end) {
                let before = if interval.starts_from_nothing() {
                    0.0
                } else {
                    at(&self.about[i], interval.start).map_or(0.0, |start| start.value)
                };
                prescribed.turn[i] = Some(2.0 * (0.5 * (end.value - before)).tan());
                prescribed.spin[i] = if interval.is_load_step { 0.0 } else { end.rate };
            }
        }
        let given = prescribed.shift.iter().chain(&prescribed.turn).flatten().sum::<f64>();
        (given + prescribed.velocity.sum() + prescribed.spin.sum()).is_finite().then_some(prescribed)
    }
}

/// A force and a moment on a rigid body.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Resultant {
    /// The force [N].
    pub force: [Option<Signal>; 3],
    /// The moment [N m].
    pub moment: [Option<Signal>; 3],
    /// The point of the body that the force acts at, from the centre of mass in the reference configuration [m].
    pub arm: Vector<3>,
}

impl Resultant {
    /// The force [N] and the moment [N m] by what `value` says of signals.
    pub fn values(&self, value: impl Fn(&Signal) -> f64) -> [Vector<3>; 2] {
        [&self.force, &self.moment]
            .map(|signals| Vector::from_fn(|i, _| signals[i].as_ref().map_or(0.0, &value)))
    }
}
