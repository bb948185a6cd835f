//! What iterates in a step: bodies, their contacts, and where they are guessed to be.

use carom_mesh::{Vector, nodal};

use super::blend::Blend;
use super::newton::Newton;
use crate::body::Body;
use crate::contact::{Contacts, PosedProblem};
use crate::model::assembly::Assembly;

/// The bodies with their factors, contacts and iterations. One of these has the bodies of a step; where threads iterate islands side by side, others
/// have some of them meanwhile.
pub(crate) struct Iterating<const D: usize> {
    pub bodies: Vec<Box<dyn Body<D>>>,
    pub contacts: Contacts<D>,
    pub newton: Newton<D>,
    pub blend: Blend,
    /// d = u₊ − u [m] of all nodes and obstacles.
    pub motion: Vec<Vector<D>>,
    /// Factorisations made so far.
    pub factorisations: u64,
}

impl<const D: usize> Iterating<D> {
    /// With these `bodies`, those of the `assembly`.
    pub fn new(assembly: &Assembly<D>, bodies: Vec<Box<dyn Body<D>>>) -> Self {
        Self {
            contacts: Contacts::new(assembly),
            newton: Newton::new(assembly),
            blend: Blend::new(bodies.len()),
            motion: nodal::zeros(assembly.reference.len()),
            factorisations: 0,
            bodies,
        }
    }

    /// The last contact problem that was posed, solved or not; after [`crate::StepError::Friction`] the one that failed.
    pub fn posed_problem(&self) -> Option<PosedProblem<'_, D>> {
        let reduced = &self.contacts.reduced;
        let (problem, guess) = (&reduced.problem, &reduced.guess[..]);
        (!problem.is_empty()).then_some(PosedProblem { problem, guess })
    }
}
