//! Stresses of a step whose work is the change of energy, in any number of dimensions.

use carom_mesh::{Matrix, tensor};

use super::control::CONTROL;

/// The symmetric stress S̄ [Pa] closest to `stress` with S̄:ΔE = `work`: S̄ = S + [W − S:ΔE] ΔE/|ΔE|² (Gonzalez 2000).
///
/// `change` is ΔE, the change of the Green–Lagrange strain, and `work` [J/m³] is asked for only where it matters.
#[inline]
pub(crate) fn with_work<const S: usize>(
    stress: &Matrix<S>,
    change: &Matrix<S>,
    work: impl FnOnce() -> f64,
) -> Matrix<S> {
    let size = change.norm_squared();
    if size > CONTROL.small_strain * CONTROL.small_strain {
        stress + change * ((work() - stress.dot(change)) / size)
    } else {
        *stress
    }
}

/// The stress P̄ [Pa] of a step from F₀ to F₁ with P̄:(F₁ − F₀) = ψ(F₁) − ψ(F₀), for an objective law.
///
/// P̄ = ½(F₀ + F₁) S̄ with a symmetric S̄, so that angular momentum is kept: that [`with_work`] Δψ closest to the stress at the
/// mean of the Green–Lagrange strains.
pub(crate) fn discrete_stress<const S: usize>(
    f0: &Matrix<S>,
    f1: &Matrix<S>,
    energy: impl Fn(&Matrix<S>) -> f64,
    stress: impl Fn(&Matrix<S>) -> Matrix<S>,
) -> Matrix<S> {
    let (c0, c1) = (f0.transpose() * f0, f1.transpose() * f1);
    let mean = deformation(&((c0 + c1) * 0.5));
    let stress = second_piola(&mean, &stress(&mean));
    (f0 + f1) * 0.5 * with_work(&stress, &((c1 - c0) * 0.5), || energy(f1) - energy(f0))
}

/// ½(F₀ + F₁)(S₁ − S₀) [Pa], whose moment vanishes too, for the stresses P₀ and P₁ of both ends.
pub(crate) fn stress_difference<const S: usize>(
    f0: &Matrix<S>,
    p0: &Matrix<S>,
    f1: &Matrix<S>,
    p1: &Matrix<S>,
) -> Matrix<S> {
    (f0 + f1) * 0.5 * (second_piola(f1, p1) - second_piola(f0, p0))
}

/// S = F⁻¹P, symmetric.
pub(crate) fn second_piola<const S: usize>(f: &Matrix<S>, p: &Matrix<S>) -> Matrix<S> {
    let s = tensor::inverse(f).0 * p;
    (s + s.transpose()) * 0.5
}

/// An F with FᵀF = C: which one is all the same to an objective law. The upper triangular one, by Cholesky; a stretch by
/// eigenvectors would lose six digits where stretches are nearly equal, and Newton's iterations would not converge.
pub(crate) fn deformation<const S: usize>(c: &Matrix<S>) -> Matrix<S> {
    let mut f = Matrix::zeros();
    for i in 0..S {
        for j in i..S {
            let rest = c[(i, j)] - (0..i).map(|k| f[(k, i)] * f[(k, j)]).sum::<f64>();
            f[(i, j)] = if i == j { rest.sqrt() } else { rest / f[(i, i)] };
        }
    }
    f
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deformation_of_given_stretch_is_found() {
        let f = Matrix::<3>::new(1.2, 0.3, -0.1, 0.2, 0.9, 0.4, -0.3, 0.1, 1.1);
        let c = f.transpose() * f;
        let found = deformation(&c);
        assert!((found.transpose() * found - c).norm() < 1e-15);
    }
}
