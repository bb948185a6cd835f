//! The books, the event log, the history and the totals of a run.

use carom_contact::{Pairs, Solid};
use carom_friction::SolverKind;

use crate::archive::{Archive, CheckpointError};
use crate::contact::cross_check::CrossCheckSummary;
use crate::ledger::ByPair;
use crate::model::assembly::Assembly;
use crate::run::account::Account;
use crate::run::crushed::CrushedCells;
use crate::run::events::{ContactEvent, EventLog};
use crate::run::history::History;
use crate::run::impact::Impact;
use crate::run::totals::{Totals, Worst};
use crate::step::free_motion::FreeMotion;
use crate::step::report::Inside;
use crate::step::resting::Resting;
use crate::step::workspace::Workspace;
use crate::{Books, Simulation};

type Done = Result<(), CheckpointError>;

/// Records or replays how far a run has come and what it has gathered on the way.
pub(super) fn exchange<const D: usize>(archive: &mut Archive<'_>, run: &mut Simulation<D>) -> Done {
    archive.integers(
        "run/step",
        [&mut run.grid.step, &mut run.history_rows, &mut run.work.iterating.factorisations],
    )?;
    archive.integers("run/halvings", [&mut run.halvings])?;
    archive.numbers("run/since_look", run.work.since_look.iter_mut().map(|l| &mut l.wandered))?;
    archive.flags("run/asleep", &mut run.work.iterating.contacts.finder.asleep)?;
    resting(archive, &mut run.work)?;
    archive.optional("run/last_recorded", [&mut run.last_recorded])?;
    archive.numbers("run/initial_energies", run.initial_energies.iter_mut().flat_map(|e| e.terms_mut()))?;
    if run.grid.step > run.grid.steps || run.halvings > run.stage().method.max_halvings {
        return Err(CheckpointError::new("run/step", "is beyond the end of the run"));
    }
    let pairs = &run.stages[run.current].model.assembly.contact.pairs;
    books(archive, "books", pairs, &mut run.books)?;
    accounts(archive, run)?;
    totals(archive, &mut run.totals)?;
    cross_checks(archive, &mut run.cross_checks)?;
    events(archive, &run.stages[run.current].model.assembly, &mut run.events)?;
    history(archive, &mut run.history)?;
    archive.pending("ledger/rows", &mut run.ledger_table.rows)
}

/// Which bodies rest, and how long the others have been still.
fn resting<const D: usize>(archive: &mut Archive<'_>, work: &mut Workspace<D>) -> Done {
    let Resting { who, watches, place, .. } = &mut work.resting;
    archive.flags("run/resting/bodies", &mut who.bodies)?;
    archive.integers("run/resting/steps", watches.iter_mut().map(|w| &mut w.steps))?;
    archive.numbers("run/resting/since", watches.iter_mut().flat_map(|w| [&mut w.since, &mut w.depth]))?;
    archive.vectors("run/resting/place", place)?;
    work.resting.list();
    Ok(())
}

/// Records or replays something of some pairs: tells of which it is.
fn by_pair<T: Clone + Default>(
    archive: &mut Archive<'_>,
    name: &str,
    pairs: &Pairs,
    of: &mut ByPair<T>,
) -> Done {
    let mut places: Vec<usize> = of.iter().map(|(between, _)| pairs.place(between)).collect();
    let count = archive.rows(name, places.len())?;
    places.resize(count, 0);
    archive.integers(name, &mut places)?;
    if archive.replays() {
        let between = |place: &usize| Some((pairs.at_place(*place)?, T::default()));
        // Two of the same would leave one without.
        let known = places.iter().map(between).collect::<Option<ByPair<T>>>().filter(|k| k.len() == count);
        *of = known.ok_or_else(|| CheckpointError::new(name, "names a pair that is not there"))?;
    }
    Ok(())
}

fn books(archive: &mut Archive<'_>, name: &str, pairs: &Pairs, books: &mut Books) -> Done {
    archive.numbers(&format!("{name}/total"), books.total.terms_mut())?;
    archive.numbers(&format!("{name}/bodies"), books.bodies.iter_mut().flat_map(|b| b.terms_mut()))?;
    by_pair(archive, &format!("{name}/between"), pairs, &mut books.pairs)?;
    archive.numbers(&format!("{name}/pairs"), books.pairs.values_mut().flat_map(|p| p.terms_mut()))?;
    archive.flags(&format!("{name}/has_touched"), books.pairs.values_mut().map(|p| &mut p.has_touched))
}

/// The books of every stage that has begun.
fn accounts<const D: usize>(archive: &mut Archive<'_>, run: &mut Simulation<D>) -> Done {
    let blank = Account::new(run.initial_energies.clone());
    run.accounts.resize(run.current + 1, blank);
    for (i, (account, stage)) in run.accounts.iter_mut().zip(&run.stages).enumerate() {
        let name = format!("stages/{i}");
        let counts = [&mut account.steps, &mut account.newton_iterations, &mut account.retried];
        archive.integers(&format!("{name}/counts"), counts)?;
        let sizes = [&mut account.max_drift, &mut account.max_defect, &mut account.max_step_defect];
        archive.numbers(&format!("{name}/sizes"), sizes)?;
        let energies = account.start.iter_mut().chain(&mut account.end);
        archive.numbers(&format!("{name}/energies"), energies.flat_map(|e| e.terms_mut()))?;
        books(archive, &name, &stage.model.assembly.contact.pairs, &mut account.books)?;
    }
    Ok(())
}

fn totals(archive: &mut Archive<'_>, t: &mut Totals) -> Done {
    archive.integers("totals/iterations", [&mut t.newton_iterations, &mut t.retried])?;
    archive.integers("totals/contacts", [&mut t.contacts])?;
    let sizes = [
        &mut t.max_drift,
        &mut t.max_defect,
        &mut t.max_step_defect,
        &mut t.max_energy,
        &mut t.max_reaction_work,
        &mut t.max_certificate,
        &mut t.solver_certificate,
        &mut t.max_residual,
        &mut t.max_blend,
        &mut t.repaid,
        &mut t.least_friction,
    ];
    archive.numbers("totals/sizes", sizes)?;
    penetration(archive, t)?;
    free_motion(archive, t)?;
    archive.extremes("totals/min_gap", [&mut t.min_gap])
}

fn penetration(archive: &mut Archive<'_>, t: &mut Totals) -> Done {
    archive.numbers("totals/penetration", [&mut t.let_in, &mut t.max_penetration])?;
    // Without depth there is none.
    let nowhere = Inside { between: [Solid::Body(0); 2], depth: 0.0, cell: 0.0, arcs: 0.0, at: [0.0; 3] };
    let nothing = Worst { inside: nowhere, allowed: 0.0, time: 0.0, crushed: None };
    let mut worst = t.worst_penetration.unwrap_or(nothing);
    let Worst { inside: Inside { between, depth, cell, arcs, at }, allowed, time, crushed } = &mut worst;
    let mut who = between.map(|solid| match solid {
        Solid::Body(i) => [0, i],
        Solid::Obstacle(i) => [1, i],
    });
    archive.integers("totals/worst_penetration", who.iter_mut().flatten())?;
    *between = who.map(|[kind, i]| if kind == 0 { Solid::Body(i) } else { Solid::Obstacle(i) });
    archive.numbers("totals/worst_place", [depth, cell, arcs, allowed, time].into_iter().chain(at))?;
    let mut cells = crushed.unwrap_or(CrushedCells { body: 0, cells: 0, least: 0.0 });
    archive.integers("totals/crushed", [&mut cells.body, &mut cells.cells])?;
    archive.numbers("totals/crushed_least", [&mut cells.least])?;
    *crushed = (cells.cells > 0).then_some(cells);
    t.worst_penetration = (worst.inside.depth > 0.0).then_some(worst);
    Ok(())
}

fn free_motion(archive: &mut Archive<'_>, t: &mut Totals) -> Done {
    // Nothing is left undone that nothing drives.
    let none = FreeMotion { body: 0, along: [0.0; 3], spin: [0.0; 3], touches: false, driving: 0.0 };
    let mut motion = t.free_motion.unwrap_or(none);
    let FreeMotion { body, along, spin, touches, driving } = &mut motion;
    let mut touching = usize::from(*touches);
    archive.integers("totals/free_body", [body, &mut touching])?;
    *touches = touching == 1;
    archive.numbers("totals/free_motion", along.iter_mut().chain(spin).chain([driving]))?;
    t.free_motion = (motion.driving > 0.0).then_some(motion);
    Ok(())
}

fn cross_checks(archive: &mut Archive<'_>, checks: &mut CrossCheckSummary) -> Done {
    let names = || SolverKind::ALL.iter().map(|kind| kind.name());
    let mut solvers: Vec<u64> =
        names().map(|name| checks.solvers.get(name).copied().unwrap_or_default()).collect();
    archive.integers("cross_checks/solvers", &mut solvers)?;
    checks.solvers = names().zip(solvers).filter(|&(_, count)| count > 0).collect();
    let counts = [&mut checks.problems, &mut checks.unsolved, &mut checks.disagreements];
    archive.integers("cross_checks/counts", counts)?;
    if checks.unsolved.saturating_add(checks.disagreements) > checks.problems {
        return Err(CheckpointError::new("cross_checks/counts", "has more answers than problems"));
    }
    let sizes =
        [&mut checks.max_difference, &mut checks.explained_difference, &mut checks.max_certificate_joule];
    archive.extremes("cross_checks/sizes", sizes)?;
    archive.optional("cross_checks/time_of_max", [&mut checks.time_of_max])?;
    if checks.disagreements > 0 && checks.time_of_max.is_none() {
        return Err(CheckpointError::new("cross_checks/time_of_max", "is missing where answers differ"));
    }
    Ok(())
}

fn events<const D: usize>(archive: &mut Archive<'_>, assembly: &Assembly<D>, log: &mut EventLog) -> Done {
    let pairs = &assembly.contact.pairs;
    let count = archive.rows("events/pair", log.events.len())?;
    let pair_of = |event: &ContactEvent| assembly.between(&event.pair).map_or(0, |b| pairs.place(b));
    let mut places: Vec<usize> = log.events.iter().map(pair_of).collect();
    places.resize(count, 0);
    archive.integers("events/pair", &mut places)?;
    if archive.replays() {
        let event = |&place: &usize| {
            Some(ContactEvent {
                pair: assembly.names(pairs.at_place(place)?),
                onset: 0.0,
                release: None,
                peak_force: 0.0,
                friction_work: 0.0,
                impact: None,
            })
        };
        let events: Option<Vec<ContactEvent>> = places.iter().map(event).collect();
        let missing = || CheckpointError::new("events/pair", "names a pair that is not there");
        log.events = events.ok_or_else(missing)?;
    }
    let sizes = log.events.iter_mut().flat_map(|e| [&mut e.onset, &mut e.peak_force, &mut e.friction_work]);
    archive.numbers("events/sizes", sizes)?;
    archive.optional("events/release", log.events.iter_mut().map(|e| &mut e.release))?;
    let mut have_ended: Vec<bool> = log.events.iter().map(|e| e.impact.is_some()).collect();
    archive.flags("events/have_ended", &mut have_ended)?;
    if archive.replays() {
        let impacts = have_ended.iter().map(|ended| ended.then(Impact::default));
        log.events.iter_mut().zip(impacts).for_each(|(event, impact)| event.impact = impact);
    }
    let impacts = log.events.iter_mut().filter_map(|e| e.impact.as_mut());
    archive.numbers("events/impacts", impacts.flat_map(Impact::numbers_mut))?;
    let impacts = log.events.iter_mut().filter_map(|e| e.impact.as_mut());
    archive.optional("events/restitutions", impacts.flat_map(Impact::optional_mut))?;
    // The last contact of pairs, and until when it lasts.
    by_pair(archive, "events/between", pairs, &mut log.last)?;
    archive.integers("events/last", log.last.values_mut().map(|last| &mut last.event))?;
    archive.numbers("events/until", log.last.values_mut().map(|last| &mut last.until))?;
    archive.numbers("events/touching", log.last.values_mut().flat_map(|last| last.touching.numbers_mut()))?;
    if log.last.values().any(|last| last.event >= count) {
        return Err(CheckpointError::new("events/last", "names an event that is not there"));
    }
    Ok(())
}

fn history<const D: usize>(archive: &mut Archive<'_>, history: &mut History<D>) -> Done {
    let since = &mut history.since;
    archive.integers("history/counts", [&mut since.steps, &mut since.iterations, &mut since.contacts])?;
    archive.integers("history/retried", [&mut since.retried])?;
    let sizes = [
        &mut since.shortest_step,
        &mut since.certificate,
        &mut since.residual,
        &mut since.blend,
        &mut since.step_defect,
        &mut since.friction_defect,
        &mut since.penetration,
        &mut since.normal_force,
    ];
    archive.numbers("history/sizes", sizes)?;
    archive.extremes("history/min_gap", [&mut since.min_gap])?;
    let trails = history.trails.iter_mut();
    let trails = trails.flat_map(|t| t.displacement.iter_mut().chain(t.mean_velocity.iter_mut()));
    archive.numbers("history/trails", trails)?;
    archive.pending("history/rows", &mut history.rows)
}
