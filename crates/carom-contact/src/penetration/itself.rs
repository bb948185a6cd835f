//! A body inside itself.

use std::collections::BTreeSet;

use carom_mesh::Vector;

use super::deep::Deep;
use super::shell::Shell;
use crate::aabb::Aabb;
use crate::patch::Patch;
use crate::project::normal;
use crate::tolerances::MEASURE;

/// Where rays go: nearly along an axis, so that few boxes are in their way, and along no edge that anybody drew.
const RAY: [f64; 3] = [1.0, 0.013_717_421, 0.007_316_239];

impl<const D: usize> Shell<D> {
    /// What of this boundary is deepest inside another part of the same body.
    ///
    /// A boundary that crosses itself does so at an edge that goes through a facet. From there on its nodes are followed as long as the
    /// boundary winds around them once more. How deep they are is told no larger than the wall is thick that they are on.
    pub fn in_itself(&self) -> Deep<D> {
        let mut deepest = Deep::none();
        let mut seeds = BTreeSet::new();
        for &(nodes, own) in &self.edges {
            let ends = nodes.map(|n| self.at(n));
            self.tree.overlapping(&Aabb::of(ends), |f, _| {
                if self.facets[f as usize].nodes.iter().any(|n| nodes.contains(n)) {
                    return;
                }
                self.crossings(f, &ends, &mut |t, _| {
                    seeds.extend(nodes);
                    let at = ends[0] + (ends[1] - ends[0]) * t;
                    let depth =
                        ends.iter().map(|x| self.distance_from_plane(f, x)).fold(f64::INFINITY, f64::min);
                    deepest = deepest.deeper(Deep { depth, at, facet: Some(own), other: Some(f) });
                });
            });
        }
        if seeds.is_empty() {
            return deepest;
        }
        let inside = self.inside_from(seeds);
        let of_nodes = inside.into_iter().map(|(node, facet)| self.behind_others(node, facet));
        // Nodes say how deep it is; without any there is but an edge through a facet.
        of_nodes.reduce(Deep::deeper).filter(|deep| deep.depth > 0.0).unwrap_or(deepest)
    }

    /// The nodes that are inside another part of the body and can be reached from the seeds by others that are, each with a facet.
    fn inside_from(&self, seeds: BTreeSet<u32>) -> Vec<(u32, u32)> {
        let mut next_to: BTreeSet<(u32, u32)> = BTreeSet::new();
        for &([a, b], _) in &self.edges {
            next_to.extend([(a, b), (b, a)]);
        }
        let (mut open, mut seen, mut inside) = (Vec::from_iter(seeds.iter().copied()), seeds, Vec::new());
        while let Some(node) = open.pop() {
            let facet = self.around(node)[0];
            if self.winds_around(node, facet) {
                inside.push((node, facet));
                let others = next_to.range((node, 0)..=(node, u32::MAX)).map(|(_, other)| *other);
                open.extend(others.filter(|other| seen.insert(*other)));
            }
        }
        inside
    }

    /// Whether the boundary winds around what is just before a node.
    fn winds_around(&self, node: u32, facet: u32) -> bool {
        let Some(from) = self.before(node, facet) else { return false };
        let far = 2.0 * self.bounds().diameter();
        let ray = [from, from + Vector::from_fn(|i, _| RAY[i]) * far];
        let mut winding = 0;
        self.tree.overlapping(&Aabb::of(ray), |f, _| {
            self.crossings(f, &ray, &mut |_, leaves| winding += if leaves { 1 } else { -1 });
        });
        winding > 0
    }

    /// A place just before a node; none where a slot ends that has closed: there the facets around look at one another.
    fn before(&self, node: u32, facet: u32) -> Option<Vector<D>> {
        let outwards: Vector<D> = self.around(node).iter().map(|&f| self.normal(f)).sum();
        let outwards = outwards.try_normalize(MEASURE.closed)?;
        Some(self.at(node) + outwards * (MEASURE.before * self.diameter(facet)))
    }

    /// How far a node is behind the nearest facet that it is no part of.
    ///
    /// What is just before a node that touches another part is in that part, by as much as it is before the node: from there it is asked, lest
    /// the nearest facet that the node is behind is the far side of the other part.
    fn behind_others(&self, node: u32, facet: u32) -> Deep<D> {
        let Some(x) = self.before(node, facet) else { return Deep::none() };
        let position = |n: u32| self.at(n);
        let (mut depth, mut other) = (f64::INFINITY, None);
        self.tree.nearest(&x, |f, _| {
            let facet = &self.facets[f as usize];
            if !facet.nodes.contains(&node) {
                let patch = Patch::new(facet, &position);
                let p = patch.at(&patch.closest(&x));
                let offset = x - p.point;
                if normal(&p.tangents).dot(&offset) < 0.0 && offset.norm() < depth {
                    (depth, other) = (offset.norm(), Some(f));
                }
            }
            depth
        });
        depth -= MEASURE.before * self.diameter(facet);
        if other.is_some() && depth > 0.0 {
            Deep { depth, at: self.at(node), facet: Some(facet), other }
        } else {
            Deep::none()
        }
    }

    fn distance_from_plane(&self, f: u32, x: &Vector<D>) -> f64 {
        (x - self.at(self.facets[f as usize].nodes[0])).dot(&self.normal(f)).abs()
    }
}
