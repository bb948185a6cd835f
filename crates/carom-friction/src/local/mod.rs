//! Solvers of a single contact, whose motion is w = A r + b with its own block A of W and b, the motion without its reaction.

mod alart_curnier;
mod bipotential;
mod control;
mod enumerative;
mod polynomial;

pub(crate) use alart_curnier::AlartCurnier;
pub(crate) use bipotential::Bipotential;
pub(crate) use enumerative::Enumerative;

use crate::{ContactProblem, Matrix, Vector, cone, small};
use control::CONTROL;

/// What does not change of a contact while its neighbours do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LocalContact<const D: usize> {
    /// A, the diagonal block of W [m/N].
    pub block: Matrix<D>,
    /// A⁻¹ [N/m], unless A is singular to round-off.
    pub inverse: Option<Matrix<D>>,
    pub mu: f64,
    /// The step ρ = 1/λ_max(A) [N/m] of the bi-potential fixed point; 0 where nothing can move.
    pub rho: f64,
}

impl<const D: usize> LocalContact<D> {
    pub fn new(problem: &ContactProblem<D>, i: usize) -> Self {
        let block = *problem.w.diagonal(i);
        let inverse =
            small::inverse(&block).filter(|inverse| inverse.amax() * block.amax() < CONTROL.singular);
        Self { block, inverse, mu: problem.mu[i], rho: problem.step_length(i) }
    }

    /// One step of the bi-potential fixed point from `r` with the motion `free` without own reaction.
    #[inline]
    pub fn fixed_point(&self, free: &Vector<D>, r: &Vector<D>) -> Vector<D> {
        cone::fixed_point(r, &(free + self.block * r), self.mu, self.rho)
    }
}

/// A method for one contact.
pub(crate) trait LocalSolver<const D: usize> {
    /// The reaction of `contact` with the motion `free` [m] without its own reaction, from the guess `r` [N]; always in K.
    ///
    /// Steps below `accuracy` |r| are not worth making.
    fn solve(contact: &LocalContact<D>, free: &Vector<D>, r: &Vector<D>, accuracy: f64) -> Vector<D>;
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::BlockMatrix;

    /// A = B Bᵀ scaled, with as many columns of B as `rank` says.
    fn contact<const D: usize>(entries: &[f64], rank: usize, size: f64, mu: f64) -> LocalContact<D> {
        let b = Matrix::<D>::from_fn(|i, j| if j < rank { entries[i * D + j] } else { 0.0 });
        let mut w = BlockMatrix::default();
        w.push_row([(0, b * b.transpose() * size)]);
        LocalContact::new(&ContactProblem { w, q: vec![Vector::zeros()], mu: vec![mu] }, 0)
    }

    /// Error of the law: motions relative to the free one, forces to the reaction.
    fn error<const D: usize>(contact: &LocalContact<D>, free: &Vector<D>, r: &Vector<D>) -> f64 {
        (contact.fixed_point(free, r) - r).norm()
            / (r.norm() + contact.rho * free.norm()).max(f64::MIN_POSITIVE)
    }

    /// The bi-potential alone converges linearly: it is asked for as many steps as it takes.
    fn solve<const D: usize, L: LocalSolver<D>>(
        contact: &LocalContact<D>,
        free: &Vector<D>,
        repetitions: usize,
    ) -> Vector<D> {
        (0..repetitions).fold(Vector::zeros(), |r, _| L::solve(contact, free, &r, 1e-14))
    }

    fn check<const D: usize>(entries: &[f64], free: &[f64], size: f64, mu: f64) {
        let contact = contact::<D>(entries, D, size, mu);
        let free = Vector::<D>::from_column_slice(&free[..D]);
        let condition =
            contact.inverse.map_or(f64::INFINITY, |inverse| inverse.norm() * contact.block.norm());
        if condition > 1e4 {
            return;
        }
        let enumerated = solve::<D, Enumerative>(&contact, &free, 1);
        assert!(error(&contact, &free, &enumerated) < 1e-12, "{contact:?} {free}: {enumerated}");
        assert!(cone::tangential_norm(&enumerated) <= mu * enumerated[0] * (1.0 + 1e-14));
        // The others may need to be started again where a condition number of 10⁴ makes the fixed point slow.
        // Where friction can hold a contact that nothing presses, they may go round in circles.
        let wedge = (1..D).map(|t| contact.block[(0, t)].powi(2)).sum::<f64>().sqrt();
        if mu * wedge > 0.9 * contact.block[(0, 0)] {
            return;
        }
        let newton = solve::<D, AlartCurnier>(&contact, &free, 5000);
        assert!(error(&contact, &free, &newton) < 1e-10, "{contact:?} {free}: {newton}");
        let fixed = solve::<D, Bipotential>(&contact, &free, 5000);
        assert!(error(&contact, &free, &fixed) < 1e-10, "{contact:?} {free}: {fixed}");
    }

    proptest! {
        #[test]
        fn single_contact_obeys_the_law(
            entries in proptest::collection::vec(-1.0..1.0, 9),
            free in proptest::collection::vec(-1.0..1.0, 3),
            decade in -6..6,
            mu in prop_oneof![Just(0.0), 0.01..1.0],
        ) {
            let size = 10f64.powi(decade);
            check::<1>(&entries, &free, size, mu);
            check::<2>(&entries, &free, size, mu);
            check::<3>(&entries, &free, size, mu);
        }

        /// Whatever the block, the answer is a number and inside the cone.
        #[test]
        fn singular_block_gives_a_reaction_of_the_cone(
            entries in proptest::collection::vec(-1.0..1.0, 9),
            free in proptest::collection::vec(-1.0..1.0, 3),
            rank in 0usize..3,
            mu in prop_oneof![Just(0.0), 0.01..1.0],
        ) {
            let contact = contact::<3>(&entries, rank, 1.0, mu);
            let free = Vector::<3>::from_column_slice(&free);
            for r in [
                Enumerative::solve(&contact, &free, &Vector::zeros(), 1e-12),
                AlartCurnier::solve(&contact, &free, &Vector::zeros(), 1e-12),
                Bipotential::solve(&contact, &free, &Vector::zeros(), 1e-12),
            ] {
                prop_assert!(r.iter().all(|x| x.is_finite()));
                prop_assert!(cone::tangential_norm(&r) <= mu * r[0] * (1.0 + 1e-14));
            }
        }
    }

    /// A plane of smooth ice: nothing resists sliding, and the closed forms of slip and stick still hold.
    #[test]
    fn contact_without_friction_gets_a_normal_reaction() {
        let contact = contact::<3>(&[1.0, 0.2, 0.1, 0.3, 1.0, 0.0, 0.1, 0.2, 1.0], 3, 1.0, 0.0);
        let free = Vector::<3>::new(-1.0, 0.4, 0.2);
        let expected = Vector::<3>::new(1.0 / contact.block[(0, 0)], 0.0, 0.0);
        assert!((Enumerative::solve(&contact, &free, &Vector::zeros(), 1e-12) - expected).norm() < 1e-14);
    }
}
