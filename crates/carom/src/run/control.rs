//! A nominal step that fails is taken in halves; the time grid stays that of the nominal steps.
//!
//! In time the next step is a new chance, and the whole one is tried as soon as the grid allows. Load steps that are hard stay so:
//! a static analysis goes on with the length that it came down to, and doubles it after a step that was easy.

use carom_mesh::parallel::among_threads;

use super::error::RunError;
use crate::error::StepError;
use crate::step::report::StepReport;
use crate::step::workspace::Workspace;
use crate::{Crushed, Method, Model, Scheme, State, step};

/// A load step that took no more iterations than this was easy.
const EASY: usize = 12;

/// Share of the largest energy so far, that at the end of the step and what it received included, that the blends of massless contact may leave
/// over in one step, to be given back later. Where there has been no energy at all nothing can be left over.
///
/// Measured on 54 random impacts in the plane at up to the speed of waves: 43 complete without a limit, and some miss a fifth of their
/// energy; with it 41 complete and miss 0.4 % at most. What damping leaves at the onset of a contact does not shrink with the step, so a shorter
/// step may leave as much as a long one.
const LARGEST_DEBT: f64 = 1e-3;

/// Takes `state` over one nominal step of length `dt` that ends at time `end` [s], in substeps where it must be.
///
/// After each substep that succeeds `observe` is told; `spare` is scratch of the same size as `state`. On an error `state` is
/// where the last good substep left it.
/// `energy` is the largest of the model so far [J],
/// `failed` counts the substeps that failed, and `halvings` is how often the steps of a static analysis are halved at present.
pub(crate) fn advance_nominal_step<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &mut State<D>,
    spare: &mut State<D>,
    end: f64,
    dt: f64,
    energy: f64,
    work: &mut Workspace<D>,
    failed: &mut u64,
    halvings: &mut u32,
    mut observe: impl FnMut(&State<D>, &StepReport, &Workspace<D>),
) -> Result<(), RunError> {
    // Progress is counted in the smallest substep allowed, so that halves always meet the grid.
    let whole = 1_u64 << method.max_halvings;
    let mut done = 0;
    let load_steps = method.scheme == Scheme::Static;
    let mut size = if load_steps { whole >> *halvings } else { whole };
    while done < whole {
        let length = dt * (size as f64 / whole as f64);
        let taken =
            among_threads(model.node_count(), || step(&model.assembly, method, state, spare, length, work))
                .and_then(|report| check_debt(state, spare, energy, &report).map(|()| report));
        match taken {
            Ok(report) => {
                done += size;
                spare.time = end - dt * ((whole - done) as f64 / whole as f64);
                std::mem::swap(state, spare);
                observe(state, &report, work);
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
                *failed += 1;
                if size == 1 {
                    return Err(RunError {
                        time: state.time,
                        time_step: length,
                        halvings: method.max_halvings,
                        reason,
                        crushed: Crushed::find(model, state).map(Box::new),
                    });
                }
                size /= 2;
            }
        }
    }
    *halvings = (whole / size).trailing_zeros();
    Ok(())
}

/// Refuses a step to `next` whose blends left more over than a share of the largest `energy` [J], be it too much or too little of a body. A run
/// may start without any: what the step itself brings counts.
fn check_debt<const D: usize>(
    state: &State<D>,
    next: &State<D>,
    energy: f64,
    report: &StepReport,
) -> Result<(), StepError> {
    let debt = |state: &State<D>| state.excess.iter().map(|e| e.abs()).sum::<f64>();
    let missing = debt(next) - debt(state);
    let given = report.ledger.external.abs() + report.ledger.prescribed.abs();
    let allowed = LARGEST_DEBT * energy.max(next.energies.total()).max(given);
    if missing > allowed { Err(StepError::Unbalanced { missing, allowed }) } else { Ok(()) }
}
