//! Coulomb's cone K_μ = {r : |r_t| ≤ μ r_n} and the bi-potential of contact with friction.

use crate::{Matrix, Vector};

/// |x_t|, the length of the tangential part.
#[inline]
#[must_use]
pub fn tangential_norm<const D: usize>(x: &Vector<D>) -> f64 {
    match D {
        1 => 0.0,
        2 => x[1].abs(),
        _ => {
            let norm = x.rows_range(1..).norm();
            // `hypot` is slow, and only needed where squares vanish or overflow.
            if SAFE.contains(&norm) { norm } else { x[1].hypot(x[2]) }
        }
    }
}

/// Lengths whose squares have all their digits.
const SAFE: std::ops::Range<f64> = 1e-140..f64::INFINITY;

/// Orthogonal projection of τ on K_μ [de Saxcé & Feng 1998]: stick, separation or slip.
#[inline]
#[must_use]
pub fn project<const D: usize>(tau: &Vector<D>, mu: f64) -> Vector<D> {
    let (normal, tangential) = (tau[0], tangential_norm(tau));
    // The polar cone first: without friction its border and that of the cone meet where there is no tangential part.
    if mu * tangential <= -normal {
        return Vector::zeros();
    }
    if tangential <= mu * normal {
        return *tau;
    }
    // s (n + μ t) with s = (τ_n + μ|τ_t|)/(1 + μ²) and t = τ_t/|τ_t|: on the border of the cone however small it is beside τ.
    let s = (normal + mu * tangential) / (1.0 + mu * mu);
    let mut r = tau * (mu * s / tangential);
    r[0] = s;
    r
}

/// [`project`] of every contact, in place.
pub fn project_all<const D: usize>(r: &mut [Vector<D>], mu: &[f64]) {
    for (r, mu) in r.iter_mut().zip(mu) {
        *r = project(r, *mu);
    }
}

/// A generalised derivative of [`project`].
#[inline]
#[must_use]
pub fn projection_derivative<const D: usize>(tau: &Vector<D>, mu: f64) -> Matrix<D> {
    let (normal, tangential) = (tau[0], tangential_norm(tau));
    if mu * tangential <= -normal {
        return Matrix::zeros();
    }
    if tangential <= mu * normal {
        return Matrix::identity();
    }
    // proj τ = s (n + μ t) with s = (τ_n + μ|τ_t|)/(1 + μ²) and t = τ_t/|τ_t|.
    let scale = 1.0 / (1.0 + mu * mu);
    let s = (normal + mu * tangential) * scale;
    let mut derivative = Matrix::zeros();
    derivative[(0, 0)] = scale;
    for t in 1..D {
        let direction = tau[t] / tangential;
        derivative[(0, t)] = mu * scale * direction;
        derivative[(t, 0)] = mu * scale * direction;
        for u in 1..D {
            let along = direction * tau[u] / tangential;
            let across = f64::from(u8::from(t == u)) - along;
            derivative[(t, u)] = mu * mu * scale * along + mu * s / tangential * across;
        }
    }
    derivative
}

/// One step of the bi-potential fixed point r ← proj(r − ρ (w + μ |w_t| n)), whose fixed points are the solutions.
#[inline]
#[must_use]
pub fn fixed_point<const D: usize>(r: &Vector<D>, w: &Vector<D>, mu: f64, rho: f64) -> Vector<D> {
    let mut tau = r - w * rho;
    tau[0] -= rho * mu * tangential_norm(w);
    project(&tau, mu)
}

/// The bi-potential gap μ r_n |w_t| + w·r [J] for r in K_μ: zero exactly where the law holds.
///
/// A normal motion that penetrates counts with its absolute value, so that it cannot hide a violation elsewhere.
#[inline]
#[must_use]
pub fn bipotential_gap<const D: usize>(w: &Vector<D>, r: &Vector<D>, mu: f64) -> f64 {
    let tangential_power: f64 = (1..D).map(|t| w[t] * r[t]).sum();
    (w[0] * r[0]).abs() + (mu * r[0] * tangential_norm(w) + tangential_power).abs()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The projection p of τ is in the cone, and τ − p makes an obtuse angle with every direction p' − p into it.
        #[test]
        fn projection_is_the_closest_point_of_the_cone(
            tau in proptest::array::uniform3(-2.0..2.0),
            other in proptest::array::uniform3(-2.0..2.0),
            mu in 0.0..1.5,
        ) {
            let tau = Vector::<3>::from(tau);
            let p = project(&tau, mu);
            prop_assert!(tangential_norm(&p) <= mu * p[0] + 1e-14);
            let q = project(&Vector::<3>::from(other), mu);
            prop_assert!((tau - p).dot(&(q - p)) <= 1e-13);
            prop_assert!((project(&p, mu) - p).norm() < 1e-14);
        }

        #[test]
        fn bipotential_gap_is_never_negative(
            w in proptest::array::uniform3(-2.0..2.0),
            tau in proptest::array::uniform3(-2.0..2.0),
            mu in 0.0..1.5,
        ) {
            let r = project(&Vector::<3>::from(tau), mu);
            prop_assert!(bipotential_gap(&Vector::<3>::from(w), &r, mu) >= 0.0);
        }
    }
}
