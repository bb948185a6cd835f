//! One step: predict, detect, then linearise, condense, solve and correct until converged, and commit.

use carom_contact::Candidate;
use carom_friction::cone;
use carom_mesh::Vector;

use crate::condense::condense;
use crate::error::StepError;
use crate::linearise::{BodyStep, predicted_motion};
use crate::state::{Reaction, State, dot};
use crate::workspace::{BodyProgress, GroupReport, StepReport, Workspace};
use crate::{ContactCondition, Energies, Ledger, Method, Model, StepMap};

/// Margin of the contact search, in largest predicted motions of a node in the step.
const SEARCH_MARGIN: f64 = 2.0;
/// How often a step is repeated with a wider search where a node came into contact unforeseen.
const MAX_SEARCHES: usize = 4;
/// Corrections below this multiple of the size of the model's coordinates are round-off.
const ROUND_OFF: f64 = 4.0 * f64::EPSILON;
/// A factor is renewed within a step when iterations converge slower than this, from iteration `PATIENCE` on.
const SLOW_CONTRACTION: f64 = 0.3;
/// See `SLOW_CONTRACTION`.
const PATIENCE: usize = 6;

/// Takes `state` one step of length `dt` [s] further and writes the result to `next`.
///
/// # Errors
/// If the iterations or the friction solver do not converge, a matrix is not positive definite, or a number is not finite.
/// `state` is never written; after an error `next` holds nothing of use.
pub fn step<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    dt: f64,
    work: &mut Workspace<D>,
) -> Result<StepReport, StepError> {
    let map = method.scheme.step_map(dt);
    predict(model, state, &map, work)?;
    let motion = predicted_motion(state, &model.gravity, dt);
    let mut margin = SEARCH_MARGIN * motion;
    let mut iterations = 0;
    for _ in 0..MAX_SEARCHES {
        search(model, state, margin, work);
        iterations += iterate(model, method, state, next, &map, motion, work)?;
        if !missed_a_contact(model, method, next, work) {
            return commit(model, state, next, &map, work, iterations);
        }
        margin *= 4.0;
    }
    Err(StepError::MissedContact { margin: margin / 4.0 })
}

/// The start of the iterations: free flight, d = Δt v; the frame of every body and a factor that fits the step.
fn predict<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    for (d, v) in work.motion.iter_mut().zip(&state.velocity) {
        *d = v * map.dt;
    }
    for (i, b) in model.bodies.iter().enumerate() {
        let nodes = b.nodes();
        let middle = &mut work.correction[nodes.clone()];
        for ((m, u), d) in middle.iter_mut().zip(&state.displacement[nodes.clone()]).zip(&work.motion[nodes])
        {
            *m = u + d * 0.5;
        }
        work.frames[i] = b.body.frame(middle);
        if !work.operators[i].fits(map) {
            work.operators[i].factorize(&b.body, map, middle, &work.frames[i])?;
            work.factorisations += 1;
        }
        work.operators[i].turn_to(&work.frames[i]);
    }
    Ok(())
}

/// Finds the candidates of the step between its start and the predicted end.
fn search<const D: usize>(model: &Model<D>, state: &State<D>, margin: f64, work: &mut Workspace<D>) {
    let start = |n: u32| model.reference[n as usize] + state.displacement[n as usize];
    let motion = &work.motion;
    let end = |n: u32| start(n) + motion[n as usize];
    model.contact.detect(&start, &end, margin, &mut work.candidates);
}

/// Newton's iterations with a kept factor; returns how many were made. Writes u₊ to `next` and d to `work`.
fn iterate<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    predicted: f64,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    select_active(model, method, state, work);
    work.progress.fill(BodyProgress::default());
    for ((u1, u0), d) in next.displacement.iter_mut().zip(&state.displacement).zip(&work.motion) {
        *u1 = u0 + d;
    }
    for iteration in 1.. {
        residuals(model, state, next, map, work);
        react(model, method, state, map, work)?;
        let motion = correct(model, state, next, work)?;
        let wanted = (method.newton.tolerance * motion.max(predicted)).max(ROUND_OFF * model.size);
        if settle(work, wanted) {
            return Ok(iteration);
        }
        let slowest = work.progress.iter().filter(|p| !p.settled);
        if iteration >= method.newton.max_iterations {
            let correction = slowest.map(|p| p.correction).fold(0.0, f64::max);
            return Err(StepError::Newton { iterations: iteration, correction, wanted });
        }
        if iteration >= PATIENCE && slowest.map(|p| p.contraction).fold(0.0, f64::max) > SLOW_CONTRACTION {
            refactorize(model, state, next, map, work)?;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Marks the bodies that have converged and says whether all have. Bodies in contact depend on one another and settle together.
fn settle<const D: usize>(work: &mut Workspace<D>, wanted: f64) -> bool {
    // A correction this small, or one after which the next will surely be.
    let converged =
        |p: &BodyProgress| p.correction <= wanted || p.correction * (10.0 * p.contraction).min(1.0) <= wanted;
    let in_contact = |(p, &touched): (&BodyProgress, &bool)| !touched || p.settled || converged(p);
    let contact_converged = work.progress.iter().zip(&work.touched).all(in_contact);
    for (p, &touched) in work.progress.iter_mut().zip(&work.touched) {
        p.settled |= if touched { contact_converged } else { converged(p) };
    }
    work.progress.iter().all(|p| p.settled)
}

/// Keeps the candidates that take part in the step and recalls their last reactions.
fn select_active<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    work: &mut Workspace<D>,
) {
    let start = |n: u32| model.reference[n as usize] + state.displacement[n as usize];
    let contact = &model.contact;
    work.searched.clear();
    work.searched.extend(work.candidates.iter().map(|c| (c.pair, c.node)));
    work.start_gaps.clear();
    work.candidates.retain(|c| {
        let gap = contact.evaluate(c, &start).gap;
        let active = !c.mirrored && method.condition.is_active(gap);
        if active {
            work.start_gaps.push(if contact.is_two_sided(c.pair as usize) { gap.min(0.0) } else { 0.0 });
        }
        active
    });
    work.reactions.clear();
    work.friction.clear();
    work.touched.fill(false);
    for candidate in &work.candidates {
        let known = state.reactions.binary_search_by_key(&(candidate.pair, candidate.node), Reaction::key);
        work.reactions.push(known.map_or_else(|_| Vector::zeros(), |k| state.reactions[k].force));
        let pair = &contact.pairs[candidate.pair as usize];
        work.friction.push(pair.friction);
        work.touched[pair.source] = true;
        if let carom_contact::Target::Surface(target) = pair.target {
            work.touched[target] = true;
        }
    }
}

/// Residuals without reactions, and from them the corrections without reactions, of the bodies that still move.
fn residuals<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    for (i, b) in model.bodies.iter().enumerate() {
        if work.progress[i].settled {
            continue;
        }
        let nodes = b.nodes();
        let body_step =
            BodyStep::new(model, b, map, &work.frames[i], state, &work.motion, &next.displacement);
        let residual = &mut work.residual[nodes.clone()];
        body_step.residual(&mut work.residual_scratch[i], residual);
        work.correction[nodes.clone()].copy_from_slice(residual);
        work.operators[i].solve(&mut work.correction[nodes]);
    }
}

/// Solves the reduced problem of the contacts and adds the effect of their reactions to the corrections.
fn react<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    if work.candidates.is_empty() {
        work.contacts.clear();
        return Ok(());
    }
    // The bodies in contact settle together; while others still move, these keep their reactions.
    if work.progress.iter().zip(&work.touched).any(|(p, &touched)| touched && p.settled) {
        return Ok(());
    }
    let weight = method.condition.evaluation_weight();
    let motion = &work.motion;
    let position = |n: u32| {
        let n = n as usize;
        model.reference[n] + state.displacement[n] + motion[n] * weight
    };
    work.contacts.clear();
    work.contacts.extend(work.candidates.iter().map(|c| model.contact.evaluate(c, &position)));
    work.offsets.clear();
    work.offsets.extend(work.contacts.iter().zip(&work.start_gaps).map(|(contact, &kept)| {
        method.condition.normal_offset(contact, kept, map, |n| motion[n], |n| state.velocity[n])
    }));
    // The motion without reactions is d plus the correction; `momentum` is free here and holds it.
    for ((free, d), c) in work.momentum.iter_mut().zip(&work.motion).zip(&work.correction) {
        *free = d + c;
    }
    condense(
        model,
        &mut work.operators,
        &mut work.compliances,
        &work.contacts,
        &work.friction,
        &work.offsets,
        &work.momentum,
        &mut work.problem,
    );
    let report = method.solver.solve(&work.problem, &mut work.reactions, &method.stopping);
    if !report.is_converged() {
        return Err(StepError::Friction { contacts: work.contacts.len(), report });
    }
    // r as an external load: a second solve for the bodies in contact.
    for (contact, r) in work.contacts.iter().zip(&work.reactions) {
        contact.add_force(r, &mut work.residual);
    }
    for (i, b) in model.bodies.iter().enumerate().filter(|&(i, _)| work.touched[i]) {
        let nodes = b.nodes();
        work.correction[nodes.clone()].copy_from_slice(&work.residual[nodes.clone()]);
        work.operators[i].solve(&mut work.correction[nodes]);
    }
    Ok(())
}

/// Applies the corrections; returns the largest motion of a node in the step so far [m].
fn correct<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<f64, StepError> {
    let mut motion: f64 = 0.0;
    for (i, b) in model.bodies.iter().enumerate() {
        if work.progress[i].settled {
            continue;
        }
        let mut correction: f64 = 0.0;
        let mut sum = 0.0;
        for n in b.nodes() {
            work.motion[n] += work.correction[n];
            next.displacement[n] = state.displacement[n] + work.motion[n];
            correction = correction.max(work.correction[n].amax());
            motion = motion.max(work.motion[n].amax());
            sum += work.correction[n].sum();
        }
        // `max` ignores NaN, a sum does not.
        if !sum.is_finite() {
            return Err(StepError::NotFinite("displacement"));
        }
        work.progress[i].note(correction);
    }
    Ok(motion)
}

/// Renews the factors of the bodies that still move, at the present guess.
fn refactorize<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    for (i, b) in model.bodies.iter().enumerate().filter(|&(i, _)| !work.progress[i].settled) {
        let nodes = b.nodes();
        let middle = &mut work.correction[nodes.clone()];
        for ((m, u0), u1) in
            middle.iter_mut().zip(&state.displacement[nodes.clone()]).zip(&next.displacement[nodes])
        {
            *m = (u0 + u1) * 0.5;
        }
        work.operators[i].factorize(&b.body, map, middle, &work.frames[i])?;
        work.factorisations += 1;
    }
    Ok(())
}

/// Whether a node that the search did not find has gone through its target by the end of the step.
///
/// Only where the condition is written there: the others choose their contacts at the start.
fn missed_a_contact<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    next: &State<D>,
    work: &mut Workspace<D>,
) -> bool {
    if method.condition != ContactCondition::Gap {
        return false;
    }
    let end = |n: u32| model.reference[n as usize] + next.displacement[n as usize];
    model.contact.detect(&end, &end, 0.0, &mut work.missed);
    work.missed.iter().any(|m| {
        let known = work.searched.binary_search(&(m.pair, m.node)).is_ok();
        !known && model.contact.evaluate(m, &end).gap < -ROUND_OFF * model.size
    })
}

/// Completes the new state and closes the books of the step.
fn commit<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    newton_iterations: usize,
) -> Result<StepReport, StepError> {
    let mut report = StepReport { newton_iterations, min_gap: f64::INFINITY, ..StepReport::default() };
    next.time = state.time + map.dt;
    for ((v1, v0), d) in next.velocity.iter_mut().zip(&state.velocity).zip(&work.motion) {
        *v1 = map.end_velocity(v0, d);
    }
    next.energies = Energies::default();
    for (i, b) in model.bodies.iter().enumerate() {
        let nodes = b.nodes();
        let (v0, v1) = (&state.velocity[nodes.clone()], &next.velocity[nodes.clone()]);
        let motion = &work.motion[nodes.clone()];
        b.body.internal_force(&next.displacement[nodes.clone()], &mut next.internal_force[nodes.clone()]);
        b.body.mass().multiply(v1, &mut work.momentum[nodes.clone()]);
        next.energies.kinetic += 0.5 * dot(v1, &work.momentum[nodes.clone()]);
        next.energies.strain += b.body.strain_energy(&next.displacement[nodes.clone()]);
        if map.kinetic_dissipation != 0.0 {
            let jump = &mut work.correction[nodes.clone()];
            jump.iter_mut().zip(v1).zip(v0).for_each(|((j, v1), v0)| *j = v1 - v0);
            b.body.mass().multiply(jump, &mut work.residual[nodes.clone()]);
            report.ledger.scheme +=
                map.kinetic_dissipation * dot(&work.correction[nodes.clone()], &work.residual[nodes.clone()]);
        }
        if map.strain_dissipation != 0.0 {
            let (f0, f1) = (&state.internal_force[nodes.clone()], &next.internal_force[nodes.clone()]);
            report.ledger.scheme += map.strain_dissipation * (dot(motion, f1) - dot(motion, f0));
        }
        let body_step =
            BodyStep::new(model, b, map, &work.frames[i], state, &work.motion, &next.displacement);
        let (external, viscous) = body_step.external_and_viscous_work(&mut work.residual_scratch[i]);
        report.ledger.external += external;
        report.ledger.viscous += viscous;
    }
    settle_contacts(model, next, work, &mut report);
    report.ledger = Ledger {
        kinetic: next.energies.kinetic - state.energies.kinetic,
        strain: next.energies.strain - state.energies.strain,
        ..report.ledger
    };
    if next.is_finite() { Ok(report) } else { Err(StepError::NotFinite("state")) }
}

/// Measures the contact law at the final motion, books the work of the reactions and keeps them in the state.
fn settle_contacts<const D: usize>(
    model: &Model<D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    work.groups.fill(GroupReport::default());
    next.reactions.clear();
    next.contact_force.fill(Vector::zeros());
    if work.contacts.is_empty() {
        return;
    }
    report.residual = carom_friction::measure(&work.problem, &work.reactions).residual;
    let end = |n: u32| model.reference[n as usize] + next.displacement[n as usize];
    for (i, (candidate, contact)) in work.candidates.iter().zip(&work.contacts).enumerate() {
        let r = &work.reactions[i];
        let motion = contact.relative(|n| work.motion[n]);
        let mut w = motion;
        w[0] += work.offsets[i];
        report.certificate += cone::bipotential_gap(&w, r, work.friction[i]);
        let friction_work = -(1..D).map(|t| r[t] * motion[t]).sum::<f64>();
        report.ledger.friction += friction_work;
        report.ledger.normal_contact -= r[0] * motion[0];
        report.normal_force += r[0];
        report.contacts += usize::from(r[0] > 0.0);
        report.min_gap = report.min_gap.min(model.contact.evaluate(candidate, &end).gap);
        let group = &mut work.groups[model.contact.pairs[candidate.pair as usize].group];
        group.normal_force += r[0];
        group.friction_work += friction_work;
        contact.add_force(r, &mut next.contact_force);
        if r[0] > 0.0 {
            let Candidate { pair, node, .. } = *candidate;
            next.reactions.push(Reaction { pair, node, contact: *contact, force: *r });
        }
    }
}
