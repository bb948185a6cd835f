//! Whether what touches resists, together, every motion that closed contacts do not see.
//!
//! With C̃ the compliance of bodies and reactions at the nodes of contacts, C̃⁻¹ is what they resist motions there with, all other nodes following
//! in equilibrium. An equilibrium is stable only if x·C̃⁻¹x > 0 for every x that opens no closed contact, and slides at none that may stick (Hill 1958). Where
//! there is another motion some of it sets energy free, whatever friction does, which takes none where nothing slides.

use carom_mesh::Vector;
use faer::linalg::solvers::DenseSolveCore;
use faer::{Mat, MatRef, Side};

/// How much stiffer than anything else contacts are that hold.
const RIGID: f64 = 1e4;

/// A stiffness below zero by less than this, of the largest, is round-off.
const ROUND_OFF: f64 = 1e-9;

/// A node yields nothing if it does by less than this, of the softest: it is held.
const HELD: f64 = 1e-12;

/// What a motion of some places must not have a part in.
type Row<const D: usize> = Vec<(usize, Vector<D>)>;

/// The place that moves most in the motion that sets most energy free, by the `compliance` C̃ [m/N] of all places, where these `rows` are held; none if there is
/// no such motion.
pub(super) fn gives_way<const D: usize>(
    compliance: MatRef<'_, f64>,
    rows: impl Iterator<Item = Row<D>>,
) -> Option<usize> {
    let diagonal = |i: usize| compliance[(i, i)].abs();
    let softest = (0..compliance.nrows()).map(diagonal).fold(0.0, f64::max);
    let free: Vec<usize> = (0..compliance.nrows()).filter(|&i| diagonal(i) > HELD * softest).collect();
    let size = free.len();
    let among = Mat::from_fn(size, size, |i, j| compliance[(free[i], free[j])]);
    let inverse = among.partial_piv_lu().inverse();
    // Friction that turns with its frame is not symmetric: energy is of the symmetric part.
    let mut resistance = Mat::from_fn(size, size, |i, j| 0.5 * (inverse[(i, j)] + inverse[(j, i)]));
    let largest = (0..size).map(|i| resistance[(i, i)].abs()).fold(0.0, f64::max);
    if !largest.is_finite() {
        return None;
    }
    for row in rows {
        let entries: Vec<(usize, f64)> = row
            .iter()
            .flat_map(|(place, part)| (0..D).map(move |k| (place * D + k, part[k])))
            .filter_map(|(i, part)| Some((free.binary_search(&i).ok()?, part)))
            .collect();
        for &(i, a) in &entries {
            entries.iter().for_each(|&(j, b)| resistance[(i, j)] += RIGID * largest * a * b);
        }
    }
    if resistance.llt(Side::Lower).is_ok() {
        return None;
    }
    let modes = resistance.self_adjoint_eigen(Side::Lower).ok()?;
    let least = (0..size).min_by(|&i, &j| modes.S()[i].total_cmp(&modes.S()[j]))?;
    if modes.S()[least] >= -ROUND_OFF * largest {
        return None;
    }
    let moves = |&i: &usize| modes.U()[(i, least)].abs();
    let most = (0..size).max_by(|i, j| moves(i).total_cmp(&moves(j)))?;
    Some(free[most] / D)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two places on springs, with a third of negative stiffness between them: alone they are stable, together they are not, unless they are held together.
    #[test]
    fn what_two_springs_bear_alone_they_do_not_bear_together() {
        let held_together = || vec![vec![(0, Vector::<1>::new(1.0)), (1, Vector::<1>::new(-1.0))]];
        for (between, unstable) in [(-0.4, false), (-0.6, true)] {
            let stiffness = Mat::from_fn(2, 2, |i, j| if i == j { 1.0 + between } else { -between });
            let compliance = stiffness.partial_piv_lu().inverse();
            assert_eq!(gives_way::<1>(compliance.as_ref(), std::iter::empty()).is_some(), unstable);
            assert_eq!(gives_way::<1>(compliance.as_ref(), held_together().into_iter()), None);
        }
    }
}
