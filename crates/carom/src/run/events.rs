use serde::Serialize;

use carom_contact::Target;

use crate::step::report::PairReport;
use crate::{Model, NamedPair, Scheme};

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
}

/// Follows the contacts of all named pairs.
#[derive(Debug)]
pub(crate) struct EventLog {
    /// For each named pair: contacts less than this apart are one [s].
    merge: Vec<f64>,
    pub events: Vec<ContactEvent>,
    /// For each named pair: its last event and the end of the last step with a reaction.
    pub last: Vec<Option<(usize, f64)>>,
}

impl EventLog {
    /// A log that takes contacts of each named pair for one that are less than `merge` [s] apart.
    pub fn new(merge: Vec<f64>) -> Self {
        Self { events: Vec::new(), last: vec![None; merge.len()], merge }
    }

    /// How close contacts of each named pair are that count as one [s]: less than `merge`. Without it a dynamic analysis in steps of `dt` [s] takes
    /// the time of the bodies themselves, see [`crossing_times`]. The time of a static one does not say how long anything lasts, and nothing is
    /// merged there.
    pub fn merges<const D: usize>(model: &Model<D>, scheme: Scheme, dt: f64, merge: Option<f64>) -> Vec<f64> {
        let count = model.assembly.named_pairs.len();
        match (merge, scheme) {
            (Some(merge), _) => vec![merge; count],
            (None, Scheme::Static) => vec![0.0; count],
            (None, _) => crossing_times(model).into_iter().map(|time| time.max(FLICKER * dt)).collect(),
        }
    }

    /// Goes on where contacts less than this apart are one [s].
    pub fn go_on(&mut self, merge: &[f64]) {
        self.merge.copy_from_slice(merge);
    }

    /// Records what the named pairs did in a step from `start` to `end` [s].
    pub fn record(&mut self, named_pairs: &[NamedPair], reports: &[PairReport], start: f64, end: f64) {
        for (pair, report) in reports.iter().enumerate() {
            if report.normal_force <= 0.0 {
                // A reaction that is gone by the end of the step may still have rubbed in it.
                if let Some((event, _)) = self.last[pair] {
                    self.events[event].friction_work += report.ledger.friction;
                }
                continue;
            }
            let event = match self.last[pair] {
                Some((event, until)) if start <= until || start - until < self.merge[pair] => event,
                _ => {
                    self.events.push(ContactEvent {
                        pair: named_pairs[pair].between.clone(),
                        onset: end,
                        release: None,
                        peak_force: 0.0,
                        friction_work: 0.0,
                    });
                    self.events.len() - 1
                }
            };
            self.last[pair] = Some((event, end));
            let event = &mut self.events[event];
            event.peak_force = event.peak_force.max(report.normal_force);
            event.friction_work += report.ledger.friction;
            event.release = Some(end);
        }
    }

    /// The events so far; those that had a reaction in the step that ended at `now` are still open.
    pub fn events(&self, now: f64) -> Vec<ContactEvent> {
        let mut events = self.events.clone();
        for &(event, until) in self.last.iter().flatten() {
            if until >= now {
                events[event].release = None;
            }
        }
        events
    }
}

/// For every named pair, how long a pressure wave takes along the longest side of a deformable body of the pair [s], of the body where that is
/// shortest. While waves are on their way a contact may open and close again; who is out of it for longer has parted.
fn crossing_times<const D: usize>(model: &Model<D>) -> Vec<f64> {
    let of_body = |index: usize| {
        let body = &model.bodies[index];
        let (low, high) = body.body.mesh().bounds();
        Some((high - low).max() / body.wave_speed()?)
    };
    let of_bodies: Vec<Option<f64>> = (0..model.bodies.len()).map(of_body).collect();
    let mut times = vec![f64::INFINITY; model.assembly.named_pairs.len()];
    for pair in &model.assembly.contact.pairs {
        let target = match pair.target {
            Target::Surface(target) => of_bodies[target],
            Target::Obstacle(_) => None,
        };
        let time = &mut times[pair.named_pair];
        *time = of_bodies[pair.source].into_iter().chain(target).fold(*time, f64::min);
    }
    times.into_iter().map(|time| if time.is_finite() { time } else { 0.0 }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PairLedger;

    fn record(log: &mut EventLog, named_pairs: &[NamedPair], force: f64, start: f64, end: f64) {
        log.record(
            named_pairs,
            &[PairReport {
                normal_force: force,
                ledger: PairLedger { friction: 0.5, ..PairLedger::default() },
            }],
            start,
            end,
        );
    }

    #[test]
    fn flickers_are_one_event_and_a_later_impact_is_another() {
        let named_pairs = vec![NamedPair { between: ["a".into(), "b".into()], friction: 0.0 }];
        let mut log = EventLog { merge: vec![0.03], events: vec![], last: vec![None] };
        record(&mut log, &named_pairs, 3.0, 0.99, 1.00);
        record(&mut log, &named_pairs, 0.0, 1.00, 1.01);
        record(&mut log, &named_pairs, 5.0, 1.01, 1.02);
        record(&mut log, &named_pairs, 4.0, 2.00, 2.01);
        let events = log.events(2.01);
        assert_eq!(events.len(), 2);
        assert_eq!((events[0].onset, events[0].release), (1.00, Some(1.02)));
        assert_eq!((events[0].peak_force, events[0].friction_work), (5.0, 1.5));
        assert_eq!((events[1].onset, events[1].release), (2.01, None));
        assert_eq!(log.events(3.0)[1].release, Some(2.01));
    }
}
