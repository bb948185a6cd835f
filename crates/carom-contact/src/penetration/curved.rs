//! Edges of second order, which between their nodes are where no node and no straight line between two of them is.

use carom_mesh::{CellKind, Facet, Vector};

use super::deep::Deep;
use super::shell::Shell;
use crate::aabb::Aabb;
use crate::surface::overshoot;
use crate::tolerances::MEASURE;

/// The ends of a curved edge and the node between them.
pub(super) type Curved = [u32; 3];

/// The curved edges of these facets, each once; in the plane the facets themselves.
pub(super) fn curved_edges(facets: &[Facet]) -> Vec<Curved> {
    let mut edges = Vec::new();
    for facet in facets.iter().filter(|f| f.kind.is_quadratic()) {
        let reference = facet.kind.reference();
        let sides = reference.facets.iter().filter(|_| facet.kind.dimension() == 2);
        let sides = sides.map(|(_, nodes)| [nodes[0], nodes[1], nodes[2]]);
        let line = (facet.kind.dimension() == 1).then_some([0, 1, 2]);
        for [a, b, middle] in sides.chain(line) {
            let [a, b] = [facet.nodes[a], facet.nodes[b]];
            edges.push([a.min(b), a.max(b), facet.nodes[middle]]);
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

impl<const D: usize> Shell<D> {
    /// What of the curved edges is deepest inside another boundary.
    pub fn curves_inside_of(&self, other: &Self) -> Deep<D> {
        let mut deepest = Deep::none();
        for edge in &self.curved {
            let room = self.room_of(edge);
            let mut is_near = false;
            other.tree.overlapping(&room, |_, _| is_near = true);
            if !is_near {
                continue;
            }
            let reach = room.diameter() + other.largest_cell;
            let (at, gap) = self.lowest(edge, &|x| other.signed_distance(x, reach).0);
            if -gap > deepest.depth {
                let nearest = other.signed_distance(&at, reach).1;
                deepest =
                    Deep { depth: -gap, at, facet: Some(self.around(edge[2])[0]), other: Some(nearest) };
            }
        }
        deepest
    }

    /// What of the curved edges is deepest inside what is this `gap` [m] away.
    pub fn curves_behind(&self, gap: &impl Fn(&Vector<D>) -> f64) -> Deep<D> {
        let mut deepest = Deep::none();
        for edge in &self.curved {
            // The distance from an obstacle changes by no more than the way.
            let reach = self.room_of(edge).diameter();
            if gap(&self.at(edge[2])) > reach {
                continue;
            }
            let (at, gap) = self.lowest(edge, gap);
            if -gap > deepest.depth {
                deepest = Deep { depth: -gap, at, facet: Some(self.around(edge[2])[0]), other: None };
            }
        }
        deepest
    }

    /// A box around a curved edge.
    fn room_of(&self, edge: &Curved) -> Aabb<D> {
        Aabb::of(edge.map(|n| self.at(n))).scaled(overshoot(CellKind::Line3))
    }

    /// Where on a curved edge a value is lowest, and the value: the least at a few places, and from there on by parabolas.
    fn lowest(&self, edge: &Curved, value: &impl Fn(&Vector<D>) -> f64) -> (Vector<D>, f64) {
        let [a, b, middle] = edge.map(|n| self.at(n));
        let at = |t: f64| a * (0.5 * t * (t - 1.0)) + b * (0.5 * t * (t + 1.0)) + middle * (1.0 - t * t);
        let there = |t: f64| (t, value(&at(t)));
        let lower = |p: (f64, f64), q: (f64, f64)| if q.1 < p.1 { q } else { p };
        let mut step = 2.0 / MEASURE.places as f64;
        let places = (0..=MEASURE.places).map(|k| there(k as f64 * step - 1.0));
        let mut lowest = places.fold((0.0, f64::INFINITY), lower);
        for _ in 0..MEASURE.parabolas {
            let t = lowest.0.clamp(step - 1.0, 1.0 - step);
            let [before, here, after] = [t - step, t, t + step].map(|t| there(t).1);
            let bend = before - 2.0 * here + after;
            let way = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
            lowest = lower(lowest, there(t + step * way.clamp(-1.0, 1.0)));
            step *= 0.25;
        }
        (at(lowest.0), lowest.1)
    }
}
