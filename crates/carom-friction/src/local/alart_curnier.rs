use super::control::CONTROL;
use super::{Bipotential, LocalContact, LocalSolver};
use crate::equation::Equation;
use crate::{Vector, cone, small};

/// Semismooth Newton on Alart and Curnier's equation with a line search; the fixed point where it gets stuck.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AlartCurnier;

impl<const D: usize> LocalSolver<D> for AlartCurnier {
    #[inline]
    fn solve(contact: &LocalContact<D>, free: &Vector<D>, r: &Vector<D>, accuracy: f64) -> Vector<D> {
        let LocalContact { block, mu, rho, .. } = contact;
        let value = |r: &Vector<D>, w: &Vector<D>| Equation::AlartCurnier.value(r, w, *mu, *rho);
        let mut r = *r;
        let mut w = free + block * r;
        let mut merit = value(&r, &w).norm();
        for _ in 0..CONTROL.iterations {
            if merit <= accuracy * r.norm() {
                return cone::project(&r, *mu);
            }
            let at = Equation::AlartCurnier.linearise(&r, &w, *mu, *rho);
            let Some(inverse) = small::inverse(&(at.by_motion * block + at.by_reaction)) else { break };
            let step = -(inverse * at.value);
            let motion_step = block * step;
            let mut length = 1.0;
            let found = (0..CONTROL.halvings).find_map(|_| {
                let (r, w) = (r + step * length, w + motion_step * length);
                let trial = value(&r, &w).norm();
                length *= 0.5;
                (trial < (1.0 - 0.25 * length) * merit).then_some((r, w, trial))
            });
            let Some(better) = found else { break };
            (r, w, merit) = better;
        }
        Bipotential::solve(contact, free, &cone::project(&r, *mu), accuracy)
    }
}
