//! Alternating directions: the linear law and the friction cones in turn, coupled by penalties.

use crate::anderson::Anderson;
use crate::residual::Measured;
use crate::schedule::Schedule;
use crate::sparse_factor::NoFactor;
use crate::stopping::Monitor;
use crate::{SolveStatus, Vector, cone};

/// The linear half of a problem: the pairs (a, u) of reactions and motions with u = W a + q, in whatever form W is known.
pub(crate) trait LinearLaw<const D: usize> {
    /// The first scale of the penalties.
    fn first_scale(&self) -> f64;

    /// The stiffness k_i > 0 of each contact on its own [N/m], about D/tr W_ii.
    fn stiffness(&self) -> &[f64];

    /// Prepares for the penalties ρ_i = `scale` k_i.
    fn prepare(&mut self, scale: f64) -> Result<(), NoFactor>;

    /// Overwrites `motion` with the u of the one pair for which a_i + ρ_i u_i = `sum`_i [N].
    fn motion(&mut self, sum: &[Vector<D>], motion: &mut [Vector<D>]);
}

/// How the steps are taken, and when the penalties change.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Over-relaxation, between 1 and 2.
    relaxation: f64,
    /// Steps none of which was the shortest so far, after which over-relaxation is given up, and then the slip follows half as fast.
    patience: usize,
    /// Least share of its change by which the slip follows the motion.
    least_slip_rate: f64,
    /// Factor between the changes of r and ρ z from which on other penalties are worth another factor.
    band: f64,
    /// Iterations before the first change of the penalties.
    period: f64,
    /// Growth of that period from one change to the next: the method converges for fixed penalties.
    growth: f64,
    /// Largest factor by which the penalties change at once.
    leap: f64,
    /// Smallest penalties, relative to the stiffness, that are tried where larger ones have no factor.
    smallest: f64,
}

/// The thresholds of every run.
const CONTROL: Control = Control {
    relaxation: 1.6,
    patience: 200,
    least_slip_rate: 0.01,
    band: 2.0,
    period: 20.0,
    growth: 1.2,
    leap: 20.0,
    smallest: 1e-6,
};

/// Runs ADMM from `r` until it is time to stop [S. Boyd et al., Found. Trends Mach. Learn. 3 (2011) 1–122], or until
/// `max_iterations` are made or there is no factor: then None.
///
/// The slip s = μ|u_t| n is that of the last motions. Then r in K and z in its dual cone are found so that the pair (a, u) has
/// a = r and u + s = z.
///
/// A step is one of Douglas and Rachford's on the point r − ρ z, whose projection on K is r [J. Eckstein, D. P. Bertsekas,
/// Math. Program. 55 (1992) 293–318]; it is over-relaxed and Anderson-accelerated. Now and then the penalties are set so that
/// r and ρ z move alike. The pair (a, u) obeys the linear law in every step, so that its residual tells how far the answer is
/// without another product with W.
pub(crate) fn run<const D: usize, P: Measured<D>, L: LinearLaw<D>>(
    monitor: &mut Monitor<'_, D, P>,
    law: &mut L,
    mu: &[f64],
    r: &mut [Vector<D>],
    max_iterations: usize,
) -> Option<SolveStatus> {
    if let Some(status) = monitor.check(r) {
        return Some(status);
    }
    let mut state = Splitting::new(mu, law.stiffness(), r);
    match state.prepare(law, law.first_scale()) {
        Ok(()) => {}
        Err(NoFactor::Singular) => return None,
        Err(NoFactor::TimeIsUp) => return Some(SolveStatus::TimeLimit),
    }
    let mut wanted = monitor.tolerance();
    let mut schedule = Schedule::new(monitor.tolerance(), monitor.iterations);
    let (mut trial, mut tried) = (CONTROL.period, 0.0);
    let last = monitor.iterations.saturating_add(max_iterations);
    while monitor.iterations < last {
        let change = state.step(law);
        monitor.iterations += 1;
        let is_last = monitor.iterations == last || monitor.exhausted().is_some();
        if schedule.is_due(monitor.iterations, change.point) || is_last {
            let residual = monitor.residual_of(mu, &state.a, &state.u);
            schedule.checked(monitor.iterations, change.point, residual);
            if residual <= wanted || !residual.is_finite() || is_last {
                state.answer(r);
                if let Some(status) = monitor.check(r) {
                    return Some(status);
                }
                // The answer in the cone is a little worse than the pair.
                wanted = 0.7 * residual * monitor.tolerance() / monitor.residual();
            } else {
                monitor.note(residual);
            }
        }
        state.watch(change.point);
        tried += 1.0;
        let imbalance = change.imbalance();
        if tried >= trial
            && imbalance.is_finite()
            && !(1.0 / CONTROL.band..=CONTROL.band).contains(&imbalance)
        {
            let scale = state.scale * imbalance.clamp(1.0 / CONTROL.leap, CONTROL.leap);
            match state.prepare(law, scale) {
                Ok(()) => {}
                Err(NoFactor::Singular) => return None,
                Err(NoFactor::TimeIsUp) => return Some(SolveStatus::TimeLimit),
            }
            (trial, tried) = (CONTROL.growth * trial, 0.0);
        }
    }
    None
}

/// Where the iteration is.
struct Splitting<'a, const D: usize> {
    mu: &'a [f64],
    stiffness: Vec<f64>,
    scale: f64,
    /// ρ_i, `scale` times the stiffness.
    rho: Vec<f64>,
    relaxation: f64,
    /// Share of its change by which the slip follows the motion.
    slip_rate: f64,
    r: Vec<Vector<D>>,
    z: Vec<Vector<D>>,
    slip: Vec<f64>,
    /// r − ρ z, now and before the last step.
    point: Vec<Vector<D>>,
    before: Vec<Vector<D>>,
    /// The pair of the linear law and the sum that fixed it.
    a: Vec<Vector<D>>,
    u: Vec<Vector<D>>,
    sum: Vec<Vector<D>>,
    anderson: Anderson<D>,
    /// The shortest step since the penalties were set, and the number of steps since.
    shortest: f64,
    stale: usize,
}

/// How far a step went, in the norm Σ|x_i|²/k_i [J].
#[derive(Debug, Clone, Copy)]
struct Change {
    /// The unrelaxed step of the point.
    point: f64,
    r: f64,
    /// ρ z.
    rho_z: f64,
}

impl Change {
    /// By which factor the penalties are too small for r and ρ z to move alike.
    fn imbalance(&self) -> f64 {
        (self.r / self.rho_z).sqrt()
    }
}

impl<'a, const D: usize> Splitting<'a, D> {
    fn new(mu: &'a [f64], stiffness: &[f64], r: &[Vector<D>]) -> Self {
        let zeros = || vec![Vector::zeros(); mu.len()];
        Self {
            mu,
            stiffness: stiffness.to_vec(),
            scale: 1.0,
            rho: stiffness.to_vec(),
            relaxation: CONTROL.relaxation,
            slip_rate: 1.0,
            r: r.to_vec(),
            z: zeros(),
            slip: vec![0.0; mu.len()],
            point: r.to_vec(),
            before: zeros(),
            a: zeros(),
            u: zeros(),
            sum: zeros(),
            anderson: Anderson::new(stiffness.iter().map(|k| 1.0 / k.sqrt()).collect()),
            shortest: f64::INFINITY,
            stale: 0,
        }
    }

    /// Sets the penalties to `scale` times the stiffness, or to less where there is no factor.
    fn prepare(&mut self, law: &mut impl LinearLaw<D>, mut scale: f64) -> Result<(), NoFactor> {
        while let Err(error) = law.prepare(scale) {
            scale *= 0.1;
            if error == NoFactor::TimeIsUp || scale < CONTROL.smallest || scale.is_nan() {
                return Err(error);
            }
        }
        self.scale = scale;
        for i in 0..self.mu.len() {
            self.rho[i] = scale * self.stiffness[i];
            self.point[i] = self.r[i] - self.z[i] * self.rho[i];
        }
        self.anderson.restart();
        (self.shortest, self.stale) = (f64::INFINITY, 0);
        Ok(())
    }

    fn step(&mut self, law: &mut impl LinearLaw<D>) -> Change {
        let n = self.mu.len();
        for i in 0..n {
            self.sum[i] = self.r[i] + self.z[i] * self.rho[i];
            self.sum[i][0] -= self.rho[i] * self.mu[i] * self.slip[i];
        }
        law.motion(&self.sum, &mut self.u);
        self.before.copy_from_slice(&self.point);
        let mut change = Change { point: 0.0, r: 0.0, rho_z: 0.0 };
        for i in 0..n {
            let mut u = self.u[i];
            self.a[i] = self.sum[i] - u * self.rho[i];
            self.slip[i] += self.slip_rate * (cone::tangential_norm(&u) - self.slip[i]);
            u[0] += self.mu[i] * self.slip[i];
            let step = self.r[i] - u * self.rho[i] - self.point[i];
            change.point += step.norm_squared() / self.stiffness[i];
            self.point[i] += step * self.relaxation;
        }
        if self.anderson.is_active() {
            self.anderson.accelerate(&self.before, &mut self.point);
        }
        for i in 0..n {
            let r = cone::project(&self.point[i], self.mu[i]);
            let z = (r - self.point[i]) / self.rho[i];
            change.r += (r - self.r[i]).norm_squared() / self.stiffness[i];
            change.rho_z += ((z - self.z[i]) * self.rho[i]).norm_squared() / self.stiffness[i];
            (self.r[i], self.z[i]) = (r, z);
        }
        Change { point: change.point.sqrt(), r: change.r.sqrt(), rho_z: change.rho_z.sqrt() }
    }

    /// Gives up over-relaxation, and then lets the slip follow more slowly, where steps of this length lead nowhere.
    fn watch(&mut self, length: f64) {
        self.stale = if length < self.shortest { 0 } else { self.stale + 1 };
        self.shortest = self.shortest.min(length);
        if self.stale < CONTROL.patience {
            return;
        }
        if self.relaxation > 1.0 {
            self.relaxation = 1.0;
        } else {
            self.slip_rate = CONTROL.least_slip_rate.max(0.5 * self.slip_rate);
        }
        self.anderson.restart();
        self.stale = 0;
    }

    /// Overwrites `r` with the reactions of the pair, brought into the cones.
    fn answer(&self, r: &mut [Vector<D>]) {
        for (r, (a, &mu)) in r.iter_mut().zip(self.a.iter().zip(self.mu)) {
            *r = cone::project(a, mu);
        }
    }
}
