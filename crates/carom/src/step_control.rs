//! A nominal step that fails is taken in halves; the time grid stays that of the nominal steps.
//!
//! In time the next step is a new chance, and the whole one is tried as soon as the grid allows. Load steps that are hard stay so:
//! a static analysis goes on with the length that it came down to, and doubles it after a step that was easy.

use crate::error::RunError;
use crate::workspace::{StepReport, Workspace};
use crate::{Method, Model, Scheme, State, step};

/// A load step that took no more iterations than this was easy.
const EASY: usize = 12;

/// Takes `state` over one nominal step of length `dt` that ends at time `end` [s], in substeps where it must be.
///
/// After each substep that succeeds `observe` is told; `spare` is scratch of the same size as `state`. On an error `state` is
/// where the last good substep left it.
/// `failed` counts the substeps that failed, and `halvings` is how often the steps of a static analysis are halved at present.
pub(crate) fn advance_nominal_step<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &mut State<D>,
    spare: &mut State<D>,
    end: f64,
    dt: f64,
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
        match step(model, method, state, spare, length, work) {
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
                    });
                }
                size /= 2;
            }
        }
    }
    *halvings = (whole / size).trailing_zeros();
    Ok(())
}
