//! What an impulse makes of the velocities of a body.

use carom_mesh::{Vector, nodal};

use crate::Body;

/// The residual at which M⁻¹ p is known, relative to p. It is well above round-off and far below what is asked of an impulse.
const TOLERANCE: f64 = 1e-13;

/// Iterations after which the residual is as small as it gets: diag(M)⁻¹ M has a condition of at most 64, that of cells of second order.
const MAX_ITERATIONS: usize = 200;

/// Solves M Δv = p by conjugate gradients with the diagonal as preconditioner, and so without a factor. Their number of iterations
/// depends on the kind of the cells alone (Wathen 1987).
#[derive(Debug, Default)]
pub struct MassSolver<const D: usize> {
    inverse_diagonal: Vec<f64>,
    residual: Vec<Vector<D>>,
    direction: Vec<Vector<D>>,
    image: Vec<Vector<D>>,
}

impl<const D: usize> MassSolver<D> {
    /// Writes the change of velocity Δv [m/s] by an `impulse` [N s] to `change`: zero where displacements are held, and the same at nodes
    /// that are tied. Slices have an entry per node of the `body`, none of which is without mass.
    pub fn solve(&mut self, body: &Body<D>, impulse: &[Vector<D>], change: &mut [Vector<D>]) {
        self.prepare(body);
        let Self { inverse_diagonal, residual, direction, image } = self;
        residual.copy_from_slice(impulse);
        restrict(body, residual);
        change.fill(Vector::zeros());
        let weighted =
            |r: &[Vector<D>]| r.iter().zip(&*inverse_diagonal).map(|(r, m)| r.norm_squared() * m).sum();
        let mut size: f64 = weighted(residual);
        let enough = TOLERANCE * TOLERANCE * size;
        let mut kept = 0.0;
        for _ in 0..MAX_ITERATIONS {
            if size <= enough {
                break;
            }
            for ((p, r), m) in direction.iter_mut().zip(&*residual).zip(&*inverse_diagonal) {
                *p = r * *m + *p * kept;
            }
            body.mesh()
                .ties()
                .iter()
                .for_each(|t| direction[t.image as usize] = direction[t.master as usize]);
            body.multiply_mass(direction, image);
            restrict(body, image);
            let length = size / nodal::dot(direction, image);
            nodal::each(change, [direction], |x, [p]| *x += p * length);
            nodal::each(residual, [image], |r, [a]| *r -= a * length);
            let before = std::mem::replace(&mut size, weighted(residual));
            kept = size / before;
        }
        body.mesh().ties().iter().for_each(|t| change[t.image as usize] = change[t.master as usize]);
    }

    /// Makes room when it is first asked.
    fn prepare(&mut self, body: &Body<D>) {
        if !self.inverse_diagonal.is_empty() {
            return;
        }
        let (mass, nodes) = (body.mass(), body.node_count());
        let own = |n: usize| mass.values[mass.graph().entry(n as u32, n as u32)];
        let mut diagonal: Vec<f64> = (0..nodes).map(own).collect();
        body.ranks().iter().for_each(|ranks| ranks.sum(&mut diagonal));
        self.inverse_diagonal = diagonal.into_iter().map(f64::recip).collect();
        let zeros = vec![Vector::zeros(); nodes];
        (self.residual, self.direction, self.image) = (zeros.clone(), zeros.clone(), zeros);
    }
}

/// Leaves of forces what free nodes feel: nothing where displacements are held, at masters what acts on their images.
fn restrict<const D: usize>(body: &Body<D>, forces: &mut [Vector<D>]) {
    for tie in body.mesh().ties() {
        let at_image = std::mem::replace(&mut forces[tie.image as usize], Vector::zeros());
        forces[tie.master as usize] += at_image;
    }
    body.held().clear(forces);
}
