use super::control::CONTROL;
use super::{LocalContact, LocalSolver};
use crate::Vector;

/// The bi-potential fixed point with ρ = 1/λ_max(A) [G. de Saxcé, Z.-Q. Feng, Math. Comput. Modelling 28 (1998) 225–245].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bipotential;

impl<const D: usize> LocalSolver<D> for Bipotential {
    #[inline]
    fn solve(contact: &LocalContact<D>, free: &Vector<D>, r: &Vector<D>, accuracy: f64) -> Vector<D> {
        let mut r = *r;
        for _ in 0..CONTROL.steps {
            let next = contact.fixed_point(free, &r);
            let moved = (next - r).norm_squared();
            r = next;
            if moved <= accuracy * accuracy * next.norm_squared() {
                break;
            }
        }
        r
    }
}
