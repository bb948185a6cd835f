//! The books of the springs and dampers of a step.

use carom_mesh::{Vector, nodal};

use crate::ledger::{BodyLedger, Ledger};
use crate::model::assembly::Assembly;
use crate::model::given::Given;

/// What springs and dampers did in a step.
#[derive(Debug)]
pub(crate) struct SpringBooks<const D: usize> {
    /// The forces of the books, and those at the end of the step, node by node, those of obstacles too [N]; empty without springs.
    mean: Vec<Vector<D>>,
    end: Vec<Vector<D>>,
    /// Contact forces and `end`.
    pressing: Vec<Vector<D>>,
    /// The work of the mean forces on every body [J]: on what of it is free, and on all of it.
    works: Vec<[f64; 2]>,
    /// Which bodies contacts press on in the books.
    is_pressed: Vec<bool>,
    /// Terms of the run.
    ledger: Ledger,
}

impl<const D: usize> SpringBooks<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let count = if assembly.springs.is_empty() { 0 } else { assembly.reference.len() };
        Self {
            mean: nodal::zeros(count),
            end: nodal::zeros(count),
            pressing: nodal::zeros(count),
            works: vec![[0.0; 2]; assembly.body_count()],
            is_pressed: vec![true; assembly.body_count()],
            ledger: Ledger::default(),
        }
    }

    /// Takes the forces of a step, which moved nodes and obstacles by `motion` [m] to these displacements [m], and what they did.
    pub fn pull(&mut self, given: &Given<'_, D>, motion: &[Vector<D>], displacement: &[Vector<D>]) {
        let Given { assembly, state, interval, .. } = *given;
        if assembly.springs.is_empty() {
            return;
        }
        self.mean.fill(Vector::zeros());
        self.end.fill(Vector::zeros());
        self.ledger = Ledger::default();
        for spring in &assembly.springs {
            let step = spring.in_step(interval, &state.displacement, motion);
            spring.add_force(&step.mean_pull(), &mut self.mean);
            spring.add_force(&step.pull(), &mut self.end);
            self.ledger.springs += spring.energy(displacement) - spring.energy(&state.displacement);
            self.ledger.dampers += step.taken_by_damper();
            self.ledger.scheme += step.taken_by_scheme();
        }
        self.works.fill([0.0; 2]);
        for (n, (force, d)) in self.mean.iter().zip(motion).enumerate() {
            match assembly.body_of(n) {
                Some(body) => {
                    self.works[body][0] += force.dot(&assembly.free_part(n, d));
                    self.works[body][1] += force.dot(d);
                }
                None => self.ledger.prescribed -= force.dot(d),
            }
        }
    }

    /// Adds the mean forces to those of the books of contacts [N], and takes contact forces at the end of the step [N] to its own there.
    pub fn join(&mut self, given: &Given<'_, D>, forces: &mut [Vector<D>], at_end: &[Vector<D>]) {
        if self.mean.is_empty() {
            return;
        }
        // What a blend gives back it gives through contact, wherever these press.
        for (body, is_pressed) in self.is_pressed.iter_mut().enumerate() {
            let forces = &forces[given.assembly.nodes(body)];
            *is_pressed = given.interval.is_blended || forces.iter().any(|f| *f != Vector::<D>::zeros());
        }
        forces.iter_mut().zip(&self.mean).for_each(|(sum, force)| *sum += force);
        let own = self.pressing.iter_mut().zip(at_end).zip(&self.end);
        own.for_each(|((sum, contact), spring)| *sum = contact + spring);
    }

    /// Contact forces [N] at the end of the step, and with them those of springs.
    pub fn with_those_at_end<'a>(&'a self, contact_force: &'a [Vector<D>]) -> &'a [Vector<D>] {
        if self.pressing.is_empty() { contact_force } else { &self.pressing }
    }

    /// Their work on what of a body is free [J].
    pub fn work_on_free(&self, body: usize) -> f64 {
        self.works[body][0]
    }

    /// Tells what bodies received through springs from what they received through contact. Where they are held, supports do what springs do.
    pub fn close(&self, bodies: &mut [BodyLedger]) {
        if self.mean.is_empty() {
            return;
        }
        for (i, (body, &[free, all])) in bodies.iter_mut().zip(&self.works).enumerate() {
            body.contact = if self.is_pressed[i] { body.contact - free } else { 0.0 };
            body.connections = all;
            body.prescribed -= all - free;
        }
    }

    /// Adds what is of no body.
    pub fn add_to(&self, ledger: &mut Ledger) {
        ledger.springs += self.ledger.springs;
        ledger.dampers += self.ledger.dampers;
        ledger.scheme += self.ledger.scheme;
        ledger.prescribed += self.ledger.prescribed;
    }
}
