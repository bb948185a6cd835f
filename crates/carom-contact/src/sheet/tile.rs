//! A tile of a smooth surface: a Gregory patch whose control points are combinations of nodes.

use carom_mesh::Vector;
use smallvec::SmallVec;

use super::combination::Combination;
use super::gregory::{MAX_CONTROLS, control_count, degree_across, shape};
use super::network::{CornerOf, Network};
use super::tangents::{IN_PLANE, TangentPlane, Tangents};
use crate::closest::{Local, Parametric};
use crate::domain::Domain;
use crate::path::Positions;
use crate::project::Weights;

/// A tile.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Tile {
    pub domain: Domain,
    /// The facet that it is of.
    pub facet: u32,
    /// The tile across every side, and its side there; none beyond which the surface is not smooth.
    pub neighbours: SmallVec<[Option<CornerOf>; 4]>,
    /// The nodes that its control points are combinations of.
    pub nodes: Vec<u32>,
    /// Their weights, control point by control point.
    weights: Vec<f64>,
}

impl Tile {
    /// A tile of a network; its neighbours are still those of the network.
    pub fn new<const D: usize>(network: &Network, number: u32, tangents: &Tangents<'_, D>) -> Self {
        let cut = &network.tiles[number as usize];
        let count = cut.nodes.len() as u32;
        let domain = if count == 3 { Domain::Triangle } else { Domain::Square };
        let corners: Vec<Combination> = cut.nodes.iter().map(|&n| Combination::of(n)).collect();
        let slopes: Vec<[Combination; 2]> = (0..count).map(|k| tangents.of_side((number, k))).collect();
        let planes: Vec<_> = (0..count).map(|k| tangents.plane_at((number, k))).collect();
        let mut controls = corners.clone();
        for k in 0..count as usize {
            let next = (k + 1) % count as usize;
            let [first, last] = &slopes[k];
            let curve = [
                corners[k].clone(),
                corners[k].plus(1.0 / 3.0, first),
                corners[next].plus(-1.0 / 3.0, last),
                corners[next].clone(),
            ];
            let (before, after) = (&slopes[(k + count as usize - 1) % count as usize], &slopes[next]);
            let ends = [
                End { plane: planes[k].as_ref(), along: first, off: Combination::sum([(-1.0, &before[1])]) },
                End { plane: planes[next].as_ref(), along: last, off: after[0].clone() },
            ];
            let across = across(&ends, &curve, tangents);
            let inner = |i: usize| curve[i].plus(1.0 / degree_across(domain), &across[i - 1]);
            controls.extend([curve[1].clone(), curve[2].clone(), inner(1), inner(2)]);
        }
        let mut nodes: Vec<u32> = controls.iter().flat_map(|c| c.terms().map(|(n, _)| n)).collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut weights = vec![0.0; controls.len() * nodes.len()];
        for (row, control) in weights.chunks_exact_mut(nodes.len()).zip(&controls) {
            for (node, weight) in control.terms() {
                row[nodes.partition_point(|&n| n < node)] = weight;
            }
        }
        let neighbours = network.neighbours[number as usize].clone();
        Self { domain, facet: cut.facet, neighbours, nodes, weights }
    }

    /// The control points, seen from `x` [m].
    pub fn seen_from<const D: usize>(&self, x: &Vector<D>, position: &Positions<'_, D>) -> Controls<'_, D> {
        let mut at = [Vector::zeros(); MAX_CONTROLS];
        let offsets: SmallVec<[Vector<D>; 32]> = self.nodes.iter().map(|&n| position(n) - x).collect();
        for (at, row) in at.iter_mut().zip(self.weights.chunks_exact(self.nodes.len())) {
            for (offset, &weight) in offsets.iter().zip(row) {
                *at += offset * weight;
            }
        }
        Controls { tile: self, at }
    }

    /// The weights of the nodes where those of the control points are these.
    pub fn weights(&self, of_controls: &[f64; MAX_CONTROLS]) -> Weights {
        let mut weights = Weights::from_elem(0.0, self.nodes.len());
        for (row, &share) in self.weights.chunks_exact(self.nodes.len()).zip(of_controls) {
            for (sum, weight) in weights.iter_mut().zip(row) {
                *sum += share * weight;
            }
        }
        weights
    }

    /// The nodes that are its corners.
    #[cfg(test)]
    pub fn nodes_at_corners(&self) -> Vec<u32> {
        let rows = self.weights.chunks_exact(self.nodes.len()).take(self.domain.corners().len());
        rows.map(|row| self.nodes[row.iter().position(|&w| w == 1.0).expect("a node")]).collect()
    }

    /// The weights of the nodes at ξ.
    pub fn weights_at(&self, xi: &[f64; 2]) -> Weights {
        self.weights(&shape(self.domain, xi).map(|b| b.value))
    }
}

/// The control points of a tile, as offsets from a point [m]: these have less round-off than positions.
pub(super) struct Controls<'a, const D: usize> {
    tile: &'a Tile,
    at: [Vector<D>; MAX_CONTROLS],
}

impl<const D: usize> Controls<'_, D> {
    /// The points, whose convex hull holds the tile.
    pub fn points(&self) -> &[Vector<D>] {
        &self.at[..control_count(self.tile.domain)]
    }

    /// The weights of the control points at ξ and, from there straight on along the tangents, by a step in ξ.
    pub fn shares(&self, xi: &[f64; 2], beyond: [f64; 2]) -> [f64; MAX_CONTROLS] {
        shape(self.tile.domain, xi).map(|b| b.value + b.slope[0] * beyond[0] + b.slope[1] * beyond[1])
    }
}

impl<const D: usize> Parametric<D> for Controls<'_, D> {
    fn domain(&self) -> Domain {
        self.tile.domain
    }

    fn is_straight(&self) -> bool {
        false
    }

    fn local(&self, xi: &[f64; 2]) -> Local<D> {
        let mut local =
            Local { point: Vector::zeros(), tangents: [Vector::zeros(); 2], bends: [Vector::zeros(); 3] };
        for (x, b) in self.points().iter().zip(&shape(self.tile.domain, xi)) {
            local.point += x * b.value;
            local.tangents.iter_mut().zip(b.slope).for_each(|(t, slope)| *t += x * slope);
            local.bends.iter_mut().zip(b.bend).for_each(|(t, bend)| *t += x * bend);
        }
        local
    }
}

/// The two inner coefficients of the slope across a side, inwards and to the next sides at its ends.
///
/// The slope is α d + β c′ with the slope c′ along the `curve`, and a direction d across it that both tiles there share; so their tangent planes are
/// the same all along, however nodes move. At the ends d is c′ turned in the tangent plane by 90°, and α and β, which come from the reference
/// configuration, make of both the slopes of the next sides. Between, all three are linear.
fn across<const D: usize>(
    ends: &[End<'_, D>; 2],
    curve: &[Combination; 4],
    tangents: &Tangents<'_, D>,
) -> [Combination; 2] {
    let third = 1.0 / 3.0;
    let [Some((d0, alpha0, beta0)), Some((d1, alpha1, beta1))] =
        ends.each_ref().map(|end| end.shares(tangents))
    else {
        // Where sides are on one line there is no tangent plane, and a sharp edge may leave that of its corner.
        let [s0, s1] = ends.each_ref().map(|end| &end.off);
        return [[(2.0 * third, s0), (third, s1)], [(third, s0), (2.0 * third, s1)]].map(Combination::sum);
    };
    let slope = |i: usize| Combination::sum([(3.0, &curve[i + 1]), (-3.0, &curve[i])]);
    let c = [slope(0), slope(1), slope(2)];
    // Bézier coefficients of α d, of second degree; with β c′ they make those of the sum, of third.
    let q = [
        Combination::sum([(alpha0, &d0)]),
        Combination::sum([(0.5 * alpha0, &d1), (0.5 * alpha1, &d0)]),
        Combination::sum([(alpha1, &d1)]),
    ];
    [
        [(third, &q[0]), (2.0 * third, &q[1]), (beta1 * third, &c[0]), (2.0 * beta0 * third, &c[1])],
        [(2.0 * third, &q[1]), (third, &q[2]), (2.0 * beta1 * third, &c[1]), (beta0 * third, &c[2])],
    ]
    .map(Combination::sum)
}

/// One end of a side.
struct End<'a, const D: usize> {
    plane: Option<&'a TangentPlane<D>>,
    /// The slope of the side.
    along: &'a Combination,
    /// The slope of the next side there, away from this one.
    off: Combination,
}

impl<const D: usize> End<'_, D> {
    /// The slope along the side turned by 90°, and how much of it and of that along the side makes the slope of the next side.
    fn shares(&self, tangents: &Tangents<'_, D>) -> Option<(Combination, f64, f64)> {
        let plane = self.plane?;
        let [along, off] = [self.along, &self.off].map(|slope| tangents.coordinates(plane, slope));
        let turned = [-along[1], along[0]];
        let size = along[0] * along[0] + along[1] * along[1];
        if size.sqrt() < IN_PLANE * tangents.length(self.along) {
            return None;
        }
        let share = |other: [f64; 2]| (off[0] * other[0] + off[1] * other[1]) / size;
        Some((plane.image(turned), share(turned), share(along)))
    }
}
