//! Bodies swept along an axis: first upright from the origin, then put in place.

use super::check::{check, is_length};
use crate::{Matrix, Mesh, MeshError, Vector};

/// The axis of a cylinder or tube: where its bottom is, which way it goes, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// Centre of the bottom [m].
    pub base: [f64; 3],
    /// Direction from the bottom to the top, of any length.
    pub direction: [f64; 3],
    /// Distance between bottom and top [m].
    pub height: f64,
}

impl Axis {
    pub(super) fn check(&self) -> Result<(), MeshError> {
        let length = Vector::from(self.direction).norm();
        check(is_length(length), "axis", &self.direction, "the axis must not be the zero vector")?;
        check(is_length(self.height), "height", &self.height, "the height must be greater than 0 m")
    }

    /// Whether a point of the upright body is at its bottom.
    pub(super) fn at_bottom(&self, x: &Vector<3>) -> bool {
        x[2].abs() <= 1e-9 * self.height
    }

    /// Whether a point of the upright body is at its top.
    pub(super) fn at_top(&self, x: &Vector<3>) -> bool {
        (x[2] - self.height).abs() <= 1e-9 * self.height
    }

    /// The upright body, its bottom centred at the origin and its axis z, where it belongs.
    pub(super) fn place(&self, upright: Mesh<3>) -> Mesh<3> {
        let (base, turn) = (Vector::from(self.base), self.turn());
        upright.moved(|x| base + turn * x)
    }

    /// The rotation that takes z to the axis the shortest way.
    fn turn(&self) -> Matrix<3> {
        let z = Vector::from([0.0, 0.0, 1.0]);
        let axis = Vector::from(self.direction).normalize();
        let half = z + axis;
        if half.norm_squared() < 1e-24 {
            return Matrix::from_diagonal(&Vector::from([1.0, -1.0, -1.0]));
        }
        // Two reflections make a rotation: z is kept by the first and goes to the axis by the second, turned about.
        let mirror = |n: Vector<3>| Matrix::identity() - n * n.transpose() * (2.0 / n.norm_squared());
        mirror(half) * mirror(z)
    }
}
