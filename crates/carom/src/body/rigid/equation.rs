//! The equation of motion of a rigid body over a step.
//!
//! The centre moves as the scheme says, Δc = Δt[(1 − θ)v₀ + θv₁], and the angular velocity Ω in the frame of the body gives the vector of its
//! rotation likewise, Θ = Δt[(1 − θ)Ω₀ + θΩ₁] (Simo & Wong 1991 with θ = ½). Linear and angular momentum in space change by the impulse of
//! the forces and of their moments by mean arms, m(v₁ − v₀) = Δt f, R₁JΩ₁ − R₀JΩ₀ = Δt Σ ½(a₀ + a₁) × f. As R₀ᵀ and R₁ᵀ make the same Θ of the
//! vector of the rotation in space, the work of the forces is the change of kinetic energy and (θ − ½)(m|Δv|² + ΔΩ·JΔΩ).

use carom_mesh::{Matrix, Vector, tensor};

use super::pose::{Displaced, Pose, Twist, cayley, cayley_tangent, cross_matrix, inverse_on, on};
use super::shape::{RigidShape, Wrench};
use crate::StepMap;

/// Newton's iterations for the rotation; they converge quadratically.
const ITERATIONS: usize = 30;

/// What is prescribed of a step: how far, and the velocity at its end, axis by axis; the rest is free.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Prescribed {
    /// Shifts of the centre [m].
    pub shift: [Option<f64>; 3],
    /// Components of the vector of the rotation.
    pub turn: [Option<f64>; 3],
    /// Velocities [m/s] of the centre, zero where none is prescribed.
    pub velocity: Vector<3>,
    /// Angular velocities [rad/s] likewise.
    pub spin: Vector<3>,
}

/// A step of a rigid body without contacts.
#[derive(Debug, Clone, Copy)]
pub(in crate::body) struct Equation {
    pub map: StepMap,
    pub mass: f64,
    pub inertia: Matrix<3>,
    /// The axes along and about which it is free.
    pub moves_along: [bool; 3],
    pub turns_about: [bool; 3],
    /// The place and the velocity at the start.
    pub start: Pose,
    pub twist: Twist,
    pub prescribed: Prescribed,
}

/// The end of a step.
#[derive(Debug, Clone, Copy)]
pub(in crate::body) struct End {
    pub twist: Twist,
    /// What supports give [N s], [N m s].
    pub impulse: Vector<3>,
    pub moment: Vector<3>,
}

impl Equation {
    /// Of a body with this shape.
    pub fn new<const D: usize>(shape: &RigidShape<D>, map: StepMap, start: Pose, twist: Twist) -> Self {
        Self {
            map,
            mass: shape.mass,
            inertia: shape.inertia,
            moves_along: shape.moves_along,
            turns_about: shape.turns_about,
            start,
            twist,
            prescribed: Prescribed::default(),
        }
    }

    /// The same with a part of the motion prescribed.
    pub fn with(self, prescribed: Prescribed) -> Self {
        let free = |axes: [bool; 3], given: &[Option<f64>; 3]| {
            std::array::from_fn(|i| axes[i] && given[i].is_none())
        };
        Self {
            moves_along: free(self.moves_along, &prescribed.shift),
            turns_about: free(self.turns_about, &prescribed.turn),
            prescribed,
            ..self
        }
    }

    /// The motion with the prescribed part of it, and nothing else.
    pub fn driven(&self) -> Displaced {
        let of = |given: &[Option<f64>; 3]| Vector::<3>::from_fn(|i, _| given[i].unwrap_or(0.0));
        Displaced { shift: of(&self.prescribed.shift), turn: of(&self.prescribed.turn) }
    }

    /// θ of the scheme.
    fn theta(&self) -> f64 {
        1.0 / (self.map.velocity_of_motion * self.map.dt)
    }

    /// L₀ [N m s].
    fn angular_momentum(&self) -> Vector<3> {
        let Pose { rotation, .. } = &self.start;
        rotation * (self.inertia * rotation.tr_mul(&self.twist.spin))
    }

    /// The angular velocity that the scheme makes of the vector of a rotation, which leads to `rotation`; what is prescribed as it is.
    fn spin_after(&self, turn: &Vector<3>, rotation: &Matrix<3>) -> Vector<3> {
        let kept = rotation * self.start.rotation.tr_mul(&self.twist.spin);
        let spin = turn * self.map.velocity_of_motion + kept * self.map.velocity_of_velocity;
        on(&self.turns_about, &spin) + self.prescribed.spin
    }

    /// The motion under these forces, starting from a guess of it.
    pub fn solve(&self, wrench: &Wrench, guess: &Displaced) -> Displaced {
        let dt = self.map.dt;
        let driven = self.driven();
        let after = self.twist.velocity + wrench.force * (dt / self.mass);
        let theta = self.theta();
        let mean = self.twist.velocity * (1.0 - theta) + after * theta;
        let shift = on(&self.moves_along, &(mean * dt)) + driven.shift;
        if self.turns_about == [false; 3] {
            return Displaced { shift, turn: driven.turn };
        }
        let before = self.angular_momentum()
            + wrench.moment_at(&self.start.rotation) * (0.5 * dt)
            + wrench.moment * (0.5 * dt);
        let mut turn = on(&self.turns_about, &guess.turn) + driven.turn;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let rotation = cayley(&turn) * self.start.rotation;
            let spin = self.spin_after(&turn, &rotation);
            let inertia = rotation * self.inertia * rotation.transpose();
            let momentum = inertia * spin;
            let dyad = rotation * wrench.dyad * 0.5;
            let moment = super::pose::moment_of(&dyad);
            let residual = before + moment * dt - momentum;
            let tangent = cayley_tangent(&turn);
            let kept = rotation * self.start.rotation.tr_mul(&self.twist.spin);
            // δ(R₁Ω₀) = δψ × R₁Ω₀, and δ(R₁JR₁ᵀ) ω = δψ × (I ω) − I (δψ × ω).
            let change = Matrix::<3>::from_diagonal_element(self.map.velocity_of_motion)
                - cross_matrix(&kept) * tangent * self.map.velocity_of_velocity;
            let change = Matrix::<3>::from_fn(|i, j| if self.turns_about[i] { change[(i, j)] } else { 0.0 });
            let of_momentum =
                (inertia * cross_matrix(&spin) - cross_matrix(&momentum)) * tangent + inertia * change;
            // (δψ × p) × f = p (f·δψ) − (p·f) δψ.
            let of_moment = (dyad - Matrix::from_diagonal_element(dyad.trace())) * tangent;
            let correction = self.solve_on_free(&(of_momentum - of_moment * dt), &residual);
            let size = correction.norm();
            if size.is_nan() || size >= last {
                break;
            }
            turn += correction;
            last = size;
        }
        Displaced { shift, turn }
    }

    /// A⁻¹ b on the axes about which it is free.
    fn solve_on_free(&self, a: &Matrix<3>, b: &Vector<3>) -> Vector<3> {
        let free = &self.turns_about;
        let whole = Matrix::<3>::from_fn(|i, j| match free[i] && free[j] {
            true => a[(i, j)],
            false if i == j => 1.0,
            false => 0.0,
        });
        on(free, &(tensor::inverse(&whole).0 * on(free, b)))
    }

    /// The end of a step with this motion under these forces: momenta change by their impulse.
    pub fn end(&self, wrench: &Wrench, pose: Pose) -> End {
        let dt = self.map.dt;
        let push = wrench.force * dt;
        let velocity =
            on(&self.moves_along, &(self.twist.velocity + push / self.mass)) + self.prescribed.velocity;
        let impulse = (velocity - self.twist.velocity) * self.mass - push;
        let before = self.angular_momentum();
        let mean = (self.start.rotation + pose.rotation) * 0.5;
        let after = before + wrench.moment_at(&mean) * dt;
        let inertia = pose.rotation * self.inertia * pose.rotation.transpose();
        let given = inertia * self.prescribed.spin;
        let spin = inverse_on(&self.turns_about, &inertia) * (after - given) + self.prescribed.spin;
        let moment = inertia * spin - after;
        End { twist: Twist { velocity, spin }, impulse, moment }
    }

    /// K̄⁻¹ at a motion: how the shift yields to a force [m/N], and the turn to a moment [1/(N m)], without the gyroscopic part, which is not symmetric.
    pub fn compliance(&self, moved: &Displaced) -> [Matrix<3>; 2] {
        let resisted = self.map.mass_coefficient();
        let mean = moved.mean_rotation(&self.start);
        let inertia = mean * self.inertia * mean.transpose() * resisted;
        let shift =
            Vector::<3>::from_fn(|i, _| if self.moves_along[i] { 1.0 / (self.mass * resisted) } else { 0.0 });
        [Matrix::from_diagonal(&shift), inverse_on(&self.turns_about, &inertia)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scheme;

    fn equation(scheme: Scheme, dt: f64) -> Equation {
        Equation {
            map: scheme.step_map(dt),
            mass: 2.0,
            inertia: Matrix::from_diagonal(&Vector::<3>::new(1.0, 2.0, 2.5)),
            moves_along: [true; 3],
            turns_about: [true; 3],
            start: Pose { shift: Vector::zeros(), rotation: cayley(&Vector::<3>::new(0.3, -0.2, 0.5)) },
            twist: Twist {
                velocity: Vector::<3>::new(1.0, -2.0, 0.5),
                spin: Vector::<3>::new(3.0, -1.0, 2.0),
            },
            prescribed: Prescribed::default(),
        }
    }

    fn forces() -> Wrench {
        let mut wrench = Wrench { moment: Vector::<3>::new(0.5, 0.2, -1.0), ..Wrench::default() };
        wrench.add(&Vector::<3>::new(0.3, 0.1, -0.2), &Vector::<3>::new(4.0, -3.0, 5.0));
        wrench.add(&Vector::<3>::new(-0.1, 0.6, 0.2), &Vector::<3>::new(-2.0, 1.0, 8.0));
        wrench
    }

    /// Work of the forces, kinetic energy and what the scheme takes, each from its own definition.
    #[test]
    fn work_is_kinetic_energy_and_what_the_scheme_takes() {
        for scheme in [
            Scheme::Conserving,
            Scheme::Theta { theta: 0.5, xi: 0.5 },
            Scheme::Theta { theta: 0.8, xi: 0.6 },
            Scheme::Theta { theta: 1.0, xi: 1.0 },
        ] {
            let equation = equation(scheme, 0.1);
            let wrench = forces();
            let moved = equation.solve(&wrench, &equation.driven());
            let pose = moved.from(&equation.start);
            let end = equation.end(&wrench, pose);
            let kinetic = |pose: &Pose, twist: &Twist| {
                let body = pose.rotation.tr_mul(&twist.spin);
                0.5 * (2.0 * twist.velocity.norm_squared() + body.dot(&(equation.inertia * body)))
            };
            let work = wrench.force.dot(&moved.shift)
                + wrench.moment_at(&moved.mean_rotation(&equation.start)).dot(&moved.turn);
            let jump = end.twist.velocity - equation.twist.velocity;
            let turned =
                pose.rotation.tr_mul(&end.twist.spin) - equation.start.rotation.tr_mul(&equation.twist.spin);
            let taken = equation.map.kinetic_dissipation
                * (2.0 * jump.norm_squared() + turned.dot(&(equation.inertia * turned)));
            let gained = kinetic(&pose, &end.twist) - kinetic(&equation.start, &equation.twist);
            assert!((gained + taken - work).abs() < 2e-14 * work.abs(), "{gained} {taken} {work}");
            assert!(end.impulse.norm() + end.moment.norm() < 1e-14, "nothing holds it");
        }
    }

    /// Reference: the exact motion about an axis, and the order of the scheme.
    #[test]
    fn the_motion_of_a_top_converges_with_the_square_of_the_step() {
        let end = |steps: usize| {
            let mut equation = equation(Scheme::Conserving, 0.5 / steps as f64);
            for _ in 0..steps {
                let moved = equation.solve(&Wrench::default(), &equation.driven());
                let pose = moved.from(&equation.start);
                let end = equation.end(&Wrench::default(), pose);
                (equation.start, equation.twist) = (pose, end.twist);
            }
            equation.start.rotation
        };
        let fine = end(6400);
        let [coarse, half] = [50, 100].map(|steps| (end(steps) - fine).norm());
        assert!((3.9..4.1).contains(&(coarse / half)), "{coarse} {half}");
    }
}
