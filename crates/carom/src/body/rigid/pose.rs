//! Where a rigid body is and how it moves, in space whatever the dimension of the model: a body of the plane turns about z alone.

use carom_mesh::{Matrix, Vector};

/// A vector of the model in space.
#[inline]
pub(in crate::body) fn lift<const D: usize>(v: &Vector<D>) -> Vector<3> {
    Vector::from_fn(|i, _| if i < D { v[i] } else { 0.0 })
}

/// A vector in space, in the model.
#[inline]
pub(in crate::body) fn lower<const D: usize>(v: &Vector<3>) -> Vector<D> {
    Vector::from_fn(|i, _| v[i])
}

/// The matrix of ω ×.
#[inline]
pub(in crate::body) fn cross_matrix(omega: &Vector<3>) -> Matrix<3> {
    Matrix::<3>::new(0.0, -omega[2], omega[1], omega[2], 0.0, -omega[0], -omega[1], omega[0], 0.0)
}

/// Σ a × b of pairs whose Σ a ⊗ b is this.
#[inline]
pub(super) fn moment_of(dyad: &Matrix<3>) -> Vector<3> {
    Vector::<3>::new(dyad[(1, 2)] - dyad[(2, 1)], dyad[(2, 0)] - dyad[(0, 2)], dyad[(0, 1)] - dyad[(1, 0)])
}

/// The rotation (I − ½θ̂)⁻¹ (I + ½θ̂), by 2 arctan(|θ|/2) about θ (Cayley). With R₁ = R(θ) R₀, R₁ − R₀ = θ × ½(R₀ + R₁): a point moves
/// by exactly θ × the mean of its arms.
pub(in crate::body) fn cayley(theta: &Vector<3>) -> Matrix<3> {
    let hat = cross_matrix(theta);
    Matrix::identity() + (hat + hat * hat * 0.5) / (1.0 + 0.25 * theta.norm_squared())
}

/// δψ = T δθ, where the rotation of [`cayley`] changes by δR = δψ × R.
pub(super) fn cayley_tangent(theta: &Vector<3>) -> Matrix<3> {
    (Matrix::identity() + cross_matrix(theta) * 0.5) / (1.0 + 0.25 * theta.norm_squared())
}

/// The θ of a rotation, which is not by half a turn.
pub(super) fn cayley_vector(rotation: &Matrix<3>) -> Vector<3> {
    // R − Rᵀ = 2 sin φ n̂, and θ = 2 tan(φ/2) n.
    moment_of(&rotation.transpose()) * (2.0 / (1.0 + rotation.trace()))
}

/// The inverse of a symmetric matrix on some of the axes, zero on the others.
pub(in crate::body) fn inverse_on(axes: &[bool; 3], m: &Matrix<3>) -> Matrix<3> {
    let on = |i: usize, j: usize| axes[i] && axes[j];
    let whole = Matrix::<3>::from_fn(|i, j| match on(i, j) {
        true => m[(i, j)],
        false if i == j => 1.0,
        false => 0.0,
    });
    let inverse = carom_mesh::tensor::inverse(&whole).0;
    Matrix::from_fn(|i, j| if on(i, j) { inverse[(i, j)] } else { 0.0 })
}

/// The components of a vector on some of the axes.
#[inline]
pub(super) fn on(axes: &[bool; 3], v: &Vector<3>) -> Vector<3> {
    Vector::from_fn(|i, _| if axes[i] { v[i] } else { 0.0 })
}

/// The place of a rigid body: x = c + R (X − C).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pose {
    /// How far the centre of mass has moved, c − C [m].
    pub shift: Vector<3>,
    /// R.
    pub rotation: Matrix<3>,
}

impl Default for Pose {
    fn default() -> Self {
        Self { shift: Vector::zeros(), rotation: Matrix::identity() }
    }
}

/// The motion of a rigid body from one place to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Displaced {
    /// How far the centre moves [m].
    pub shift: Vector<3>,
    /// The vector θ of the rotation: see [`cayley`].
    pub turn: Vector<3>,
}

impl Displaced {
    /// What takes one pose to the other.
    pub fn between(start: &Pose, end: &Pose) -> Self {
        Self {
            shift: end.shift - start.shift,
            turn: cayley_vector(&(end.rotation * start.rotation.transpose())),
        }
    }

    /// Where it leads to.
    pub fn from(&self, start: &Pose) -> Pose {
        Pose { shift: start.shift + self.shift, rotation: cayley(&self.turn) * start.rotation }
    }

    /// ½(R₀ + R₁), which makes mean arms of those of the reference configuration.
    pub fn mean_rotation(&self, start: &Pose) -> Matrix<3> {
        (start.rotation + cayley(&self.turn) * start.rotation) * 0.5
    }
}

/// The velocity of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Twist {
    /// That of the centre [m/s].
    pub velocity: Vector<3>,
    /// Angular velocity [rad/s].
    pub spin: Vector<3>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_moves_by_the_vector_of_the_rotation_times_its_mean_arm() {
        let theta = Vector::<3>::new(0.7, -1.3, 0.4);
        let r = cayley(&theta);
        assert!((r * r.transpose() - Matrix::identity()).norm() < 1e-15);
        let arm = Vector::<3>::new(0.2, 0.5, -0.9);
        assert!((r * arm - arm - theta.cross(&((r * arm + arm) * 0.5))).norm() < 1e-15);
        assert!((cayley_vector(&r) - theta).norm() < 1e-15);
        let exact = carom_mesh::tensor::rotation::<3>(
            &(theta.normalize() * (2.0 * (0.5 * theta.norm()).atan())).into(),
        );
        assert!((r - exact).norm() < 1e-15);
    }

    #[test]
    fn the_tangent_of_the_rotation_is_that_of_differences() {
        let (theta, step) = (Vector::<3>::new(0.7, -1.3, 0.4), 1e-6);
        for axis in 0..3 {
            let mut moved = [theta, theta];
            moved[0][axis] += step;
            moved[1][axis] -= step;
            let change = (cayley(&moved[0]) - cayley(&moved[1])) / (2.0 * step) * cayley(&theta).transpose();
            let expected = cross_matrix(&cayley_tangent(&theta).column(axis).into());
            assert!((change - expected).norm() < 1e-9);
        }
    }
}
