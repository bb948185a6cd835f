//! A nominal step that fails is taken in halves; the time grid stays that of the nominal steps.
//!
//! In time the next step is a new chance, and the whole one is tried as soon as the grid allows. Load steps that are hard stay so:
//! a static analysis goes on with the length that it came down to, and doubles it after a step that was easy.

use carom_mesh::Vector;
use carom_mesh::parallel::among_threads;

use super::bridge;
use super::error::RunError;
use super::stepper::{Nominal, Stepper};
use crate::error::StepError;
use crate::model::Model;
use crate::step::report::StepReport;
use crate::step::step_over;
use crate::step::workspace::Workspace;
use crate::{Scheme, State};

/// A load step that took no more iterations than this was easy.
const EASY: usize = 12;

/// Share of the largest energy so far that the blends of massless contact may leave over in one step, to be given back later. That energy
/// includes the energy at the end of the step and what the step received. Where there has been no energy at all nothing can be left over.
///
/// Measured on 54 random impacts in the plane at up to the speed of waves: 43 complete without a limit, and some miss a fifth of their energy.
/// With it 41 complete and miss 0.4 % at most. What damping leaves at the onset of a contact does not shrink with the step, so a shorter step
/// may leave as much as a long one.
const LARGEST_DEBT: f64 = 1e-3;

/// The same of a step that is no shorter than a part of a whole one: its halves may leave nothing over.
const DEBT_OF_LONG_STEP: f64 = 1e-10;
const LONG: f64 = 0.1;

/// What waits for vibration may grow by this part of it in a step: nodes that have given way to a load come to rest only by and by.
const GROWTH: f64 = 0.1;

impl<const D: usize> Stepper<'_, D> {
    /// Takes the state over a nominal step, in substeps where it must be; `observe` is told of each that succeeds, with the states at both ends.
    ///
    /// # Errors
    /// If the shortest substep fails; the state is where the last good one left it.
    pub fn advance(
        &mut self,
        nominal: Nominal,
        mut observe: impl FnMut([&State<D>; 2], &StepReport, &Workspace<D>),
    ) -> Result<(), RunError> {
        let Nominal { end, dt, energy } = nominal;
        // Progress is counted in the smallest substep allowed, so that halves always meet the grid.
        let whole = 1_u64 << self.method.max_halvings;
        let mut done = 0;
        let load_steps = self.method.scheme == Scheme::Static;
        let mut size = if load_steps { whole >> *self.halvings } else { whole };
        while done < whole {
            let length = dt * (size as f64 / whole as f64);
            match self.substep(length, dt, energy) {
                Ok(report) => {
                    done += size;
                    self.spare.time = end - dt * ((whole - done) as f64 / whole as f64);
                    std::mem::swap(self.state, self.spare);
                    observe([self.spare, self.state], &report, self.work);
                    // Grow again where the coarser grid allows.
                    let easy = report.newton_iterations <= EASY;
                    while size < whole && done % (2 * size) == 0 && (easy || !load_steps) {
                        size *= 2;
                        if load_steps {
                            break;
                        }
                    }
                }
                Err(reason) => {
                    self.failed += 1;
                    self.work.iterating.contacts.finder.forget_end();
                    let is_short = size <= whole >> bridge::AFTER.min(self.method.max_halvings);
                    if self.method.bridges && is_short {
                        let there = end - dt * ((whole - done - size) as f64 / whole as f64);
                        if !self.bridge(there, &mut observe) {
                            return Err(self.error(length, (whole / size).trailing_zeros(), reason));
                        }
                        done += size;
                        continue;
                    }
                    // Short steps may do without a factor, load steps never do.
                    if size == 1 || load_steps && reason.is_of_memory() {
                        return Err(self.error(length, (whole / size).trailing_zeros(), reason));
                    }
                    size /= 2;
                }
            }
        }
        *self.halvings = (whole / size).trailing_zeros();
        Ok(())
    }

    /// Writes the state after `length` [s] of a step of `whole` [s] to `spare`.
    fn substep(&mut self, length: f64, whole: f64, energy: f64) -> Result<StepReport, StepError> {
        let Self { model, method, state, spare, work, .. } = self;
        let assembly = &model.assembly;
        let mut interval = method.interval(state.time, length);
        (interval.map, interval.whole) = (interval.map.part_of(whole), whole);
        let report =
            among_threads(model.node_count(), || step_over(assembly, method, &interval, state, spare, work))?;
        let may_wait = length < LONG * whole;
        let share = if may_wait { LARGEST_DEBT } else { DEBT_OF_LONG_STEP };
        check_debt(model, [state, spare], energy, share, &report)?;
        Ok(report)
    }
}

/// The energy [J] that bodies would have if they moved as fast as the obstacles which touch them: what an obstacle brings to a body at rest, of which
/// its first touch has only round-off.
fn met<const D: usize>(model: &Model<D>, state: &State<D>) -> f64 {
    let assembly = &model.assembly;
    let energies = state.reactions.iter().map(|reaction| {
        let of_obstacle =
            |n: usize| if assembly.place_of(n).is_none() { state.velocity[n] } else { Vector::zeros() };
        let source = assembly.contact.pairs.get(reaction.pair as usize).source;
        let mass = model.bodies.get(source).map_or(0.0, |b| b.body.total_mass());
        0.5 * mass * reaction.contact.relative(of_obstacle).norm_squared()
    });
    energies.fold(0.0, f64::max)
}

/// Refuses a step to `next` whose blends left more over than a `share` of the largest `energy` [J], be it too much or too little of a body. A run
/// may start without any: what the step itself brings counts, and what obstacles meet.
///
/// Nodes without mass give way at once to a load that sets in, or to a stress that they start with. Inside, it takes waves some steps: what has been
/// left over by then waits for their vibration, however short the steps are.
fn check_debt<const D: usize>(
    model: &Model<D>,
    [state, next]: [&State<D>; 2],
    energy: f64,
    share: f64,
    report: &StepReport,
) -> Result<(), StepError> {
    let debt = |state: &State<D>| state.energy_debt.iter().map(|e| e.abs()).sum::<f64>();
    let missing = debt(next) - debt(state);
    let given = report.ledger.external.abs() + report.ledger.prescribed.abs();
    let usual = share * energy.max(next.energies.total()).max(given);
    if missing <= usual {
        return Ok(());
    }
    let allowed = usual.max(share * met(model, next)).max(report.onset + GROWTH * debt(state));
    if missing > allowed { Err(StepError::Unbalanced { missing, allowed }) } else { Ok(()) }
}
