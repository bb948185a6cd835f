use crate::{Matrix, Vector, cone};

/// The law of a contact as an equation φ(r, w) = 0 [N] that has a derivative almost everywhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Equation {
    /// φ_n = r_n − (r_n − ρ w_n)⁺ and φ_t = r_t − proj(r_t − ρ w_t) on the disc of radius μ (r_n − ρ w_n)⁺
    /// [P. Alart, A. Curnier, Comput. Methods Appl. Mech. Engrg. 92 (1991) 353–375].
    AlartCurnier,
    /// φ = r − proj_K(r − ρ (w + μ|w_t| n)), the fixed point of the bi-potential.
    NaturalMap,
}

/// An equation at a point: φ with its generalised derivatives ∂φ/∂w and ∂φ/∂r.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Linearised<const D: usize> {
    pub value: Vector<D>,
    pub by_motion: Matrix<D>,
    pub by_reaction: Matrix<D>,
}

impl Equation {
    /// φ alone.
    #[inline]
    pub fn value<const D: usize>(self, r: &Vector<D>, w: &Vector<D>, mu: f64, rho: f64) -> Vector<D> {
        match self {
            Equation::AlartCurnier => r - alart_curnier_point(&(r - w * rho), mu),
            Equation::NaturalMap => r - cone::fixed_point(r, w, mu, rho),
        }
    }

    /// φ and its derivatives.
    #[inline]
    pub fn linearise<const D: usize>(self, r: &Vector<D>, w: &Vector<D>, mu: f64, rho: f64) -> Linearised<D> {
        let (point, derivative, coupling) = match self {
            Equation::AlartCurnier => {
                let tau = r - w * rho;
                (alart_curnier_point(&tau, mu), alart_curnier_derivative(&tau, mu), Matrix::identity())
            }
            Equation::NaturalMap => {
                let slip = cone::tangential_norm(w);
                let mut tau = r - w * rho;
                tau[0] -= rho * mu * slip;
                // ∂(w + μ|w_t| n)/∂w
                let mut coupling = Matrix::identity();
                if slip > 0.0 {
                    for t in 1..D {
                        coupling[(0, t)] = mu * w[t] / slip;
                    }
                }
                (cone::project(&tau, mu), cone::projection_derivative(&tau, mu), coupling)
            }
        };
        Linearised {
            value: r - point,
            by_motion: derivative * coupling * rho,
            by_reaction: Matrix::identity() - derivative,
        }
    }
}

/// ((τ_n)⁺, proj of τ_t on the disc of radius μ (τ_n)⁺).
#[inline]
fn alart_curnier_point<const D: usize>(tau: &Vector<D>, mu: f64) -> Vector<D> {
    let mut point = Vector::zeros();
    if tau[0] > 0.0 {
        point[0] = tau[0];
        let (radius, length) = (mu * tau[0], cone::tangential_norm(tau));
        let shrink = if length > radius { radius / length } else { 1.0 };
        for t in 1..D {
            point[t] = tau[t] * shrink;
        }
    }
    point
}

/// ∂(point)/∂τ.
#[inline]
fn alart_curnier_derivative<const D: usize>(tau: &Vector<D>, mu: f64) -> Matrix<D> {
    if tau[0] <= 0.0 {
        return Matrix::zeros();
    }
    let (radius, length) = (mu * tau[0], cone::tangential_norm(tau));
    if length <= radius {
        return Matrix::identity();
    }
    let mut derivative = Matrix::zeros();
    derivative[(0, 0)] = 1.0;
    let shrink = radius / length;
    for t in 1..D {
        let direction = tau[t] / length;
        derivative[(t, 0)] = mu * direction;
        for s in 1..D {
            let along = direction * tau[s] / length;
            derivative[(t, s)] = shrink * (f64::from(u8::from(t == s)) - along);
        }
    }
    derivative
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn derivatives_are_those_of_the_value(
            r in proptest::array::uniform3(-2.0..2.0),
            w in proptest::array::uniform3(-2.0..2.0),
            mu in 0.1..1.5,
        ) {
            let (r, w, rho, step) = (Vector::<3>::from(r), Vector::<3>::from(w), 0.7, 1e-6);
            for equation in [Equation::AlartCurnier, Equation::NaturalMap] {
                let at = equation.linearise(&r, &w, mu, rho);
                prop_assert!((at.value - equation.value(&r, &w, mu, rho)).norm() < 1e-14);
                for k in 0..3 {
                    let mut e = Vector::zeros();
                    e[k] = step;
                    for (derivative, ahead, behind) in [
                        (at.by_reaction, equation.value(&(r + e), &w, mu, rho), equation.value(&(r - e), &w, mu, rho)),
                        (at.by_motion, equation.value(&r, &(w + e), mu, rho), equation.value(&r, &(w - e), mu, rho)),
                    ] {
                        let difference = (ahead - behind) / (2.0 * step);
                        // A kink between the two points is allowed to spoil one case in many: there the value is off by O(step).
                        let error = (difference - derivative.column(k)).norm();
                        let kink = (ahead + behind - at.value * 2.0).norm() > 1e-9;
                        prop_assert!(error < 1e-5 || kink, "{equation:?} {k} {error}");
                    }
                }
            }
        }
    }
}
