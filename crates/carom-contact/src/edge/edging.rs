//! Which edges a surface has.

use std::collections::BTreeMap;

use carom_mesh::{CellKind, Vector};

use super::crossing::turns_outwards;
use super::{Edge, Side};
use crate::ContactSurface;
use crate::patch::{Patch, rim};
use crate::path::Positions;
use crate::project::normal;
use crate::tolerances::{EDGES, SEARCH};

impl ContactSurface {
    /// The same boundary with its edges, if it is one in space: convex ones, at which facets meet at an angle in the `reference`
    /// configuration [m], and all others.
    pub(crate) fn edged<const D: usize>(mut self, reference: &Positions<'_, D>) -> Self {
        let mut open: BTreeMap<[u32; 2], ([u32; 2], Side)> = BTreeMap::new();
        for (f, facet) in (0..).zip(&self.facets).filter(|(_, facet)| facet.kind.dimension() == 2) {
            for ([a, b], middle) in lines(facet.kind) {
                let nodes = [facet.nodes[a], facet.nodes[b]];
                let [from, to] = nodes.map(|n| self.master(n));
                let side = Side { facet: f, middle };
                let Some((first, beside)) = open.remove(&[to, from]) else {
                    open.insert([from, to], (nodes, side));
                    continue;
                };
                let mut edge =
                    Edge { nodes: first, sides: [beside, side], is_feature: false, goes_on: [false; 2] };
                let [m0, m1] = SurfaceEdge { surface: &self, edge: &edge }.normals(reference);
                let along = reference(first[1]) - reference(first[0]);
                if turns_outwards(&along, [m0, m1]) && m0.dot(&m1) < EDGES.flat {
                    let is_long = |width: f64| along.norm() > EDGES.slender * width;
                    edge.is_feature =
                        m0.dot(&m1) < SEARCH.corner || self.widths(&edge, reference).into_iter().all(is_long);
                    self.edges.push(edge);
                } else {
                    self.flat_edges.push(edge);
                }
            }
        }
        self.edges.sort_unstable_by_key(|e| e.nodes);
        self.flat_edges.sort_unstable_by_key(|e| e.nodes);
        self.join_edges(reference);
        self.has_features = self.edges.iter().any(|e| e.is_feature);
        self
    }

    /// Finds the ends at which edges go on, by less of a turn than at a corner.
    fn join_edges<const D: usize>(&mut self, reference: &Positions<'_, D>) {
        let mut at: BTreeMap<u32, Vec<(usize, usize, Vector<D>)>> = BTreeMap::new();
        for (k, edge) in self.edges.iter().enumerate() {
            let along = (reference(edge.nodes[1]) - reference(edge.nodes[0])).normalize();
            for (end, from) in [(0, along), (1, -along)] {
                at.entry(self.master(edge.nodes[end])).or_default().push((k, end, from));
            }
        }
        for ends in at.values() {
            for (k, end, from) in ends {
                let goes_on =
                    |(other, _, on): &(usize, usize, Vector<D>)| other != k && -from.dot(on) > SEARCH.corner;
                self.edges[*k].goes_on[*end] = ends.iter().any(goes_on);
            }
        }
    }

    /// How wide the two facets of an edge are across it [m].
    fn widths<const D: usize>(&self, edge: &Edge, position: &Positions<'_, D>) -> [f64; 2] {
        let along = position(edge.nodes[1]) - position(edge.nodes[0]);
        let across = |x: Vector<D>| (x - along * (along.dot(&x) / along.norm_squared())).norm();
        edge.sides.map(|side| {
            let facet = &self.facets[side.facet as usize];
            let corners = &facet.nodes[..facet.kind.corner_count()];
            corners.iter().map(|&n| across(position(n) - position(edge.nodes[0]))).fold(0.0, f64::max)
        })
    }
}

/// An edge, and the surface that it is of.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfaceEdge<'a> {
    pub surface: &'a ContactSurface,
    pub edge: &'a Edge,
}

impl SurfaceEdge<'_> {
    /// Outward unit normals of the two facets beside it, at its middle.
    pub(crate) fn normals<const D: usize>(&self, position: &Positions<'_, D>) -> [Vector<D>; 2] {
        self.edge.sides.map(|side| {
            let patch = Patch::new(&self.surface.facets[side.facet as usize], position);
            normal(&patch.at(&side.middle).tangents)
        })
    }
}

/// The straight lines around a facet, from node to node, with the places of their middles.
fn lines(kind: CellKind) -> impl Iterator<Item = ([usize; 2], [f64; 2])> {
    let reference = kind.reference();
    rim(kind).map(|[a, b]| {
        let [a_at, b_at] = [a, b].map(|k| reference.nodes[k]);
        ([a, b], [0, 1].map(|i| 0.5 * (a_at[i] + b_at[i])))
    })
}
