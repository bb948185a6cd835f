//! A reduced body: it moves as a rigid one and vibrates in few shapes, which move and turn with it.
//!
//! Its frame is that of mean axes, in which the vibrations have neither momentum nor angular momentum. What is of the order of its strain times its spin
//! is left out of its inertia, so that its kinetic energy is that of a rigid body and of free vibrations. As for a [rigid](super::rigid) one nothing is
//! stored but displacements and velocities of nodes; its place and the amplitudes are read from some of them. It never rests: displacements and
//! velocities of its other nodes do not tell whether it is still.

mod books;
mod compliance;
mod equation;
mod outline;
pub(crate) mod part;
mod place;
pub(crate) mod vibrations;

use std::sync::Arc;

use carom_mesh::{Matrix, Vector};

use self::compliance::{inner, mobility, own_compliance, weighed};
use self::equation::{Forces, Moved, ReducedEquation};
use self::part::{Reading, ReducedPart};
use self::place::{Place, Rates};
use super::fe::part::ModelBody;
use super::rigid::equation::Equation;
use super::rigid::pose::{Twist, cross_matrix, lift, lower};
use super::rigid::shape::Wrench;
use super::{Ball, Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};
use crate::scheme::{Scheme, StepMap};

/// A reduced body in a step.
pub(crate) struct ReducedBody<const D: usize> {
    body: Arc<ModelBody<D>>,
    equation: ReducedEquation<D>,
    /// The present guess, and what the forces known so far make of it, once that is asked for.
    moved: Moved,
    solved: Moved,
    is_solved: bool,
    /// The motion of nodes that was told last [m], and whether it is that of `solved`, or of the guess where that is what the step began with.
    told: Vec<Vector<D>>,
    is_told: bool,
    forces: Forces<D>,
    /// Where the guess leads to.
    reached: Place,
    /// The motion of the nodes at the guess [m].
    motion: Vec<Vector<D>>,
    /// K̄⁻¹ of the vibrations [m/N] between nodes that may touch, in the frame of the body, and the step that it is of.
    inner: Vec<Matrix<D>>,
    inner_of: Option<StepMap>,
    /// The number of a node among those that may touch, and where these are in the middle of the step when K̄ was made, from the centre [m].
    place_of: Vec<u32>,
    arms: Vec<Vector<3>>,
    /// From where nodes that move are to where the body has them at the start [m].
    healed: Vec<Vector<D>>,
    /// K̄⁻¹ of shifts [m/N] and of turns [1/(N m)], and the rotation that arms have in it.
    compliance: [Matrix<3>; 2],
    arms_in: Matrix<3>,
    generation: u64,
    reading: Reading<D>,
    /// Amplitudes where somebody last looked at all of it, if anybody did, and what they have changed by.
    looked_at: Vec<f64>,
    is_looked_at: bool,
    since_look: Vec<f64>,
    /// How far they let nodes of the outline move at most [m].
    wandered: f64,
    /// What an impulse gave it.
    jolted: Rates,
    scratch: Vec<f64>,
}

fn part<const D: usize>(body: &ModelBody<D>) -> &ReducedPart<D> {
    body.reduced.as_ref().expect("a reduced body has a reduced part")
}

/// The number of every node among some.
fn places(some: &[u32], nodes: usize) -> Vec<u32> {
    let mut places = vec![u32::MAX; nodes];
    (0..).zip(some).for_each(|(k, &node)| places[node as usize] = k);
    places
}

impl<const D: usize> ReducedBody<D> {
    /// The body as it steps.
    ///
    /// # Panics
    /// If it is not reduced.
    pub fn new(body: Arc<ModelBody<D>>) -> Self {
        let own = part(&body);
        let (count, nodes) = (own.reduction.count(), body.body.node_count());
        let (place, rates) = (Place::of(count), Rates::of(count));
        let zeros = vec![Vector::zeros(); nodes];
        let map = Scheme::Conserving.step_map(1.0);
        Self {
            equation: ReducedEquation {
                rigid: Equation::new(&own.shape, map, place.pose, rates.twist),
                place: place.clone(),
                rates,
                compliance: vec![0.0; count],
                mean: vec![0.0; count],
                bent: zeros.clone(),
            },
            moved: Moved::of(count),
            solved: Moved::of(count),
            is_solved: false,
            told: zeros.clone(),
            is_told: false,
            forces: Forces::none(nodes, body.body.surface().nodes().len()),
            reached: place,
            motion: zeros,
            inner: Vec::new(),
            inner_of: None,
            place_of: places(body.body.surface().nodes(), nodes),
            arms: vec![Vector::zeros(); body.body.surface().nodes().len()],
            healed: vec![Vector::zeros(); nodes],
            compliance: [Matrix::zeros(); 2],
            arms_in: Matrix::identity(),
            generation: 0,
            reading: Reading::new(own),
            looked_at: vec![0.0; count],
            is_looked_at: false,
            since_look: vec![0.0; count],
            wandered: 0.0,
            jolted: Rates::of(count),
            scratch: vec![0.0; count],
            body,
        }
    }

    /// Takes a guess of the motion for what of it the body can do.
    ///
    /// It is read from how far nodes move, and not from where they are: round-off of places would be one of velocities, over the time step.
    fn take(&mut self, guess: &Guess<'_, D>) {
        let own = part(&self.body);
        own.moved.iter().for_each(|&n| self.motion[n as usize] = guess.motion[n as usize]);
        if self.is_solved {
            self.moved.copy(&self.solved);
        }
        let Self { equation, moved, reached, healed, motion, told, is_told, reading, .. } = self;
        let asked = |n: usize| motion[n] - healed[n];
        let told = is_told.then_some(&**told);
        let has_changed = equation.read(own, asked, told, moved, reading);
        *is_told &= !has_changed;
        reached.pose = moved.rigid.from(&equation.place.pose);
        let ends = equation.place.amplitudes.iter().zip(&moved.stretch);
        reached.amplitudes.iter_mut().zip(ends).for_each(|(end, (a, d))| *end = a + d);
        self.is_solved = false;
    }

    /// Forgets what the forces known so far made of the guess, as there are others.
    fn is_pressed_anew(&mut self) {
        self.is_told &= !self.is_solved;
        self.is_solved = false;
    }

    /// Makes K̄ at the guess.
    fn make(&mut self) {
        self.compliance = self.equation.rigid.compliance(&self.moved.rigid);
        self.arms_in = self.moved.rigid.mean_rotation(&self.equation.place.pose);
        let ReducedEquation { mean, place, .. } = &mut self.equation;
        let all = mean.iter_mut().zip(&place.amplitudes).zip(&self.moved.stretch);
        all.for_each(|((mean, a), d)| *mean = a + 0.5 * d);
        let own = part(&self.body);
        let surface = self.body.body.surface().nodes();
        for (arm, &node) in self.arms.iter_mut().zip(surface) {
            *arm = self.arms_in * own.bent_arm(node as usize, &self.equation.mean);
        }
        if self.inner_of != Some(self.equation.rigid.map) {
            self.inner.clear();
            for &a in surface {
                let a = weighed(own, a, |k| self.equation.compliance[k]);
                self.inner.extend(surface.iter().map(|&b| inner(own, &a, b)));
            }
            self.inner_of = Some(self.equation.rigid.map);
        }
        self.generation += 1;
    }

    /// The weight of the body.
    fn weight(&self) -> Wrench {
        let mut wrench = Wrench::default();
        wrench.add(&Vector::zeros(), &(lift(&self.body.gravity) * part(&self.body).shape.mass));
        wrench
    }

    /// Finds the motion under the forces known so far.
    fn solve(&mut self) {
        if self.is_solved {
            return;
        }
        self.is_told = false;
        self.solved.copy(&self.moved);
        self.equation.solve(part(&self.body), &self.forces, &mut self.solved, &mut self.scratch);
        self.is_solved = true;
    }

    /// The motion of a node [m] from where it is, to where the body has it.
    fn motion_of(&self, moved: &Moved, mean: &Matrix<3>, node: usize) -> Vector<D> {
        self.equation.motion(part(&self.body), moved, mean, node) + self.healed[node]
    }
}

impl<const D: usize> Body<D> for ReducedBody<D> {
    fn measure(&self, state: &BodyState<'_, D>, internal_force: &mut [Vector<D>]) -> Energies {
        internal_force.fill(Vector::zeros());
        let own = part(&self.body);
        let (place, rates) = own.seen(state.displacement, state.velocity);
        own.energies(&place, &rates)
    }

    fn mean_velocity(&self, velocity: &[Vector<D>]) -> Vector<D> {
        let moved = &part(&self.body).moved;
        moved.iter().map(|&n| velocity[n as usize]).sum::<Vector<D>>() / moved.len() as f64
    }

    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        let own = part(&self.body);
        self.equation.begin(own, interval.map, [start.displacement, start.velocity], &mut self.reading);
        self.moved.rigid = self.equation.rigid.driven();
        self.moved.stretch.fill(0.0);
        // What an attempt at the step that failed has left is not that of this one.
        self.is_solved = false;
        // Free flight is known to round-off before the first iteration.
        self.forces.restart(Wrench::default());
        self.equation.solve(own, &self.forces, &mut self.moved, &mut self.scratch);
        let Self { equation, moved, told, healed, .. } = self;
        let mean = moved.rigid.mean_rotation(&equation.place.pose);
        for node in own.moved.iter().map(|&n| n as usize) {
            let placed = own.displaced(&equation.place.pose, node, &equation.bent[node]);
            healed[node] = placed - start.displacement[node];
            told[node] = equation.motion(own, moved, &mean, node);
            motion[node] = told[node] + healed[node];
        }
        self.is_told = true;
        let speed = own.moved.iter().map(|&n| start.velocity[n as usize].norm_squared()).fold(0.0, f64::max);
        self.make();
        let acceleration = self.body.gravity.norm();
        Ok(Forecast { speed: speed.sqrt(), acceleration, driven: 0.0, is_factorised: true })
    }

    /// That of a step in time is zero: forces that do not depend on contacts make the whole motion in [`Self::begin_solve`].
    fn residual(&mut self, guess: &Guess<'_, D>, _blend: Option<f64>, out: &mut [Vector<D>]) {
        self.take(guess);
        // Others have none ever.
        part(&self.body).moved.iter().for_each(|&n| out[n as usize] = Vector::zeros());
    }

    fn begin_solve(&mut self, residual: &[Vector<D>]) {
        self.forces.restart(self.weight());
        for &node in self.body.body.surface().nodes() {
            self.forces.add(node, &residual[node as usize]);
        }
        self.is_pressed_anew();
    }

    fn set_reach(&mut self, _nodes: &[u32]) {}

    fn partial_solve(&mut self, nodes: &[u32], out: &mut [Vector<D>]) {
        self.solve();
        let mean = self.solved.rigid.mean_rotation(&self.equation.place.pose);
        for node in nodes.iter().map(|&n| n as usize) {
            out[node] = self.motion_of(&self.solved, &mean, node) - self.motion[node];
        }
    }

    fn add_forces(&mut self, nodes: &[u32], forces: &[Vector<D>]) {
        nodes.iter().for_each(|&node| self.forces.add(node, &forces[node as usize]));
        self.is_pressed_anew();
    }

    fn end_solve(&mut self, correction: &mut [Vector<D>]) {
        self.solve();
        let Self { body, equation, solved, told, healed, motion, .. } = self;
        let own = part(body);
        let mean = solved.rigid.mean_rotation(&equation.place.pose);
        for node in own.moved.iter().map(|&n| n as usize) {
            told[node] = equation.motion(own, solved, &mean, node);
            correction[node] = told[node] + healed[node] - motion[node];
        }
        self.is_told = true;
    }

    fn renew(&mut self, guess: &Guess<'_, D>, _again: bool) -> Result<(), StepError> {
        self.take(guess);
        self.make();
        Ok(())
    }

    fn stiffness_at(&mut self, node: u32) -> f64 {
        let stiffness = part(&self.body).reduction.stiffness();
        1.0 / own_compliance(part(&self.body), node, &[Matrix::zeros(); 2], |k| 1.0 / stiffness[k])
    }

    fn forget(&mut self) {}

    fn end_step(
        &mut self,
        guess: &Guess<'_, D>,
        _blend: Option<f64>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        self.take(guess);
        // The next step starts where the nodes are, which know the place less well than the motion.
        part(&self.body).place(guess.displacement, &mut self.reading, &mut self.reached);
        self.close(guess, end)
    }

    fn is_damped(&self) -> bool {
        part(&self.body).damping != 0.0
    }

    /// The mass that a force at the node moves, in the mean of all directions; none inside, where no force is taken.
    fn mass_of(&self, node: u32) -> f64 {
        if self.place_of[node as usize] == u32::MAX {
            return 0.0;
        }
        let mobility = mobility(&part(&self.body).shape, &Matrix::identity());
        1.0 / own_compliance(part(&self.body), node, &mobility, |_| 1.0)
    }

    fn jolt(
        &mut self,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        change: &mut [Vector<D>],
        _support: &mut [Vector<D>],
    ) -> Jolt {
        let Self { body, reading, reached: place, jolted: rates, .. } = self;
        let own = part(body);
        own.place(state.displacement, reading, place);
        let mut wrench = Wrench::default();
        rates.amplitudes.fill(0.0);
        for &node in body.body.surface().nodes() {
            let push = lift(&impulse[node as usize]);
            wrench.add(&own.bent_arm(node as usize, &place.amplitudes), &push);
            let turned = lower::<D>(&place.pose.rotation.tr_mul(&push));
            own.reduction.add_force(node as usize, &turned, &mut rates.amplitudes);
        }
        let [along, about] = mobility(&own.shape, &place.pose.rotation);
        let moment = wrench.moment_at(&place.pose.rotation);
        rates.twist = Twist { velocity: along * wrench.force, spin: about * moment };
        change.fill(Vector::zeros());
        for node in own.moved.iter().map(|&n| n as usize) {
            change[node] = own.velocity(place, rates, node);
        }
        let modes = rates.amplitudes.iter().zip(own.reduction.stiffness());
        Jolt { power: modes.map(|(v, k)| own.damping * k * v * v).sum(), borne: 0.0 }
    }

    fn generation(&self) -> u64 {
        self.generation
    }

    fn responses_at_once(&self) -> usize {
        usize::MAX
    }

    fn respond(&mut self, _nodes: &[u32]) {}

    fn response(&self, a: u32, b: u32, _number: usize) -> Matrix<D> {
        let [a, b] = [a, b].map(|node| self.place_of[node as usize] as usize);
        let [shift, turn] = &self.compliance;
        let inner = self.inner[a * self.arms.len() + b];
        let inner = Matrix::<3>::from_fn(|i, j| if i < D && j < D { inner[(i, j)] } else { 0.0 });
        let rotation = &self.arms_in;
        let block = shift - cross_matrix(&self.arms[a]) * turn * cross_matrix(&self.arms[b])
            + rotation * inner * rotation.transpose();
        Matrix::from_fn(|i, j| block[(i, j)])
    }

    fn rigid_motions(&self) -> Vec<usize> {
        (0..D * (D + 1) / 2).collect()
    }

    fn wandered(&self) -> Option<f64> {
        Some(if self.is_looked_at { self.wandered } else { f64::MAX })
    }

    fn looked_at(&mut self) {
        self.is_looked_at = true;
        self.looked_at.copy_from_slice(&self.reached.amplitudes);
    }

    fn balls(&mut self, displacement: &[Vector<D>], out: &mut Vec<Ball<D>>) {
        let own = part(&self.body);
        // The guess that was taken last is that before the last correction.
        own.place(displacement, &mut self.reading, &mut self.reached);
        let ends = self.reached.amplitudes.iter().zip(&self.looked_at);
        self.since_look.iter_mut().zip(ends).for_each(|(since, (now, then))| *since = now - then);
        let moved =
            own.moved.iter().map(|&n| own.reduction.displacement(n as usize, &self.since_look).norm());
        self.wandered = moved.fold(own.outline.bend(&self.since_look), f64::max);
        let ends = [&self.equation.place, &self.reached];
        own.outline.balls(&own.shape, ends, &mut self.scratch, out);
    }

    fn complete(&mut self, places: [&mut [Vector<D>]; 2], is_near: &dyn Fn(usize) -> bool) {
        let own = part(&self.body);
        let ends = [&self.equation.place, &self.reached];
        let [displacement, motion] = places;
        let exact = |node: usize| own.displacements(ends, node);
        for node in own.tracked.iter().map(|&n| n as usize) {
            let [from, to] = exact(node);
            (displacement[node], motion[node]) = (to, to - from);
        }
        own.outline.place((&own.shape, exact), ends, [displacement, motion], is_near);
    }
}
