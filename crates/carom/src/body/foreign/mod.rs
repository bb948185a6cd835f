//! A body of somebody else's: of it are known its mass, and at any displacements its energy, forces and stiffness.
//!
//! With the scheme `conserving` its energy is kept whatever its law, by Gonzalez' discrete gradient of the body as a whole ([`mean_force`]).

pub(crate) mod code;
pub(crate) mod law;
mod mean_force;

use std::sync::Arc;

use carom_fem::Held;
use carom_fem::sparse::{Inverse, NodalMatrix, NodeGraph, Precision};
use carom_mesh::{Matrix, Vector, nodal};

use self::code::{Blocks, ForeignCode};
use self::law::ForeignLaw;
use self::mean_force::MeanForce;
use super::{Body, BodyEnd, BodyState, Forecast, Guess, Interval, Jolt};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};
use crate::scheme::StepMap;

/// Such a body in a step.
pub struct ForeignBody<const D: usize> {
    code: Arc<dyn ForeignCode<D>>,
    mean_force: MeanForce<D>,
    held: Held,
    mass_blocks: Blocks<D>,
    mass: NodalMatrix<Matrix<D>>,
    /// Sum of every row of the mass, in the mean of the directions [kg].
    nodal_mass: Vec<f64>,
    nodal_inertia: Vec<f64>,
    mass_inverse: Inverse<D>,
    gravity: Vector<D>,
    /// The force of gravity on its nodes [N].
    weight: Vec<Vector<D>>,
    /// K̄⁻¹, for steps of this length [s].
    inverse: Inverse<D>,
    made_for: Option<f64>,
    generation: u64,
    scratch: Vec<Vector<D>>,
    middle: Vec<Vector<D>>,
}

impl<const D: usize> ForeignBody<D> {
    /// A body with nodes at `reference` [m] and this law, under `gravity` [m/s²].
    ///
    /// # Errors
    /// If its mass is not positive definite.
    pub fn new(
        reference: Vec<Vector<D>>,
        law: &ForeignLaw<D>,
        gravity: Vector<D>,
    ) -> Result<Self, StepError> {
        let ForeignLaw { mass: mass_blocks, held, code, .. } = law.clone();
        let count = reference.len();
        let graph = Arc::new(NodeGraph::of_pairs(count, mass_blocks.iter().map(|&(a, b, _)| (a, b))));
        let (mass, held) = (filled(&graph, &mass_blocks), Held::of(&held));
        let mut mass_inverse = Inverse::new(&[]);
        let mut free_mass = mass.clone();
        held.uncouple(&mut free_mass);
        mass_inverse.make_exact(false, &free_mass)?;
        let (nodal_mass, nodal_inertia) = (law.nodal_mass(count), law.nodal_inertia(count));
        let zeros = vec![Vector::zeros(); count];
        let mut weight = zeros.clone();
        mass.multiply(&vec![gravity; count], &mut weight);
        Ok(Self {
            code,
            gravity,
            weight,
            mean_force: MeanForce::new(reference),
            held,
            mass_blocks,
            mass,
            nodal_mass,
            nodal_inertia,
            mass_inverse,
            inverse: Inverse::new(&[]),
            made_for: None,
            generation: 0,
            scratch: zeros.clone(),
            middle: zeros,
        })
    }

    /// Makes K̄ with the stiffness in the middle of the step.
    fn factorise(&mut self, map: &StepMap) -> Result<(), StepError> {
        self.made_for = None;
        let blocks = self.code.stiffness(&self.middle);
        let mut blocks = blocks.ok_or(StepError::NotFinite("stiffness"))?;
        let is_known = |a: u32, b: u32| self.mass.graph().find(a, b).is_some();
        if !blocks.iter().all(|&(a, b, _)| is_known(a, b)) {
            let pairs = blocks.iter().map(|&(a, b, _)| (a, b));
            let graph = Arc::new(self.mass.graph().extended(pairs));
            self.mass = filled(&graph, &self.mass_blocks);
            self.inverse = Inverse::new(&[]);
        }
        let (k, m) = (map.stiffness_coefficient(), map.mass_coefficient());
        blocks.iter_mut().for_each(|(_, _, block)| *block *= k);
        let mut matrix = filled(self.mass.shared_graph(), &blocks);
        matrix.values.iter_mut().zip(&self.mass.values).for_each(|(k, mass)| *k += mass * m);
        self.held.uncouple(&mut matrix);
        self.inverse.make(Precision::Double, false, &matrix)?;
        self.made_for = Some(map.dt);
        self.generation += 1;
        Ok(())
    }

    fn kinetic(&mut self, velocity: &[Vector<D>]) -> f64 {
        self.mass.multiply(velocity, &mut self.scratch);
        0.5 * nodal::dot(velocity, &self.scratch)
    }
}

/// The matrix with the sums of these blocks.
fn filled<const D: usize>(graph: &Arc<NodeGraph>, blocks: &Blocks<D>) -> NodalMatrix<Matrix<D>> {
    let mut matrix = NodalMatrix::filled(graph, Matrix::zeros());
    for (a, b, block) in blocks {
        if let Some(entry) = graph.find(*a, *b) {
            matrix.values[entry] += block;
        }
    }
    matrix
}

impl<const D: usize> Body<D> for ForeignBody<D> {
    fn constrain(&self, _displacement: &[Vector<D>], velocity: &mut [Vector<D>], _t: f64) {
        self.held.clear(velocity);
    }

    fn measure(&self, state: &BodyState<'_, D>, internal_force: &mut [Vector<D>]) -> Energies {
        self.code.force(state.displacement, internal_force);
        let mut momentum = vec![Vector::zeros(); state.velocity.len()];
        self.mass.multiply(state.velocity, &mut momentum);
        Energies {
            strain: self.code.energy(state.displacement),
            kinetic: 0.5 * nodal::dot(state.velocity, &momentum),
            springs: 0.0,
        }
    }

    fn mean_velocity(&self, velocity: &[Vector<D>]) -> Vector<D> {
        nodal::weighted_total(&self.nodal_mass, velocity) / self.nodal_mass.iter().sum::<f64>()
    }

    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Result<Forecast, StepError> {
        let is_factorised = self.made_for != Some(interval.map.dt);
        if is_factorised {
            nodal::each(&mut self.middle, [start.displacement, motion], |m, [u, d]| *m = u + d * 0.5);
            self.factorise(&interval.map)?;
        }
        let speed = start.velocity.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        Ok(Forecast { speed, acceleration: self.gravity.norm(), is_factorised, ..Forecast::default() })
    }

    fn residual(&mut self, guess: &Guess<'_, D>, _blend: Option<f64>, out: &mut [Vector<D>]) {
        let (map, v0) = (&guess.interval.map, guess.start.velocity);
        nodal::each(&mut self.middle, [v0, guess.motion], |jump, [v, d]| *jump = map.end_velocity(v, d) - v);
        self.mass.multiply(&self.middle, &mut self.scratch);
        self.mean_force.write(&*self.code, guess, out);
        nodal::each(out, [&self.scratch, &self.weight], |r, [impulse, weight]| {
            *r = weight - *r - impulse / map.dt
        });
    }

    fn begin_solve(&mut self, residual: &[Vector<D>]) {
        self.scratch.copy_from_slice(residual);
        self.held.clear(&mut self.scratch);
        self.inverse.begin(&mut self.scratch);
    }

    fn set_reach(&mut self, nodes: &[u32]) {
        self.inverse.set_reach(nodes.iter().map(|&n| n as usize));
    }

    fn partial_solve(&mut self, nodes: &[u32], out: &mut [Vector<D>]) {
        self.inverse.look();
        nodes.iter().map(|&n| n as usize).for_each(|n| out[n] = self.inverse.seen(n));
    }

    fn add_forces(&mut self, nodes: &[u32], forces: &[Vector<D>]) {
        let Self { inverse, held, .. } = self;
        let nodes = nodes.iter().map(|&n| n as usize);
        inverse.add(nodes.map(|n| (n, held.free_part(n, &forces[n]))));
    }

    fn end_solve(&mut self, correction: &mut [Vector<D>]) {
        self.inverse.end(&mut self.scratch);
        correction.copy_from_slice(&self.scratch);
    }

    fn renew(&mut self, guess: &Guess<'_, D>, _again: bool) -> Result<(), StepError> {
        let ends = [guess.start.displacement, guess.displacement];
        nodal::each(&mut self.middle, ends, |m, [u0, u1]| *m = (u0 + u1) * 0.5);
        self.factorise(&guess.interval.map)
    }

    fn expect_contacts(&mut self, nodes: &[u32]) {
        self.inverse.expect(nodes);
    }

    fn forget(&mut self) {
        self.made_for = None;
    }

    fn end_step(
        &mut self,
        guess: &Guess<'_, D>,
        _blend: Option<f64>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies) {
        let (map, start) = (&guess.interval.map, &guess.start);
        nodal::each(end.velocity, [start.velocity, guess.motion], |v1, [v, d]| *v1 = map.end_velocity(v, d));
        self.code.force(guess.displacement, end.internal_force);
        let strain = self.code.energy(guess.displacement);
        let kinetic = self.kinetic(end.velocity);
        let mut scheme = 0.0;
        if map.kinetic_dissipation != 0.0 {
            nodal::each(&mut self.middle, [&*end.velocity, start.velocity], |jump, [v1, v0]| *jump = v1 - v0);
            self.mass.multiply(&self.middle, &mut self.scratch);
            scheme += map.kinetic_dissipation * nodal::dot(&self.middle, &self.scratch);
        }
        if map.strain_dissipation != 0.0 {
            let works = [&*end.internal_force, start.internal_force].map(|f| nodal::dot(guess.motion, f));
            scheme += map.strain_dissipation * (works[0] - works[1]);
        }
        let ledger = BodyLedger {
            kinetic: kinetic - start.energies.kinetic,
            strain: strain - start.energies.strain,
            external: self.held.free_dot(guess.motion, &self.weight),
            scheme,
            contact: self.held.free_dot(guess.motion, end.mean_contact_force),
            ..BodyLedger::default()
        };
        (ledger, Energies { kinetic, strain, springs: 0.0 })
    }

    fn mass_of(&self, node: u32) -> f64 {
        self.nodal_inertia[node as usize]
    }

    fn jolt(
        &mut self,
        impulse: &mut [Vector<D>],
        _state: &BodyState<'_, D>,
        change: &mut [Vector<D>],
        _support: &mut [Vector<D>],
    ) -> Jolt {
        self.held.clear(impulse);
        change.copy_from_slice(impulse);
        self.mass_inverse.begin(change);
        self.mass_inverse.end(change);
        Jolt::default()
    }

    fn generation(&self) -> u64 {
        self.generation
    }

    fn order(&self, node: u32) -> usize {
        self.inverse.order(node as usize)
    }

    fn responses_at_once(&self) -> usize {
        Inverse::<D>::AT_ONCE
    }

    fn respond(&mut self, nodes: &[u32]) {
        self.inverse.respond(nodes.iter().map(|&n| n as usize));
    }

    fn response(&self, a: u32, b: u32, number: usize) -> Matrix<D> {
        let mut block = self.inverse.response(number, a as usize);
        for i in (0..D).filter(|&i| self.held.holds(b as usize, i)) {
            block.set_column(i, &Vector::zeros());
        }
        block
    }

    fn factor_bytes(&self) -> usize {
        self.inverse.bytes()
    }
}
