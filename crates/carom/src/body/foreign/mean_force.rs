//! The internal force of a step.

use carom_mesh::{Matrix, Vector, nodal, tensor};

use super::code::ForeignCode;
use crate::body::Guess;
use crate::scheme::StressRule;

/// Where a body deforms by less than this part of its motion, there is nothing that a step could miss of its energy, and round-off is all there is.
const RIGID: f64 = 1e-7;

/// The same in terms of its size: where it is at rest there is neither motion nor change of energy, and the quotient of the two would be one of round-off, which
/// contacts that stick would bear.
const STILL: f64 = 1e-9;

/// The mean force of a step, and room for it.
pub(super) struct MeanForce<const D: usize> {
    reference: Vec<Vector<D>>,
    /// u in the middle of the step [m].
    middle: Vec<Vector<D>>,
    /// Where nodes are there [m], from their centre, and how the motion deforms the body [m].
    arms: Vec<Vector<D>>,
    deforming: Vec<Vector<D>>,
}

impl<const D: usize> MeanForce<D> {
    /// Of a body with nodes at `reference` [m].
    pub fn new(reference: Vec<Vector<D>>) -> Self {
        let zeros = vec![Vector::zeros(); reference.len()];
        Self { reference, middle: zeros.clone(), arms: zeros.clone(), deforming: zeros }
    }

    /// Writes the mean force [N] of a guess to `out`. With the scheme `conserving` its work over the motion d is the change of the energy,
    ///
    /// ```text
    /// f̄ = f(u_m) + [E(u₊) − E(u) − f(u_m)·d] / |d'|² d',        u_m = u + d/2
    /// ```
    ///
    /// (Gonzalez, J. Nonlinear Sci. 6, 1996), where d' is d less the rigid motion nearest to it, from x_m. So f̄ has neither resultant nor moment about x_m,
    /// and momenta are kept.
    pub fn write(&mut self, code: &dyn ForeignCode<D>, guess: &Guess<'_, D>, out: &mut [Vector<D>]) {
        let (map, d, start) = (&guess.interval.map, guess.motion, &guess.start);
        if map.stress == StressRule::Weighted {
            code.force(guess.displacement, out);
            nodal::each(out, [start.internal_force], |f, [f0]| *f = *f * map.xi + f0 * (1.0 - map.xi));
            return;
        }
        nodal::each(&mut self.middle, [start.displacement, d], |m, [u, d]| *m = u + d * 0.5);
        code.force(&self.middle, out);
        self.deform(d);
        let size = nodal::dot(&self.deforming, &self.deforming);
        let rigid = RIGID * RIGID * nodal::dot(d, d);
        if size <= rigid.max(STILL * STILL * nodal::dot(&self.arms, &self.arms)) {
            return;
        }
        let missing = code.energy(guess.displacement) - start.energies.strain - nodal::dot(out, d);
        nodal::each(out, [&self.deforming], |f, [d]| *f += d * (missing / size));
    }

    /// Finds how the motion `d` deforms the body: what is orthogonal to all rigid motions from the middle.
    fn deform(&mut self, d: &[Vector<D>]) {
        let Self { reference, middle, arms, deforming } = self;
        nodal::each(arms, [reference, middle], |x, [x0, u]| *x = x0 + u);
        let count = d.len() as f64;
        let (centre, shift) = (nodal::total(arms) / count, nodal::total(d) / count);
        arms.iter_mut().for_each(|x| *x -= centre);
        nodal::each(deforming, [d], |e, [d]| *e = d - shift);
        // ω from Σ y × (ω × y) = Σ y × d, of which the plane has the third component alone.
        let lift = |v: &Vector<D>| Vector::<3>::from_fn(|i, _| if i < D { v[i] } else { 0.0 });
        let mut inertia = Matrix::<3>::zeros();
        let mut moment = Vector::<3>::zeros();
        for (y, e) in arms.iter().zip(&*deforming) {
            let (y, e) = (lift(y), lift(e));
            inertia += Matrix::<3>::from_diagonal_element(y.norm_squared()) - y * y.transpose();
            moment += Vector::<3>::from(tensor::cross(&y, &e));
        }
        let Some(turn) = inertia.lu().solve(&moment) else { return };
        for (e, y) in deforming.iter_mut().zip(&*arms) {
            let along = tensor::cross(&turn, &lift(y));
            *e -= Vector::from_fn(|i, _| along[i]);
        }
    }
}
