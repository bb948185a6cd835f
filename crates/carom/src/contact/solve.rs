//! The contacts at the present guess, and their reactions.

use carom_contact::Contact;
use carom_friction::{ContactProblem, StoppingRule};
use carom_mesh::Vector;

use crate::contact::delassus::condense;
use crate::error::StepError;
use crate::model::state::State;
use crate::step::blend::Rubbing;
use crate::step::workspace::Workspace;
use crate::{Method, Model, StepMap};

/// Evaluates the contacts where the condition is written, in frames that follow those before: reactions are known in these.
pub(crate) fn evaluate_contacts<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    work: &mut Workspace<D>,
) {
    let weight = method.condition.evaluation_weight();
    let motion = &work.motion;
    let position = |n: u32| {
        let n = n as usize;
        model.reference[n] + state.displacement[n] + motion[n] * weight
    };
    model.contact.evaluate_all(&work.candidates, &position, &mut work.mortar, &mut work.contacts);
    for (contact, frame) in work.contacts.iter_mut().zip(&mut work.frames) {
        contact.carry_frame(frame);
        *frame = contact.frame;
    }
}

/// Work [J] that prescribed motion does through a contact with the reaction `r`: of an obstacle that moves, and of what supports
/// hold of the nodes around.
pub(crate) fn driven<const D: usize>(
    model: &Model<D>,
    contact: &Contact<D>,
    r: &Vector<D>,
    motion: &[Vector<D>],
) -> f64 {
    let travel = contact.stencil().fold(Vector::zeros(), |sum: Vector<D>, (node, weight)| {
        sum - model.prescribed_part(node, &motion[node]) * weight
    });
    r.dot(&(contact.frame * travel))
}

/// What the contacts mean for the balance of their bodies: those of the step, and those that it starts with and loses.
pub(crate) fn measure_rubbing<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    let motion = &work.motion;
    let weight = method.condition.reaction_weight(map);
    let rubbing = |pair: u32, contact: &Contact<D>, start: Vector<D>, end: Vector<D>| {
        let pair = &model.contact.pairs[pair as usize];
        let w = contact.relative(|n| motion[n]);
        let driven = [start, end].map(|r| driven(model, contact, &r, motion));
        Rubbing {
            group: pair.group,
            source: pair.source,
            target: pair.target,
            friction: pair.friction,
            start: start[0],
            end: end[0],
            slip: (1..D).map(|t| w[t] * w[t]).sum::<f64>().sqrt(),
            driven,
        }
    };
    work.rubbing.clear();
    for (k, contact) in work.contacts.iter().enumerate() {
        let (start, end) = (work.start_forces[k], work.reactions[k] / weight);
        work.rubbing.push(rubbing(work.candidates[k].pair, contact, start, end));
    }
    for reaction in work.lost.iter().map(|&k| &state.reactions[k]) {
        work.rubbing.push(rubbing(reaction.pair, &reaction.contact, reaction.force, Vector::zeros()));
    }
}

/// Gets the bodies ready to respond at the nodes of the contacts: their compliance there, and the reach of these nodes.
pub(crate) fn prepare_contacts<const D: usize>(model: &Model<D>, map: &StepMap, work: &mut Workspace<D>) {
    work.contact_nodes.iter_mut().for_each(Vec::clear);
    for contact in &work.contacts {
        for (node, _) in contact.stencil() {
            // The motion of obstacles is prescribed: they do not respond.
            let Some(b) = model.body_of(node) else { continue };
            work.contact_nodes[b].push((node - model.bodies[b].first_node) as u32);
        }
    }
    for (((nodes, operator), compliance), b) in
        work.contact_nodes.iter_mut().zip(&mut work.operators).zip(&mut work.compliances).zip(&model.bodies)
    {
        if nodes.is_empty() {
            continue;
        }
        nodes.sort_unstable();
        nodes.dedup();
        compliance.prepare(&b.body, operator, nodes, map.is_static());
        operator.set_reach(nodes.iter().map(|&node| node as usize));
    }
}

/// No contact problem is solved more loosely than this.
const LOOSEST: f64 = 1e-4;

/// The tolerance of a contact problem whose motions may be wrong by `error` [m], which is what natural residuals are of the larger of q
/// and, by the natural stiffness, r; at least that which is asked for.
fn tolerance<const D: usize>(
    problem: &ContactProblem<D>,
    reactions: &[Vector<D>],
    error: f64,
    least: f64,
) -> f64 {
    if error == 0.0 {
        return least;
    }
    let squares = |vectors: &[Vector<D>]| vectors.iter().map(Vector::norm_squared).sum::<f64>();
    let size = squares(&problem.q).max(squares(reactions) / problem.natural_stiffness().powi(2));
    (error * (problem.q.len() as f64 / size).sqrt()).min(LOOSEST).max(least)
}

/// Solves the reduced problem of the contacts, so that their motions are wrong by about `error` [m] if that is not zero, while the bodies in
/// contact are between [`BodyOperator::begin`] and [`BodyOperator::end`], and gives them the change of the reactions.
///
/// [`BodyOperator::begin`]: crate::body::fe::operator::BodyOperator::begin
/// [`BodyOperator::end`]: crate::body::fe::operator::BodyOperator::end
pub(crate) fn react<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    error: f64,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    let motion = &work.motion;
    work.offsets.clear();
    work.offsets.extend(work.contacts.iter().zip(&work.start_gaps).map(|(contact, &kept)| {
        method.condition.normal_offset(contact, kept, map, |n| motion[n], |n| state.velocity[n])
    }));
    // The motion with the reactions known so far, at the nodes of contacts.
    let obstacles = model.node_count()..;
    work.momentum[obstacles.clone()].copy_from_slice(&work.motion[obstacles]);
    for ((b, nodes), operator) in model.bodies.iter().zip(&work.contact_nodes).zip(&mut work.operators) {
        if nodes.is_empty() {
            continue;
        }
        operator.look();
        for node in nodes.iter().map(|&node| node as usize) {
            let n = b.first_node + node;
            work.momentum[n] = work.motion[n] + operator.seen(node);
        }
    }
    condense(
        model,
        &work.operators,
        &work.compliances,
        &work.contacts,
        &work.friction,
        &work.offsets,
        &work.momentum,
        &work.reactions,
        &mut work.coupling,
        &mut work.row_blocks,
        &mut work.problem,
    );
    work.guess.clone_from(&work.reactions);
    let tolerance = tolerance(&work.problem, &work.reactions, error, method.stopping.tolerance);
    let stopping = StoppingRule { tolerance, ..method.stopping };
    let report = method.solver.solve(&work.problem, &mut work.reactions, &stopping);
    work.solved_by = report.solver;
    work.friction_time += report.time;
    if !report.is_solved() {
        let q = &work.problem.q;
        return Err(if q.iter().all(|q| q.iter().all(|x| x.is_finite())) {
            StepError::Friction { contacts: q.len(), report: Box::new(report) }
        } else {
            StepError::NotFinite("free motion of the contacts")
        });
    }
    // The change of the reactions as an external load; `momentum` is free again.
    for (b, nodes) in model.bodies.iter().zip(&work.contact_nodes) {
        nodes.iter().for_each(|&node| work.momentum[b.first_node + node as usize] = Vector::zeros());
    }
    for ((contact, r), before) in work.contacts.iter().zip(&work.reactions).zip(&work.guess) {
        contact.add_force(&(r - before), &mut work.momentum);
    }
    for ((b, nodes), operator) in model.bodies.iter().zip(&work.contact_nodes).zip(&mut work.operators) {
        if !nodes.is_empty() {
            let force = &work.momentum[b.nodes()];
            operator.add(nodes.iter().map(|&node| (node as usize, force[node as usize])));
        }
    }
    Ok(())
}
