//! The end of a step: the new state, and what happened to the energy.

use carom_contact::{Candidate, Contact, shares};
use carom_friction::cone;
use carom_mesh::{Vector, nodal};

use crate::body::fe::drive::{load_body, support_work};
use crate::body::fe::equation::BodyStep;
use crate::contact::solve::{driven, measure_rubbing};
use crate::error::StepError;
use crate::ledger::BodyLedger;
use crate::model::state::{Reaction, State};
use crate::step::workspace::{GroupReport, StepReport, Workspace};
use crate::{Energies, Method, Model, StepMap};

/// Completes the new state and closes the books of the step.
pub(crate) fn commit<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    newton_iterations: usize,
) -> Result<StepReport, StepError> {
    let mut report = StepReport { newton_iterations, min_gap: f64::INFINITY, ..StepReport::default() };
    next.time = state.time + map.dt;
    keep_contacts(model, method, next, map, work, &mut report);
    if method.is_blended() {
        report.blend = work.blend.largest_weight();
    }
    let nodes = model.node_count();
    for (v, motion) in next.velocity[nodes..].iter_mut().zip(&model.obstacle_motions) {
        *v = motion.velocity(next.time);
    }
    next.support.fill(Vector::zeros());
    for i in 0..model.bodies.len() {
        close_body(model, method, state, next, map, work, i);
    }
    next.energies = next.body_energies.iter().copied().sum();
    close_contacts(model, method, state, next, map, work, &mut report);
    for body in &work.bodies {
        report.ledger.kinetic += body.kinetic;
        report.ledger.strain += body.strain;
        report.ledger.external += body.external;
        report.ledger.prescribed += body.prescribed;
        report.ledger.viscous += body.viscous;
        report.ledger.plastic += body.plastic;
        report.ledger.scheme += body.scheme;
    }
    for group in &work.groups {
        report.ledger.friction += group.ledger.friction;
        report.ledger.normal_contact += group.ledger.normal_contact;
        report.ledger.prescribed += group.ledger.prescribed;
        report.normal_force += group.normal_force;
    }
    if !next.is_finite() {
        return Err(StepError::NotFinite("state"));
    }
    // What is largest or smallest of a run does not see what is not a number.
    if report.is_finite() { Ok(report) } else { Err(StepError::NotFinite("account of the step")) }
}

/// Measures the contact law at the final motion and keeps the reactions in the state.
fn keep_contacts<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    next.reactions.clear();
    next.contact_force.fill(Vector::zeros());
    if work.contacts.is_empty() {
        return;
    }
    let weight = method.condition.reaction_weight(map);
    let measure = carom_friction::measure(&work.problem, &work.reactions);
    report.residual = measure.natural_residual;
    report.solver_certificate = measure.certificate / weight;
    let end = |n: u32| model.reference[n as usize] + next.displacement[n as usize];
    model.contact.evaluate_all(&work.candidates, &end, &mut work.mortar, &mut work.end_contacts);
    for contact in &work.end_contacts {
        report.min_gap = report.min_gap.min(contact.gap);
    }
    for (i, (candidate, contact)) in work.candidates.iter().zip(&work.contacts).enumerate() {
        let r = work.reactions[i] / weight;
        let mut w = contact.relative(|n| work.motion[n]);
        w[0] += work.offsets[i];
        report.certificate += cone::bipotential_gap(&w, &r, work.friction[i]);
        report.reaction_work += r.dot(&work.problem.q[i]).abs();
        contact.add_force(&r, &mut next.contact_force);
        if r[0] > 0.0 {
            report.contacts += 1;
            let Candidate { pair, site, .. } = *candidate;
            next.reactions.push(Reaction { pair, site, contact: contact.clone(), force: r });
        }
    }
}

/// Completes the state of body `index` and closes its books.
fn close_body<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    index: usize,
) {
    let b = &model.bodies[index];
    let nodes = b.nodes();
    load_body(model, state, next, map, work, index);
    let drive = &work.drives[index];
    let step =
        BodyStep::new(model, index, map, &work.poses[index], drive, state, &work.motion, &next.displacement);
    let scratch = &mut work.residual_scratch[index];
    let (v0, v1) = (&state.velocity[nodes.clone()], &mut next.velocity[nodes.clone()]);
    step.end_velocity(v1);
    let internal_force = &mut next.internal_force[nodes.clone()];
    let mut elastic = None;
    let exchanged = if method.is_blended() {
        work.blend.measure(model, index, &step, scratch);
        internal_force.copy_from_slice(&work.blend.end[nodes.clone()]);
        Some(work.blend.exchanged(index))
    } else {
        // After plastic flow the stored energy is another: that of the new history.
        let energy = step.worked.internal_force_and_energy(step.displacement, internal_force);
        elastic = step.worked.is_virgin().then_some(energy);
        None
    };
    let held = b.body.held();
    let weights = method.contact_weights(map);
    let mut prescribed = 0.0;
    if !held.is_empty() {
        let residual = &mut work.residual[nodes.clone()];
        if method.is_blended() {
            work.blend.residual(model, index, &step, scratch, residual);
        } else {
            step.residual(scratch, residual);
        }
        let (change, product) = (&mut work.correction[nodes.clone()], &mut work.momentum[nodes.clone()]);
        change.iter_mut().zip(&*v1).zip(v0).for_each(|((c, v1), v0)| *c = v1 - v0);
        b.body.mass().multiply(change, product);
        prescribed = support_work(&step, &drive.rates, residual, product);
        for (dof, driver) in held.dofs().iter().zip(model.drivers(index)) {
            let Some(k) = driver else { continue };
            let (n, i) = (dof.node as usize, dof.component as usize);
            let contact =
                weights[0] * step.contact_force[n][i] + weights[1] * next.contact_force[b.first_node + n][i];
            next.support[k][i] -= residual[n][i] + contact;
        }
    }
    let momentum = &mut work.momentum[nodes.clone()];
    b.body.mass().multiply(v1, momentum);
    let history = &mut next.history[index];
    let plastic = step.worked.update(step.displacement, history);
    let strain = elastic.unwrap_or_else(|| b.body.after(history).strain_energy(step.displacement));
    let energies = Energies { kinetic: 0.5 * nodal::dot(v1, momentum), strain };
    let (external, viscous) = step.external_and_viscous_work(scratch);
    let mut scheme = 0.0;
    if map.kinetic_dissipation != 0.0 {
        let jump = &mut work.correction[nodes.clone()];
        jump.iter_mut().zip(&*v1).zip(v0).for_each(|((j, v1), v0)| *j = v1 - v0);
        b.body.mass().multiply(jump, momentum);
        // What is held moves as prescribed, not as the scheme would have it.
        held.clear(jump);
        scheme += map.kinetic_dissipation * nodal::dot(jump, momentum);
    }
    if map.strain_dissipation != 0.0 {
        let start = &state.internal_force[nodes.clone()];
        scheme += map.strain_dissipation
            * (nodal::dot(step.motion, internal_force) - nodal::dot(step.motion, start));
    }
    let contact = exchanged.unwrap_or_else(|| {
        let work_of = |force: &[Vector<D>]| nodal::dot(step.motion, force) - held.dot(step.motion, force);
        weights[0] * work_of(step.contact_force) + weights[1] * work_of(&next.contact_force[nodes.clone()])
    });
    if exchanged.is_none() {
        let ends = [step.contact_force, &next.contact_force[nodes.clone()]];
        scheme += step.static_balance_work(ends, &next.internal_force[nodes], scratch.viscous());
    }
    let before = state.body_energies[index];
    work.bodies[index] = BodyLedger {
        kinetic: energies.kinetic - before.kinetic,
        strain: energies.strain - before.strain,
        external,
        prescribed,
        viscous,
        plastic,
        scheme,
        contact,
    };
    next.body_energies[index] = energies;
}

/// Books the work of the reactions of every group.
fn close_contacts<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    work.groups.fill(GroupReport::default());
    for reaction in &next.reactions {
        let group = model.contact.pairs[reaction.pair as usize].group;
        work.groups[group].normal_force += reaction.force[0];
        work.groups[group].ledger.has_touched = true;
    }
    next.slip.copy_from_slice(&state.slip);
    add_slip(model, next, work);
    next.friction_energy.copy_from_slice(&state.friction_energy);
    let mut book = |group: &mut GroupReport, contact: &Contact<D>, dissipation: f64| {
        group.ledger.friction += dissipation;
        report.least_friction = report.least_friction.min(dissipation);
        deposit(model, contact, dissipation, &mut next.friction_energy);
    };
    if method.is_blended() {
        // The blend returns what normal reactions take, so there is nothing to book for them.
        measure_rubbing(model, method, state, map, work);
        let lost = work.lost.iter().map(|&k| &state.reactions[k].contact);
        for (c, contact) in work.rubbing.iter().zip(work.contacts.iter().chain(lost)) {
            let weight = work.blend.weight[c.source];
            work.groups[c.group].ledger.prescribed += c.prescribed(weight);
            book(&mut work.groups[c.group], contact, c.dissipation(weight));
        }
        next.excess.copy_from_slice(&state.excess);
        let surplus = work
            .bodies
            .iter()
            .map(|b| b.kinetic + b.strain + b.viscous + b.plastic - b.external - b.prescribed);
        work.blend.carry(surplus, &work.rubbing, &mut next.excess);
        return;
    }
    let [start, end] = method.contact_weights(map);
    for (reactions, share) in [(&state.reactions, start), (&next.reactions, end)] {
        if share == 0.0 {
            continue;
        }
        for reaction in reactions {
            let motion = reaction.contact.relative(|n| work.motion[n]);
            let group = &mut work.groups[model.contact.pairs[reaction.pair as usize].group];
            group.ledger.normal_contact -= share * reaction.force[0] * motion[0];
            group.ledger.prescribed +=
                share * driven(model, &reaction.contact, &reaction.force, &work.motion);
            let dissipation = -share * (1..D).map(|t| reaction.force[t] * motion[t]).sum::<f64>();
            book(group, &reaction.contact, dissipation);
        }
    }
}

/// Adds to the slip of every node how far it has slid in the step along what presses on it at the end.
fn add_slip<const D: usize>(model: &Model<D>, next: &mut State<D>, work: &mut Workspace<D>) {
    let nodes = |contact: &Contact<D>, visit: &mut dyn FnMut(usize, f64)| {
        contact.sources().chain(contact.targets()).for_each(|(node, weight)| {
            if node < model.node_count() {
                visit(node, weight.abs());
            }
        });
    };
    for reaction in next.reactions.iter().filter(|r| r.force[0] > 0.0) {
        let motion = reaction.contact.relative(|n| work.motion[n]);
        let distance = (1..D).map(|t| motion[t] * motion[t]).sum::<f64>().sqrt();
        nodes(&reaction.contact, &mut |node, weight| {
            work.slid[node][0] += weight;
            work.slid[node][1] += weight * distance;
        });
    }
    let slip = &mut next.slip;
    for reaction in next.reactions.iter().filter(|r| r.force[0] > 0.0) {
        nodes(&reaction.contact, &mut |node, _| {
            let [weight, distance] = std::mem::take(&mut work.slid[node]);
            if weight > 0.0 {
                slip[node] += distance / weight;
            }
        });
    }
}

/// Leaves the energy that friction takes at a contact to its nodes: half to the source, half to those of a deformable target.
fn deposit<const D: usize>(model: &Model<D>, contact: &Contact<D>, energy: f64, nodes: &mut [f64]) {
    let targets = contact.targets().filter(|&(node, _)| node < model.node_count());
    let to_target = if targets.clone().next().is_some() { 0.5 * energy } else { 0.0 };
    shares(contact.sources()).for_each(|(node, share)| nodes[node] += (energy - to_target) * share);
    shares(targets).for_each(|(node, share)| nodes[node] += to_target * share);
}
