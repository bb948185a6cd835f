//! The nodes of the outline of a reduced body that no iteration asks for, in clumps of which is known how far vibrations move them at most.
//!
//! To place a node where it is takes all shapes. Where nothing is near it does as well where the body without strain would have it.

use carom_fem::{Body, Reduction};
use carom_mesh::{Matrix, Surface, Vector};

use super::place::Place;
use crate::body::Ball;
use crate::body::rigid::pose::lower;
use crate::body::rigid::shape::RigidShape;

/// Nodes of a clump, at most: with more many are placed that nothing is near of, with fewer the clumps cost what the nodes do.
const NODES: usize = 64;

/// A facet of second order goes beyond its nodes by as much as it is large, at most, and moves by three times what they do.
const BEYOND: f64 = 2.0;
const MOVES: f64 = 3.0;

/// Nodes that are near one another.
#[derive(Debug, Clone, PartialEq)]
struct Clump {
    nodes: Vec<u32>,
    /// The middle of its nodes, from the centre of mass of the body [m].
    arm: Vector<3>,
    /// How far its facets are from there at most, without strain [m].
    radius: f64,
    /// How far an amplitude of one of every vibration moves its facets at most [1/√kg].
    most: Vec<f64>,
}

/// The outline of a reduced body but for the nodes that every step moves.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outline {
    clumps: Vec<Clump>,
}

impl Outline {
    /// Those of the outline that are not among these, which are ascending.
    pub fn new<const D: usize>(
        body: &Body<D>,
        shape: &RigidShape<D>,
        reduction: &Reduction<D>,
        placed: &[u32],
    ) -> Self {
        let surface = Surface::of(body.mesh());
        let x = body.mesh().nodes();
        let mut reach = vec![0.0_f64; body.node_count()];
        let mut moves = vec![1.0_f64; body.node_count()];
        for facet in surface.facets() {
            let corners = || facet.nodes.iter().map(|&n| x[n as usize]);
            let size = corners().flat_map(|a| corners().map(move |b| (a - b).norm())).fold(0.0, f64::max);
            let (beyond, moved) = if facet.kind.is_quadratic() { (BEYOND, MOVES) } else { (1.0, 1.0) };
            for &n in &facet.nodes {
                reach[n as usize] = reach[n as usize].max(beyond * size);
                moves[n as usize] = moves[n as usize].max(moved);
            }
        }
        let mut rest: Vec<u32> = surface.nodes().to_vec();
        rest.retain(|n| placed.binary_search(n).is_err());
        let mut groups = Vec::new();
        divide(rest, x, &mut groups);
        // What a facet does hangs on all of its nodes, in whatever clump they are.
        let mut of_facets: Vec<Vec<u32>> = vec![Vec::new(); body.node_count()];
        for facet in surface.facets() {
            facet.nodes.iter().for_each(|&n| of_facets[n as usize].extend(&facet.nodes));
        }
        let clumps = groups.into_iter().map(|nodes| {
            let arms = || nodes.iter().map(|&n| shape.arm(n as usize));
            let arm = arms().sum::<Vector<3>>() / nodes.len() as f64;
            let radius = nodes
                .iter()
                .map(|&n| (shape.arm(n as usize) - arm).norm() + reach[n as usize])
                .fold(0.0, f64::max);
            let mut most = vec![0.0_f64; reduction.count()];
            for &n in &nodes {
                for &other in &of_facets[n as usize] {
                    let shapes = reduction.shapes_at(other as usize);
                    for (k, most) in most.iter_mut().enumerate() {
                        let shape = Vector::<D>::from_fn(|i, _| shapes[i][k]);
                        *most = most.max(shape.norm() * moves[n as usize]);
                    }
                }
            }
            Clump { nodes, arm, radius, most }
        });
        Self { clumps: clumps.collect() }
    }

    /// How far vibrations of these amplitudes move a node of it at most [m].
    pub fn bend(&self, amplitudes: &[f64]) -> f64 {
        self.clumps.iter().map(|clump| clump.bend(amplitudes)).fold(0.0, f64::max)
    }

    /// Writes a ball for every clump, in which it is all the way from `start` to `end`; `most` is scratch of as many amplitudes.
    pub fn balls<const D: usize>(
        &self,
        shape: &RigidShape<D>,
        [start, end]: [&Place; 2],
        most: &mut [f64],
        out: &mut Vec<Ball<D>>,
    ) {
        let centre = shape.centre;
        let ends = start.amplitudes.iter().zip(&end.amplitudes);
        most.iter_mut().zip(ends).for_each(|(most, (a, b))| *most = a.abs().max(b.abs()));
        out.clear();
        out.extend(self.clumps.iter().map(|clump| {
            let [from, to] =
                [start, end].map(|place| centre + place.pose.shift + place.pose.rotation * clump.arm);
            Ball {
                centre: lower(&((from + to) * 0.5)),
                radius: clump.radius + clump.bend(most) + 0.5 * (to - from).norm(),
            }
        }));
    }

    /// Places the nodes of every clump at the `end` of a step and says how far they moved [m]: where the clump `is_near` of something by what is `exact`, the
    /// displacements of a node at both ends, elsewhere as the body without strain would have them.
    pub fn place<const D: usize>(
        &self,
        (shape, exact): (&RigidShape<D>, impl Fn(usize) -> [Vector<D>; 2]),
        [start, end]: [&Place; 2],
        [displacement, motion]: [&mut [Vector<D>]; 2],
        is_near: &dyn Fn(usize) -> bool,
    ) {
        let shift = end.pose.shift - start.pose.shift;
        let turn = end.pose.rotation - start.pose.rotation;
        let turned = end.pose.rotation - Matrix::identity();
        for (k, clump) in self.clumps.iter().enumerate() {
            let is_near = is_near(k);
            for node in clump.nodes.iter().map(|&n| n as usize) {
                if is_near {
                    let [from, to] = exact(node);
                    (displacement[node], motion[node]) = (to, to - from);
                } else {
                    let arm = shape.arm(node);
                    displacement[node] = lower(&(end.pose.shift + turned * arm));
                    motion[node] = lower(&(shift + turn * arm));
                }
            }
        }
    }
}

impl Clump {
    fn bend(&self, amplitudes: &[f64]) -> f64 {
        // Eight sums at once: one would wait for itself.
        let mut sums = [0.0; 8];
        for (most, amplitudes) in self.most.chunks(8).zip(amplitudes.chunks(8)) {
            for (sum, (most, a)) in sums.iter_mut().zip(most.iter().zip(amplitudes)) {
                *sum += most * a.abs();
            }
        }
        sums.iter().sum()
    }
}

/// Cuts nodes along the longest side of the box around them until there are few.
fn divide<const D: usize>(mut nodes: Vec<u32>, x: &[Vector<D>], out: &mut Vec<Vec<u32>>) {
    if nodes.len() <= NODES {
        if !nodes.is_empty() {
            nodes.sort_unstable();
            out.push(nodes);
        }
        return;
    }
    let mut low = x[nodes[0] as usize];
    let mut high = low;
    for &n in &nodes {
        (low, high) = (low.inf(&x[n as usize]), high.sup(&x[n as usize]));
    }
    let axis = (high - low).imax();
    nodes.sort_by(|&a, &b| x[a as usize][axis].total_cmp(&x[b as usize][axis]).then(a.cmp(&b)));
    let rest = nodes.split_off(nodes.len() / 2);
    divide(nodes, x, out);
    divide(rest, x, out);
}
