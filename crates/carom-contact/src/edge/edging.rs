//! Which edges a surface has.

use std::collections::BTreeMap;

use carom_mesh::{Facet, Vector};

use super::crossing::turns_outwards;
use super::{Bow, Edge, Side};
use crate::ContactSurface;
use crate::patch::{Patch, bows, rim};
use crate::path::Positions;
use crate::project::normal;
use crate::tolerances::{EDGES, SEARCH};

impl ContactSurface {
    /// The same boundary with its edges, if it is one in space: convex ones, at which facets meet at an angle in the `reference`
    /// configuration [m], and all others.
    pub(crate) fn edged<const D: usize>(mut self, reference: &Positions<'_, D>) -> Self {
        let mut open: BTreeMap<[u32; 2], ([u32; 2], Side)> = BTreeMap::new();
        for (f, facet) in (0..).zip(&self.facets).filter(|(_, facet)| facet.kind.dimension() == 2) {
            for [a, b] in rim(facet.kind) {
                let nodes = [facet.nodes[a], facet.nodes[b]];
                let [from, to] = nodes.map(|n| self.master(n));
                let places = facet.kind.reference().nodes;
                let side = Side { facet: f, ends: [a, b].map(|k| [places[k][0], places[k][1]]) };
                let Some((first, beside)) = open.remove(&[to, from]) else {
                    open.insert([from, to], (nodes, side));
                    continue;
                };
                // The other facet goes around it the other way.
                let side = Side { ends: [side.ends[1], side.ends[0]], ..side };
                let mut edge = Edge {
                    nodes: first,
                    bow: bow_of(first, &self.facets[beside.facet as usize]),
                    sides: [beside, side],
                    is_feature: false,
                    goes_on: [false; 2],
                };
                let [m0, m1] = SurfaceEdge { surface: &self, edge: &edge }.normals(0.5, reference);
                let along = edge.line(reference).chord();
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
            let line = edge.line(reference);
            for (end, from) in [(0, line.slope(0.0)), (1, -line.slope(1.0))] {
                let from = from.normalize();
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
    /// Outward unit normals of the two facets beside it, at its point at s or the end nearest to that.
    pub(crate) fn normals<const D: usize>(&self, s: f64, position: &Positions<'_, D>) -> [Vector<D>; 2] {
        let s = s.clamp(0.0, 1.0);
        self.edge.sides.map(|Side { facet, ends: [a, b] }| {
            let patch = Patch::new(&self.surface.facets[facet as usize], position);
            let xi = [0, 1].map(|i| a[i] * (1.0 - s) + b[i] * s);
            normal(&patch.at(&xi).tangents)
        })
    }
}

/// The curve that the line between two nodes around a facet is half of.
fn bow_of(nodes: [u32; 2], facet: &Facet) -> Option<Bow> {
    bows(facet.kind).map(|bow| bow.map(|k| facet.nodes[k])).find_map(|[a, b, middle]| {
        let between = nodes.iter().position(|n| *n == middle)?;
        match nodes[1 - between] {
            end if end == a => Some(Bow { far: b, between }),
            end if end == b => Some(Bow { far: a, between }),
            _ => None,
        }
    })
}
