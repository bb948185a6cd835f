//! What the blend of start and end stresses leaves over, vibration takes or gives.
//!
//! Nodes without mass go from one static balance to the next. Where corners fold there may be none near the last: they snap, and what that sets free
//! belongs to the waves that it sends inside. The [blend](super::blend) cannot move it where stresses change little, or the reactions bound it.
//! Then the velocities at the end of the step change, inside and by what is no rigid motion alone: v₊ + s w, w without momentum and angular
//! momentum, the same s for all bodies of a group. That is w·M w (s + s²/2) of energy, and no other is changed.

use super::iterating::Iterating;
use super::report::StepReport;
use super::workspace::Workspace;
use crate::model::given::Given;
use crate::model::state::State;

/// The largest part of the energy of vibrations that a step may take or give. More waits for the next.
const LARGEST_PART: f64 = 0.5;

/// What is left over below this fraction of the energy of the model is round-off.
const NEGLIGIBLE: f64 = 1e-14;

/// Pays the debts of a step that is at its end.
pub(super) fn repay<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
    report: &mut StepReport,
) {
    if !given.interval.is_blended {
        return;
    }
    let Workspace { iterating: Iterating { bodies, blend, .. }, body_ledgers, resting, .. } = work;
    let least = NEGLIGIBLE * next.energies.total();
    blend.share.fill(0.0);
    blend.vibration.fill(0.0);
    blend.vibration_of_group.fill(0.0);
    for (i, body) in bodies.iter_mut().enumerate() {
        let leader = blend.leader_of(i);
        if next.energy_debt[leader].abs() > least && !resting.who.bodies[i] {
            blend.vibration[i] = body.vibration(&next.body(i, given.assembly.nodes(i)));
            blend.vibration_of_group[leader] += blend.vibration[i];
        }
    }
    for (i, body) in bodies.iter_mut().enumerate() {
        let leader = blend.leader_of(i);
        let vibration = blend.vibration_of_group[leader];
        if vibration <= 0.0 {
            continue;
        }
        let part = (next.energy_debt[leader] / vibration).clamp(-LARGEST_PART, LARGEST_PART);
        // (1 + s)² = 1 − part, without its cancellation.
        let share = -part / (1.0 + (1.0 - part).sqrt());
        blend.share[i] = share;
        let State { velocity, support, .. } = &mut *next;
        body.vibrate(share, given.interval.map.dt, &mut velocity[given.assembly.nodes(i)], support);
        let given = -part * blend.vibration[i];
        body_ledgers[i].kinetic += given;
        body_ledgers[i].contact += given;
        next.body_energies[i].kinetic += given;
        report.repaid += given.abs();
    }
    for (debt, vibration) in next.energy_debt.iter_mut().zip(&blend.vibration_of_group) {
        if *vibration > 0.0 {
            *debt -= debt.clamp(-LARGEST_PART * vibration, LARGEST_PART * vibration);
        }
    }
    next.sum_energies(given.assembly);
}
