//! What a step asks of a body, whatever it is made of.
//!
//! A step knows nodes, forces on them and how they yield; it knows nothing of cells. A body owns its factors and its scratch and answers for
//! itself, stage by stage; the [`fe`] body of finite elements is one of these, the [`rigid`] and the [`reduced`] one others,
//! and the [`foreign`] one that of somebody else's code.

pub(crate) mod fe;
pub(crate) mod foreign;
pub(crate) mod lent;
pub(crate) mod reduced;
pub(crate) mod rigid;

use carom_fem::material::PlasticState;
use carom_mesh::{Matrix, Vector};

use crate::StepMap;
use crate::archive::{Archive, CheckpointError};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};

/// A step in time, and the rules that hold for every body in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    /// What the time scheme says.
    pub map: StepMap,
    /// Time at its start and at its end [s], of loads and of what is prescribed.
    pub start: f64,
    /// See `start`.
    pub end: f64,
    /// Length of the whole step that it is a part of [s]: the next one may be as long.
    pub whole: f64,
    /// Whether time only says how far loads have come: what is prescribed has no velocity.
    pub is_load_step: bool,
    /// Whether inverses need not be exact: polynomials, and factors in single precision of bodies whose nodes all have mass.
    pub approximates: bool,
    /// Whether stresses of start and end are blended so that massless contact keeps the energy: see [`Body::balance`].
    pub is_blended: bool,
}

/// How much the reactions at the start and at the end of a step count in its books.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactWeights {
    /// Of normal reactions.
    pub normal: [f64; 2],
    /// Of friction.
    pub across: [f64; 2],
}

impl ContactWeights {
    /// The part of a reaction at the start (0) or at the end (1) that counts.
    #[must_use]
    pub fn part<const D: usize>(&self, end: usize, force: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| force[i] * if i == 0 { self.normal[end] } else { self.across[end] })
    }
}

impl Interval {
    /// Whether it is the first step of a static analysis. That starts from bodies that nothing has driven yet: what drives them at t = 0 is
    /// applied in this step.
    #[must_use]
    pub fn starts_from_nothing(&self) -> bool {
        self.is_load_step && self.start == 0.0
    }
}

/// The part of one body in a state; vectors have an entry per node of the body.
#[derive(Debug, Clone, Copy)]
pub struct BodyState<'a, const D: usize> {
    /// u [m].
    pub displacement: &'a [Vector<D>],
    /// v [m/s].
    pub velocity: &'a [Vector<D>],
    /// ∂E/∂u [N].
    pub internal_force: &'a [Vector<D>],
    /// Contact forces [N].
    pub contact_force: &'a [Vector<D>],
    /// u where the motion that is prescribed now began [m]; of no use where none is.
    pub anchor: &'a [Vector<D>],
    /// What its material remembers; empty where it remembers nothing.
    pub history: &'a [PlasticState],
    /// Its energies [J].
    pub energies: Energies,
}

/// What is guessed of the motion of a body in a step.
#[derive(Debug, Clone, Copy)]
pub struct Guess<'a, const D: usize> {
    /// The step.
    pub interval: &'a Interval,
    /// Where it starts.
    pub start: BodyState<'a, D>,
    /// d = u₊ − u [m], an entry per node of the body.
    pub motion: &'a [Vector<D>],
    /// u₊ [m].
    pub displacement: &'a [Vector<D>],
}

/// What the tangent of a load step has beside the stiffness of the body itself.
#[derive(Debug, Clone, Copy)]
pub struct Tangent<'a, const D: usize> {
    /// The share of the inertia of the body's lowest elastic motion that holds corrections back towards the guess, in K̄ alone, where the tangent by
    /// itself has no inverse.
    pub held_back: f64,
    /// How much is left of what holds a body back that its supports leave loose, from 0 to 1.
    pub grip: f64,
    /// Springs to the ground [N/m] at some nodes.
    pub springs: &'a [(u32, Matrix<D>)],
    /// How stiff the softest spring of the model is that holds the body [N/m]; zero without.
    pub softest_spring: f64,
    /// Whether it is the first one of the step: later ones are made where it was not good enough.
    pub is_first: bool,
}

/// The motion of a body that its tangent in a load step resists least; its largest component is one.
#[derive(Debug, Clone, PartialEq)]
pub struct SoftestMotion<const D: usize> {
    /// x, an entry per node of the body.
    pub field: Vec<Vector<D>>,
    /// x·K x [N/m], springs included. Below zero the motion sets energy free.
    pub stiffness: f64,
    /// The same of the inertia of the body's lowest elastic motion [N/m], which it is compared with.
    pub inertia: f64,
}

impl<const D: usize> SoftestMotion<D> {
    /// How much the body resists, without a unit.
    #[must_use]
    pub fn resistance(&self) -> f64 {
        self.stiffness / self.inertia
    }
}

/// What a body expects of a step before it knows of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Forecast {
    /// Largest speed of a node at the start [m/s].
    pub speed: f64,
    /// Acceleration that it is under without contact [m/s²].
    pub acceleration: f64,
    /// Largest motion that is prescribed [m].
    pub driven: f64,
    /// Whether a factor was made.
    pub is_factorised: bool,
}

/// The two ends of the balance of energy of a body with nodes without mass: α is their ratio.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Balance {
    /// What is missing with the conserving force alone [J].
    pub missing: f64,
    /// What the difference of the stresses of both ends gives [J].
    pub available: f64,
    /// Energy of the motion of the step, ½ Σ m (d/Δt)² [J].
    pub motion: f64,
    /// Work of the forces that set in on nodes without mass, without its sign [J]: of what their loads change by, and of what they start a run with.
    pub onset: f64,
}

/// What is known of the boundary at the end of a step when its balance is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outlook {
    /// Nothing will press on the body, and the guess is the first one, far from any balance: none is wanted, nor the forces that give back momenta.
    First,
    /// Nothing will press on the body.
    Free,
    /// What will press is what the guess says.
    Pressed,
}

/// A place in which something of a body is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball<const D: usize> {
    /// Its centre [m].
    pub centre: Vector<D>,
    /// Its radius [m].
    pub radius: f64,
}

/// What an impulse meant for a body.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Jolt {
    /// The power [W] that damping and viscosity would take from the motion that it makes, Δv·C Δv.
    pub power: f64,
    /// The work [J] of what guides the body as a whole against its part of the impulse: it moves on as it did.
    pub borne: f64,
}

/// What of bodies resists impulses in their contacts.
pub(crate) trait Masses<const D: usize> {
    /// See [`Body::mass_of`].
    fn mass_of(&self, body: usize, node: u32) -> f64;

    /// See [`Body::jolt`]; what is written are the change of velocities and the impulses of supports.
    fn jolt(
        &mut self,
        body: usize,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        written: [&mut [Vector<D>]; 2],
    ) -> Jolt;
}

impl<const D: usize> Masses<D> for [Box<dyn Body<D>>] {
    fn mass_of(&self, body: usize, node: u32) -> f64 {
        self[body].mass_of(node)
    }

    fn jolt(
        &mut self,
        body: usize,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        [change, support]: [&mut [Vector<D>]; 2],
    ) -> Jolt {
        self[body].jolt(impulse, state, change, support)
    }
}

/// What a body writes at the end of a step, beside its displacements.
#[derive(Debug)]
pub struct BodyEnd<'a, const D: usize> {
    /// Contact forces [N] that the step ended with.
    pub contact_force: &'a [Vector<D>],
    /// Those of the books: the reactions of start and end by their [weights](ContactWeights). Springs pull as contacts press.
    pub mean_contact_force: &'a [Vector<D>],
    /// The work of springs on what of the body is free [J], which the contact forces have a part in.
    pub spring_work: f64,
    /// v₊ [m/s].
    pub velocity: &'a mut [Vector<D>],
    /// ∂E/∂u at u₊ [N].
    pub internal_force: &'a mut [Vector<D>],
    /// What the material remembers.
    pub history: &'a mut [PlasticState],
    /// The force of every support of the model [N], to which a body adds its own.
    pub support: &'a mut [Vector<D>],
}

/// A body in a step, with its factors and its scratch.
///
/// Slices have an entry per node of the body unless it is said otherwise, and nodes are numbered within it. A body alone decides what K̄ is,
/// the matrix with which it corrects its motion. The step asks for K̄⁻¹ by parts, so that reactions, which depend on all bodies, can join in
/// between. The parts are [`Self::begin_solve`] with what is known, [`Self::partial_solve`] at the contacts, [`Self::add_forces`] once these
/// are solved, and [`Self::end_solve`].
pub trait Body<const D: usize>: Send + Sync {
    /// What its material remembers at the start of a run.
    fn initial_history(&self) -> Vec<PlasticState> {
        Vec::new()
    }

    /// Makes the velocities [m/s] at time `t` [s], where nodes have these displacements [m], obey what binds and drives the nodes.
    fn constrain(&self, _displacement: &[Vector<D>], _velocity: &mut [Vector<D>], _t: f64) {}

    /// Writes ∂E/∂u [N] at `state`, whose own forces and energies are not read, and returns its energies.
    fn measure(&self, state: &BodyState<'_, D>, internal_force: &mut [Vector<D>]) -> Energies;

    /// Whether all that drives it is the same at two times [s], and has no rate: if so it may rest. A body that cannot say never rests.
    fn is_driven_alike(&self, _times: [f64; 2]) -> bool {
        false
    }

    /// Puts what its supports gave `before` [N] among the forces of every `support` of the model: where it rests these stay as they are.
    fn keep_support(&self, _before: &[Vector<D>], _support: &mut [Vector<D>]) {}

    /// The velocity at which it moves as a whole [m/s].
    fn mean_velocity(&self, velocity: &[Vector<D>]) -> Vector<D>;

    /// Starts a step: `motion`, which holds free flight Δt v [m], becomes what is prescribed where it is, and a K̄ is there that fits. Here as in what
    /// follows only those nodes count that [iterations move](crate::Assembly::stepped).
    ///
    /// # Errors
    /// If what is prescribed is not finite or K̄ cannot be factorised.
    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, D>,
        motion: &mut [Vector<D>],
    ) -> Result<Forecast, StepError>;

    /// The balance of energy at a guess, of steps that [are blended](Interval::is_blended).
    fn balance(&mut self, _guess: &Guess<'_, D>, _outlook: Outlook) -> Balance {
        Balance::default()
    }

    /// Writes the residual [N] of its equation of motion at a guess, without reactions, to `out`. In steps that are blended the
    /// weight of the blend is given, and [`Self::balance`] has been asked at the same guess.
    fn residual(&mut self, guess: &Guess<'_, D>, blend: Option<f64>, out: &mut [Vector<D>]);

    /// Begins to solve for the correction of the motion under a `residual` [N].
    fn begin_solve(&mut self, residual: &[Vector<D>]);

    /// Names the nodes of [`Self::partial_solve`], [`Self::add_forces`], [`Self::respond`], ascending or not.
    fn set_reach(&mut self, nodes: &[u32]);

    /// Writes the correction [m] as it stands to `out` at these `nodes`, which are of the reach.
    fn partial_solve(&mut self, nodes: &[u32], out: &mut [Vector<D>]);

    /// Adds `forces` [N] to the residual at these `nodes`, which are of the reach.
    fn add_forces(&mut self, nodes: &[u32], forces: &[Vector<D>]);

    /// Writes the correction [m].
    fn end_solve(&mut self, correction: &mut [Vector<D>]);

    /// Makes K̄ anew at a guess; `again` if it was made in this step before.
    ///
    /// # Errors
    /// If K̄ cannot be factorised.
    fn renew(&mut self, guess: &Guess<'_, D>, again: bool) -> Result<(), StepError>;

    /// Names the nodes, ascending, that contacts act on in what is [made](Self::linearise) from now on.
    fn expect_contacts(&mut self, _nodes: &[u32]) {}

    /// How many iterations with a kept tangent a new one is worth in a load step.
    fn tangent_worth(&self) -> i32 {
        1
    }

    /// Makes K̄ the tangent at a guess of a load step.
    ///
    /// # Errors
    /// If K̄ is not positive definite even with what the tangent has beside the body's own stiffness.
    fn linearise(&mut self, guess: &Guess<'_, D>, _tangent: &Tangent<'_, D>) -> Result<(), StepError> {
        self.renew(guess, false)
    }

    /// Whether its tangents in load steps may be definite where the stiffness is not: what supports leave loose is held back by inertia. Of bodies that
    /// are so large that another factor is half of a load step this is not said.
    fn hides_softness(&self) -> bool {
        false
    }

    /// The motion that it resists least at a guess of a load step, with `springs` to the ground [N/m] and but for `neutral` motions; none if that is not
    /// known of such a body. K̄ is of no use afterwards.
    fn softest_motion(
        &mut self,
        _guess: &Guess<'_, D>,
        _springs: &[(u32, Matrix<D>)],
        _neutral: &[Vec<Vector<D>>],
    ) -> Option<SoftestMotion<D>> {
        None
    }

    /// Lets the rest of the body follow the part of `motion` [m] that is prescribed, from the start of a load step, as its K̄ says.
    fn follow(&mut self, _interval: &Interval, _start: &BodyState<'_, D>, _motion: &mut [Vector<D>]) {}

    /// How stiff it is at a node, where nothing has moved [N/m]. Zero wants no springs there; what is rigid is infinitely stiff.
    fn stiffness_at(&mut self, _node: u32) -> f64 {
        0.0
    }

    /// How far the round-off of its forces moves it [m], as its present K̄ resists. Corrections below this say nothing.
    fn round_off(&self) -> f64 {
        0.0
    }

    /// Lets no step rely on K̄ as it is.
    fn forget(&mut self);

    /// Writes balls that hold what of its outline it places at the end of a step alone, all the way there, where its nodes have these displacements [m];
    /// none if every iteration places all.
    fn balls(&mut self, _displacement: &[Vector<D>], _out: &mut Vec<Ball<D>>) {}

    /// Places at the end of a step what no iteration asks for: writes displacements and motions [m]. Whether anything `is_near` of the balls of
    /// [`Self::balls`] says where it has to be exact.
    fn complete(&mut self, _places: [&mut [Vector<D>]; 2], _is_near: &dyn Fn(usize) -> bool) {}

    /// How far its nodes have moved beside its motion as a rigid body since [`Self::looked_at`] at most [m], if it knows without them, after
    /// [`Self::balls`].
    fn wandered(&self) -> Option<f64> {
        None
    }

    /// Somebody has looked at where all of it is.
    fn looked_at(&mut self) {}

    /// Completes the state at the end of a step and says what happened to the energy; returns that and the energies [J].
    fn end_step(
        &mut self,
        guess: &Guess<'_, D>,
        blend: Option<f64>,
        end: BodyEnd<'_, D>,
    ) -> (BodyLedger, Energies);

    /// Whether damping or viscosity takes energy from its motion.
    fn is_damped(&self) -> bool {
        false
    }

    /// The mass by which a node resists what moves it alone [kg]; none of a node that takes no force.
    fn mass_of(&self, node: u32) -> f64;

    /// What an `impulse` [N s] makes of the velocities: writes Δv = M⁻¹ p [m/s] to `change`, zero where displacements are held, and where they
    /// are replaces the impulse by M Δv, which the supports see to. What they give for that is added to `support`, the impulse of every support of
    /// the model [N s]. The body is at the end of a step in `state`. It is asked of no body with nodes without mass.
    fn jolt(
        &mut self,
        impulse: &mut [Vector<D>],
        state: &BodyState<'_, D>,
        change: &mut [Vector<D>],
        support: &mut [Vector<D>],
    ) -> Jolt;

    /// The velocity [m/s] of a node, `velocity` at the start of the step, where the body has turned half way through it as was last guessed. A rigid
    /// body knows it better than its nodes.
    fn velocity_half_way(&self, _node: u32, velocity: &Vector<D>) -> Vector<D> {
        *velocity
    }

    /// The energy [J] of what vibrates in the body at the end of a step that [is blended](Interval::is_blended): of the velocities less those of a rigid
    /// motion with the same momenta. It is zero where supports move.
    fn vibration(&mut self, _state: &BodyState<'_, D>) -> f64 {
        0.0
    }

    /// Adds a `share` of the [vibration](Self::vibration) that was asked for last to the velocities. What supports give for that over `dt` [s] is added
    /// to `support`, the force of every support of the model [N].
    fn vibrate(&mut self, _share: f64, _dt: f64, _velocity: &mut [Vector<D>], _support: &mut [Vector<D>]) {}

    /// Grows with every K̄.
    fn generation(&self) -> u64;

    /// The rotation since K̄ was made: blocks of [`Self::response`] are to be turned by it.
    fn turn(&self) -> Matrix<D> {
        Matrix::identity()
    }

    /// The nodes of the surface that feel a force at `node` within a step, itself among them, ascending; none if all do.
    fn near(&mut self, _node: u32) -> Option<Vec<u32>> {
        None
    }

    /// When a node is eliminated: unit forces on nodes near each other in this order cost least.
    fn order(&self, node: u32) -> usize {
        node as usize
    }

    /// So many nodes does [`Self::respond`] take at once.
    fn responses_at_once(&self) -> usize {
        1
    }

    /// Solves for unit forces at these nodes of the reach.
    fn respond(&mut self, nodes: &[u32]);

    /// The block (K̄⁻¹)_ab [m/N] for a node a of the reach and a node b that was `number` among those last given to [`Self::respond`].
    fn response(&self, a: u32, b: u32, number: usize) -> Matrix<D>;

    /// The numbers of the rigid motions that it has where nothing holds it: see [`carom_fem::rigid_motion`].
    fn rigid_motions(&self) -> Vec<usize> {
        (0..D).collect()
    }

    /// Memory of its factor [bytes].
    fn factor_bytes(&self) -> usize {
        0
    }

    /// Records what K̄ was made from, or makes it again, under names that begin with `name`; `map` gives that of steps of a length [s]. Returns
    /// whether there is a K̄.
    ///
    /// # Errors
    /// If the archive does not fit.
    fn exchange(
        &mut self,
        _archive: &mut Archive<'_>,
        _name: &str,
        _map: &dyn Fn(f64) -> StepMap,
    ) -> Result<bool, CheckpointError> {
        Ok(false)
    }
}
