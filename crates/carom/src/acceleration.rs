//! Anderson's acceleration of the iterations of a step, which a kept factor makes a fixed-point iteration.
//!
//! With corrections f_k at guesses d_k, the next guess is not d_k + f_k but that of the combination of the last guesses whose
//! corrections cancel best (Walker & Ni, SIAM J. Numer. Anal. 49, 2011). Bodies in contact depend on one another and share a
//! combination, others have their own. The acceleration is local to a step: contacts of the next one are others.

use carom_mesh::Vector;

use crate::Model;
use crate::workspace::Workspace;

/// Differences combined.
const DEPTH: usize = 3;
/// Differences of corrections that are parallel up to this, relative and squared, say nothing new.
const PARALLEL: f64 = 1e-12;
/// Largest weight of a difference: beyond it the combination is an extrapolation that nothing supports.
const LARGEST_WEIGHT: f64 = 2.0;

/// The last guesses and corrections, one vector per node of the model.
#[derive(Debug)]
pub(crate) struct Acceleration<const D: usize> {
    guess: Vec<Vector<D>>,
    correction: Vec<Vector<D>>,
    /// Differences from guess to guess, a ring.
    guesses: [Vec<Vector<D>>; DEPTH],
    /// Differences from correction to correction, alike.
    corrections: [Vec<Vector<D>>; DEPTH],
    /// The products of every body that [`weights`] needs.
    products: Vec<Products>,
    /// Iterations since the start.
    recorded: usize,
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
            if l[i][i] <= PARALLEL * self.matrix[p][p] {
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
        if weights.iter().all(|w| w.abs() <= LARGEST_WEIGHT) { weights } else { [0.0; DEPTH] }
    }
}

impl<const D: usize> Acceleration<D> {
    /// For a model with so many positions and bodies.
    pub fn new(positions: usize, bodies: usize) -> Self {
        let zeros = vec![Vector::zeros(); positions];
        Self {
            guess: zeros.clone(),
            correction: zeros.clone(),
            guesses: std::array::from_fn(|_| zeros.clone()),
            corrections: std::array::from_fn(|_| zeros.clone()),
            products: vec![Products::default(); bodies],
            recorded: 0,
        }
    }

    /// Forgets all, because the iteration has become another.
    pub fn restart(&mut self) {
        self.recorded = 0;
    }

    /// Takes note of the guess and the correction of a body, at `nodes` of the model.
    fn record(&mut self, body: usize, nodes: std::ops::Range<usize>, d: &[Vector<D>], f: &[Vector<D>]) {
        let products = &mut self.products[body];
        *products = Products::default();
        if self.recorded > 0 {
            let slot = self.recorded % DEPTH;
            for n in nodes.clone() {
                self.guesses[slot][n] = d[n] - self.guess[n];
                self.corrections[slot][n] = f[n] - self.correction[n];
            }
            for i in 0..DEPTH.min(self.recorded) {
                let i = (slot + DEPTH - i) % DEPTH;
                let of = |other: &[Vector<D>]| -> f64 {
                    self.corrections[i][nodes.clone()].iter().zip(other).map(|(a, b)| a.dot(b)).sum()
                };
                products.right[i] = of(&f[nodes.clone()]);
                for j in 0..DEPTH {
                    products.matrix[i][j] = of(&self.corrections[j][nodes.clone()]);
                }
            }
        }
        self.guess[nodes.clone()].copy_from_slice(&d[nodes.clone()]);
        self.correction[nodes.clone()].copy_from_slice(&f[nodes]);
    }
}

/// Replaces the corrections of the bodies that still move by those to better guesses.
pub(crate) fn accelerate<const D: usize>(model: &Model<D>, work: &mut Workspace<D>) {
    let Workspace { acceleration, motion, correction, progress, touched, .. } = work;
    let moves = |i: usize| !progress[i].settled;
    let mut together = Products::default();
    for (i, b) in model.bodies.iter().enumerate().filter(|&(i, _)| moves(i)) {
        acceleration.record(i, b.nodes(), motion, correction);
        if touched[i] {
            together.add(&acceleration.products[i]);
        }
    }
    let (count, slot) = (acceleration.recorded.min(DEPTH), acceleration.recorded % DEPTH);
    acceleration.recorded += 1;
    if count == 0 {
        return;
    }
    for (i, b) in model.bodies.iter().enumerate().filter(|&(i, _)| moves(i)) {
        let weights = if touched[i] { &together } else { &acceleration.products[i] }.weights(count, slot);
        for (k, weight) in weights.into_iter().enumerate().filter(|&(_, weight)| weight != 0.0) {
            for n in b.nodes() {
                correction[n] -= (acceleration.guesses[k][n] + acceleration.corrections[k][n]) * weight;
            }
        }
    }
}
