//! The books, the event log, the history and the totals of a run.

use carom_friction::SolverKind;

use super::CheckpointError;
use super::tape::Tape;
use crate::cross_check::CrossCheckSummary;
use crate::events::{ContactEvent, EventLog};
use crate::history::History;
use crate::totals::Totals;
use crate::{Books, Group, Simulation};

type Done = Result<(), CheckpointError>;

/// Records or replays how far a run has come and what it has gathered on the way.
pub(super) fn exchange<const D: usize>(tape: &mut Tape<'_>, run: &mut Simulation<D>) -> Done {
    tape.integers("run/step", [&mut run.step, &mut run.history_rows, &mut run.work.factorisations])?;
    tape.integers("run/halvings", [&mut run.halvings])?;
    tape.optional("run/last_recorded", [&mut run.last_recorded])?;
    tape.numbers("run/initial_energies", run.initial_energies.iter_mut().flat_map(|e| e.terms_mut()))?;
    if run.step > run.steps || run.halvings > run.method.max_halvings {
        return Err(CheckpointError::new("run/step", "is beyond the end of the run"));
    }
    books(tape, &mut run.books)?;
    totals(tape, &mut run.totals)?;
    cross_checks(tape, &mut run.cross_checks)?;
    events(tape, &run.model.groups, &mut run.events)?;
    history(tape, &mut run.history)?;
    tape.pending("ledger/rows", &mut run.ledger_table.rows)
}

fn books(tape: &mut Tape<'_>, books: &mut Books) -> Done {
    tape.numbers("books/total", books.total.terms_mut())?;
    tape.numbers("books/bodies", books.bodies.iter_mut().flat_map(|b| b.terms_mut()))?;
    tape.numbers("books/pairs", books.pairs.iter_mut().flat_map(|p| p.terms_mut()))?;
    tape.flags("books/has_touched", books.pairs.iter_mut().map(|p| &mut p.has_touched))
}

fn totals(tape: &mut Tape<'_>, t: &mut Totals) -> Done {
    tape.integers("totals/iterations", [&mut t.newton_iterations, &mut t.retried])?;
    tape.integers("totals/contacts", [&mut t.contacts])?;
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
        &mut t.least_friction,
    ];
    tape.numbers("totals/sizes", sizes)?;
    tape.extremes("totals/min_gap", [&mut t.min_gap])
}

fn cross_checks(tape: &mut Tape<'_>, checks: &mut CrossCheckSummary) -> Done {
    let names = || SolverKind::ALL.iter().map(|kind| kind.name());
    let mut solvers: Vec<u64> =
        names().map(|name| checks.solvers.get(name).copied().unwrap_or_default()).collect();
    tape.integers("cross_checks/solvers", &mut solvers)?;
    checks.solvers = names().zip(solvers).filter(|&(_, count)| count > 0).collect();
    let counts = [&mut checks.problems, &mut checks.unsolved, &mut checks.disagreements];
    tape.integers("cross_checks/counts", counts)?;
    let sizes =
        [&mut checks.max_difference, &mut checks.explained_difference, &mut checks.max_certificate_joule];
    tape.extremes("cross_checks/sizes", sizes)?;
    tape.optional("cross_checks/time_of_max", [&mut checks.time_of_max])
}

fn events(tape: &mut Tape<'_>, groups: &[Group], log: &mut EventLog) -> Done {
    let count = tape.rows("events/group", log.events.len())?;
    let group_of = |event: &ContactEvent| groups.iter().position(|g| g.between == event.pair).unwrap_or(0);
    let mut group: Vec<usize> = log.events.iter().map(group_of).collect();
    group.resize(count, 0);
    tape.integers("events/group", &mut group)?;
    if group.iter().any(|&g| g >= groups.len()) {
        return Err(CheckpointError::new("events/group", "names a pair that is not there"));
    }
    if tape.replays() {
        let event = |&g: &usize| ContactEvent {
            pair: groups[g].between.clone(),
            onset: 0.0,
            release: None,
            peak_force: 0.0,
            friction_work: 0.0,
        };
        log.events = group.iter().map(event).collect();
    }
    let sizes = log.events.iter_mut().flat_map(|e| [&mut e.onset, &mut e.peak_force, &mut e.friction_work]);
    tape.numbers("events/sizes", sizes)?;
    tape.optional("events/release", log.events.iter_mut().map(|e| &mut e.release))?;
    // The last event of each group, and until when it lasts.
    let mut last: Vec<usize> = log.last.iter().map(|l| l.map_or(0, |(event, _)| event)).collect();
    let mut until: Vec<Option<f64>> = log.last.iter().map(|l| l.map(|(_, until)| until)).collect();
    tape.integers("events/last", &mut last)?;
    tape.optional("events/until", &mut until)?;
    if last.iter().zip(&until).any(|(&event, until)| until.is_some() && event >= count) {
        return Err(CheckpointError::new("events/last", "names an event that is not there"));
    }
    log.last = last.into_iter().zip(until).map(|(event, until)| Some((event, until?))).collect();
    Ok(())
}

fn history<const D: usize>(tape: &mut Tape<'_>, history: &mut History<D>) -> Done {
    let since = &mut history.since;
    tape.integers("history/counts", [&mut since.steps, &mut since.iterations, &mut since.contacts])?;
    tape.integers("history/retried", [&mut since.retried])?;
    let sizes = [
        &mut since.shortest_step,
        &mut since.certificate,
        &mut since.residual,
        &mut since.blend,
        &mut since.step_defect,
        &mut since.normal_force,
    ];
    tape.numbers("history/sizes", sizes)?;
    tape.extremes("history/min_gap", [&mut since.min_gap])?;
    let trails = history.trails.iter_mut();
    let trails = trails.flat_map(|t| t.displacement.iter_mut().chain(t.mean_velocity.iter_mut()));
    tape.numbers("history/trails", trails)?;
    tape.pending("history/rows", &mut history.rows)
}
