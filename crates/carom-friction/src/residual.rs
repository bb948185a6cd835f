use crate::{ContactProblem, Criterion, Vector, cone};

/// How far reactions are from the laws of Signorini and Coulomb.
///
/// Both residuals are ‖r − proj_K(r − ρ(w + μ|w_t| n))‖ / max(ρ‖q‖, ‖r‖, ρ‖w‖), the distance from a fixed point of the
/// bi-potential. Published codes take ρ = 1 in whatever units the problem has; where W is small or large in these units, that
/// sees reactions only or motions only. The natural ρ = n D / tr W weighs the two alike, whatever the units, and there ‖r‖ counts
/// as no more than 10³ ρ‖q‖: or else reactions without bound would solve problems that contradict themselves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measure {
    /// With ρ = 1.
    pub residual: f64,
    /// With ρ = n D / tr W and ‖r‖ ≤ 10³ ρ‖q‖.
    pub natural_residual: f64,
    /// Σ of the bi-potential gaps [J]: the certificate.
    pub certificate: f64,
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
    problem.measure(&Meter::new(problem), r)
}

/// A contact problem in any form in which the motions of given reactions can be found.
pub(crate) trait Measured<const D: usize> {
    /// What its measure needs beforehand.
    fn meter(&self) -> Meter;

    /// Measures `r`, whose motions are computed anew.
    fn measure(&self, meter: &Meter, r: &[Vector<D>]) -> Measure;
}

impl<const D: usize> Measured<D> for ContactProblem<D> {
    fn meter(&self) -> Meter {
        Meter::new(self)
    }

    fn measure(&self, meter: &Meter, r: &[Vector<D>]) -> Measure {
        meter.measure(&self.mu, r, |i| self.motion(i, r))
    }
}

/// ‖r‖ over ρ‖q‖ above which reactions are out of proportion; in piles of many contacts it is 10 to 100.
const LARGEST_REACTIONS: f64 = 1e3;

/// What the measure needs of a problem beforehand.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meter {
    /// The natural ρ [N/m].
    pub stiffness: f64,
    /// ‖q‖² [m²].
    pub squared_q: f64,
}

impl Meter {
    pub fn new<const D: usize>(problem: &ContactProblem<D>) -> Self {
        let squared_q = problem.q.iter().map(Vector::norm_squared).sum();
        Self { stiffness: problem.natural_stiffness(), squared_q }
    }

    /// Measures the reactions `r` whose motions are `motion(0)`, `motion(1)`, …
    pub fn measure<const D: usize>(
        &self,
        mu: &[f64],
        r: &[Vector<D>],
        motion: impl Fn(usize) -> Vector<D>,
    ) -> Measure {
        let rho = self.stiffness;
        let (mut error, mut natural_error, mut squared_r, mut squared_w) = (0.0, 0.0, 0.0, 0.0);
        let mut certificate = 0.0;
        for (i, &mu) in mu.iter().enumerate() {
            let w = motion(i);
            error += (r[i] - cone::fixed_point(&r[i], &w, mu, 1.0)).norm_squared();
            natural_error += (r[i] - cone::fixed_point(&r[i], &w, mu, rho)).norm_squared();
            squared_r += r[i].norm_squared();
            squared_w += w.norm_squared();
            certificate += cone::bipotential_gap(&w, &r[i], mu);
        }
        let called_for = if self.squared_q > 0.0 {
            (LARGEST_REACTIONS * rho).powi(2) * self.squared_q
        } else {
            f64::INFINITY
        };
        let relative = |error: f64, rho: f64, squared_r: f64| {
            // `max` ignores NaN, and beside infinity anything is small: neither may pass for a small residual.
            if !(squared_r + self.squared_q + squared_w).is_finite() {
                return f64::NAN;
            }
            let size = squared_r.max(rho * rho * self.squared_q).max(rho * rho * squared_w);
            if size == 0.0 { 0.0 } else { (error / size).sqrt() }
        };
        // Beside such reactions motions are lost in round-off.
        if squared_r > called_for {
            natural_error += f64::EPSILON.powi(2) * squared_r;
        }
        Measure {
            residual: relative(error, 1.0, squared_r),
            natural_residual: relative(natural_error, rho, squared_r.min(called_for)),
            certificate,
        }
    }
}
