//! Alternating directions: the linear law and the friction cone in turn, coupled by a penalty.

use crate::anderson::Anderson;
use crate::residual::Measured;
use crate::sparse_factor::NoFactor;
use crate::stopping::Monitor;
use crate::{SolveStatus, Vector, cone};

/// The linear half of a problem: the pairs (a, u) of reactions and motions with u = W a + q, in whatever form W is known.
pub(crate) trait LinearLaw<const D: usize> {
    /// Prepares for the penalty `rho` [N/m].
    fn prepare(&mut self, rho: f64) -> Result<(), NoFactor>;

    /// Overwrites `motion` with the u of the one pair for which a + ρ u = `sum` [N].
    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]);
}

/// Iterations between two looks at the penalty, at least.
const PERIOD: usize = 20;
/// Change of the penalty that is worth another factor.
const BAND: f64 = 2.0;
/// Over-relaxation; between 1 and 2.
const RELAXATION: f64 = 1.6;

/// Runs ADMM from `r` until the monitor stops it [S. Boyd et al., Found. Trends Mach. Learn. 3 (2011) 1–122].
///
/// With s = μ|u_t| n of the last motions, r in K and z in its dual cone are found so that the pair (a, u) has a = r and
/// u + s = z. A step is one of Douglas and Rachford's on the point r − ρ z, whose projection on K is r [J. Eckstein,
/// D. P. Bertsekas, Math. Program. 55 (1992) 293–318]; it is over-relaxed and Anderson-accelerated, and now and then ρ is set
/// so that r and z settle alike. The pair (a, u) obeys the linear law at every step, so that its residual tells how far the
/// answer is without another product with W.
///
/// # Errors
/// If there is no factor for some penalty.
pub(crate) fn run<const D: usize, P: Measured<D>>(
    monitor: &mut Monitor<'_, D, P>,
    law: &mut impl LinearLaw<D>,
    mu: &[f64],
    r: &mut [Vector<D>],
) -> Result<SolveStatus, NoFactor> {
    if let Some(status) = monitor.check(r) {
        return Ok(status);
    }
    let mut state = Splitting::new(mu, r, monitor.stiffness());
    law.prepare(state.rho)?;
    let mut wanted = monitor.tolerance();
    let mut next_look = monitor.iterations + PERIOD;
    loop {
        let change = state.step(law);
        monitor.iterations += 1;
        let residual = monitor.residual_of(mu, &state.a, &state.u);
        if residual <= wanted || !residual.is_finite() || monitor.exhausted().is_some() {
            for (r, (a, &mu)) in r.iter_mut().zip(state.a.iter().zip(mu)) {
                *r = cone::project(a, mu);
            }
            if let Some(status) = monitor.check(r) {
                return Ok(status);
            }
            // The answer in the cone is a little worse than the pair.
            wanted = 0.7 * residual * monitor.tolerance() / monitor.residual();
        }
        if monitor.iterations >= next_look {
            next_look += PERIOD.max(monitor.iterations / 3);
            monitor.note(residual);
            let factor = state.imbalance(&change, monitor.size_q());
            if factor.is_finite() && !(1.0 / BAND..BAND).contains(&factor) {
                state.set_penalty(state.rho * factor.clamp(0.01, 100.0));
                law.prepare(state.rho)?;
            }
        }
    }
}

/// Where the iteration is.
struct Splitting<'a, const D: usize> {
    mu: &'a [f64],
    rho: f64,
    r: Vec<Vector<D>>,
    z: Vec<Vector<D>>,
    /// r − ρ z, now and before the last step.
    point: Vec<Vector<D>>,
    before: Vec<Vector<D>>,
    /// The pair of the linear law, the slip |u_t|, and the sum that fixed it.
    a: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    slip: Vec<f64>,
    sum: Vec<Vector<D>>,
    anderson: Anderson<D>,
}

/// How far r and z went in a step.
struct Change {
    r: f64,
    z: f64,
}

impl<'a, const D: usize> Splitting<'a, D> {
    fn new(mu: &'a [f64], r: &[Vector<D>], rho: f64) -> Self {
        let n = mu.len();
        let zeros = || vec![Vector::zeros(); n];
        Self {
            mu,
            rho,
            r: r.to_vec(),
            z: zeros(),
            point: r.to_vec(),
            before: zeros(),
            a: zeros(),
            u: zeros(),
            slip: vec![0.0; n],
            sum: zeros(),
            anderson: Anderson::new(vec![1.0; n]),
        }
    }

    fn step(&mut self, law: &mut impl LinearLaw<D>) -> Change {
        let (n, rho) = (self.mu.len(), self.rho);
        for i in 0..n {
            self.sum[i] = self.r[i] + self.z[i] * rho;
            self.sum[i][0] -= rho * self.mu[i] * self.slip[i];
        }
        law.motion(&self.sum, &mut self.u);
        self.before.copy_from_slice(&self.point);
        for i in 0..n {
            let mut u = self.u[i];
            self.a[i] = self.sum[i] - u * rho;
            self.slip[i] = cone::tangential_norm(&u);
            u[0] += self.mu[i] * self.slip[i];
            self.point[i] += (self.r[i] - u * rho - self.before[i]) * RELAXATION;
        }
        if self.anderson.is_active() {
            self.anderson.accelerate(&self.before, &mut self.point);
        }
        let mut change = Change { r: 0.0, z: 0.0 };
        for i in 0..n {
            let r = cone::project(&self.point[i], self.mu[i]);
            let z = (r - self.point[i]) / rho;
            change.r += (r - self.r[i]).norm_squared();
            change.z += (z - self.z[i]).norm_squared();
            (self.r[i], self.z[i]) = (r, z);
        }
        Change { r: change.r.sqrt(), z: change.z.sqrt() }
    }

    /// By which factor the penalty is too small for r and z to settle alike, each relative to its size.
    fn imbalance(&self, change: &Change, size_q: f64) -> f64 {
        let size = |x: &[Vector<D>]| x.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let motion = change.r / (self.rho * size(&self.z).max(size_q));
        let reaction = self.rho * change.z / size(&self.r);
        (motion / reaction).sqrt()
    }

    fn set_penalty(&mut self, rho: f64) {
        self.rho = rho;
        for i in 0..self.mu.len() {
            self.point[i] = self.r[i] - self.z[i] * rho;
        }
        self.anderson.restart();
    }
}
