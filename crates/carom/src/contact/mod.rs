//! The contacts of a step: which there may be, which take part, their reduced problem and its reactions, what they do to the energy.

pub(crate) mod active;
pub(crate) mod candidates;
pub(crate) mod compliance;
pub(crate) mod contact_work;
mod control;
mod coupling;
pub(crate) mod cross_check;
mod delassus;
pub(crate) mod reduced;
pub(crate) mod slip;

use carom_contact::Contact;
use carom_friction::ContactProblem;
use carom_mesh::Vector;

use self::active::ActiveSet;
use self::candidates::Finder;
use self::contact_work::ContactWork;
use self::reduced::Reduced;
use self::slip::Slip;
use crate::body::Body;
use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::given::Given;

/// A contact problem as a step posed it: motions in m, reactions in N (with massless contact ξ times these).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedProblem<'a, const D: usize> {
    /// W, q and μ.
    pub problem: &'a ContactProblem<D>,
    /// The reactions that its solver started from.
    pub guess: &'a [Vector<D>],
}

/// All that a step knows of contacts. It holds no result: the reactions that a step ends with are kept in the state.
#[derive(Debug)]
pub(crate) struct Contacts<const D: usize> {
    pub finder: Finder<D>,
    pub active: ActiveSet<D>,
    pub reduced: Reduced<D>,
    /// What the contacts mean for the balance of blended steps.
    pub work: Vec<ContactWork>,
    pub slip: Slip,
    /// Contacts at the end of the step.
    pub at_end: Vec<Contact<D>>,
}

impl<const D: usize> Contacts<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        Self {
            finder: Finder::new(assembly.body_count()),
            active: ActiveSet::new(assembly.body_count()),
            reduced: Reduced::new(assembly),
            work: Vec::new(),
            slip: Slip::new(assembly.node_count()),
            at_end: Vec::new(),
        }
    }

    /// Evaluates the contacts at a guess and gets the bodies ready to respond to them.
    pub fn evaluate(&mut self, given: &Given<'_, D>, motion: &[Vector<D>], bodies: &mut [Box<dyn Body<D>>]) {
        self.active.evaluate(given, motion);
        self.reduced.prepare(given, &self.active, bodies);
    }

    /// Solves for the reactions at a guess: see [`Reduced::solve`].
    pub fn solve(
        &mut self,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        error: f64,
        bodies: &mut [Box<dyn Body<D>>],
    ) -> Result<f64, StepError> {
        self.reduced.solve(given, &mut self.active, motion, error, bodies)
    }

    /// What the contacts mean for the balance of blended steps, at a guess.
    pub fn measure_work(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) -> &[ContactWork] {
        contact_work::measure(given, &self.active, motion, &mut self.work);
        &self.work
    }
}
