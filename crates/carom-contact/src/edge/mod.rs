//! Edges of surfaces in space: where two bodies meet with crossed edges no node need face a facet.

mod crossing;
mod detect;

use std::collections::BTreeMap;

use carom_mesh::{CellKind, Vector};

use crate::ContactSurface;
use crate::patch::Patch;
use crate::project::normal;
use crate::surface::CORNER;

pub(crate) use crossing::Crossing;
pub(crate) use detect::path;

/// Cosine of the turning angle from which on a surface has an edge and is not flat there: 1°.
const FLAT: f64 = 0.999_847_695_156_391;

/// A straight line along which a surface turns away from its outside, as it is without deformation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edge {
    /// Its ends, in the sense in which they go around the first facet.
    pub nodes: [u32; 2],
    /// The facets that meet there, and where on them its middle is.
    sides: [(u32, [f64; 2]); 2],
    /// Whether the surface turns by as much as at a corner; other edges are those of facets of something round.
    is_sharp: bool,
}

impl Edge {
    /// The facets that meet there.
    pub fn facets(&self) -> impl Iterator<Item = u32> {
        self.sides.iter().map(|(facet, _)| *facet)
    }
}

impl ContactSurface {
    /// The same boundary with its convex edges, if it is one in space: those at which facets meet at an angle in the `reference`
    /// configuration [m].
    #[must_use]
    pub fn edged<const D: usize>(mut self, reference: &impl Fn(u32) -> Vector<D>) -> Self {
        let mut open: BTreeMap<[u32; 2], ([u32; 2], (u32, [f64; 2]))> = BTreeMap::new();
        for (f, facet) in (0..).zip(&self.facets).filter(|(_, facet)| facet.kind.dimension() == 2) {
            for ([a, b], at) in lines(facet.kind) {
                let nodes = [facet.nodes[a], facet.nodes[b]];
                let [from, to] = nodes.map(|n| self.master(n));
                let Some((first, side)) = open.remove(&[to, from]) else {
                    open.insert([from, to], (nodes, (f, at)));
                    continue;
                };
                let edge = Edge { nodes: first, sides: [side, (f, at)], is_sharp: false };
                let [m0, m1] = self.normals(&edge, reference);
                let along = reference(first[1]) - reference(first[0]);
                if crossing::turns_outwards(&along, [m0, m1]) && m0.dot(&m1) < FLAT {
                    self.edges.push(Edge { is_sharp: m0.dot(&m1) < CORNER, ..edge });
                }
            }
        }
        self.edges.sort_unstable_by_key(|e| e.nodes);
        self
    }

    /// Outward unit normals of the two facets of an edge, at its middle.
    fn normals<const D: usize>(
        &self,
        edge: &Edge,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> [Vector<D>; 2] {
        edge.sides.map(|(f, at)| {
            normal(&Patch::new(&self.facets[f as usize], position).at(&at).tangents)
        })
    }
}

/// The straight lines around a facet, from node to node, with the places of their middles; of a quadratic one two on each side.
fn lines(kind: CellKind) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
    let reference = kind.reference();
    let around = reference.facets.iter().flat_map(|(side, nodes)| {
        let halves = [[nodes[0], nodes[nodes.len() - 1]], [nodes[nodes.len() - 1], nodes[1]]];
        let whole = [[nodes[0], nodes[1]], [nodes[0], nodes[1]]];
        if side.is_quadratic() { halves.into_iter().take(2) } else { whole.into_iter().take(1) }
    });
    around.map(|[a, b]| {
        let [a_at, b_at] = [a, b].map(|k| reference.nodes[k]);
        ([a, b], [0, 1].map(|i| 0.5 * (a_at[i] + b_at[i])))
    })
}
