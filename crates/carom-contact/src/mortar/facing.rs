//! Which facets of two surfaces may press on one another in a step.

use carom_mesh::{Facet, Vector};

use super::plane::Plane;
use crate::aabb::Aabb;
use crate::{ContactModel, ContactSurface, Target};

/// A facet of the source and one of the target that may touch. Ordered by pair, source and target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Facing {
    /// Index of the pair.
    pub pair: u32,
    /// Index of the facet of the source.
    pub source: u32,
    /// Index of the facet of the target.
    pub target: u32,
}

/// Cosine of the largest angle, 60°, between a normal and the opposite one for facets to face one another. Those at the sides of
/// bodies that stand on one another do not.
const OPPOSED: f64 = 0.5;

/// How deep inside one another facets are still found, in diameters.
const DEPTH: f64 = 0.5;

impl<const D: usize> ContactModel<D> {
    /// Adds the facing facets of a pair that come within `margin` [m] of one another between `start` and `end`.
    pub(super) fn find_facing(
        &self,
        pair: usize,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
        margin: f64,
        out: &mut Vec<Facing>,
    ) {
        let Target::Surface(target) = self.pairs[pair].target else { return };
        let (source, target) = (&self.surfaces[self.pairs[pair].source], &self.surfaces[target]);
        let middle = |n: u32| (start(n) + end(n)) * 0.5;
        let swept = |surface: &ContactSurface, f: usize| {
            let nodes = surface.facets[f].nodes.iter();
            let facet_box = Aabb::of(nodes.flat_map(|&n| [start(n), end(n)]));
            facet_box.inflated(margin + DEPTH * facet_box.diameter())
        };
        let whole = |surface: &ContactSurface| {
            Aabb::of(surface.nodes.iter().flat_map(|&n| [start(n), end(n)])).inflated(margin)
        };
        // The facets that come near the other side at all.
        let near = |surface: &ContactSurface, other: &Aabb<D>| -> Vec<(usize, Aabb<D>, Vector<D>)> {
            (0..surface.facets.len())
                .map(|f| (f, swept(surface, f)))
                .filter(|(_, b)| b.overlaps(other))
                .filter_map(|(f, b)| Some((f, b, normal(&surface.facets[f], &middle)?)))
                .collect()
        };
        let targets = near(target, &whole(source));
        if targets.is_empty() {
            return;
        }
        for (f, source_box, outward) in near(source, &whole(target)) {
            let facing =
                targets.iter().filter(|(_, b, n)| n.dot(&outward) < -OPPOSED && b.overlaps(&source_box));
            out.extend(facing.map(|&(t, ..)| Facing {
                pair: pair as u32,
                source: f as u32,
                target: t as u32,
            }));
        }
    }
}

/// The outward normal of a facet, by its corners.
fn normal<const D: usize>(facet: &Facet, position: &impl Fn(u32) -> Vector<D>) -> Option<Vector<D>> {
    let mut corners = [Vector::zeros(); 4];
    let count = facet.kind.corner_count();
    corners.iter_mut().zip(&facet.nodes).for_each(|(x, &n)| *x = position(n));
    Plane::through(&corners[..count]).map(|p| p.normal())
}
