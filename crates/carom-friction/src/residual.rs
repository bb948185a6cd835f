use crate::binary::{exponent, power_of_two};
use crate::units::Units;
use crate::{ContactProblem, Vector, cone};

/// How far reactions are from the laws of Signorini and Coulomb.
///
/// Both residuals are ‖r − proj_K(r − ρ(w + μ|w_t| n))‖ / max(ρ‖q‖, ‖r‖, ρ‖w‖), the distance from a fixed point of the
/// bi-potential. Published codes take ρ = 1 in whatever units the problem has. Where W is small or large in these units, that
/// sees reactions only or motions only. The natural ρ = n D / tr W weighs the two alike, whatever the units. There ‖r‖ counts as
/// no more than 10³ ρ‖q‖; otherwise unbounded reactions would solve problems that contradict themselves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measure {
    /// With ρ = 1.
    pub residual: f64,
    /// With ρ = n D / tr W and ‖r‖ ≤ 10³ ρ‖q‖.
    pub natural_residual: f64,
    /// Σ of the bi-potential gaps [J]: the certificate.
    pub certificate: f64,
}

/// In which units the residual has to be below the tolerance (see [`Measure`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Criterion {
    /// In the units of the problem, as published codes compare themselves, and in its natural ones.
    #[default]
    Both,
    /// In the natural units of the problem alone, so that the answer does not depend on the choice of units.
    Natural,
}

impl Measure {
    /// The residual that a tolerance is compared with.
    #[must_use]
    pub fn decisive(&self, criterion: Criterion) -> f64 {
        match criterion {
            // `max` would ignore what is not a number.
            Criterion::Both if self.residual > self.natural_residual || self.residual.is_nan() => {
                self.residual
            }
            Criterion::Both | Criterion::Natural => self.natural_residual,
        }
    }
}

/// Measures `r`, whose motions are computed anew from the problem.
#[must_use]
pub fn measure<const D: usize>(problem: &ContactProblem<D>, r: &[Vector<D>]) -> Measure {
    let units = Units::of(problem);
    if units.are_own() {
        return problem.measure(&problem.meter(1.0), r);
    }
    let (problem, mut r) = (units.enter(problem), r.to_vec());
    units.enter_reactions(&mut r);
    let measure = problem.measure(&problem.meter(units.stiffness(1.0)), &r);
    Measure { certificate: units.leave_energy(measure.certificate), ..measure }
}

/// A contact problem in any form in which the motions of given reactions can be found.
pub(crate) trait Measured<const D: usize> {
    /// What its measure needs beforehand, where the stiffness `unit` [N/m] counts as 1.
    fn meter(&self, unit: f64) -> Meter;

    /// Measures `r`, whose motions are computed anew.
    fn measure(&self, meter: &Meter, r: &[Vector<D>]) -> Measure;
}

impl<const D: usize> Measured<D> for ContactProblem<D> {
    fn meter(&self, unit: f64) -> Meter {
        let squared_q = self.q.iter().map(Vector::norm_squared).sum::<f64>();
        Meter { stiffness: self.natural_stiffness(), unit, size_q: squared_q.sqrt() }
    }

    fn measure(&self, meter: &Meter, r: &[Vector<D>]) -> Measure {
        if !self.w.is_shared() {
            return meter.measure(&self.mu, r, |i| self.motion(i, r));
        }
        let mut motions = vec![Vector::zeros(); r.len()];
        self.w.each_row_times(r, &mut motions, |i, moved| self.q[i] + moved);
        meter.measure(&self.mu, r, |i| motions[i])
    }
}

/// ‖r‖ over ρ‖q‖ above which reactions are out of proportion; in piles of many contacts it is 10 to 100.
pub(crate) const LARGEST_REACTIONS: f64 = 1e3;
/// Sums of squares between these have lost nothing.
const SAFE: std::ops::Range<f64> = 1e-150..1e300;

/// What the measure needs of a problem beforehand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meter {
    /// The natural ρ [N/m].
    pub stiffness: f64,
    /// The ρ of published codes [N/m].
    pub unit: f64,
    /// ‖q‖ [m].
    pub size_q: f64,
}

impl Meter {
    /// Measures the reactions `r` whose motions are `motion(0)`, `motion(1)`, …
    pub fn measure<const D: usize>(
        &self,
        mu: &[f64],
        r: &[Vector<D>],
        motion: impl Fn(usize) -> Vector<D>,
    ) -> Measure {
        let mut norms = self.norms(mu, r, &motion, 1.0);
        if !SAFE.contains(&norms.largest_square) {
            // A square has overflowed or vanished: once more, relative to the largest number of all.
            let size = |(r, i): (&Vector<D>, usize)| r.amax().max(self.stiffness * motion(i).amax());
            let largest = r.iter().zip(0..).map(size).fold(0.0, f64::max);
            if largest > 0.0 && largest.is_finite() {
                let scale = power_of_two((-exponent(largest)).clamp(-1000, 1000));
                norms = self.norms(mu, r, &motion, scale);
            }
        }
        let Norms { mut natural_error, r: size_r, w, .. } = norms;
        // `max` ignores NaN, and beside infinity anything is small: neither may pass for a small residual.
        let is_finite = (size_r + self.size_q + w).is_finite();
        let relative = |error: f64, rho: f64, size_r: f64| match error {
            _ if !is_finite => f64::NAN,
            0.0 => 0.0,
            _ => error / size_r.max(rho * self.size_q).max(rho * w),
        };
        let called_for = LARGEST_REACTIONS * self.stiffness * self.size_q;
        let mut counted = size_r;
        if self.size_q > 0.0 && size_r > called_for {
            // Beside such reactions motions are lost in round-off.
            natural_error = natural_error.hypot(f64::EPSILON * size_r);
            counted = called_for;
        }
        Measure {
            residual: relative(norms.error, self.unit, size_r),
            natural_residual: relative(natural_error, self.stiffness, counted),
            certificate: norms.certificate,
        }
    }

    /// The norms, from squares of the numbers times `scale`, a power of two.
    fn norms<const D: usize>(
        &self,
        mu: &[f64],
        r: &[Vector<D>],
        motion: impl Fn(usize) -> Vector<D>,
        scale: f64,
    ) -> Norms {
        let rho = self.stiffness;
        let (mut error, mut natural_error, mut squared_r, mut squared_w) = (0.0, 0.0, 0.0, 0.0);
        let mut certificate = 0.0;
        for (i, (&mu, r)) in mu.iter().zip(r).enumerate() {
            let (r, w) = (r * scale, motion(i) * scale);
            error += (r - cone::fixed_point(&r, &w, mu, self.unit)).norm_squared();
            natural_error += (r - cone::fixed_point(&r, &w, mu, rho)).norm_squared();
            squared_r += r.norm_squared();
            squared_w += w.norm_squared();
            certificate += cone::bipotential_gap(&w, &r, mu);
        }
        Norms {
            error: error.sqrt() / scale,
            natural_error: natural_error.sqrt() / scale,
            r: squared_r.sqrt() / scale,
            w: squared_w.sqrt() / scale,
            certificate: certificate / scale / scale,
            largest_square: squared_r + rho * rho * squared_w,
        }
    }
}

/// Sizes of what the measure is made of.
#[derive(Debug, Clone, Copy)]
struct Norms {
    /// ‖r − proj_K(r − ρ(w + μ|w_t| n))‖ [N] with the ρ of published codes and with the natural one.
    error: f64,
    natural_error: f64,
    /// ‖r‖ [N] and ‖w‖ [m].
    r: f64,
    w: f64,
    certificate: f64,
    /// ‖r‖² + ρ²‖w‖², scaled.
    largest_square: f64,
}
