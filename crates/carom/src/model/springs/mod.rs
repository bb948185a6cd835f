//! Springs and dampers between two places.

mod law;

use carom_mesh::{Matrix, Vector};

pub use self::law::ForceLaw;
use crate::body::Interval;
use crate::scheme::StressRule;

/// A spring and a damper, side by side, on the straight line between two places.
///
/// What it depends on is the vector r from its first to its second place, r = r₀ + Σ w u over the nodes of a stencil. Its length is ℓ = |r| and its
/// energy ψ(ℓ − ℓ_free).
#[derive(Debug, Clone, PartialEq)]
pub struct Spring<const D: usize> {
    /// Name.
    pub name: String,
    /// Nodes, those of obstacles too, and what of their displacements r has.
    pub stencil: Vec<(u32, f64)>,
    /// r where nothing has moved [m].
    pub reference: Vector<D>,
    /// The length without tension [m].
    pub free_length: f64,
    /// The tension over the elongation.
    pub law: ForceLaw,
    /// Tension per rate of the length [N s/m].
    pub damping: f64,
}

/// A spring in a step: r at its start and at its end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpringStep<'a, const D: usize> {
    spring: &'a Spring<D>,
    interval: &'a Interval,
    ends: [Vector<D>; 2],
    lengths: [f64; 2],
}

/// r/|r|; zero of a place with itself.
fn direction<const D: usize>(r: &Vector<D>) -> Vector<D> {
    r.try_normalize(0.0).unwrap_or_else(Vector::zeros)
}

impl<const D: usize> Spring<D> {
    /// r [m] at these displacements.
    #[must_use]
    pub fn span(&self, displacement: &[Vector<D>]) -> Vector<D> {
        self.reference + self.change(displacement)
    }

    /// By how much r changes as nodes move like this [m].
    fn change(&self, motion: &[Vector<D>]) -> Vector<D> {
        self.stencil.iter().fold(Vector::zeros(), |sum, &(n, weight)| sum + motion[n as usize] * weight)
    }

    /// ψ [J] at these displacements.
    #[must_use]
    pub fn energy(&self, displacement: &[Vector<D>]) -> f64 {
        self.law.energy(self.span(displacement).norm() - self.free_length)
    }

    /// Its length [m] and tension [N], that of the damper included, at these displacements and velocities.
    #[must_use]
    pub fn length_and_tension(&self, displacement: &[Vector<D>], velocity: &[Vector<D>]) -> [f64; 2] {
        let r = self.span(displacement);
        let rate = direction(&r).dot(&self.change(velocity));
        let length = r.norm();
        [length, self.law.force(length - self.free_length) + self.damping * rate]
    }

    /// How it resists where it is [N/m], without what would give way: along its line, and across it where it is under tension.
    pub(crate) fn support(&self, displacement: &[Vector<D>]) -> Matrix<D> {
        let r = self.span(displacement);
        let (length, elongation) = (r.norm(), r.norm() - self.free_length);
        let across = if length > 0.0 { (self.law.force(elongation) / length).max(0.0) } else { 0.0 };
        tangent(&direction(&r), self.law.slope(elongation).max(0.0), across)
    }

    /// The directions in which it resists where it is.
    pub(crate) fn held_directions(&self, displacement: &[Vector<D>]) -> Vec<Vector<D>> {
        let r = self.span(displacement);
        let elongation = r.norm() - self.free_length;
        let share = |resists: bool| if resists { 1.0 } else { 0.0 };
        let along = share(self.law.slope(elongation) > 0.0);
        let across = share(self.law.force(elongation) > 0.0);
        // The columns of the projector on them see as much as they do.
        tangent(&direction(&r), along, across).column_iter().map(|column| column.into_owned()).collect()
    }

    /// The spring in a step from these displacements, by this `motion` [m].
    pub(crate) fn in_step<'a>(
        &'a self,
        interval: &'a Interval,
        displacement: &[Vector<D>],
        motion: &[Vector<D>],
    ) -> SpringStep<'a, D> {
        let start = self.span(displacement);
        let ends = [start, start + self.change(motion)];
        SpringStep { spring: self, interval, ends, lengths: ends.map(|r| r.norm()) }
    }

    /// Adds the force [N] that `pull` = ∂ψ/∂r makes of every node to `forces`.
    pub(crate) fn add_force(&self, pull: &Vector<D>, forces: &mut [Vector<D>]) {
        self.stencil.iter().for_each(|&(n, weight)| forces[n as usize] -= pull * weight);
    }

    /// Calls `add` with the blocks between its nodes of a stiffness of r [N/m].
    pub(crate) fn each_block(&self, stiffness: &Matrix<D>, mut add: impl FnMut(usize, usize, Matrix<D>)) {
        for &(n, a) in &self.stencil {
            self.stencil.iter().for_each(|&(m, b)| add(n as usize, m as usize, stiffness * (a * b)));
        }
    }
}

/// A stiffness `along` a direction, and `across` it.
fn tangent<const D: usize>(direction: &Vector<D>, along: f64, across: f64) -> Matrix<D> {
    let line = direction * direction.transpose();
    if *direction == Vector::<D>::zeros() {
        // Without a length there is no direction to tell apart.
        return Matrix::identity() * along;
    }
    line * along + (Matrix::identity() - line) * across
}

impl<const D: usize> SpringStep<'_, D> {
    fn elongations(&self) -> [f64; 2] {
        self.lengths.map(|length| length - self.spring.free_length)
    }

    /// By how much it gets longer [m].
    fn lengthening(&self) -> f64 {
        self.lengths[1] - self.lengths[0]
    }

    /// The rate of its length [1/s] per lengthening; none in a load step, where nothing has a velocity.
    fn rate(&self) -> f64 {
        if self.interval.map.is_static() { 0.0 } else { 1.0 / self.interval.map.dt }
    }

    /// The discrete gradient of ℓ: g·(r₊ − r) = ℓ₊ − ℓ.
    fn gradient(&self) -> Vector<D> {
        let sum = self.lengths[0] + self.lengths[1];
        if sum > 0.0 { (self.ends[0] + self.ends[1]) / sum } else { Vector::zeros() }
    }

    /// The mean tension over the step [N], that of the damper included.
    fn mean_tension(&self) -> f64 {
        self.spring.law.mean(self.elongations()) + self.spring.damping * self.lengthening() * self.rate()
    }

    /// ∂ψ/∂r [N] at the start or the end.
    fn pull_at(&self, end: usize) -> Vector<D> {
        direction(&self.ends[end]) * self.spring.law.force(self.elongations()[end])
    }

    /// What the scheme adds to the mean force of the step: as (1 − ξ)f + ξf₊ is more than the mean of both by (ξ − ½)(f₊ − f).
    fn beside_the_mean(&self) -> Vector<D> {
        match self.interval.map.strain_dissipation {
            excess if excess != 0.0 && !self.interval.map.is_static() => {
                (self.pull_at(1) - self.pull_at(0)) * excess
            }
            _ => Vector::zeros(),
        }
    }

    /// The pull [N] of the books: its work over the step is the change of ψ, what the damper takes and what the scheme does.
    pub fn mean_pull(&self) -> Vector<D> {
        self.gradient() * self.mean_tension() + self.beside_the_mean()
    }

    /// The pull [N] that a step is balanced with: of a load step that at its end.
    pub fn pull(&self) -> Vector<D> {
        if self.interval.map.is_static() { self.pull_at(1) } else { self.mean_pull() }
    }

    /// How [`Self::pull`] changes with the end of the step [N/m], made symmetric.
    pub fn stiffness(&self) -> Matrix<D> {
        let Spring { law, damping, .. } = self.spring;
        let [_, elongation] = self.elongations();
        let at_end = || {
            let length = self.lengths[1];
            let across = if length > 0.0 { law.force(elongation) / length } else { 0.0 };
            tangent(&direction(&self.ends[1]), law.slope(elongation), across)
        };
        if self.interval.map.is_static() {
            return at_end();
        }
        let sum = self.lengths[0] + self.lengths[1];
        let along = law.mean_slope(self.elongations()) + damping * self.rate();
        let across = if sum > 0.0 { self.mean_tension() / sum } else { along };
        let mean = tangent(&direction(&self.gradient()), along, across);
        match self.interval.map.stress {
            StressRule::Weighted => mean + at_end() * self.interval.map.strain_dissipation,
            StressRule::Conserving => mean,
        }
    }

    /// What the damper takes [J]: never less than nothing.
    pub fn taken_by_damper(&self) -> f64 {
        self.spring.damping * self.lengthening() * self.lengthening() * self.rate()
    }

    /// What the scheme takes [J].
    pub fn taken_by_scheme(&self) -> f64 {
        self.beside_the_mean().dot(&(self.ends[1] - self.ends[0]))
    }
}
