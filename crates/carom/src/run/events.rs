use std::sync::Arc;

use carom_contact::Solid;
use serde::Serialize;

use crate::body::fe::part::ModelBody;
use crate::ledger::ByPair;
use crate::run::impact::{Impact, Touching, Whole};
use crate::step::report::PairReport;
use crate::{Model, Scheme};

/// Steps of a dynamic analysis for which a pair that stays in contact may be without a reaction: one that rests under `midpoint` has none in
/// every second step.
const FLICKER: f64 = 3.0;

/// A contact of a pair from its first reaction to its last, flickers merged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ContactEvent {
    /// The two names.
    pub pair: [String; 2],
    /// End of the first step with a reaction [s].
    pub onset: f64,
    /// End of the last step with a reaction [s]; none while the pair may still be touching.
    pub release: Option<f64>,
    /// Largest sum of the normal reactions [N].
    pub peak_force: f64,
    /// Dissipated by friction [J].
    pub friction_work: f64,
    /// What the two did to one another; none while the pair may still be touching, nor of a static analysis.
    pub impact: Option<Impact>,
}

/// The last contact of a pair.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Last {
    /// Which of the events it is.
    pub event: usize,
    /// End of the last step with a reaction [s].
    pub until: f64,
    /// What is known of it.
    pub touching: Touching,
}

/// How close contacts of a pair are that count as one [s].
#[derive(Debug, Clone)]
pub(crate) enum Merge {
    /// The same for all pairs.
    Fixed(f64),
    /// How long a pressure wave takes along the longest side of a deformable body of the pair, of the body where that is shortest. While waves are
    /// on their way a contact may open and close again; who is out of it for longer has parted.
    Crossing {
        /// That of every body; none of a rigid one.
        of_bodies: Vec<Option<f64>>,
        /// No less than this.
        least: f64,
    },
}

impl Merge {
    /// Less than `merge` [s]. Without it a dynamic analysis in steps of `dt` [s] takes the time of the bodies themselves. The time of a
    /// static one does not say how long anything lasts, and nothing is merged there.
    pub fn new<const D: usize>(model: &Model<D>, scheme: Scheme, dt: f64, merge: Option<f64>) -> Self {
        let crossing_time = |body: &Arc<ModelBody<D>>| {
            let (low, high) = body.body.mesh().bounds();
            Some((high - low).max() / body.wave_speed()?)
        };
        match (merge, scheme) {
            (Some(merge), _) => Self::Fixed(merge),
            (None, Scheme::Static) => Self::Fixed(0.0),
            (None, _) => Self::Crossing {
                of_bodies: model.bodies.iter().map(crossing_time).collect(),
                least: FLICKER * dt,
            },
        }
    }

    /// Of the contacts of two solids.
    pub fn of(&self, between: [Solid; 2]) -> f64 {
        match self {
            Self::Fixed(merge) => *merge,
            Self::Crossing { of_bodies, least } => {
                let times = between.iter().filter_map(|solid| match solid {
                    Solid::Body(body) => of_bodies[*body],
                    Solid::Obstacle(_) => None,
                });
                times.reduce(f64::min).unwrap_or(0.0).max(*least)
            }
        }
    }
}

/// Follows the contacts of all pairs.
#[derive(Debug)]
pub(crate) struct EventLog {
    merge: Merge,
    pub events: Vec<ContactEvent>,
    /// The last contact of pairs that have touched.
    pub last: ByPair<Last>,
}

impl EventLog {
    /// An empty log.
    pub fn new(merge: Merge) -> Self {
        Self { merge, events: Vec::new(), last: ByPair::default() }
    }

    /// Goes on where contacts this close to one another are one.
    pub fn go_on(&mut self, merge: &Merge) {
        self.merge = merge.clone();
    }

    /// Records what pairs, which have these `names`, did in a step from `start` to `end` [s]; `whole` says how a solid moved at its start, and
    /// `arrived` where its centre was at its end [m].
    pub fn record(
        &mut self,
        names: impl Fn([Solid; 2]) -> [String; 2],
        reports: &ByPair<PairReport>,
        [start, end]: [f64; 2],
        whole: impl Fn(Solid) -> Whole,
        arrived: impl Fn(Solid) -> [f64; 3],
    ) {
        let touch = |between| reports.get(between).is_some_and(|report| report.normal_force > 0.0);
        for (between, last) in self.last.iter() {
            if last.until >= start && !touch(between) {
                let impact = last.touching.impact(&between.map(&whole), between[0] == between[1]);
                self.events[last.event].impact = impact;
            }
        }
        for (between, report) in reports.iter() {
            let last = self.last.get(between).copied();
            if report.normal_force <= 0.0 {
                // A reaction that is gone by the end of the step may still have rubbed in it.
                if let Some(last) = last {
                    self.events[last.event].friction_work += report.ledger.friction;
                }
                continue;
            }
            let last = last.filter(|l| start <= l.until || start - l.until < self.merge.of(between));
            let mut last = match last {
                Some(last) => last,
                None => {
                    self.events.push(ContactEvent {
                        pair: names(between),
                        onset: end,
                        release: None,
                        peak_force: 0.0,
                        friction_work: 0.0,
                        impact: None,
                    });
                    let touching = Touching::meeting(between.map(&whole));
                    Last { event: self.events.len() - 1, until: end, touching }
                }
            };
            last.until = end;
            let middle = |solid| {
                let ends = [whole(solid).centre, arrived(solid)];
                std::array::from_fn(|i| 0.5 * (ends[0][i] + ends[1][i]))
            };
            last.touching.go_on(&report.given, end - start, || between.map(middle));
            self.last.insert(between, last);
            let event = &mut self.events[last.event];
            event.peak_force = event.peak_force.max(report.normal_force);
            event.friction_work += report.ledger.friction;
            event.release = Some(end);
        }
    }

    /// The events so far; those that had a reaction in the step that ended at `now` are still open.
    pub fn events(&self, now: f64) -> Vec<ContactEvent> {
        let mut events = self.events.clone();
        for last in self.last.values() {
            if last.until >= now {
                (events[last.event].release, events[last.event].impact) = (None, None);
            }
        }
        events
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PairLedger;
    use crate::step::report::PairImpulse;

    fn record(log: &mut EventLog, force: f64, start: f64, end: f64) {
        let ledger = PairLedger { friction: 0.5, ..PairLedger::default() };
        let given =
            PairImpulse { normal: [force * (end - start), 0.0, 0.0], weight: 1.0, ..PairImpulse::default() };
        let report = PairReport { normal_force: force, given, ledger };
        let between = [Solid::Body(0), Solid::Obstacle(0)];
        let names = |_| ["a".into(), "b".into()];
        // The body turns round at 1 s.
        let whole = |solid| match solid {
            Solid::Body(_) => Whole { velocity: [100.0 * (start - 1.0), 0.0, 0.0], ..Whole::default() },
            Solid::Obstacle(_) => Whole::default(),
        };
        log.record(names, &[(between, report)].into_iter().collect(), [start, end], whole, |_| [0.0; 3]);
    }

    #[test]
    fn flickers_are_one_event_and_a_later_impact_is_another() {
        let mut log = EventLog::new(Merge::Fixed(0.03));
        record(&mut log, 3.0, 0.99, 1.00);
        record(&mut log, 0.0, 1.00, 1.01);
        record(&mut log, 5.0, 1.01, 1.02);
        record(&mut log, 0.0, 1.02, 1.03);
        record(&mut log, 4.0, 2.00, 2.01);
        let events = log.events(2.01);
        assert_eq!(events.len(), 2);
        assert_eq!((events[0].onset, events[0].release), (1.00, Some(1.02)));
        assert_eq!((events[0].peak_force, events[0].friction_work), (5.0, 2.0));
        assert_eq!((events[1].onset, events[1].release), (2.01, None));
        assert_eq!(log.events(3.0)[1].release, Some(2.01));
        assert_eq!(events[1].impact, None);
        // It came at 1 m/s and left at 2: flickers are parts of one impact.
        let impact = events[0].impact.expect("has ended");
        assert!((impact.restitution.expect("came together") - 2.0).abs() < 1e-12, "{impact:?}");
        assert!((impact.impulse - 0.08).abs() < 1e-12, "{impact:?}");
    }
}
