//! A nominal step that fails is taken in halves; the time grid stays that of the nominal steps.

use crate::error::RunError;
use crate::workspace::{StepReport, Workspace};
use crate::{Method, Model, State, step};

/// Takes `state` over one nominal step of length `dt` that ends at time `end` [s], in substeps where it must be.
///
/// After each substep that succeeds `observe` is told; `spare` is scratch of the same size as `state`. On an error `state` is
/// where the last good substep left it.
/// `failed` counts the substeps that failed.
pub(crate) fn advance_nominal_step<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &mut State<D>,
    spare: &mut State<D>,
    end: f64,
    dt: f64,
    work: &mut Workspace<D>,
    failed: &mut u64,
    mut observe: impl FnMut(&State<D>, &StepReport, &Workspace<D>),
) -> Result<(), RunError> {
    // Progress is counted in the smallest substep allowed, so that halves always meet the grid.
    let whole = 1_u64 << method.max_halvings;
    let mut done = 0;
    let mut size = whole;
    while done < whole {
        let length = dt * (size as f64 / whole as f64);
        match step(model, method, state, spare, length, work) {
            Ok(report) => {
                done += size;
                spare.time = end - dt * ((whole - done) as f64 / whole as f64);
                std::mem::swap(state, spare);
                observe(state, &report, work);
                // Grow again where the coarser grid allows.
                while size < whole && done % (2 * size) == 0 {
                    size *= 2;
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
    Ok(())
}
