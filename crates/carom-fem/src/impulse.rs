//! What an impulse makes of the velocities of a body.

use carom_mesh::Vector;

use crate::Body;

/// The residual at which M⁻¹ p is known, relative to p. It is well above round-off and far below what is asked of an impulse.
const TOLERANCE: f64 = 1e-13;

/// Iterations after which the residual is as small as it gets: diag(M)⁻¹ M has a condition of at most 64, that of cells of second order.
const MAX_ITERATIONS: usize = 200;

/// How many rings of cells around a blow are looked at before it is asked whether more feel it: of a consistent mass each takes (2 − √3) of
/// what the last one felt, and this many take it to round-off.
const RINGS: usize = 24;

/// Solves M Δv = p by conjugate gradients with the diagonal as preconditioner, and so without a factor. Their number of iterations
/// depends on the kind of the cells alone (Wathen 1987).
///
/// A blow on a few nodes costs what the cells around these cost: what is so far away that it does not feel it is not looked at.
#[derive(Debug, Default)]
pub struct MassSolver<const D: usize> {
    inverse_diagonal: Vec<f64>,
    residual: Vec<Vector<D>>,
    direction: Vec<Vector<D>>,
    image: Vec<Vector<D>>,
    reached: Reached,
    /// What is summed over the ranks that share a body.
    parts: Vec<Vector<D>>,
}

impl<const D: usize> MassSolver<D> {
    /// Writes the change of velocity Δv [m/s] by an `impulse` [N s] to `change`: zero where displacements are held, and the same at nodes
    /// that are tied. Slices have an entry per node of the `body`, none of which is without mass.
    pub fn solve(&mut self, body: &Body<D>, impulse: &[Vector<D>], change: &mut [Vector<D>]) {
        self.prepare(body);
        self.residual.copy_from_slice(impulse);
        restrict(body, &mut self.residual);
        change.fill(Vector::zeros());
        // Tied nodes move at once however far apart they are.
        let ties = body.mesh().ties();
        let Self { reached, residual, .. } = self;
        reached.start(residual.len(), |n| !ties.is_empty() || residual[n].amax() > 0.0);
        let enough = TOLERANCE * TOLERANCE * self.left(0);
        self.reached.grow(body, RINGS);
        loop {
            self.iterate(body, change, enough);
            let known = self.reached.nodes.len();
            self.reached.grow(body, 1);
            self.multiply(body, change, known);
            for &n in &self.reached.nodes[known..] {
                self.residual[n as usize] -= self.image[n as usize];
            }
            // What the next ring feels bounds what those beyond it do.
            if self.left(known) <= enough {
                break;
            }
            self.reached.grow(body, RINGS);
        }
        ties.iter().for_each(|t| change[t.image as usize] = change[t.master as usize]);
    }

    /// Conjugate gradients among the nodes that are reached.
    fn iterate(&mut self, body: &Body<D>, change: &mut [Vector<D>], enough: f64) {
        let ties = body.mesh().ties();
        let mut size = self.left(0);
        let mut kept = 0.0;
        self.direction.fill(Vector::zeros());
        for _ in 0..MAX_ITERATIONS {
            if size <= enough {
                break;
            }
            let Self { inverse_diagonal, residual, direction, reached, .. } = self;
            for n in reached.nodes() {
                direction[n] = residual[n] * inverse_diagonal[n] + direction[n] * kept;
            }
            ties.iter().for_each(|t| direction[t.image as usize] = direction[t.master as usize]);
            let direction = std::mem::take(direction);
            self.multiply(body, &direction, 0);
            self.direction = direction;
            let Self { residual, direction, image, reached, .. } = self;
            let length = size / reached.nodes().map(|n| direction[n].dot(&image[n])).sum::<f64>();
            for n in reached.nodes() {
                change[n] += direction[n] * length;
                residual[n] -= image[n] * length;
            }
            let before = std::mem::replace(&mut size, self.left(0));
            kept = size / before;
        }
    }

    /// Writes the rows of M v of the nodes that are reached, from this number of them on, to the image.
    fn multiply(&mut self, body: &Body<D>, v: &[Vector<D>], from: usize) {
        let Self { image, reached, parts, .. } = self;
        let nodes = || reached.nodes[from..].iter().map(|&n| n as usize);
        for n in nodes() {
            image[n] = body.mass().row_times(n, v);
        }
        if let Some(ranks) = body.ranks() {
            parts.clear();
            parts.extend(nodes().map(|n| image[n]));
            ranks.sum(bytemuck::cast_slice_mut(parts));
            nodes().zip(&*parts).for_each(|(n, sum)| image[n] = *sum);
        }
        restrict(body, image);
    }

    /// What is left to do at the nodes that are reached, from this number of them on: their residual, by their masses.
    fn left(&self, from: usize) -> f64 {
        let nodes = self.reached.nodes[from..].iter().map(|&n| n as usize);
        nodes.map(|n| self.residual[n].norm_squared() * self.inverse_diagonal[n]).sum()
    }

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

/// The nodes that an impulse may have reached, ring by ring.
#[derive(Debug, Default)]
struct Reached {
    nodes: Vec<u32>,
    /// Where the last ring begins.
    last: usize,
    is_within: Vec<bool>,
}

impl Reached {
    /// Those at which it starts, of so many.
    fn start(&mut self, count: usize, is_hit: impl Fn(usize) -> bool) {
        self.nodes.iter().for_each(|&n| self.is_within[n as usize] = false);
        self.nodes.clear();
        self.is_within.resize(count, false);
        self.last = 0;
        for n in (0..count).filter(|&n| is_hit(n)) {
            self.nodes.push(n as u32);
            self.is_within[n] = true;
        }
    }

    fn nodes(&self) -> impl Iterator<Item = usize> + Clone {
        self.nodes.iter().map(|&n| n as usize)
    }

    /// Takes in so many rings of those that have a mass in common with the last ones.
    fn grow<const D: usize>(&mut self, body: &Body<D>, rings: usize) {
        let known = self.nodes.len();
        for _ in 0..rings {
            let end = self.nodes.len();
            for k in std::mem::replace(&mut self.last, end)..end {
                for (_, neighbour) in body.graph().row(self.nodes[k] as usize) {
                    if !std::mem::replace(&mut self.is_within[neighbour], true) {
                        self.nodes.push(neighbour as u32);
                    }
                }
            }
        }
        // In the order of the matrix they cost less; the last ring alone is asked for its neighbours.
        self.nodes[known..self.last].sort_unstable();
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
