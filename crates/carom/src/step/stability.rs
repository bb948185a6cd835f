//! Whether a body is in stable equilibrium at the end of a load step, and how it gives way if it is not.
//!
//! Where the tangent of a body is indefinite a load step may still end in equilibrium: beyond a bifurcation iterations that are held back stay on a path
//! that nothing but round-off leaves. No part is ever found in such a state, so the step is refused by a witness: a motion x of one body that its closed
//! contacts do not see, and that sets energy free, x·(K + G)x < 0, with G the stiffness of the reactions; or one of several bodies at once. Where there is
//! none the state may be unstable all the same, by a motion that slides with friction.

use carom_contact::Contact;
use carom_mesh::Vector;
use nalgebra::DMatrix;

use super::giving_way::GivingWay;
use super::hold::{elastic_share, neutral};
use super::iterating::Iterating;
use super::report::StepReport;
use crate::body::{Guess, SoftestMotion};
use crate::contact::Contacts;
use crate::contact::stiffened::{ground, ground_of_model};
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::state::Reaction;

/// How much stiffer than κ contacts are where nothing but the motions that they do not see is looked at.
const RIGID: f64 = 1e4;

/// A motion sets energy free if its resistance is below zero by more than this, in units of the inertia of the lowest one.
const ROUND_OFF: f64 = 1e-8;

/// A state is next to one that is not stable where the resistance to its softest motion has fallen to this share of that of the undeformed body.
/// Measured: where a block between plates is squeezed into wrinkles iterations end at 1e-2.
const NEAR: f64 = 0.03;

/// A motion is as good as rigid if less than this share of it, squared, is not: a shaft that turns in a hub does not give way. Of a slender column
/// between plates that buckles it is 0.014.
const RIGID_MOTION: f64 = 3e-3;

/// The difference of places that gives the stiffness of the reactions, in sizes of the smaller body.
const DIFFERENCE: f64 = 1e-6;

/// Beyond so many contacts the modes of W cost more than a step.
const MANY: usize = 300;

/// A contact, its reaction [N] and its friction coefficient.
type Pressed<'a, const D: usize> = (&'a Contact<D>, &'a Vector<D>, f64);

/// What holds still where only motions that no closed contact sees are looked at: with friction all directions, as what slides may not slide back.
fn holding<'a, const D: usize>(
    pressed: &'a [Pressed<'a, D>],
) -> impl Iterator<Item = (&'a Contact<D>, usize)> + 'a {
    pressed.iter().map(|&(contact, r, mu)| (contact, held_by::<D>(r, mu)))
}

/// The directions of its frame in which a contact holds still then.
fn held_by<const D: usize>(r: &Vector<D>, mu: f64) -> usize {
    match (r[0] > 0.0, mu > 0.0) {
        (false, _) => 0,
        (true, false) => 1,
        (true, true) => D,
    }
}

/// The softest motion of a body at these displacements `at`, where these contacts hold it; none if that is as good as rigid.
fn softest<const D: usize>(
    body: usize,
    at: &[Vector<D>],
    pressed: &[Pressed<'_, D>],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &mut Iterating<D>,
) -> Option<SoftestMotion<D>> {
    let assembly = given.assembly;
    let neutral = neutral(body, holding(pressed), given, reached, work);
    let mut springs = vec![Vec::new(); assembly.body_count()];
    ground(assembly, holding(pressed), RIGID, &mut work.bodies, &mut springs);
    ground_of_model(assembly, reached, &mut work.bodies, &mut springs);
    let motion = &work.motion[assembly.nodes(body)];
    let guess = Guess { interval: given.interval, start: given.start(body), motion, displacement: at };
    let softest = work.bodies[body].softest_motion(&guess, &springs[body], &neutral)?;
    let is_elastic = elastic_share(body, &softest.field, given, reached, work) > RIGID_MOTION;
    is_elastic.then_some(softest)
}

/// x·G x [N/m] of a motion x of one body: what the reactions, which turn with it, resist it with.
fn by_reactions<const D: usize>(
    body: usize,
    x: &[Vector<D>],
    given: &Given<'_, D>,
    work: &Iterating<D>,
) -> f64 {
    let (assembly, active) = (given.assembly, &work.contacts.active);
    let nodes = assembly.nodes(body);
    let pairs = &assembly.contact.pairs;
    let sizes = active.candidates.iter().map(|c| assembly.pair_size(&pairs.get(c.pair as usize)));
    let step = DIFFERENCE * sizes.fold(assembly.size, f64::min);
    let mut mortar = active.mortar.clone();
    let (mut moved, mut forces) = (Vec::new(), vec![Vector::zeros(); work.motion.len()]);
    for sign in [1.0, -1.0] {
        let position = |n: u32| {
            let place = given.position(n) + work.motion[n as usize];
            let own = (n as usize).checked_sub(nodes.start).and_then(|own| x.get(own));
            own.map_or(place, |x| place + x * (sign * step))
        };
        assembly.contact.evaluate_all(&active.candidates, &position, &mut mortar, &mut moved);
        active.tie(&mut moved, &position);
        for ((moved, contact), r) in moved.iter_mut().zip(&active.contacts).zip(active.all_acting()) {
            moved.carry_frame(&contact.frame);
            moved.add_force(&(r * (-sign / (2.0 * step))), &mut forces);
        }
    }
    x.iter().zip(&forces[nodes]).map(|(x, f)| x.dot(f)).sum()
}

/// Whether a body may be in an equilibrium that is not stable although its iterations have ended: they were held back.
pub(super) fn is_in_question<const D: usize>(body: usize, work: &Iterating<D>) -> bool {
    let is_pressed = !work.contacts.reduced.delassus.stiffened.springs[body].is_empty();
    work.newton.holding[body].was_indefinite || is_pressed && work.bodies[body].hides_softness()
}

/// Refuses the equilibrium that a load step of some `bodies` has come to if one of them is found to give way.
///
/// # Errors
/// [`StepError::Unstable`].
pub(super) fn check<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    for &i in bodies {
        if !is_in_question(i, work) {
            continue;
        }
        let active = &work.contacts.active;
        let contacts = active.contacts.clone();
        let (reactions, friction) = (active.reactions.clone(), active.friction.clone());
        let pressed: Vec<_> =
            contacts.iter().zip(&reactions).zip(friction).map(|((c, r), mu)| (c, r, mu)).collect();
        let at = &reached[given.assembly.nodes(i)];
        let Some(found) = softest(i, at, &pressed, given, reached, work) else { continue };
        let stiffness = found.stiffness + by_reactions(i, &found.field, given, work);
        if stiffness < -ROUND_OFF * found.inertia {
            let giving_way = GivingWay { body: i, motion: found.field };
            let error = giving_way.error(given);
            work.newton.giving_way = Some(giving_way);
            return Err(error);
        }
    }
    Ok(())
}

/// Refuses the guess of a load step at which bodies that touch give way together: an equilibrium, or the last guess before contacts that found none. Their
/// tangents are those of the guess.
///
/// # Errors
/// [`StepError::Unstable`].
pub(super) fn check_together<const D: usize>(
    given: &Given<'_, D>,
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    let Iterating { contacts, motion, bodies, newton, .. } = work;
    contacts.evaluate(given, motion, None, &given.assembly.everyone, bodies);
    let before = contacts.reduced.delassus.stiffened.of_reactions;
    if !contacts.take_stiffness_of_reactions() {
        return Ok(());
    }
    contacts.stiffen(given, motion, bodies, &mut newton.residual);
    let Contacts { active, reduced, .. } = contacts;
    let stiffened = &mut reduced.delassus.stiffened;
    let held = active.reactions.iter().zip(&active.friction).map(|(r, mu)| held_by::<D>(r, *mu));
    let node = stiffened.gives_way(active, held);
    stiffened.of_reactions = before;
    match node.and_then(|n| given.assembly.body_of(n)) {
        Some(body) => Err(GivingWay { body, motion: Vec::new() }.error(given)),
        None => Ok(()),
    }
}

/// Refuses a load step that ends in another equilibrium than the one next to its start: more is missing of the energy than the step was given.
///
/// # Errors
/// [`StepError::Unstable`].
pub(super) fn check_jump<const D: usize>(
    given: &Given<'_, D>,
    report: &StepReport,
    work: &Iterating<D>,
) -> Result<(), StepError> {
    let mut in_question = work.newton.holding.iter().map(|holding| holding.was_indefinite);
    let Some(body) = in_question.position(|was_indefinite| was_indefinite) else { return Ok(()) };
    let ledger = &report.ledger;
    let received = ledger.external.abs() + ledger.prescribed.abs();
    let allowed = received.max(ROUND_OFF * given.state.energies.strain);
    // The step that ends a bridge takes what motion is left, and the last bit of the way.
    let ends_bridge = given.interval.start == given.interval.end;
    if ends_bridge || ledger.scheme <= allowed {
        return Ok(());
    }
    Err(GivingWay { body, motion: Vec::new() }.error(given))
}

/// What it says of a load step that its contact problem was not solved: one whose W is indefinite, with springs where contacts hold, may have several
/// solutions or none. Bodies that hold one another may give way there, which is not proven. Names the body of the contact that moves most.
pub(super) fn indefinite<const D: usize>(given: &Given<'_, D>, work: &Iterating<D>) -> Option<StepError> {
    let problem = work.posed_problem()?.problem;
    let count = problem.q.len();
    if count > MANY {
        return None;
    }
    let mut w = DMatrix::zeros(count * D, count * D);
    for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))) {
        if let Some(block) = problem.w.block(i, j) {
            w.view_mut((i * D, j * D), (D, D)).copy_from(block);
        }
    }
    if !w.iter().all(|x| x.is_finite()) {
        return None;
    }
    let modes = ((&w + w.transpose()) * 0.5).symmetric_eigen();
    let (softest, least) = modes.eigenvalues.argmin();
    if least >= -ROUND_OFF * modes.eigenvalues.amax() {
        return None;
    }
    let contact = modes.eigenvectors.column(softest).iamax() / D;
    let pair = work.contacts.active.candidates.get(contact)?.pair;
    let body = given.assembly.contact.pairs.get(pair as usize).source;
    if given.method.bridges {
        return Some(GivingWay { body, motion: Vec::new() }.error(given));
    }
    Some(StepError::Indefinite { body: given.assembly.name(body).to_string() })
}

/// Why a load step of some `bodies` found no equilibrium, if that is because one of them is about to give way where the step starts.
pub(super) fn about_to_give_way<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    work: &mut Iterating<D>,
) -> Option<StepError> {
    let state = given.state;
    let in_cones: Vec<_> = state.reactions.iter().map(Reaction::in_cone).collect();
    let reactions = state.reactions.iter().zip(&in_cones);
    let pressed: Vec<_> =
        reactions.map(|(r, force)| (&r.contact, force, r.friction(given.assembly))).collect();
    for &i in bodies {
        let is_sprung = work.contacts.reduced.delassus.stiffened.is_sprung[i];
        if !is_in_question(i, work) && !is_sprung {
            continue;
        }
        let nodes = given.assembly.nodes(i);
        let undeformed = vec![Vector::zeros(); nodes.len()];
        let at = &state.displacement[nodes];
        let Some(now) = softest(i, at, &pressed, given, &state.displacement, work) else { continue };
        let Some(first) = softest(i, &undeformed, &pressed, given, &state.displacement, work) else {
            continue;
        };
        if now.resistance() <= NEAR * first.resistance() {
            let giving_way = GivingWay { body: i, motion: now.field };
            let error = giving_way.error(given);
            work.newton.giving_way = Some(giving_way);
            return Some(error);
        }
    }
    None
}
