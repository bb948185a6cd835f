use crate::Vector;

/// Anderson's acceleration of a fixed-point iteration r ← G(r): the combination of the last images G(r_j) whose changes
/// G(r_j) − r_j cancel best [H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715–1735].
///
/// The law has kinks, so this is no more than a guess. Where the iteration moves farther from it than it did from the best
/// point so far, it goes back there. After a few such failures acceleration is given up for good.
#[derive(Debug)]
pub(crate) struct Anderson<const D: usize> {
    /// Changes G(r_j) − r_j, weighted, and images G(r_j): a ring over j.
    changes: Vec<Vec<Vector<D>>>,
    images: Vec<Vec<Vector<D>>>,
    /// Inner products of the changes.
    products: [[f64; CONTROL.memory]; CONTROL.memory],
    recorded: usize,
    /// Weights of the contacts, with which the changes of all count alike.
    weights: Vec<f64>,
    best: Vec<Vector<D>>,
    best_change: f64,
    failures: usize,
}

/// What is combined, and when it is given up.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Images combined.
    memory: usize,
    /// Failures after which acceleration is given up.
    failures: usize,
    /// Squared growth of the change, over the smallest one, that counts as a failure.
    growth: f64,
    /// Largest share: where reactions are free to grow changes are parallel, and any combination is as good.
    largest_share: f64,
    /// Added to the products of the normalised changes, lest round-off of nearly parallel ones be amplified.
    regularisation: f64,
}

/// The thresholds of every run.
const CONTROL: Control =
    Control { memory: 6, failures: 3, growth: 2.0, largest_share: 1e4, regularisation: 1e-10 };

impl<const D: usize> Anderson<D> {
    /// For as many contacts as there are `weights`.
    pub fn new(weights: Vec<f64>) -> Self {
        let n = weights.len();
        Self {
            changes: vec![vec![Vector::zeros(); n]; CONTROL.memory],
            images: vec![vec![Vector::zeros(); n]; CONTROL.memory],
            products: [[0.0; CONTROL.memory]; CONTROL.memory],
            recorded: 0,
            weights,
            best: vec![Vector::zeros(); n],
            best_change: f64::INFINITY,
            failures: 0,
        }
    }

    /// Whether it has not been given up.
    pub fn is_active(&self) -> bool {
        self.failures < CONTROL.failures
    }

    /// Forgets the images, because the iteration has become another.
    pub fn restart(&mut self) {
        self.recorded = 0;
        self.best_change = f64::INFINITY;
    }

    /// Replaces `r`, the image of `before`, by a point from which the iteration is hoped to converge faster. It may be outside
    /// of a cone that all images are in.
    pub fn accelerate(&mut self, before: &[Vector<D>], r: &mut [Vector<D>]) {
        let slot = self.recorded % CONTROL.memory;
        let mut change = 0.0;
        for i in 0..r.len() {
            let weighted = (r[i] - before[i]) * self.weights[i];
            change += weighted.norm_squared();
            self.changes[slot][i] = weighted;
        }
        if change > CONTROL.growth * self.best_change {
            r.copy_from_slice(&self.best);
            self.restart();
            self.failures += 1;
            return;
        }
        if change < self.best_change {
            self.best_change = change;
            self.best.copy_from_slice(r);
        }
        self.images[slot].copy_from_slice(r);
        self.recorded += 1;
        let count = self.recorded.min(CONTROL.memory);
        for j in 0..count {
            let pairs = self.changes[j].iter().zip(&self.changes[slot]);
            let product = pairs.map(|(a, b)| a.dot(b)).sum();
            (self.products[slot][j], self.products[j][slot]) = (product, product);
        }
        let Some(shares) = self.shares(count) else { return };
        for (i, r) in r.iter_mut().enumerate() {
            let mut sum = Vector::zeros();
            for (image, share) in self.images.iter().zip(&shares[..count]) {
                sum += image[i] * *share;
            }
            *r = sum;
        }
    }

    /// The shares, of sum 1, of the changes in their shortest combination: those of the solution of `products` x = 1.
    fn shares(&self, count: usize) -> Option<[f64; CONTROL.memory]> {
        let mut scale = [0.0; CONTROL.memory];
        for j in 0..count {
            scale[j] = 1.0 / self.products[j][j].sqrt();
        }
        let (mut factor, mut x) = ([[0.0; CONTROL.memory]; CONTROL.memory], scale);
        // Cholesky's factorisation of the normalised products and both substitutions.
        for i in 0..count {
            for j in 0..=i {
                let mut sum = self.products[i][j] * scale[i] * scale[j];
                sum -= (0..j).map(|k| factor[i][k] * factor[j][k]).sum::<f64>();
                factor[i][j] =
                    if i == j { (sum + CONTROL.regularisation).sqrt() } else { sum / factor[j][j] };
            }
            x[i] = (x[i] - (0..i).map(|k| factor[i][k] * x[k]).sum::<f64>()) / factor[i][i];
        }
        for i in (0..count).rev() {
            x[i] = (x[i] - (i + 1..count).map(|k| factor[k][i] * x[k]).sum::<f64>()) / factor[i][i];
        }
        for i in 0..count {
            x[i] *= scale[i];
        }
        let sum: f64 = x.iter().sum();
        x.iter_mut().for_each(|x| *x /= sum);
        x.iter().all(|x| x.abs() <= CONTROL.largest_share).then_some(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On a linear iteration with few different eigenvalues, as many steps as there are find the fixed point.
    #[test]
    fn linear_iteration_is_solved_in_as_many_steps_as_it_has_eigenvalues() {
        let n = 12;
        let rate = |i: usize| [0.9, 0.5, -0.3, 0.99][i % 4];
        let fixed = |i: usize| 1.0 + i as f64;
        let mut anderson = Anderson::new(vec![1.0; n]);
        let mut r = vec![Vector::<1>::new(0.5); n];
        for _ in 0..6 {
            let before = r.clone();
            for (i, r) in r.iter_mut().enumerate() {
                r[0] = fixed(i) + rate(i) * (r[0] - fixed(i));
            }
            anderson.accelerate(&before, &mut r);
        }
        for (i, r) in r.iter().enumerate() {
            assert!((r[0] - fixed(i)).abs() < 1e-3 * fixed(i), "{i}: {r}");
        }
    }
}
