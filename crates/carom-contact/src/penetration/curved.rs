//! Edges of second order, which between their nodes are where no node and no straight line between two of them is.

use carom_mesh::{CellKind, Vector};

use super::deep::Deep;
use super::shell::Shell;
use crate::aabb::Aabb;
use crate::surface::overshoot;
use crate::tolerances::MEASURE;

impl<const D: usize> Shell<D> {
    /// Tells `found` the deepest place of every curved edge that is inside another boundary, with its half from node to node and a facet beside it.
    pub fn curves_inside_of(&self, other: &Self, mut found: impl FnMut(Deep<D>, [u32; 2], u32)) {
        for edge in &self.curved {
            let own = self.beside(edge);
            if let Some((t, deep)) = self.dip_into(other, edge.map(|n| self.at(n)), own) {
                let end = if t < 0.0 { edge[0] } else { edge[1] };
                found(deep, [end.min(edge[2]), end.max(edge[2])], own);
            }
        }
    }

    /// The same of every straight edge inside one in space with curved facets, which reach into it between the nodes of both.
    pub fn lines_inside_of(&self, other: &Self, mut found: impl FnMut(Deep<D>, [u32; 2], u32)) {
        for (nodes, own) in self.straight() {
            let [a, b] = nodes.map(|n| self.at(n));
            if let Some((_, deep)) = self.dip_into(other, [a, b, (a + b) * 0.5], own) {
                found(deep, nodes, own);
            }
        }
    }

    /// Where on the parabola through three points of a facet of this, the last between the others, it is deepest inside another boundary, if it is.
    fn dip_into(&self, other: &Self, points: [Vector<D>; 3], own: u32) -> Option<(f64, Deep<D>)> {
        let room = room_of(&points);
        let mut is_near = false;
        other.tree.overlapping(&room, |_, _| is_near = true);
        if !is_near {
            return None;
        }
        let reach = room.diameter() + other.largest_cell;
        let (t, at, gap) = lowest(&points, &|x| other.signed_distance(x, reach).0);
        (gap < 0.0).then(|| {
            let nearest = other.signed_distance(&at, reach).1;
            (t, Deep { depth: -gap, at, facet: Some(own), other: Some(nearest) })
        })
    }

    /// What of the curved edges is deepest inside what is this `gap` [m] away.
    pub fn curves_behind(&self, gap: &impl Fn(&Vector<D>) -> f64) -> Deep<D> {
        let mut deepest = Deep::none();
        for edge in &self.curved {
            // The distance from an obstacle changes by no more than the way.
            let points = edge.map(|n| self.at(n));
            if gap(&points[2]) > room_of(&points).diameter() {
                continue;
            }
            let (_, at, gap) = lowest(&points, gap);
            if -gap > deepest.depth {
                deepest = Deep { depth: -gap, at, facet: Some(self.beside(edge)), other: None };
            }
        }
        deepest
    }

    /// The facet beside a curved edge that it is an arc of: where a round side ends it is that of the side.
    fn beside(&self, edge: &[u32; 3]) -> u32 {
        let around = self.around(edge[2]);
        let rounder = |a: u32, &b: &u32| if self.first_arc(b) > self.first_arc(a) { b } else { a };
        around.iter().fold(around[0], rounder)
    }
}

/// A box around the parabola through three points, the last between the others.
fn room_of<const D: usize>(points: &[Vector<D>; 3]) -> Aabb<D> {
    Aabb::of(*points).scaled(overshoot(CellKind::Line3))
}

/// Where on such a parabola a value is lowest, from -1 at its start to 1, the place, and the value: the least at a few places, and from there on by parabolas.
fn lowest<const D: usize>(
    [a, b, middle]: &[Vector<D>; 3],
    value: &impl Fn(&Vector<D>) -> f64,
) -> (f64, Vector<D>, f64) {
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
    (lowest.0, at(lowest.0), lowest.1)
}
