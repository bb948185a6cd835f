use carom_mesh::Vector;

/// Which internal force a step is balanced with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StressRule {
    /// (1 − ξ) f(u) + ξ f(u₊).
    Weighted,
    /// The force whose work over the step is the change of the strain energy.
    Conserving,
}

/// The affine relations of one step, with d = u₊ − u the unknown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepMap {
    /// Length of the step [s].
    pub dt: f64,
    /// v₊ = `velocity_of_velocity`·v + `velocity_of_motion`·d; the second [1/s].
    pub velocity_of_velocity: f64,
    /// See `velocity_of_velocity`.
    pub velocity_of_motion: f64,
    /// Forces count (1 − ξ) at the start and ξ at the end of the step.
    pub xi: f64,
    /// The internal force.
    pub stress: StressRule,
    /// (v₊ − v)/Δt·d and the change of kinetic energy differ by this times |v₊ − v|²_M.
    pub kinetic_dissipation: f64,
    /// The work of the weighted internal force and its trapezoidal mean differ by this times d·(f₊ − f).
    pub strain_dissipation: f64,
    /// How much nodes without mass resist a change of their motion, in terms of the stiffness that holds them; more in steps that were halved often.
    pub steadying: f64,
}

/// [`StepMap::steadying`] of a whole step.
pub(super) const STEADYING: f64 = 0.1;

/// Of so many parts of a step each is much shorter. Measured on 93 wild scenes.
const SHORT: f64 = 8.0;

impl StepMap {
    /// v₊ [m/s] of a node with velocity `v` at the start and motion `d` in the step.
    #[inline]
    #[must_use]
    pub fn end_velocity<const D: usize>(&self, v: &Vector<D>, d: &Vector<D>) -> Vector<D> {
        v * self.velocity_of_velocity + d * self.velocity_of_motion
    }

    /// v̄ = (1 − ξ)v + ξv₊ [m/s], the velocity that damping sees.
    #[inline]
    #[must_use]
    pub fn mean_velocity<const D: usize>(&self, v: &Vector<D>, d: &Vector<D>) -> Vector<D> {
        v * (1.0 - self.xi) + self.end_velocity(v, d) * self.xi
    }

    /// The same of a part of a step of `whole` [s] that was too long. Nodes without mass resist by the inertia of a mass `steadying`·k·Δt², far
    /// below their own. Where static balance snaps, shorter steps alone do not help: in much shorter ones that mass falls no more, and they
    /// follow the snap through.
    #[must_use]
    pub(crate) fn part_of(self, whole: f64) -> Self {
        let parts = (whole / self.dt / SHORT).max(1.0);
        Self { steadying: STEADYING * parts * parts, ..self }
    }

    /// Whether there is no inertia: the balance of forces at the end of the step, and no velocities.
    #[must_use]
    pub fn is_static(&self) -> bool {
        self.velocity_of_motion == 0.0
    }

    /// Factor of M in the iteration matrix K̄ [1/s²].
    #[must_use]
    pub fn mass_coefficient(&self) -> f64 {
        self.velocity_of_motion / self.dt
    }

    /// Factor of C in K̄ [1/s].
    #[must_use]
    pub fn damping_coefficient(&self) -> f64 {
        self.xi * self.velocity_of_motion
    }

    /// Factor of K in K̄.
    #[must_use]
    pub fn stiffness_coefficient(&self) -> f64 {
        self.xi
    }
}
