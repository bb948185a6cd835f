//! Anderson's acceleration of the iterations of a step, which a kept factor makes a fixed-point iteration.
//!
//! Let f_k be the corrections at guesses d_k. The next guess is not d_k + f_k but that of the combination of the last guesses
//! whose corrections cancel best (Walker & Ni, SIAM J. Numer. Anal. 49, 2011). Bodies of an island depend on one another and
//! share a combination, others have their own. The acceleration is local to a step: contacts of the next one are others.

use carom_mesh::{Vector, nodal};

use super::control::CONTROL;
use super::convergence::BodyProgress;
use crate::model::assembly::Assembly;
use crate::model::each_body::{PerNode, each_body};
use crate::model::given::Given;

/// Differences combined.
const DEPTH: usize = 3;
/// The last guesses and corrections, one vector per node of the model.
#[derive(Debug)]
pub(crate) struct Acceleration<const D: usize> {
    guess: Vec<Vector<D>>,
    correction: Vec<Vector<D>>,
    /// Differences from guess to guess, a ring.
    guesses: [Vec<Vector<D>>; DEPTH],
    /// Differences from correction to correction, alike.
    corrections: [Vec<Vector<D>>; DEPTH],
    bodies: Vec<Record>,
}

/// What is known of a body.
#[derive(Debug, Clone, Copy, Default)]
struct Record {
    products: Products,
    /// Iterations taken note of.
    count: usize,
}

impl Record {
    /// Number of differences there are.
    fn differences(&self) -> usize {
        self.count.saturating_sub(1).min(DEPTH)
    }

    /// Place of the latest difference.
    fn slot(&self) -> usize {
        self.count % DEPTH
    }
}

/// Inner products of the differences of corrections with one another, and with the last correction.
#[derive(Debug, Clone, Copy, Default)]
struct Products {
    matrix: [[f64; DEPTH]; DEPTH],
    right: [f64; DEPTH],
}

impl Products {
    fn add(&mut self, other: &Self) {
        for i in 0..DEPTH {
            self.right[i] += other.right[i];
            (0..DEPTH).for_each(|j| self.matrix[i][j] += other.matrix[i][j]);
        }
    }

    /// The weights of the first `count` differences of the ring that leave least of the correction; the latest is in `slot`.
    fn weights(&self, count: usize, slot: usize) -> [f64; DEPTH] {
        // Older differences are left out where newer ones say as much: elimination from the latest on.
        let places: [usize; DEPTH] = std::array::from_fn(|i| (slot + DEPTH - i) % DEPTH);
        let (mut l, mut y) = ([[0.0; DEPTH]; DEPTH], [0.0; DEPTH]);
        let mut used = count;
        for i in 0..count {
            let p = places[i];
            for j in 0..=i {
                let sum = self.matrix[p][places[j]] - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
                l[i][j] = if i == j { sum } else { sum / l[j][j] };
            }
            if l[i][i] <= CONTROL.parallel * self.matrix[p][p] {
                used = i;
                break;
            }
            l[i][i] = l[i][i].sqrt();
            y[i] = (self.right[p] - (0..i).map(|k| l[i][k] * y[k]).sum::<f64>()) / l[i][i];
        }
        let mut weights = [0.0; DEPTH];
        for i in (0..used).rev() {
            y[i] = (y[i] - (i + 1..used).map(|k| l[k][i] * y[k]).sum::<f64>()) / l[i][i];
            weights[places[i]] = y[i];
        }
        if weights.iter().all(|w| w.abs() <= CONTROL.largest_weight) { weights } else { [0.0; DEPTH] }
    }
}

/// What the last iteration has led to.
pub(crate) struct Last<'a, const D: usize> {
    /// Whether it was the first of the step.
    pub is_first: bool,
    /// Whether contacts act on a body.
    pub touched: &'a [bool],
    pub progress: &'a [BodyProgress],
    /// d [m].
    pub motion: &'a [Vector<D>],
    /// The correction [m] that led to it.
    pub correction: &'a [Vector<D>],
}

impl<const D: usize> Acceleration<D> {
    /// For a model with so many positions and bodies.
    pub fn new(positions: usize, bodies: usize) -> Self {
        Self {
            guess: nodal::zeros(positions),
            correction: nodal::zeros(positions),
            guesses: std::array::from_fn(|_| nodal::zeros(positions)),
            corrections: std::array::from_fn(|_| nodal::zeros(positions)),
            bodies: vec![Record::default(); bodies],
        }
    }

    /// Forgets what is known of `bodies`, because their iteration has become another.
    pub fn restart(&mut self, bodies: &[usize]) {
        bodies.iter().for_each(|&i| self.bodies[i] = Record::default());
    }

    /// Takes note of the correction of a body, and of the guess that led to it, to the motion so far.
    fn record(&mut self, body: usize, assembly: &Assembly<D>, last: &Last<'_, D>) {
        let record = &mut self.bodies[body];
        record.count += 1;
        let (slot, differences) = (record.slot(), record.differences());
        let Products { matrix, right } = &mut record.products;
        let others = (0..differences).map(|j| (slot + DEPTH - j) % DEPTH);
        for j in others.clone() {
            (matrix[slot][j], right[j]) = (0.0, 0.0);
        }
        for run in assembly.stepped(body) {
            let nodes = assembly.numbered(body, run);
            let (d, f) = (&last.motion[nodes.clone()], &last.correction[nodes.clone()]);
            let (guess, correction) = (&mut self.guess[nodes.clone()], &mut self.correction[nodes.clone()]);
            let changes = &mut self.guesses[slot][nodes.clone()];
            nodal::each_of_two(changes, guess, [d, f], |change, guess, [d, f]| {
                let before = d - f;
                *change = before - *guess;
                *guess = before;
            });
            let changes = &mut self.corrections[slot][nodes.clone()];
            nodal::each_of_two(changes, correction, [f], |change, correction, [f]| {
                *change = f - *correction;
                *correction = *f;
            });
            for j in others.clone() {
                let other = &self.corrections[j][nodes.clone()];
                matrix[slot][j] += nodal::dot(&self.corrections[slot][nodes.clone()], other);
                right[j] += nodal::dot(other, f);
            }
        }
        others.for_each(|j| matrix[j][slot] = matrix[slot][j]);
    }

    /// Takes note of the last correction [m] of the `bodies` of an assembly.
    pub fn take_note(&mut self, bodies: &[usize], assembly: &Assembly<D>, last: &Last<'_, D>) {
        for &i in bodies {
            let slow = !last.is_first && last.progress[i].contraction > CONTROL.fast;
            if last.touched[i] || slow || self.bodies[i].count > 0 {
                self.record(i, assembly, last);
            }
        }
    }

    /// Moves the `bodies`, some of which contacts have `touched`, on to better guesses.
    ///
    /// Where a step ends its last correction stands as it is: the momentum of the bodies is then balanced by the reactions to round-off.
    pub fn accelerate(
        &self,
        bodies: &[usize],
        touched: &[bool],
        given: &Given<'_, D>,
        motion: &mut [Vector<D>],
        reached: &mut [Vector<D>],
    ) {
        let mut together = Products::default();
        bodies.iter().filter(|&&i| touched[i]).for_each(|&i| together.add(&self.bodies[i].products));
        let all = (PerNode(motion), PerNode(reached));
        each_body(given.assembly, bodies, all, &|i, (motion, moved)| {
            let record = &self.bodies[i];
            let products = if touched[i] { &together } else { &record.products };
            let weights = products.weights(record.differences(), record.slot());
            if weights.iter().all(|&weight| weight == 0.0) {
                return;
            }
            for run in given.assembly.stepped(i) {
                let nodes = given.assembly.numbered(i, run);
                let motion = &mut motion.0[run.clone()];
                for (k, weight) in weights.into_iter().enumerate().filter(|&(_, weight)| weight != 0.0) {
                    let differences = [&self.guesses[k][nodes.clone()], &self.corrections[k][nodes.clone()]];
                    nodal::each(motion, differences, |m, [d, f]| *m -= (d + f) * weight);
                }
                let start = &given.state.displacement[nodes];
                nodal::each(&mut moved.0[run.clone()], [start, motion], |u1, [u0, d]| *u1 = u0 + d);
            }
        });
    }
}
