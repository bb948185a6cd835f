//! The end of a step: the new state, and what happened to the energy.

use carom_contact::{Contact, Solid, shares};
use carom_fem::material::PlasticState;
use carom_mesh::Vector;

use super::iterating::Iterating;
use super::landing::{Landing, restore, rubbed};
use super::repaying::repay;
use super::report::{PairReport, StepReport};
use super::resting::Resting;
use super::settling::settle;
use super::workspace::Workspace;
use crate::body::{Body, BodyEnd};
use crate::contact::Contacts;
use crate::contact::closing::{for_each_work, keep};
use crate::error::StepError;
use crate::ledger::{BodyLedger, Energies};
use crate::model::assembly::Assembly;
use crate::model::each_body::{PerBody, PerNode, each_body, each_body_in_turn};
use crate::model::given::Given;
use crate::model::sliding::remember;
use crate::model::state::{Reaction, State};

/// What a body writes at the end of a step.
type Own<'a, const D: usize> = (
    PerBody<'a, Box<dyn Body<D>>>,
    (PerNode<'a, Vector<D>>, PerNode<'a, Vector<D>>),
    (PerBody<'a, Vec<PlasticState>>, (PerBody<'a, BodyLedger>, PerBody<'a, Energies>)),
);

/// Completes the new state and closes the books of the step.
pub(super) fn commit<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    newton_iterations: usize,
) -> Result<StepReport, StepError> {
    let Given { assembly, interval, .. } = *given;
    let mut report = StepReport {
        newton_iterations,
        min_gap: f64::INFINITY,
        free_motion: work.iterating.newton.free_motion,
        ..StepReport::default()
    };
    next.time = interval.end;
    if work.iterating.contacts.active.unsettled > 0.0 {
        return Err(StepError::FrictionUnsettled { off: work.iterating.contacts.active.unsettled });
    }
    keep_contacts(given, next, work, &mut report);
    if interval.is_blended {
        work.resting.resting().for_each(|i| work.iterating.blend.rest(i));
        report.onset = work.iterating.blend.onset();
        report.blend = work.iterating.blend.largest_weight();
    }
    let obstacles = &mut next.velocity[assembly.node_count()..];
    for (v, motion) in obstacles.iter_mut().zip(&assembly.obstacle_motions) {
        *v = motion.velocity(next.time);
    }
    next.support.fill(Vector::zeros());
    work.springs.pull(given, &work.iterating.motion, &next.displacement);
    close_bodies(given, next, work);
    work.springs.close(&mut work.body_ledgers);
    work.pair_reports.clear();
    let Workspace { iterating: Iterating { bodies, contacts, motion, .. }, impulses, body_ledgers, .. } =
        work;
    let (active, at_end) = (&contacts.active, &contacts.at_end);
    let landing = Landing { active, at_end, motion, masses: bodies.as_mut_slice(), ledgers: body_ledgers };
    restore(given, next, landing, impulses);
    settle(given, next, work);
    next.sum_energies(assembly);
    close_contacts(given, next, work, &mut report);
    repay(given, next, work, &mut report);
    book_impulses(given, next, work, &mut report);
    report.contacts -= work.impulses.arriving.len();
    for body in &work.body_ledgers {
        report.ledger.add_body(body);
    }
    work.springs.add_to(&mut report.ledger);
    for pair in work.pair_reports.values() {
        report.ledger.add_pair(&pair.ledger);
        report.normal_force += pair.normal_force;
    }
    if !next.is_finite(assembly) {
        return Err(StepError::NotFinite("state"));
    }
    // What is largest or smallest of a run does not see what is not a number.
    if report.is_finite() { Ok(report) } else { Err(StepError::NotFinite("account of the step")) }
}

/// Measures the contact law at the final motion and keeps the reactions in the state.
fn keep_contacts<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    let Workspace { iterating: Iterating { contacts, motion, .. }, resting, .. } = work;
    if contacts.active.contacts.is_empty() {
        next.reactions.clear();
        next.contact_force.fill(Vector::zeros());
        carry(given, next, resting, report);
        remember(&given.state.sliding, std::iter::empty(), &mut next.sliding);
        return;
    }
    let measure = contacts.measure();
    let Contacts { active, reduced, at_end, .. } = contacts;
    report.residual = measure.natural_residual;
    report.solver_certificate = measure.certificate / active.least_weight();
    let kept = keep(given, active, &reduced.offsets, motion, at_end, next);
    report.min_gap = kept.min_gap;
    report.certificate = kept.certificate;
    report.friction_defect = kept.friction_defect;
    let of_step = active.sliders.iter().map(|slider| slider.after);
    remember(&given.state.sliding, of_step, &mut next.sliding);
    carry(given, next, resting, report);
    let reactions = active.reactions.iter().zip(&active.weights).zip(&reduced.problem.q);
    report.reaction_work = reactions.map(|((r, weight), q)| (r / *weight).dot(q).abs()).sum();
}

/// Puts the reactions of what rests among those of the step.
fn carry<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    resting: &Resting<D>,
    report: &mut StepReport,
) {
    resting.carry(given, next, |gap| report.min_gap = report.min_gap.min(gap));
    report.contacts = next.reactions.len();
}

/// Completes the states of the bodies and closes their books.
fn close_bodies<const D: usize>(given: &Given<'_, D>, next: &mut State<D>, work: &mut Workspace<D>) {
    let assembly = given.assembly;
    let Workspace {
        iterating: Iterating { bodies, contacts, blend, motion, .. },
        body_ledgers,
        springs,
        resting,
        ..
    } = work;
    resting.keep(given, next, bodies, body_ledgers);
    let State { displacement, contact_force, velocity, internal_force, .. } = next;
    contacts.weigh(given, [&given.state.reactions, &next.reactions]);
    let Contacts { on_masses, active, mean_force, .. } = &mut *contacts;
    on_masses.take(&assembly.everyone, given, active);
    if given.interval.is_blended {
        on_masses.weigh(&assembly.everyone, given, motion, bodies.as_slice(), &mut blend.balances);
    }
    on_masses.add_blended(&assembly.everyone, given, &blend.weight, mean_force);
    springs.join(given, &mut contacts.mean_force, contact_force);
    let springs = &*springs;
    let contact_force = springs.with_those_at_end(contact_force);
    let close =
        |i: usize, (body, (velocity, internal_force), written): Own<'_, D>, support: &mut [Vector<D>]| {
            let (history, (ledger, energies)) = written;
            let nodes = assembly.nodes(i);
            let end = BodyEnd {
                contact_force: &contact_force[nodes.clone()],
                mean_contact_force: &contacts.mean_force[nodes],
                spring_work: springs.work_on_free(i),
                velocity: velocity.0,
                internal_force: internal_force.0,
                history: history.own(),
                support,
            };
            let weight = given.interval.is_blended.then_some(blend.weight[i]);
            let guess = given.guess(i, motion, displacement);
            (*ledger.own(), *energies.own()) = body.own().end_step(&guess, weight, end);
        };
    let books = (PerBody(body_ledgers), PerBody(&mut next.body_energies));
    let written = (PerBody(&mut next.history), books);
    let all = (PerBody(bodies), (PerNode(velocity), PerNode(internal_force)), written);
    if next.support.is_empty() {
        each_body(assembly, &resting.awake, all, &|i, own| close(i, own, &mut []));
    } else {
        each_body_in_turn(assembly, &resting.awake, all, |i, own| close(i, own, &mut next.support));
    }
}

/// Books the work of impulses in contacts, and makes them part of the reactions.
fn book_impulses<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    let assembly = given.assembly;
    let Workspace { iterating: Iterating { contacts, motion, .. }, impulses, pair_reports, .. } = work;
    let State { reactions, friction_energy, displacement, .. } = next;
    impulses.join(&contacts.at_end, reactions, |reaction, done, normal, has_landed| {
        let own = assembly.contact.pairs.get(reaction.pair as usize);
        let pair = pair_reports.or_default(own.between());
        let [along, across] = done.taken;
        let is_source = own.between()[0] == Solid::Body(own.source);
        let place = |n: usize| assembly.reference[n] + displacement[n];
        pair.given.add(
            &contacts.at_end[done.contact],
            &(done.force * given.interval.map.dt),
            is_source,
            place,
        );
        pair.ledger.prescribed += done.prescribed;
        if has_landed {
            pair.ledger.normal_contact += along;
            pair.ledger.friction += across;
            // An impulse may take from the reaction: no more friction than was there.
            report.least_friction = report.least_friction.min(rubbed(reaction, motion) + across);
            deposit(assembly, &reaction.contact, across, friction_energy);
        } else {
            pair.ledger.settling += along + across;
        }
        pair.normal_force += normal;
    });
}

/// Books the work of the reactions of every pair.
fn close_contacts<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    let Given { assembly, state, interval, .. } = *given;
    let Workspace {
        iterating: Iterating { contacts, blend, motion, .. },
        pair_reports,
        body_ledgers,
        impulses,
        booked,
        resting,
        ..
    } = work;
    let pair_of = |reaction: &Reaction<D>| assembly.contact.pairs.get(reaction.pair as usize).between();
    for (k, reaction) in next.reactions.iter().enumerate() {
        if impulses.arriving.binary_search(&k).is_ok() {
            continue;
        }
        let report = pair_reports.or_default(pair_of(reaction));
        report.normal_force += reaction.force[0];
        report.ledger.has_touched = true;
    }
    next.slip.copy_from_slice(&state.slip);
    contacts.slip.add(&next.reactions, motion, &mut next.slip);
    next.friction_energy.copy_from_slice(&state.friction_energy);
    // Load steps have no duration: their forces give no impulse.
    let dt = if interval.is_load_step { 0.0 } else { interval.map.dt };
    // In the middle of the step: by its end what spins has turned the places that touched away.
    let place = |n: usize| assembly.reference[n] + (state.displacement[n] + next.displacement[n]) * 0.5;
    let push = |pair: &mut PairReport, k: u32, contact: &Contact<D>, force: &Vector<D>| {
        let pair_of = assembly.contact.pairs.get(k as usize);
        let is_source = pair_of.between()[0] == Solid::Body(pair_of.source);
        pair.given.add(contact, &(force * dt), is_source, place);
    };
    let mut book = |pair: &mut PairReport, contact: &Contact<D>, dissipation: f64| {
        pair.ledger.friction += dissipation;
        report.least_friction = report.least_friction.min(dissipation);
        deposit(assembly, contact, dissipation, &mut next.friction_energy);
    };
    if interval.is_blended {
        // The blend returns what normal reactions take, so there is nothing to book for them.
        contacts.measure_work(given, motion);
        for c in &contacts.work {
            let weight = blend.weight[c.source];
            let report = pair_reports.or_default(c.between);
            report.ledger.prescribed += c.prescribed(weight);
            let (contact, [start, end]) = contacts.active.with_forces(c.number, state);
            let force = start * (0.5 - weight) + end * (0.5 + weight);
            report.given.add(contact, &(force * dt), c.between[0] == Solid::Body(c.source), place);
            book(report, contact, c.dissipation(weight));
        }
    }
    booked.clear();
    for_each_work(given, motion, [&state.reactions, &next.reactions], |reaction, work| {
        if interval.is_blended {
            let pair = assembly.contact.pairs.get(reaction.pair as usize);
            if given.condition_of(reaction.pair).is_massless() {
                if resting.who.are_still(&pair) {
                    push(
                        pair_reports.or_default(pair_of(reaction)),
                        reaction.pair,
                        &reaction.contact,
                        &work.force,
                    );
                }
                return;
            }
            booked.push((pair, work.dissipation - work.normal - work.prescribed));
        }
        let report = pair_reports.or_default(pair_of(reaction));
        report.ledger.normal_contact -= work.normal;
        report.ledger.prescribed += work.prescribed;
        push(report, reaction.pair, &reaction.contact, &work.force);
        book(report, &reaction.contact, work.dissipation);
    });
    if interval.is_blended {
        for done in &impulses.done {
            let pair = assembly.contact.pairs.get(next.reactions[done.reaction].pair as usize);
            booked.push((pair, done.taken[0] + done.taken[1] - done.prescribed));
        }
        next.energy_debt.copy_from_slice(&state.energy_debt);
        let surplus = body_ledgers.iter().map(|b| {
            b.kinetic + b.strain + b.viscous + b.plastic - b.external - b.prescribed - b.connections
        });
        blend.carry(surplus, &contacts.work, booked, &mut next.energy_debt);
    }
}

/// Leaves the energy that friction takes at a contact to its nodes: half to the source, half to those of a deformable target.
fn deposit<const D: usize>(assembly: &Assembly<D>, contact: &Contact<D>, energy: f64, nodes: &mut [f64]) {
    let targets = contact.targets().filter(|&(node, _)| node < assembly.node_count());
    let to_target = if targets.clone().next().is_some() { 0.5 * energy } else { 0.0 };
    shares(contact.sources()).for_each(|(node, share)| nodes[node] += (energy - to_target) * share);
    shares(targets).for_each(|(node, share)| nodes[node] += to_target * share);
}
