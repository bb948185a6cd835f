//! A rigid body: its nodes are points that move as its centre of mass and its rotation say.
//!
//! Its place and its velocity are read from those of the nodes, so that a state is complete without it.

mod books;
pub(in crate::body) mod equation;
pub(crate) mod guide;
mod load_step;
pub(crate) mod part;
pub(in crate::body) mod pose;
pub(crate) mod shape;

use std::sync::Arc;

use carom_mesh::{Matrix, Vector, nodal};

use self::equation::{Equation, Prescribed};
use self::guide::Resultant;
use self::part::RigidPart;
use self::pose::{Displaced, Pose, Twist, lift, on};
use self::shape::Wrench;
use super::fe::drive::Drive;
use super::fe::part::ModelBody;
use super::{Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt, Tangent};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};
use crate::signal::Signal;

/// A rigid body in a step.
pub(crate) struct RigidBody<const D: usize> {
    body: Arc<ModelBody<D>>,
    /// Loads on its nodes.
    drive: Drive<D>,
    /// What is prescribed in the step.
    prescribed: Prescribed,
    /// The step in time; none in a load step.
    equation: Option<Equation>,
    /// Where it starts, and the present guess.
    start: Pose,
    moved: Displaced,
    /// The motion of the nodes at the guess, and their displacements at the start [m].
    motion: Vec<Vector<D>>,
    from: Vec<Vector<D>>,
    /// The forces that do not depend on contacts, and those with contacts.
    external: Wrench,
    wrench: Wrench,
    /// K̄⁻¹ of shifts [m/N] and of turns [1/(N m)], and the rotation that arms have in it.
    compliance: [Matrix<3>; 2],
    arms_in: Matrix<3>,
    generation: u64,
}

impl<const D: usize> RigidBody<D> {
    /// The body as it steps.
    ///
    /// # Panics
    /// If it is not rigid.
    pub fn new(body: Arc<ModelBody<D>>) -> Self {
        assert!(body.rigid.is_some(), "a rigid body has a rigid part");
        let zeros = vec![Vector::zeros(); body.body.node_count()];
        Self {
            drive: Drive::new(&body),
            body,
            prescribed: Prescribed::default(),
            equation: None,
            start: Pose::default(),
            moved: Displaced { shift: Vector::zeros(), turn: Vector::zeros() },
            motion: zeros.clone(),
            from: zeros,
            external: Wrench::default(),
            wrench: Wrench::default(),
            compliance: [Matrix::zeros(); 2],
            arms_in: Matrix::identity(),
            generation: 0,
        }
    }

    fn part(&self) -> &RigidPart<D> {
        part(&self.body)
    }

    /// Takes a guess of the motion for what of it is rigid.
    fn take(&mut self, guess: &Guess<'_, D>) {
        let shape = &part(&self.body).shape;
        self.motion.copy_from_slice(guess.motion);
        self.moved = shape.displaced(&self.start, guess.motion);
    }

    /// The loads as the scheme weighs them at the present guess, where the step is this `share` of the way from its start to its end.
    fn external(&mut self, guess: &Guess<'_, D>, share: f64) -> Wrench {
        self.drive.load_at(&self.body, guess, share);
        let RigidPart { shape, resultants, .. } = part(&self.body);
        let mut wrench =
            if self.drive.mean.is_empty() { Wrench::default() } else { shape.gather(&self.drive.mean) };
        wrench.add(&Vector::zeros(), &(lift(&self.body.gravity) * shape.mass));
        let times = [guess.interval.start, guess.interval.end];
        let weighted = |s: &Signal| (1.0 - share) * s.at(times[0]).value + share * s.at(times[1]).value;
        for resultant in resultants {
            let [force, moment] = resultant.values(weighted);
            wrench.add(&resultant.arm, &force);
            wrench.moment += moment;
        }
        wrench
    }

    /// The work of forces over a motion [J].
    fn work(&self, wrench: &Wrench, moved: &Displaced) -> f64 {
        let mean = moved.mean_rotation(&self.start);
        wrench.force.dot(&moved.shift) + wrench.moment_at(&mean).dot(&moved.turn)
    }

    /// The motion under the forces known so far.
    fn solved(&self) -> Displaced {
        match &self.equation {
            Some(equation) => equation.solve(&self.wrench, &self.moved),
            None => self.balanced(),
        }
    }

    /// Contact forces without what presses on prescribed displacements of the nodes.
    fn free_part(&self, forces: &[Vector<D>]) -> Wrench {
        let part = self.part();
        let held = part.held();
        let mut wrench = part.shape.gather(forces);
        let free = |i: usize| i >= D || !held[i];
        wrench.force = Vector::from_fn(|i, _| if free(i) { wrench.force[i] } else { 0.0 });
        wrench.dyad = Matrix::from_fn(|i, j| if free(j) { wrench.dyad[(i, j)] } else { 0.0 });
        wrench
    }
}

fn part<const D: usize>(body: &ModelBody<D>) -> &RigidPart<D> {
    body.rigid.as_ref().expect("a rigid body has a rigid part")
}

impl<const D: usize> Body<D> for RigidBody<D> {
    fn constrain(&self, displacement: &[Vector<D>], velocity: &mut [Vector<D>], t: f64) {
        let RigidPart { shape, guide, .. } = self.part();
        let Some(guide) = guide else { return };
        let pose = shape.pose(displacement);
        let Twist { velocity: mut along, spin: mut about } = shape.twist(&pose, velocity);
        for (own, rates) in [&mut along, &mut about].into_iter().zip(guide.rates(t)) {
            (0..3).for_each(|i| own[i] = rates[i].unwrap_or(own[i]));
        }
        shape.velocities(&pose, &Twist { velocity: along, spin: about }, velocity);
    }

    fn measure(&self, state: &BodyState<'_, D>, internal_force: &mut [Vector<D>]) -> Energies {
        let shape = &self.part().shape;
        internal_force.fill(Vector::zeros());
        let pose = shape.pose(state.displacement);
        let kinetic = shape.kinetic(&pose, &shape.twist(&pose, state.velocity));
        Energies { kinetic, ..Energies::default() }
    }

    fn mean_velocity(&self, velocity: &[Vector<D>]) -> Vector<D> {
        self.part().shape.at_centre(velocity)
    }

    fn is_driven_alike(&self, [a, b]: [f64; 2]) -> bool {
        let RigidPart { guide, resultants, .. } = self.part();
        let is_alike = |r: &Resultant| r.values(|s| s.at(a).value) == r.values(|s| s.at(b).value);
        let stands_still = guide.as_ref().is_none_or(|guide| guide.stands_still([a, b]));
        stands_still && resultants.iter().all(is_alike) && self.body.is_loaded_alike([a, b])
    }

    fn keep_support(&self, before: &[Vector<D>], support: &mut [Vector<D>]) {
        if let Some(guide) = &self.part().guide {
            support[guide.number] = before[guide.number];
        }
    }

    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        let RigidPart { shape, guide, .. } = part(&self.body);
        self.from.copy_from_slice(start.displacement);
        self.start = shape.pose(start.displacement);
        let anchor = guide.as_ref().map(|guide| (guide, shape.pose(start.anchor)));
        let prescribed = match &anchor {
            Some((guide, anchor)) => guide.prescribe(interval, &self.start, anchor),
            None => Some(Prescribed::default()),
        };
        self.prescribed = prescribed.ok_or(StepError::NotFinite("prescribed motion"))?;
        let twist = shape.twist(&self.start, start.velocity);
        let equation = Equation::new(shape, interval.map, self.start, twist).with(self.prescribed);
        let driven = equation.driven();
        let size = self.body.body.mesh().diameter();
        let reach = driven.shift.norm() + driven.turn.norm() * size;
        if interval.map.is_static() {
            self.equation = None;
            self.moved = driven;
            shape.motions(&self.start, &self.moved, start.displacement, motion);
            return Ok(Forecast { driven: reach, ..Forecast::default() });
        }
        // Free flight is known to round-off before the first iteration.
        self.moved = equation.solve(&Wrench::default(), &driven);
        shape.motions(&self.start, &self.moved, start.displacement, motion);
        self.compliance = equation.compliance(&self.moved);
        self.arms_in = self.moved.mean_rotation(&self.start);
        self.generation += 1;
        self.equation = Some(equation);
        let speed = start.velocity.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        Ok(Forecast { speed, acceleration: self.body.gravity.norm(), driven: reach, is_factorised: true })
    }

    /// That of a step in time is zero: forces that do not depend on contacts are kept for [`Self::begin_solve`], where they make the whole motion.
    fn residual(&mut self, guess: &Guess<'_, D>, _blend: Option<f64>, out: &mut [Vector<D>]) {
        self.take(guess);
        self.external = self.external(guess, guess.interval.map.xi);
        out.fill(Vector::zeros());
        if self.equation.is_none() {
            let end = self.moved.from(&self.start).rotation;
            let moment = self.external.moment_at(&end);
            self.part().shape.spread(&end, &self.external.force, &moment, out);
        }
    }

    fn begin_solve(&mut self, residual: &[Vector<D>]) {
        self.wrench = self.part().shape.gather(residual);
        if self.equation.is_some() {
            self.wrench = self.wrench + self.external;
        }
    }

    fn set_reach(&mut self, _nodes: &[u32]) {}

    fn partial_solve(&mut self, nodes: &[u32], out: &mut [Vector<D>]) {
        let solved = self.solved();
        let shape = &self.part().shape;
        let mean = solved.mean_rotation(&self.start);
        for node in nodes.iter().map(|&n| n as usize) {
            let healed = shape.displacement(&self.start, node) - self.from[node];
            out[node] = shape.motion(&mean, &solved, node) + healed - self.motion[node];
        }
    }

    fn add_forces(&mut self, nodes: &[u32], forces: &[Vector<D>]) {
        for node in nodes.iter().map(|&n| n as usize) {
            let arm = part(&self.body).shape.arm(node);
            self.wrench.add(&arm, &lift(&forces[node]));
        }
    }

    fn end_solve(&mut self, correction: &mut [Vector<D>]) {
        let solved = self.solved();
        self.part().shape.motions(&self.start, &solved, &self.from, correction);
        nodal::each(correction, [&self.motion], |c, [d]| *c -= d);
    }

    fn renew(&mut self, guess: &Guess<'_, D>, _again: bool) -> Result<(), StepError> {
        self.take(guess);
        if let Some(equation) = &self.equation {
            self.compliance = equation.compliance(&self.moved);
            self.arms_in = self.moved.mean_rotation(&self.start);
            self.generation += 1;
        }
        Ok(())
    }

    fn linearise(&mut self, guess: &Guess<'_, D>, tangent: &Tangent<'_, D>) -> Result<(), StepError> {
        if self.equation.is_none() {
            self.hold_back(guess, tangent);
            return Ok(());
        }
        // Steps in time may go on as load steps do: there its inertia resists.
        self.renew(guess, false)?;
        self.compliance = self.compliance.map(|part| part / (1.0 + tangent.held_back));
        Ok(())
    }

    /// Springs of contacts are as stiff as what touches it.
    fn stiffness_at(&mut self, _node: u32) -> f64 {
        f64::INFINITY
    }

    fn forget(&mut self) {}

    fn end_step(
        &mut self,
        guess: &Guess<'_, D>,
        _blend: Option<f64>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        self.take(guess);
        end.internal_force.fill(Vector::zeros());
        match self.equation {
            Some(equation) => self.end_in_time(&equation, guess, end),
            None => self.end_load_step(guess, end),
        }
    }

    /// The mass that a force at the node moves, in the mean of all directions.
    fn mass_of(&self, node: u32) -> f64 {
        let RigidPart { shape, .. } = self.part();
        let [along, about] = self.part().free();
        let shift = Vector::<3>::from_fn(|i, _| if along[i] { 1.0 / shape.mass } else { 0.0 });
        let turn = pose::inverse_on(&about, &shape.inertia);
        let compliance = [Matrix::from_diagonal(&shift), turn];
        let node = node as usize;
        D as f64 / shape.response(&Matrix::identity(), &compliance, node, node).trace()
    }

    fn jolt(
        &mut self,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        change: &mut [Vector<D>],
        support: &mut [Vector<D>],
    ) -> Jolt {
        let part = part(&self.body);
        let (shape, [along, about], held) = (&part.shape, part.free(), part.held());
        // What presses on held displacements of nodes changes none of them: a guide bears it.
        let pressed: Vector<D> = impulse.iter().sum();
        for force in impulse.iter_mut() {
            *force = Vector::from_fn(|i, _| if held[i] { 0.0 } else { force[i] });
        }
        let pose = shape.pose(state.displacement);
        let wrench = shape.gather(impulse);
        let moment = wrench.moment_at(&pose.rotation);
        let (push, turning) = (on(&along, &wrench.force), on(&about, &moment));
        let inertia = shape.inertia_at(&pose.rotation);
        let twist = Twist { velocity: push / shape.mass, spin: pose::inverse_on(&about, &inertia) * turning };
        shape.velocities(&pose, &twist, change);
        let before = shape.twist(&pose, state.velocity);
        let Some(guide) = &part.guide else { return Jolt::default() };
        support[guide.number] += pose::lower::<D>(&push) - pressed;
        let borne = (push - wrench.force).dot(&before.velocity) + (turning - moment).dot(&before.spin);
        Jolt { power: 0.0, borne }
    }

    fn velocity_half_way(&self, node: u32, velocity: &Vector<D>) -> Vector<D> {
        let Some(equation) = &self.equation else { return *velocity };
        let arm = self.moved.mean_rotation(&self.start) * self.part().shape.arm(node as usize);
        pose::lower(&(equation.twist.velocity + equation.twist.spin.cross(&arm)))
    }

    fn generation(&self) -> u64 {
        self.generation
    }

    fn responses_at_once(&self) -> usize {
        usize::MAX
    }

    fn respond(&mut self, _nodes: &[u32]) {}

    fn response(&self, a: u32, b: u32, _number: usize) -> Matrix<D> {
        self.part().shape.response(&self.arms_in, &self.compliance, a as usize, b as usize)
    }

    fn rigid_motions(&self) -> Vec<usize> {
        let [along, about] = self.part().free();
        let shifts = (0..D).filter(|&i| along[i]);
        let turns = if D == 2 { 2..3 } else { 0..3 };
        shifts.chain(turns.filter(|&i| about[i]).map(|i| if D == 2 { D } else { D + i })).collect()
    }
}
