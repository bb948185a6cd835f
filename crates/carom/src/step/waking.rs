//! Which bodies may touch themselves: few do, and those that cannot cost nothing.

use carom_mesh::{Matrix, Vector, tensor};

use super::control::WAKING;
use super::iterating::Iterating;
use super::workspace::Workspace;
use crate::model::each_body::{PerBody, each_body};
use crate::model::given::Given;
use crate::model::state::State;

/// Takes note of how far nodes of boundaries wander in the step, and which bodies may have gone through themselves since they were looked at.
pub(super) fn wander<const D: usize>(given: &Given<'_, D>, next: &State<D>, work: &mut Workspace<D>) {
    let Workspace { iterating: Iterating { bodies, motion, .. }, since_look, boundaries, resting, .. } = work;
    for i in resting.resting() {
        (since_look[i].in_step, since_look[i].is_due) = (0.0, false);
    }
    let all = (PerBody(since_look), PerBody(bodies));
    each_body(given.assembly, &resting.awake, all, &|i, (look, body)| {
        let look = look.own();
        let moving = boundaries.nodes(i).map(|n| {
            let d = motion[n as usize];
            (given.assembly.reference[n as usize] + next.displacement[n as usize] - d * 0.5, d)
        });
        if let Some(wandered) = body.own().wandered() {
            (look.wandered, look.in_step) = (wandered, 0.0);
        } else {
            look.in_step = against_one_another(moving);
        }
        look.is_due = look.wandered + look.in_step > WAKING.unseen * boundaries.least_cell(i);
    });
}

/// Wakes the bodies that have come near themselves and lets those sleep that have not. Returns whether one was found inside itself that nobody
/// had searched.
pub(super) fn wake<const D: usize>(given: &Given<'_, D>, next: &State<D>, work: &mut Workspace<D>) -> bool {
    let Workspace {
        iterating: Iterating { bodies, contacts, .. }, since_look, in_itself, boundaries, ..
    } = work;
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
        bodies[i].looked_at();
    }
    is_surprise
}

/// How far nodes that are at a place half way and make a motion, each given as (place, motion) [m], move beside their motion as a rigid
/// body [m].
fn against_one_another<const D: usize>(moving: impl Iterator<Item = (Vector<D>, Vector<D>)> + Clone) -> f64 {
    let (mut count, mut centre, mut mean) = (0.0, Vector::<D>::zeros(), Vector::<D>::zeros());
    for (x, d) in moving.clone() {
        count += 1.0;
        centre += x;
        mean += d;
    }
    if count == 0.0 {
        return 0.0;
    }
    (centre, mean) = (centre / count, mean / count);
    // Half way a rotation is at right angles to the offset from its centre, however large it is.
    let (mut square, mut products) = (0.0, Matrix::<3>::zeros());
    let mut moment = Vector::<3>::zeros();
    for (x, d) in moving.clone() {
        let r = x - centre;
        square += r.norm_squared();
        for i in 0..D {
            for j in 0..D {
                products[(i, j)] += r[i] * r[j];
            }
        }
        moment += Vector::<3>::from(tensor::cross(&r, &(d - mean)));
    }
    let inertia = Matrix::<3>::from_diagonal_element(square) - products;
    let spin = inertia.cholesky().map_or_else(Vector::<3>::zeros, |j| j.solve(&moment));
    let turn = [spin[0], spin[1], spin[2]];
    let off = |(x, d): (Vector<D>, Vector<D>)| {
        (d - mean - tensor::rotation_velocity(&turn, &(x - centre))).norm_squared()
    };
    moving.map(off).fold(0.0, f64::max).sqrt()
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
        let moving = |motions: &[Vector<2>]| {
            let all: Vec<_> = x.iter().zip(motions).map(|(x, d)| (x + d * 0.5, *d)).collect();
            all.into_iter()
        };
        let off = against_one_another(moving(&motions));
        assert!(off < 1e-15, "{off:e}");
        motions[2][0] += 0.01;
        let off = against_one_another(moving(&motions));
        assert!((0.002..0.01).contains(&off), "{off:e}");
    }
}
