//! A body of finite elements.

mod blended;
pub(crate) mod drive;
mod equation;
mod growing;
mod iteration_matrix;
mod light;
pub(crate) mod load;
mod load_step;
pub(crate) mod part;
mod softest;
pub(crate) mod supports;

use std::sync::Arc;

use carom_fem::material::PlasticState;
use carom_fem::sparse::{Inverse, Region};
use carom_fem::{MassSolver, Vibration};
use carom_mesh::{Matrix, Vector, nodal, tensor};

use self::blended::BlendedForces;
use self::drive::Drive;
use self::equation::{Equation, Pose, ResidualScratch, STRAIGHT};
use self::iteration_matrix::IterationMatrix;
use self::part::ModelBody;
use super::{
    Balance, Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt, Outlook, SoftestMotion, Tangent,
};
use crate::Signal;
use crate::archive::{Archive, CheckpointError};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};
use crate::scheme::{StepMap, StressRule};

/// In so many cells around a node of the surface, other nodes feel a force on it. Within a time step a force is felt as far as a wave
/// goes. What this leaves out costs iterations, not accuracy.
const RINGS: usize = 3;

/// The mass by which every node resists what moves it alone [kg]: of tied nodes that of all.
fn inertia_of_tied_nodes<const D: usize>(body: &carom_fem::Body<D>) -> Vec<f64> {
    let mut mass = body.nodal_inertia().to_vec();
    let ties = body.mesh().ties();
    ties.iter().for_each(|t| mass[t.master as usize] += body.nodal_inertia()[t.image as usize]);
    ties.iter().for_each(|t| mass[t.image as usize] = mass[t.master as usize]);
    mass
}

/// A body of finite elements in a step.
pub(crate) struct FeBody<const D: usize> {
    part: Arc<ModelBody<D>>,
    matrix: IterationMatrix<D>,
    pose: Pose<D>,
    drive: Drive<D>,
    scratch: ResidualScratch<D>,
    blended: BlendedForces<D>,
    vibration: Vibration<D>,
    mass_solver: MassSolver<D>,
    /// The mass by which every node resists, those tied to it included [kg].
    nodal_inertia: Vec<f64>,
    /// The configuration half way through the step.
    middle: Vec<Vector<D>>,
    /// How stiff nodes are [N/m]; empty until somebody asks.
    node_stiffness: Vec<f64>,
    /// The nodes near one of the surface.
    region: Region,
    /// The residual at the end of a step [N]; empty where nothing is held.
    residual: Vec<Vector<D>>,
    /// v₊ − v [m/s], and M times it or M v₊.
    jump: Vec<Vector<D>>,
    momentum: Vec<Vector<D>>,
}

impl<const D: usize> FeBody<D> {
    /// The body as it steps, which may be `connected` to others by springs.
    pub fn new(part: Arc<ModelBody<D>>, connected: bool) -> Self {
        let count = part.body.node_count();
        let held = if part.body.held().is_empty() { Vec::new() } else { nodal::zeros(count) };
        Self {
            matrix: IterationMatrix::new(&part.body, connected),
            pose: Pose::default(),
            drive: Drive::new(&part),
            scratch: ResidualScratch::new(count),
            blended: BlendedForces::default(),
            vibration: Vibration::default(),
            mass_solver: MassSolver::default(),
            nodal_inertia: inertia_of_tied_nodes(&part.body),
            node_stiffness: Vec::new(),
            region: Region::default(),
            residual: held,
            middle: nodal::zeros(count),
            jump: nodal::zeros(count),
            momentum: nodal::zeros(count),
            part,
        }
    }

    /// How much farther the body moves in a step than at its velocity [m] under its weight, its loads, its damping and the contact forces of the last
    /// step.
    /// Along what supports hold nothing is foretold.
    fn fall(&mut self, interval: &Interval, start: &BodyState<'_, D>) -> Vector<D> {
        let loads = self.drive.load_at_start(&self.part, interval, start);
        let ModelBody { body, gravity, .. } = &*self.part;
        let driven = body.resultant(start.contact_force.iter().sum::<Vector<D>>() + loads);
        let mut acceleration = gravity + driven / body.total_mass();
        // Damping is that of the velocity in the mean of the step.
        let (damping, faster) = (body.damping().mass, interval.map.velocity_of_motion);
        acceleration = (acceleration - self.pose.drift * damping) / (1.0 + damping / faster);
        body.held().dofs().iter().for_each(|dof| acceleration[dof.component as usize] = 0.0);
        acceleration * (interval.map.dt / faster)
    }

    /// Makes free flight a `motion` [m] that nodes without mass do not resist.
    fn go_on(&self, start: &BodyState<'_, D>, dt: f64, motion: &mut [Vector<D>]) {
        let (body, Pose { turn, drift, fall, .. }) = (&self.part.body, &self.pose);
        motion.iter_mut().for_each(|d| *d += fall);
        for n in body.massless().iter().map(|&n| n as usize) {
            let own = start.velocity[n] - drift;
            motion[n] += body.held().free_part(n, &((turn * own - own) * dt));
        }
    }

    /// Makes K̄ in the middle configuration.
    fn factorise(
        &mut self,
        interval: &Interval,
        history: &[PlasticState],
        approximate: bool,
    ) -> Result<(), StepError> {
        let growth = self.part.growth_of_forces(interval);
        let with_history = self.part.body.after(history).grown(growth);
        self.matrix.factorize(&with_history, &interval.map, &self.middle, &self.pose.frame, approximate)
    }

    /// The work of supports [J], whose forces are added to `support` [N], at the final motion of a step.
    fn close_supports(
        &mut self,
        guess: &Guess<'_, D>,
        blend: Option<f64>,
        contact_force: &[Vector<D>],
        support: &mut [Vector<D>],
    ) -> f64 {
        let Self { part, pose, drive, scratch, blended, residual, jump, momentum, .. } = self;
        let equation = Equation::new(part, guess, pose, drive);
        match blend {
            Some(weight) => blended.residual(&equation, weight, scratch, residual),
            None => equation.residual(scratch, residual),
        }
        part.body.multiply_mass(jump, momentum);
        let work = equation.support_work(residual, momentum);
        for (dof, k) in part.supports.driven(&part.body) {
            let (n, i) = (dof.node as usize, dof.component as usize);
            support[k][i] -= residual[n][i] + contact_force[n][i];
        }
        work
    }
}

impl<const D: usize> Body<D> for FeBody<D> {
    fn initial_history(&self) -> Vec<PlasticState> {
        self.part.body.virgin()
    }

    fn constrain(&self, _displacement: &[Vector<D>], velocity: &mut [Vector<D>], t: f64) {
        let ModelBody { body, supports, .. } = &*self.part;
        for tie in body.mesh().ties() {
            velocity[tie.image as usize] = velocity[tie.master as usize];
        }
        for (dof, there) in supports.at(body, t) {
            velocity[dof.node as usize][dof.component as usize] = there.rate;
        }
    }

    fn measure(&self, state: &BodyState<'_, D>, internal_force: &mut [Vector<D>]) -> Energies {
        let body = &self.part.body;
        let with_history = body.after(state.history);
        with_history.internal_force(state.displacement, internal_force);
        let mut momentum = nodal::zeros(body.node_count());
        body.multiply_mass(state.velocity, &mut momentum);
        Energies {
            strain: with_history.strain_energy(state.displacement),
            kinetic: 0.5 * nodal::dot(state.velocity, &momentum),
            springs: 0.0,
        }
    }

    fn mean_velocity(&self, velocity: &[Vector<D>]) -> Vector<D> {
        self.part.body.mean(velocity)
    }

    fn is_driven_alike(&self, [a, b]: [f64; 2]) -> bool {
        self.part.is_loaded_alike([a, b]) && self.part.supports.stand_still([a, b])
    }

    fn keep_support(&self, before: &[Vector<D>], support: &mut [Vector<D>]) {
        self.part.supports.numbers().for_each(|k| support[k] = before[k]);
    }

    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        let body = &self.part.body;
        let dt = interval.map.dt;
        let driven = self.drive.prescribe(&self.part, interval, start, motion);
        let driven = driven.ok_or(StepError::NotFinite("prescribed motion"))?;
        let [before, after] = self.part.growth_of(interval);
        let driven = driven.max((after - before).abs() * body.mesh().diameter());
        if interval.map.is_static() {
            return Ok(Forecast { driven, ..Forecast::default() });
        }
        nodal::each(&mut self.middle, [start.displacement, motion], |m, [u, d]| *m = u + d * 0.5);
        self.pose = Pose { frame: body.frame(&self.middle), ..Pose::default() };
        let (u, v) = (start.displacement, start.velocity);
        // Only nodes without mass ask how the body would go on.
        if !body.massless().is_empty() {
            let spin = if body.turns() { body.spin(u, v) } else { [0.0; 3] };
            self.pose.turn = tensor::rotation(&spin.map(|w| w * dt));
            self.pose.drift = body.mean(v);
            self.pose.fall = self.fall(interval, start);
            self.go_on(start, dt, motion);
        }
        let speed = v.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        let is_factorised = !self.matrix.fits(&interval.map);
        if is_factorised {
            self.factorise(interval, start.history, interval.approximates)?;
        }
        self.matrix.turn_to(&self.pose.frame);
        Ok(Forecast { speed, acceleration: self.part.gravity.norm(), driven, is_factorised })
    }

    fn balance(&mut self, guess: &Guess<'_, D>, outlook: Outlook) -> Balance {
        self.drive.load(&self.part, guess);
        let equation = Equation::new(&self.part, guess, &self.pose, &self.drive);
        self.blended.measure(&equation, outlook, &mut self.scratch)
    }

    fn residual(&mut self, guess: &Guess<'_, D>, blend: Option<f64>, out: &mut [Vector<D>]) {
        if blend.is_none() {
            self.drive.load(&self.part, guess);
        }
        let equation = Equation::new(&self.part, guess, &self.pose, &self.drive);
        match blend {
            Some(weight) => self.blended.residual(&equation, weight, &mut self.scratch, out),
            None => equation.residual(&mut self.scratch, out),
        }
    }

    fn begin_solve(&mut self, residual: &[Vector<D>]) {
        self.matrix.begin(residual);
    }

    fn set_reach(&mut self, nodes: &[u32]) {
        self.matrix.set_reach(nodes.iter().map(|&node| node as usize));
    }

    fn partial_solve(&mut self, nodes: &[u32], out: &mut [Vector<D>]) {
        self.matrix.look();
        nodes.iter().for_each(|&node| out[node as usize] = self.matrix.seen(node as usize));
    }

    fn add_forces(&mut self, nodes: &[u32], forces: &[Vector<D>]) {
        self.matrix.add(nodes.iter().map(|&node| (node as usize, forces[node as usize])));
    }

    fn end_solve(&mut self, correction: &mut [Vector<D>]) {
        self.matrix.end(correction);
    }

    fn renew(&mut self, guess: &Guess<'_, D>, again: bool) -> Result<(), StepError> {
        let ends = [guess.start.displacement, guess.displacement];
        nodal::each(&mut self.middle, ends, |m, [u0, u1]| *m = (u0 + u1) * 0.5);
        // A fresh factor that is no better may lack digits. A polynomial has replaced one only where these do not matter.
        let lacks_digits = again && self.matrix.is_exact();
        let approximate = guess.interval.approximates && !lacks_digits;
        self.factorise(guess.interval, guess.start.history, approximate)
    }

    fn tangent_worth(&self) -> i32 {
        self.matrix.worth()
    }

    fn expect_contacts(&mut self, nodes: &[u32]) {
        self.matrix.expect_contacts(nodes);
    }

    fn linearise(&mut self, guess: &Guess<'_, D>, tangent: &Tangent<'_, D>) -> Result<(), StepError> {
        let growth = self.part.growth_of_forces(guess.interval);
        let with_history = self.part.body.after(guess.start.history).grown(growth);
        let map = &guess.interval.map;
        if !map.is_static() {
            // Where the force depends on the end of the step: at the end alone, or as much on the start.
            let share = if map.stress == StressRule::Weighted { 0.0 } else { 0.5 };
            let ends = [guess.start.displacement, guess.displacement];
            nodal::each(&mut self.middle, ends, |m, [u0, u1]| *m = u0 * share + u1 * (1.0 - share));
            return self.matrix.linearise_in_time(
                &with_history,
                map,
                &self.middle,
                &self.pose.frame,
                tangent,
            );
        }
        let mut stiffness = with_history.stiffness(guess.displacement);
        let body = &self.part.body;
        for load in &self.part.loads {
            let value = |signal: &Signal| signal.at(guess.interval.end).value;
            load.add_stiffness(body, value, guess.displacement, |a, b, block| {
                // Of a shared body no rank need have the entry, and the tangent goes without.
                if body.ranks().is_none() {
                    stiffness.values[body.graph().entry(a, b)] += block;
                }
            });
        }
        self.matrix.linearise(body, stiffness, guess.displacement, tangent)
    }

    fn hides_softness(&self) -> bool {
        self.matrix.hides_softness()
    }

    fn softest_motion(
        &mut self,
        guess: &Guess<'_, D>,
        springs: &[(u32, Matrix<D>)],
        neutral: &[Vec<Vector<D>>],
    ) -> Option<SoftestMotion<D>> {
        let held_back = softest::held_back(|held_back| {
            self.linearise(
                guess,
                &Tangent { held_back, grip: 1.0, springs, softest_spring: 0.0, is_first: false },
            )
            .is_ok()
        })?;
        let softest = softest::find(&mut self.matrix, &self.part.body, held_back, neutral);
        self.forget();
        Some(softest)
    }

    /// Held nodes that move alone would crush the cells beside them. K̄⁻¹ of what the body resists that with, by a difference of its forces.
    fn follow(&mut self, interval: &Interval, start: &BodyState<'_, D>, motion: &mut [Vector<D>]) {
        let Self { part, matrix, middle, scratch, jump, .. } = self;
        let share = STRAIGHT * part.body.mesh().diameter() / nodal::largest(motion);
        if !share.is_finite() {
            return;
        }
        nodal::each(middle, [start.displacement, &*motion], |m, [u, d]| *m = u + d * share);
        let with_history = part.body.after(start.history).grown(part.growth_of(interval)[0]);
        let resisted = scratch.change_of_force(&with_history, middle, start.internal_force);
        nodal::each(jump, [resisted], |j, [f]| *j = -f / share);
        matrix.begin(jump);
        matrix.end(middle);
        nodal::each(motion, [&*middle], |d, [c]| *d += c);
    }

    fn stiffness_at(&mut self, node: u32) -> f64 {
        if self.node_stiffness.is_empty() {
            let body = &self.part.body;
            let stiffness = body.stiffness(&nodal::zeros(body.node_count()));
            let own = |n: u32| stiffness.values[stiffness.graph().entry(n, n)].trace() / D as f64;
            self.node_stiffness = (0..body.node_count() as u32).map(own).collect();
            body.ranks().iter().for_each(|ranks| ranks.sum(&mut self.node_stiffness));
        }
        self.node_stiffness[node as usize]
    }

    fn round_off(&self) -> f64 {
        self.matrix.round_off()
    }

    fn forget(&mut self) {
        self.matrix.forget();
    }

    fn end_step(
        &mut self,
        guess: &Guess<'_, D>,
        blend: Option<f64>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        let map = &guess.interval.map;
        let start = &guess.start;
        if map.is_static() {
            return self.end_load_step(guess, end);
        }
        self.drive.load(&self.part, guess);
        let Self { part, pose, drive, scratch, blended, jump, .. } = self;
        let equation = Equation::new(part, guess, pose, drive);
        equation.end_velocity(end.velocity);
        let is_held = !part.body.held().is_empty();
        if is_held || map.kinetic_dissipation != 0.0 {
            nodal::each(jump, [&*end.velocity, start.velocity], |jump, [v1, v0]| *jump = v1 - v0);
        }
        let [_, grown] = part.growth_of(guess.interval);
        // What is blended has grown half way.
        let (energy, growth, exchanged);
        if let Some(weight) = blend {
            let (Balance { missing, available, .. }, stored) = blended.close(&equation, scratch);
            end.internal_force.copy_from_slice(&blended.end);
            (energy, growth) = (stored, equation.with_history.growth());
            exchanged = Some(missing - weight * available + end.spring_work);
        } else {
            let with_history = equation.with_history.grown(grown);
            energy = with_history.internal_force_and_energy(guess.displacement, end.internal_force);
            (growth, exchanged) = (grown, None);
        }
        let mut prescribed = self.part.work_of_growth(guess);
        if is_held {
            prescribed += self.close_supports(guess, blend, end.mean_contact_force, end.support);
        }
        let Self { part, pose, drive, scratch, jump, momentum, .. } = self;
        let equation = Equation::new(part, guess, pose, drive);
        let (body, held) = (&part.body, part.body.held());
        body.multiply_mass(end.velocity, momentum);
        let kinetic = 0.5 * nodal::dot(end.velocity, momentum);
        let plastic = equation.with_history.grown(grown).update(guess.displacement, end.history);
        // After plastic flow the stored energy is another: that of the new history.
        let strain = if equation.with_history.is_virgin() && growth == grown {
            energy
        } else {
            body.after(end.history).grown(grown).strain_energy(guess.displacement)
        };
        let (external, viscous) = equation.external_and_viscous_work(scratch);
        let mut scheme = 0.0;
        if map.kinetic_dissipation != 0.0 {
            body.multiply_mass(jump, momentum);
            // What is held moves as prescribed, not as the scheme would have it.
            held.clear(jump);
            scheme += map.kinetic_dissipation * nodal::dot(jump, momentum);
        }
        if guess.interval.is_load_step {
            // A bridge between states of equilibrium takes long steps, in which forces are not linear: all that they do beside energy is the scheme's.
            let works = [start.internal_force, end.internal_force].map(|f| nodal::dot(guess.motion, f));
            let work = (1.0 - map.xi) * works[0] + map.xi * works[1];
            scheme += work + part.work_of_growth(guess) - (strain - start.energies.strain) - plastic;
        } else if map.strain_dissipation != 0.0 {
            scheme += map.strain_dissipation
                * (nodal::dot(guess.motion, end.internal_force)
                    - nodal::dot(guess.motion, start.internal_force));
        }
        // Without mass where it touches, a body feels contact by its blend alone.
        let pressed = || held.free_dot(guess.motion, end.mean_contact_force);
        let contact = exchanged.unwrap_or(0.0)
            + if exchanged.is_none() || body.massless().is_empty() { pressed() } else { 0.0 };
        if exchanged.is_none() {
            let ends = [start.contact_force, end.contact_force];
            scheme += equation.static_balance_work(ends, end.internal_force, scratch.viscous());
        }
        let ledger = BodyLedger {
            kinetic: kinetic - start.energies.kinetic,
            strain: strain - start.energies.strain,
            external,
            prescribed,
            viscous,
            plastic,
            scheme,
            contact,
            connections: 0.0,
        };
        (ledger, Energies { kinetic, strain, springs: 0.0 })
    }

    fn is_damped(&self) -> bool {
        self.part.body.is_damped() && self.part.body.massless().is_empty()
    }

    fn mass_of(&self, node: u32) -> f64 {
        self.nodal_inertia[node as usize]
    }

    fn jolt(
        &mut self,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        change: &mut [Vector<D>],
        support: &mut [Vector<D>],
    ) -> Jolt {
        let Self { part, mass_solver, pose, scratch, momentum, .. } = self;
        let body = &part.body;
        mass_solver.solve(body, impulse, change);
        if !body.held().is_empty() {
            body.multiply_mass(change, momentum);
            for (dof, k) in part.supports.driven(body) {
                let (n, i) = (dof.node as usize, dof.component as usize);
                support[k][i] += momentum[n][i] - impulse[n][i];
            }
            for dof in body.held().dofs() {
                let (n, i) = (dof.node as usize, dof.component as usize);
                impulse[n][i] = momentum[n][i];
            }
        }
        if !body.is_damped() {
            return Jolt::default();
        }
        let power = nodal::dot(change, scratch.resistance(body, &pose.frame, state.displacement, change));
        Jolt { power, ..Jolt::default() }
    }

    fn vibration(&mut self, state: &BodyState<'_, D>) -> f64 {
        self.vibration.measure(&self.part.body, state.displacement, state.velocity)
    }

    fn vibrate(&mut self, share: f64, dt: f64, velocity: &mut [Vector<D>], support: &mut [Vector<D>]) {
        let Self { part, vibration, .. } = self;
        nodal::each(velocity, [&vibration.field], |v, [w]| *v += w * share);
        for (dof, k) in part.supports.driven(&part.body) {
            let i = dof.component as usize;
            support[k][i] += vibration.momentum[dof.node as usize][i] * (share / dt);
        }
    }

    fn generation(&self) -> u64 {
        self.matrix.generation
    }

    fn turn(&self) -> Matrix<D> {
        *self.matrix.turn()
    }

    /// Ring by ring those that share a cell with others found so far, also by ways that lead through the inside.
    fn near(&mut self, node: u32) -> Option<Vec<u32>> {
        let surface = self.part.body.surface().nodes();
        self.region.grow(self.part.body.graph(), std::iter::once(node), RINGS);
        let touching = self.region.nodes().iter().copied();
        let mut found: Vec<u32> =
            touching.filter(|&n| n == node || surface.binary_search(&n).is_ok()).collect();
        found.sort_unstable();
        Some(found)
    }

    fn order(&self, node: u32) -> usize {
        self.matrix.order(node as usize)
    }

    fn responses_at_once(&self) -> usize {
        Inverse::<D>::AT_ONCE
    }

    fn respond(&mut self, nodes: &[u32]) {
        self.matrix.respond(nodes.iter().map(|&node| node as usize));
    }

    fn response(&self, a: u32, b: u32, number: usize) -> Matrix<D> {
        self.matrix.response(a as usize, (number, b as usize))
    }

    fn rigid_motions(&self) -> Vec<usize> {
        self.part.body.rigid_motions().collect()
    }

    fn factor_bytes(&self) -> usize {
        self.matrix.bytes()
    }

    fn exchange(
        &mut self,
        archive: &mut Archive<'_>,
        name: &str,
        map: &dyn Fn(f64) -> StepMap,
    ) -> Result<bool, CheckpointError> {
        self.matrix.exchange(archive, name, &self.part.body, map)
    }
}
