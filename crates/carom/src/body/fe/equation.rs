//! The equation of motion of one body over a step.

use carom_fem::{Body, BodyWithHistory};
use carom_mesh::{Matrix, Vector, nodal};

use super::drive::Drive;
use super::part::ModelBody;
use crate::body::Guess;
use crate::scheme::{StepMap, StressRule};

/// The most that massless nodes resist a change of motion, in terms of the mass that they had. In a step in which waves cross many cells
/// [`StepMap::steadying`] alone would be many times the inertia of a thin body: a sphere parted at 0.35 of its speed, where 0.18 was due, from a plate
/// in steps 26 times as long as waves need for a cell.
const HEAVIEST: f64 = 0.25;

/// The massless nodes of a body with their resistance to a change of motion [N/m] over a step.
pub(crate) fn steadied<const D: usize>(body: &Body<D>, map: &StepMap) -> impl Iterator<Item = (usize, f64)> {
    let heaviest = if map.is_static() { f64::INFINITY } else { HEAVIEST / (map.dt * map.dt) };
    let held = body.massless_stiffness().iter().zip(body.massless_mass());
    let resistance = held.map(move |(k, mass)| (map.steadying * k).min(heaviest * mass));
    body.massless().iter().map(|&n| n as usize).zip(resistance)
}

/// A motion this short, in diameters of the body, stands for a velocity.
pub(crate) const STRAIGHT: f64 = 1e-6;

/// The equation of motion at a guess.
pub(crate) struct Equation<'a, const D: usize> {
    pub body: &'a Body<D>,
    /// The body with the history of its material at the start, grown as it is where forces are evaluated.
    pub with_history: BodyWithHistory<'a, D>,
    pub map: &'a StepMap,
    gravity: &'a Vector<D>,
    /// Loads and prescribed velocities.
    drive: &'a Drive<D>,
    /// Frame of the body in this step.
    frame: &'a Matrix<D>,
    /// How far the body turns in the step at its spin.
    turn: &'a Matrix<D>,
    /// Mean velocity at the start.
    drift: &'a Vector<D>,
    /// How much farther it is expected to move than at that velocity.
    fall: &'a Vector<D>,
    /// v at the start.
    pub velocity: &'a [Vector<D>],
    /// u at the start.
    pub start: &'a [Vector<D>],
    /// ∂E/∂u at the start.
    internal_force: &'a [Vector<D>],
    /// Contact forces that the step before ended with.
    pub contact_force: &'a [Vector<D>],
    /// d = u₊ − u.
    pub motion: &'a [Vector<D>],
    /// u₊.
    pub displacement: &'a [Vector<D>],
    /// Whether the run begins with this step.
    begins: bool,
}

/// How a body stands and turns in a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pose<const D: usize> {
    /// Its mean rotation at the predicted middle of the step.
    pub frame: Matrix<D>,
    /// Its rotation from the start to the end of the step, at the spin of the start.
    pub turn: Matrix<D>,
    /// Its mean velocity at the start [m/s].
    pub drift: Vector<D>,
    /// How much farther it moves in the step than at that velocity [m], if what accelerates it goes on.
    pub fall: Vector<D>,
}

impl<const D: usize> Default for Pose<D> {
    fn default() -> Self {
        let (still, straight) = (Vector::zeros(), Matrix::identity());
        Self { frame: straight, turn: straight, drift: still, fall: still }
    }
}

/// Scratch vectors of one body.
#[derive(Debug)]
pub(crate) struct ResidualScratch<const D: usize> {
    force: Vec<Vector<D>>,
    velocity: Vec<Vector<D>>,
    viscous: Vec<Vector<D>>,
    product: Vec<Vector<D>>,
}

impl<const D: usize> ResidualScratch<D> {
    pub fn new(nodes: usize) -> Self {
        Self {
            force: nodal::zeros(nodes),
            velocity: nodal::zeros(nodes),
            viscous: nodal::zeros(nodes),
            product: nodal::zeros(nodes),
        }
    }

    /// The force C v [N] with which damping and viscosity resist the velocities `v` [m/s] at the displacements `u` [m].
    pub fn resistance(
        &mut self,
        body: &Body<D>,
        frame: &Matrix<D>,
        u: &[Vector<D>],
        v: &[Vector<D>],
    ) -> &[Vector<D>] {
        let Self { force, product, velocity, .. } = self;
        body.damping_force(frame, v, force, product);
        // Viscosity knows motions: one that is so short that it is straight.
        let largest = nodal::largest(v);
        if largest > 0.0 {
            let dt = STRAIGHT * body.mesh().diameter() / largest;
            nodal::each(velocity, [u, v], |u1, [u, v]| *u1 = u + v * dt);
            body.add_viscous_force(u, velocity, dt, force);
        }
        force
    }

    /// What the internal force [N] at `u` [m] has more than `before` [N].
    pub fn change_of_force(
        &mut self,
        body: &BodyWithHistory<'_, D>,
        u: &[Vector<D>],
        before: &[Vector<D>],
    ) -> &[Vector<D>] {
        body.internal_force(u, &mut self.force);
        nodal::each(&mut self.force, [before], |f, [f0]| *f -= f0);
        &self.force
    }

    /// C v̄ [N] as it was last computed; zero without damping and viscosity.
    pub fn viscous(&self) -> &[Vector<D>] {
        &self.viscous
    }
}

impl<'a, const D: usize> Equation<'a, D> {
    /// Of a body with its `pose` and `drive`.
    pub fn new(part: &'a ModelBody<D>, guess: &Guess<'a, D>, pose: &'a Pose<D>, drive: &'a Drive<D>) -> Self {
        let start = &guess.start;
        Self {
            body: &part.body,
            with_history: part.body.after(start.history).grown(part.growth_of_forces(guess.interval)),
            map: &guess.interval.map,
            gravity: &part.gravity,
            drive,
            frame: &pose.frame,
            turn: &pose.turn,
            drift: &pose.drift,
            fall: &pose.fall,
            velocity: start.velocity,
            start: start.displacement,
            internal_force: start.internal_force,
            contact_force: start.contact_force,
            motion: guess.motion,
            displacement: guess.displacement,
            begins: guess.interval.start == 0.0,
        }
    }

    /// Writes the residual F̄ + F̄_acc (3) without reactions [N] to `out`: M(g − (v₊ − v)/Δt) + F̄ − f̄ − C v̄, with v̄ = (1 − ξ)v +
    /// ξv₊ and f̄ by the scheme's [`StressRule`]. In the rows of nodes without mass it is −ξ(f(u₊) + C v̄ + s − F₊), with s the
    /// [`Self::steadying_force`]. What is left in held rows is for the supports.
    pub fn residual(&self, scratch: &mut ResidualScratch<D>, out: &mut [Vector<D>]) {
        self.inertia_and_damping(scratch, out);
        let map = self.map;
        match map.stress {
            StressRule::Weighted => {
                self.with_history.internal_force(self.displacement, &mut scratch.force);
                nodal::each(out, [self.internal_force, &scratch.force], |out, [f0, f1]| {
                    *out -= f0 * (1.0 - map.xi) + f1 * map.xi;
                });
            }
            StressRule::Conserving => {
                self.with_history.conserving_force(self.start, self.displacement, &mut scratch.force);
                nodal::each(out, [&scratch.force], |out, [f]| *out -= f);
            }
        }
        self.balance_massless(&scratch.force, &scratch.viscous, out);
    }

    /// Writes what a load step lacks of balance in its mean to `out` [N]: the loads half way through, which the drive has, less the force whose
    /// work is the change of the strain energy. Inside a body both ends of the step are in balance, and what is left is of third order in
    /// the step; where displacements are held it is what supports and contact do. The body has grown by `growth` half way.
    pub fn path_residual(&self, growth: f64, scratch: &mut ResidualScratch<D>, out: &mut [Vector<D>]) {
        self.with_history.grown(growth).conserving_force(self.start, self.displacement, &mut scratch.force);
        scratch.velocity.fill(*self.gravity);
        self.body.multiply_mass(&scratch.velocity, out);
        out.iter_mut().zip(&self.drive.mean).for_each(|(out, f)| *out += f);
        nodal::each(out, [&scratch.force], |out, [f]| *out -= f);
    }

    /// Writes M(g − (v₊ − v)/Δt) + F̄ − C v̄ to `out`; C v̄ stays in `scratch`.
    pub fn inertia_and_damping(&self, scratch: &mut ResidualScratch<D>, out: &mut [Vector<D>]) {
        let map = self.map;
        if map.is_static() {
            scratch.velocity.fill(*self.gravity);
        } else {
            nodal::each(&mut scratch.velocity, [self.motion, self.velocity], |a, [d, v]| {
                *a = self.gravity - (map.end_velocity(v, d) - v) / map.dt;
            });
            self.each_held(|n, i, rate| {
                scratch.velocity[n][i] = self.gravity[i] - (rate - self.velocity[n][i]) / map.dt;
            });
        }
        self.body.multiply_mass(&scratch.velocity, out);
        out.iter_mut().zip(&self.drive.mean).for_each(|(out, f)| *out += f);
        if self.is_damped() {
            let viscous = self.viscous_force(scratch);
            out.iter_mut().zip(viscous).for_each(|(out, f)| *out -= f);
        }
    }

    /// Writes the rows of the nodes without mass, static at the end of the step under the internal force `end` there, to `out`.
    pub fn balance_massless(&self, end: &[Vector<D>], viscous: &[Vector<D>], out: &mut [Vector<D>]) {
        for (n, resistance) in steadied(self.body, self.map) {
            let force = end[n] + viscous[n] + self.steadying_force(n, resistance) - self.end_load(n);
            let static_row = -force * self.map.xi;
            // Supports see to what they hold as they do inside: over the whole step.
            out[n] = self.body.held().free_part(n, &static_row) + self.body.held().part(n, &out[n]);
        }
    }

    /// Whether damping or viscosity resists the motion; in a load step nothing has a velocity.
    fn is_damped(&self) -> bool {
        self.body.is_damped() && !self.map.is_static()
    }

    /// F̄ [N] at a node.
    #[inline]
    pub fn mean_load(&self, node: usize) -> Vector<D> {
        self.drive.mean.get(node).copied().unwrap_or_else(Vector::zeros)
    }

    /// F₊ [N] at a node.
    #[inline]
    pub fn end_load(&self, node: usize) -> Vector<D> {
        self.drive.end.get(node).copied().unwrap_or_else(Vector::zeros)
    }

    /// The force [N] that sets in on a node in a step whose loads are weighed in its middle: the change of its load or, where nothing has moved or
    /// pressed yet, what its load and the stresses that it starts with leave.
    #[inline]
    pub fn set_in(&self, node: usize, viscous: &Vector<D>) -> Vector<D> {
        let is_new = self.begins || self.velocity[node].amax() == 0.0;
        if is_new && self.contact_force[node].amax() == 0.0 {
            return self.end_load(node) - self.internal_force[node] - viscous;
        }
        (self.end_load(node) - self.mean_load(node)) * 2.0
    }

    /// Calls `f` with node, component and v₊ of everything that is held.
    #[inline]
    fn each_held(&self, mut f: impl FnMut(usize, usize, f64)) {
        for (dof, &rate) in self.body.held().dofs().iter().zip(&self.drive.rates) {
            f(dof.node as usize, dof.component as usize, rate);
        }
    }

    /// The force [N] with which a massless node resists a change of its motion from step to step by this `resistance` [N/m].
    ///
    /// Static balance alone may have no stable solution near the last one: under strong compression, as where a law like
    /// Saint-Venant–Kirchhoff's softens, boundary nodes snap. This is the inertia of a mass s·k·Δt², below the node's own, with s the
    /// [`StepMap::steadying`], taken at the end of the step; a body that moves rigidly feels none, be it in free fall. It vanishes with Δt², and
    /// the blend returns its work and its momentum.
    #[inline]
    pub fn steadying_force(&self, node: usize, resistance: f64) -> Vector<D> {
        let expected = self.drift + self.turn * (self.velocity[node] - self.drift);
        (self.motion[node] - expected * self.map.dt - self.fall) * resistance
    }

    /// What it takes to write the rows of massless nodes at the end of the step instead of over it [J]. It is the work of the forces that these nodes
    /// are left with in the mean of the step. These are (1 − ξ) r₀ + ξ r₊ + F̄ − C v̄ − f̄, with the contact forces `ends` = [r₀, r₊] and the
    /// internal force `end` at its end.
    ///
    /// In static balance at both ends a node is left with nothing but the [`Self::steadying_force`], whose work this is. Where it starts a step
    /// out of balance, as at t = 0 or when a load sets in, it is left with what it gives way to.
    pub fn static_balance_work(
        &self,
        ends: [&[Vector<D>]; 2],
        end: &[Vector<D>],
        viscous: &[Vector<D>],
    ) -> f64 {
        let mean = |[a, b]: [Vector<D>; 2]| a * (1.0 - self.map.xi) + b * self.map.xi;
        let left = |n: usize| {
            let contact = mean(ends.map(|force| force[n]));
            contact + self.mean_load(n) - viscous[n] - mean([self.internal_force[n], end[n]])
        };
        let massless = self.body.massless().iter().map(|&n| n as usize);
        massless.map(|n| left(n).dot(&self.body.held().free_part(n, &self.motion[n]))).sum()
    }

    /// Writes v₊ [m/s] to `out`; what is held moves as prescribed, and a node without mass as in the mean of the step, but for what the whole body
    /// has become faster since.
    pub fn end_velocity(&self, out: &mut [Vector<D>]) {
        nodal::each(out, [self.velocity, self.motion], |v1, [v0, d]| *v1 = self.map.end_velocity(v0, d));
        if !self.body.massless().is_empty() {
            let faster = self.body.mean(out) - self.body.mean(self.motion) / self.map.dt;
            for n in self.body.massless().iter().map(|&n| n as usize) {
                out[n] = self.motion[n] / self.map.dt + faster;
            }
        }
        self.each_held(|n, i, rate| out[n][i] = rate);
    }

    /// Work of gravity and loads and dissipation by damping over the step [J].
    pub fn external_and_viscous_work(&self, scratch: &mut ResidualScratch<D>) -> (f64, f64) {
        let mut external = self.gravity.dot(&self.body.mean(self.motion)) * self.body.total_mass();
        external += self.drive.mean.iter().zip(self.motion).map(|(f, d)| f.dot(d)).sum::<f64>();
        let viscous =
            if self.is_damped() { nodal::dot(self.motion, self.viscous_force(scratch)) } else { 0.0 };
        (external, viscous)
    }

    /// The viscous force C v̄ [N] of damping and viscosity; zero without, and in a load step.
    pub fn viscous_force<'s>(&self, scratch: &'s mut ResidualScratch<D>) -> &'s [Vector<D>] {
        if self.is_damped() {
            let ResidualScratch { velocity, viscous, product, .. } = scratch;
            for ((mean, d), v) in velocity.iter_mut().zip(self.motion).zip(self.velocity) {
                *mean = self.map.mean_velocity(v, d);
            }
            for n in self.body.massless().iter().map(|&n| n as usize) {
                velocity[n] = self.motion[n] / self.map.dt;
            }
            self.each_held(|n, i, _| velocity[n][i] = self.motion[n][i] / self.map.dt);
            self.body.damping_force(self.frame, velocity, viscous, product);
            self.body.add_viscous_force(self.start, self.displacement, self.map.dt, viscous);
        }
        &scratch.viscous
    }

    /// What the supports do at the final motion of a step [J].
    ///
    /// `residual` is that of the body without reactions, scaled as the step's; its held rows are what the supports make up for. R =
    /// −residual is the force of a support less what contact presses on it. The work of the supports is Σ R·d plus, where v₊ is not
    /// what the scheme makes of d, [M(v₊ − v)]·(½(v + v₊) − d/Δt). The change of kinetic energy is then closed whatever the motion.
    pub fn support_work(&self, residual: &[Vector<D>], momentum_change: &[Vector<D>]) -> f64 {
        let mut work = 0.0;
        self.each_held(|n, i, rate| {
            let d = self.motion[n][i];
            let mean = 0.5 * (self.velocity[n][i] + rate);
            work += momentum_change[n][i] * (mean - d / self.map.dt) - residual[n][i] * d;
        });
        work
    }
}
