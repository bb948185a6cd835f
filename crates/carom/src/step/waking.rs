//! Which bodies may touch themselves: few do, and those that cannot cost nothing.

use carom_mesh::{Matrix, Vector, nodal, tensor};

use super::control::WAKING;
use super::workspace::Workspace;
use crate::model::given::Given;
use crate::model::state::State;

/// Takes note of how far nodes wander in the step, and which bodies may have gone through themselves since they were looked at.
pub(super) fn wander<const D: usize>(given: &Given<'_, D>, work: &mut Workspace<D>) {
    let Workspace { motion, since_look, boundaries, .. } = work;
    for (i, look) in since_look.iter_mut().enumerate() {
        let nodes = given.assembly.nodes(i);
        let middle = |n: usize| given.position(n as u32) + motion[n] * 0.5;
        look.in_step = against_one_another(&motion[nodes.clone()], |k| middle(nodes.start + k));
        look.is_due = look.wandered + look.in_step > WAKING.unseen * boundaries.least_cell(i);
    }
}

/// Wakes the bodies that have come near themselves and lets those sleep that have not. Returns whether one was found inside itself that nobody
/// had searched.
pub(super) fn wake<const D: usize>(given: &Given<'_, D>, next: &State<D>, work: &mut Workspace<D>) -> bool {
    let Workspace { since_look, in_itself, boundaries, contacts, .. } = work;
    let end = |n: u32| given.assembly.reference[n as usize] + next.displacement[n as usize];
    let mut is_surprise = false;
    for (i, look) in since_look.iter_mut().enumerate() {
        let finder = &mut contacts.finder;
        look.wandered += look.in_step;
        if !look.is_due {
            continue;
        }
        if in_itself[i] {
            // It is looked at again in the next step.
            is_surprise |= finder.asleep[i];
            finder.asleep[i] = false;
            continue;
        }
        let reach = (WAKING.near * boundaries.least_cell(i)).max(WAKING.near_in_motions * look.in_step);
        finder.asleep[i] = !finder.comes_near_itself(given, i, reach, &end);
        look.wandered = 0.0;
    }
    is_surprise
}

/// How far nodes that make these `motions` and are at `middle` half way move beside their motion as a rigid body [m].
fn against_one_another<const D: usize>(motions: &[Vector<D>], middle: impl Fn(usize) -> Vector<D>) -> f64 {
    let count = motions.len().max(1) as f64;
    let mean = nodal::total(motions) / count;
    let centre = (0..motions.len()).map(&middle).sum::<Vector<D>>() / count;
    // Half way a rotation is at right angles to the offset from its centre, however large it is.
    let (mut inertia, mut moment) = (Matrix::<3>::zeros(), Vector::<3>::zeros());
    for (k, d) in motions.iter().enumerate() {
        let r = middle(k) - centre;
        let in_space = Vector::<3>::from_fn(|i, _| if i < D { r[i] } else { 0.0 });
        inertia +=
            Matrix::<3>::from_diagonal_element(in_space.norm_squared()) - in_space * in_space.transpose();
        moment += Vector::<3>::from(tensor::cross(&r, &(d - mean)));
    }
    let spin = inertia.cholesky().map_or_else(Vector::<3>::zeros, |j| j.solve(&moment));
    let turn = [spin[0], spin[1], spin[2]];
    let off = |(k, d): (usize, &Vector<D>)| {
        let r = middle(k) - centre;
        (d - mean - tensor::rotation_velocity(&turn, &r)).norm_squared()
    };
    motions.iter().enumerate().map(off).fold(0.0, f64::max).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_that_turns_stays_what_it_is() {
        let x = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.5, 1.5]].map(Vector::<2>::from);
        let (sine, cosine) = 1.2_f64.sin_cos();
        let turned =
            |x: &Vector<2>| Vector::<2>::new(cosine * x[0] - sine * x[1] + 3.0, sine * x[0] + cosine * x[1]);
        let mut motions: Vec<_> = x.iter().map(|x| turned(x) - x).collect();
        let off = against_one_another(&motions, |k| x[k] + motions[k] * 0.5);
        assert!(off < 1e-15, "{off:e}");
        motions[2][0] += 0.01;
        let off = against_one_another(&motions, |k| x[k] + motions[k] * 0.5);
        assert!((0.002..0.01).contains(&off), "{off:e}");
    }
}
