use carom_contact::Site;
use carom_mesh::Vector;

/// What a contact of a pair with a friction law remembers of its sliding, whether it presses or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlidingRecord<const D: usize> {
    /// Index of the pair.
    pub pair: u32,
    /// Where between the two.
    pub site: Site,
    /// How far it has slid since the start, whichever way [m].
    pub distance: f64,
    /// The direction in which it slid in the last step, of length 1; zero if it stuck or was open.
    pub direction: Vector<D>,
    /// The state variable of its law.
    pub state: f64,
}

impl<const D: usize> SlidingRecord<D> {
    /// Of a contact that has not slid yet, with this state variable.
    pub(crate) fn new((pair, site): (u32, Site), state: f64) -> Self {
        Self { pair, site, distance: 0.0, direction: Vector::zeros(), state }
    }

    /// What identifies a contact from step to step.
    #[must_use]
    pub fn key(&self) -> (u32, Site) {
        (self.pair, self.site)
    }

    /// Whether there is nothing to remember.
    fn is_blank(&self) -> bool {
        self.distance == 0.0 && self.state == 0.0 && self.direction == Vector::<D>::zeros()
    }
}

/// Writes to `next` what is remembered after a step: the records of its contacts, in order, and of all others what was `known` of them, which have
/// not slid in it.
pub(crate) fn remember<const D: usize>(
    known: &[SlidingRecord<D>],
    of_step: impl Iterator<Item = SlidingRecord<D>>,
    next: &mut Vec<SlidingRecord<D>>,
) {
    next.clear();
    let mut known =
        known.iter().map(|record| SlidingRecord { direction: Vector::zeros(), ..*record }).peekable();
    for record in of_step {
        while let Some(other) = known.next_if(|other| other.key() < record.key()) {
            next.push(other);
        }
        known.next_if(|other| other.key() == record.key());
        next.push(record);
    }
    next.extend(known);
    next.retain(|record| !record.is_blank());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contacts_that_are_open_keep_their_distance_and_no_direction() {
        let record = |node, distance, x| SlidingRecord::<2> {
            distance,
            direction: Vector::<2>::new(x, 0.0),
            ..SlidingRecord::new((0, Site::Node(node)), 0.0)
        };
        let known = [record(1, 0.1, 1.0), record(3, 0.3, 1.0), record(5, 0.0, 1.0)];
        let of_step = [record(2, 0.2, -1.0), record(3, 0.4, -1.0), record(4, 0.0, 0.0)];
        let mut next = Vec::new();
        remember(&known, of_step.into_iter(), &mut next);
        assert_eq!(next, [record(1, 0.1, 0.0), record(2, 0.2, -1.0), record(3, 0.4, -1.0)]);
    }
}
