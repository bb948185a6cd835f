//! What an impulse makes of the velocities of a body.

use std::ops::{Add, Range};

use carom_mesh::parallel::{each_chunk, reduce};
use carom_mesh::{Vector, nodal};

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
    /// The nodes that are looked at. All vectors below have an entry for each of these, but the last two.
    reached: Reached,
    inverse_diagonal: Vec<f64>,
    change: Vec<Vector<D>>,
    residual: Vec<Vector<D>>,
    direction: Vec<Vector<D>>,
    image: Vec<Vector<D>>,
    /// What is multiplied by the mass, with an entry per node of the body.
    spread: Vec<Vector<D>>,
    /// 1/M of every node of the body [1/kg].
    all_inverse: Vec<f64>,
}

impl<const D: usize> MassSolver<D> {
    /// Writes the change of velocity Δv [m/s] by an `impulse` [N s] to `change`: zero where displacements are held, and the same at nodes
    /// that are tied. Slices have an entry per node of the `body`, none of which is without mass.
    pub fn solve(&mut self, body: &Body<D>, impulse: &[Vector<D>], change: &mut [Vector<D>]) {
        self.prepare(body);
        // Tied nodes move at once however far apart they are.
        let ties = body.mesh().ties();
        change.copy_from_slice(impulse);
        to_masters(body, change);
        body.held().clear(change);
        self.reached.start(change.len(), |n| !ties.is_empty() || change[n].amax() > 0.0);
        [&mut self.change, &mut self.residual].into_iter().for_each(Vec::clear);
        self.residual.extend(self.reached.nodes.iter().map(|&n| change[n as usize]));
        self.inverse_diagonal.clear();
        self.spread.fill(Vector::zeros());
        self.grow(body, 0);
        let enough = TOLERANCE * TOLERANCE * self.left(0);
        self.grow(body, RINGS);
        loop {
            self.iterate(body, enough);
            let known = self.reached.nodes.len();
            self.grow(body, 1);
            self.reached.spread(&self.change, &mut self.spread);
            self.multiply(body, known);
            let rows = self.residual[known..].iter_mut().zip(&self.image[known..]);
            rows.for_each(|(residual, image)| *residual -= image);
            // What the next ring feels bounds what those beyond it do.
            if self.left(known) <= enough {
                break;
            }
            self.grow(body, RINGS);
        }
        change.fill(Vector::zeros());
        self.reached.spread(&self.change, change);
        ties.iter().for_each(|t| change[t.image as usize] = change[t.master as usize]);
    }

    /// Takes in so many rings of nodes, at which nothing is known yet.
    fn grow(&mut self, body: &Body<D>, rings: usize) {
        self.reached.grow(body, rings);
        let Self { reached, inverse_diagonal, change, residual, direction, image, all_inverse, .. } = self;
        let known = inverse_diagonal.len();
        inverse_diagonal.extend(reached.nodes[known..].iter().map(|&n| all_inverse[n as usize]));
        for vector in [change, residual, direction, image] {
            vector.resize(reached.nodes.len(), Vector::zeros());
        }
    }

    /// Conjugate gradients among the nodes that are reached.
    fn iterate(&mut self, body: &Body<D>, enough: f64) {
        let mut size = self.left(0);
        let mut kept = 0.0;
        self.direction.fill(Vector::zeros());
        for _ in 0..MAX_ITERATIONS {
            if size <= enough {
                break;
            }
            let Self { reached, inverse_diagonal, residual, direction, spread, .. } = self;
            each_chunk(direction, |first, direction| {
                let known = inverse_diagonal[first..].iter().zip(&residual[first..]);
                direction.iter_mut().zip(known).for_each(|(d, (w, r))| *d = r * *w + *d * kept);
            });
            // All nodes are reached where some are tied, each in the place of its number.
            body.mesh()
                .ties()
                .iter()
                .for_each(|t| direction[t.image as usize] = direction[t.master as usize]);
            reached.spread(direction, spread);
            self.multiply(body, 0);
            let Self { change, residual, direction, image, .. } = self;
            let length = size / nodal::dot(direction, image);
            nodal::each_of_two(change, residual, [direction, image], |v, r, [d, m]| {
                *v += d * length;
                *r -= m * length;
            });
            let before = std::mem::replace(&mut size, self.left(0));
            kept = size / before;
        }
    }

    /// Writes the rows of the nodes that are reached, from this number of them on, of M times what was spread to the image.
    fn multiply(&mut self, body: &Body<D>, from: usize) {
        let Self { reached, image, spread, .. } = self;
        let nodes = &reached.nodes[from..];
        each_chunk(&mut image[from..], |first, image| {
            let rows = image.iter_mut().zip(&nodes[first..]);
            rows.for_each(|(row, &n)| *row = body.mass().row_times(n as usize, spread));
        });
        body.ranks().iter().for_each(|ranks| ranks.sum(bytemuck::cast_slice_mut(&mut image[from..])));
        to_masters(body, image);
        for dof in body.held().dofs() {
            if let Some(held) = reached.place_of(dof.node) {
                image[held][dof.component as usize] = 0.0;
            }
        }
    }

    /// What is left to do at the nodes that are reached, from this number of them on: their residual, by their masses.
    fn left(&self, from: usize) -> f64 {
        let Self { residual, inverse_diagonal, .. } = self;
        let part = |nodes: Range<usize>| {
            let own = residual[nodes.clone()].iter().zip(&inverse_diagonal[nodes]);
            own.map(|(r, w)| r.norm_squared() * w).sum::<f64>()
        };
        reduce(from..residual.len(), &part, &Add::add)
    }

    fn prepare(&mut self, body: &Body<D>) {
        if !self.all_inverse.is_empty() {
            return;
        }
        let (mass, nodes) = (body.mass(), body.node_count());
        let own = |n: usize| mass.values[mass.graph().entry(n as u32, n as u32)];
        let mut diagonal: Vec<f64> = (0..nodes).map(own).collect();
        body.ranks().iter().for_each(|ranks| ranks.sum(&mut diagonal));
        self.all_inverse = diagonal.into_iter().map(f64::recip).collect();
        self.spread = nodal::zeros(nodes);
    }
}

/// The number of a node that is not reached.
const BEYOND: u32 = u32::MAX;

/// The nodes that an impulse may have reached, ring by ring.
#[derive(Debug, Default)]
struct Reached {
    nodes: Vec<u32>,
    /// Where the last ring begins.
    last: usize,
    /// The number among these of every node of the body.
    places: Vec<u32>,
}

impl Reached {
    /// Those at which it starts, of so many.
    fn start(&mut self, count: usize, is_hit: impl Fn(usize) -> bool) {
        self.nodes.iter().for_each(|&n| self.places[n as usize] = BEYOND);
        self.nodes.clear();
        self.places.resize(count, BEYOND);
        self.last = 0;
        for n in (0..count).filter(|&n| is_hit(n)) {
            self.places[n] = self.nodes.len() as u32;
            self.nodes.push(n as u32);
        }
    }

    /// The number of a node of the body among those that are reached.
    fn place_of(&self, node: u32) -> Option<usize> {
        Some(self.places[node as usize]).filter(|&place| place != BEYOND).map(|place| place as usize)
    }

    /// Writes the vectors of the nodes that are reached to an entry per node of the body.
    fn spread<const D: usize>(&self, vectors: &[Vector<D>], out: &mut [Vector<D>]) {
        self.nodes.iter().zip(vectors).for_each(|(&n, v)| out[n as usize] = *v);
    }

    /// Takes in so many rings of those that have a mass in common with the last ones.
    fn grow<const D: usize>(&mut self, body: &Body<D>, rings: usize) {
        let known = self.nodes.len();
        for _ in 0..rings {
            let end = self.nodes.len();
            for k in std::mem::replace(&mut self.last, end)..end {
                for (_, neighbour) in body.graph().row(self.nodes[k] as usize) {
                    if self.places[neighbour] == BEYOND {
                        self.places[neighbour] = self.nodes.len() as u32;
                        self.nodes.push(neighbour as u32);
                    }
                }
            }
        }
        // In the order of the matrix they cost less; the last ring alone is asked for its neighbours.
        if self.last > known {
            self.nodes[known..self.last].sort_unstable();
            (known..self.last).for_each(|k| self.places[self.nodes[k] as usize] = k as u32);
        }
    }
}

/// Leaves at masters what acts on their images.
fn to_masters<const D: usize>(body: &Body<D>, forces: &mut [Vector<D>]) {
    for tie in body.mesh().ties() {
        let at_image = std::mem::replace(&mut forces[tie.image as usize], Vector::zeros());
        forces[tie.master as usize] += at_image;
    }
}
