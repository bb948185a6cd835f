//! The contacts of a step: which there may be, which take part, their reduced problem and its reactions, what they do to the energy.

pub(crate) mod active;
mod arriving;
pub(crate) mod candidates;
pub(crate) mod closing;
pub(crate) mod cohering;
pub(crate) mod compliance;
pub(crate) mod contact_work;
mod control;
mod coupling;
pub(crate) mod cross_check;
pub(crate) mod delassus;
mod gradients;
mod islands;
mod kinks;
mod made_of;
pub(crate) mod on_masses;
mod pressing;
pub(crate) mod reduced;
mod second_order;
mod slider;
pub(crate) mod sliding;
pub(crate) mod slip;
pub(crate) mod stiffened;
mod woodbury;

use carom_contact::Contact;
use carom_friction::{ContactProblem, Measure};
use carom_mesh::{Vector, nodal};

use self::active::ActiveSet;
use self::candidates::Finder;
use self::contact_work::ContactWork;
use self::control::CONTROL;
use self::islands::Islands;
use self::on_masses::OnMasses;
pub(crate) use self::reduced::Accuracy;
use self::reduced::Reduced;
use self::slip::Slip;
use self::stiffened::{OfReactions, Stiffened};
use crate::body::Body;
use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::given::Given;
use crate::model::state::Reaction;

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
    /// Those that take part in the step, or in the iterations of an island.
    pub active: ActiveSet<D>,
    islands: Islands<D>,
    pub reduced: Reduced<D>,
    /// What the contacts mean for the balance of blended steps.
    pub work: Vec<ContactWork>,
    /// What those without mass do to bodies with it.
    pub on_masses: OnMasses<D>,
    pub slip: Slip,
    /// Contacts at the end of the step.
    pub at_end: Vec<Contact<D>>,
    /// The nodal forces of the books [N], obstacles after the nodes of bodies.
    pub mean_force: Vec<Vector<D>>,
}

impl<const D: usize> Contacts<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        Self {
            finder: Finder::new(assembly.body_count()),
            active: ActiveSet::new(assembly.body_count()),
            islands: Islands::default(),
            reduced: Reduced::new(assembly),
            work: Vec::new(),
            on_masses: OnMasses::default(),
            slip: Slip::new(assembly.node_count()),
            at_end: Vec::new(),
            mean_force: nodal::zeros(assembly.reference.len()),
        }
    }

    /// Divides what was selected by islands; returns how many there are. [`Self::join`] puts them together again.
    pub fn divide(&mut self, given: &Given<'_, D>) -> usize {
        self.islands.divide(given, &mut self.active)
    }

    /// The bodies of an island, ascending, and how many contacts it has.
    pub fn island(&self, island: usize) -> (&[usize], usize) {
        self.islands.island(island)
    }

    /// Hands islands of the step, and what is known of the compliance of `bodies`, over `to` other contacts.
    pub fn hand_over(&mut self, islands: &[usize], bodies: &[usize], to: &mut Self) {
        self.islands.hand_over(islands, &mut to.islands);
        let [from, to] = [self, to].map(|contacts| &mut contacts.reduced.delassus.compliances);
        bodies.iter().for_each(|&i| std::mem::swap(&mut from[i], &mut to[i]));
    }

    /// Makes the contacts of an island the active ones; returns its bodies, ascending.
    pub fn enter(&mut self, island: usize) -> Vec<usize> {
        self.islands.enter(island, &mut self.active, &mut self.reduced)
    }

    /// Keeps what the iterations of an island have come to, of these `bodies`.
    pub fn leave(&mut self, island: usize, bodies: Vec<usize>) {
        self.islands.leave(island, bodies, &mut self.active, &mut self.reduced);
    }

    /// Puts the islands of a step together again.
    pub fn join(&mut self, given: &Given<'_, D>) {
        self.islands.join(given, &mut self.active, &mut self.reduced);
    }

    /// Gives up a step in which the iterations of an island have failed: its problem is the last one posed.
    pub fn give_up(&mut self, island: usize) {
        self.islands.give_up(island, &mut self.active, &mut self.reduced);
    }

    /// How far the reactions of the step are from the laws.
    pub fn measure(&self) -> Measure {
        self.islands.measure(&self.active, &self.reduced)
    }

    /// Sums the forces of the books: the reactions at the two `ends` of a step by the weights of their conditions.
    pub fn weigh(&mut self, given: &Given<'_, D>, ends: [&[Reaction<D>]; 2]) {
        self.mean_force.fill(Vector::zeros());
        for (end, reactions) in ends.into_iter().enumerate() {
            for reaction in reactions {
                let weights = given.condition_of(reaction.pair).weights_of_ends(&given.interval.map);
                let force = weights.part(end, &reaction.force);
                if force != Vector::<D>::zeros() {
                    reaction.contact.add_force(&force, &mut self.mean_force);
                }
            }
        }
    }

    /// Evaluates the contacts of `touching` bodies at a guess and gets these ready to respond to them; late in the iterations of a step the last correction [m] is
    /// given, see [`ActiveSet::evaluate_late`].
    pub fn evaluate(
        &mut self,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        late: Option<f64>,
        touching: &[usize],
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        match late {
            Some(correction) => self.active.evaluate_late(given, motion, correction),
            None => self.active.evaluate(given, motion),
        }
        self.active.meet(given, bodies);
        self.reduced.prepare(given, &self.active, touching, bodies);
    }

    /// Whether anything acts on bodies from outside that depends on their motion: contacts or springs.
    pub fn react(&self, assembly: &Assembly<D>) -> bool {
        !self.active.contacts.is_empty() || !assembly.springs.is_empty()
    }

    /// Whether reactions have their stiffness in the tangent.
    pub fn is_stiffened(&self) -> bool {
        self.reduced.delassus.stiffened.of_reactions != OfReactions::None
    }

    /// Whether `bodies` that touch may give way together: springs of contacts have made a tangent definite, or it took the whole stiffness of reactions to get
    /// there. Of many contacts this is not asked.
    pub fn are_in_question(&self, bodies: &[usize]) -> bool {
        let Stiffened { is_sprung, of_reactions, .. } = &self.reduced.delassus.stiffened;
        let is_mended = || *of_reactions == OfReactions::Whole || bodies.iter().any(|&i| is_sprung[i]);
        self.active.contacts.len() <= CONTROL.stiffened && is_mended()
    }

    /// From now on they have, in the rest of the step, unless they are so many that it costs more than it saves. Returns whether they have.
    pub fn take_stiffness_of_reactions(&mut self) -> bool {
        let is_worth_it = self.active.contacts.len() <= CONTROL.stiffened;
        if is_worth_it {
            self.reduced.delassus.stiffened.of_reactions = OfReactions::Symmetric;
        }
        is_worth_it
    }

    /// From now on they have none, and `bodies` no springs.
    pub fn soften(&mut self, bodies: &[usize]) {
        self.reduced.delassus.stiffened.clear(bodies);
    }

    /// Makes what contacts add to the tangents of a load step: see [`Reduced::stiffen`].
    pub fn stiffen(
        &mut self,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        bodies: &mut [Box<dyn Body<D>>],
        residual: &mut [Vector<D>],
    ) {
        self.reduced.stiffen(given, &self.active, motion, bodies, residual);
    }

    /// Solves for the reactions at a guess: see [`Reduced::solve`].
    pub fn solve(
        &mut self,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        accuracy: Accuracy,
        bodies: &mut [Box<dyn Body<D>>],
    ) -> Result<f64, StepError> {
        let Self { reduced, active, on_masses, .. } = self;
        reduced.feel(|i| on_masses.felt(i));
        reduced.solve(given, active, motion, accuracy, bodies)
    }

    /// Whether contacts have lost what held them where iterations have led: see [`ActiveSet::let_go`].
    pub fn let_go(&mut self) -> bool {
        !self.active.adhesions.iter().all(Option::is_none) && {
            let size = self.reduced.size(&self.active);
            self.active.let_go(&self.reduced.problem, size)
        }
    }

    /// What massless contacts mean for the balance of blended steps, at a guess.
    pub fn measure_work(&mut self, given: &Given<'_, D>, motion: &[Vector<D>]) -> &[ContactWork] {
        contact_work::measure(given, &self.active, motion, &mut self.work);
        &self.work
    }
}
