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
    /// boundary winds around them once more; where it winds around none, edges are looked at between their ends. An edge that lies flush on
    /// another part goes through its sides by round-off, and is no deeper than that. How deep a place is is told no larger than the wall is thick
    /// that it is on.
    pub fn in_itself(&self) -> Deep<D> {
        let (mut seeds, mut through) = (BTreeSet::new(), Vec::new());
        for &(nodes, own) in &self.edges {
            let ends = nodes.map(|n| self.at(n));
            let mut crossings = 0;
            self.tree.overlapping(&Aabb::of(ends), |f, _| {
                if self.facets[f as usize].nodes.iter().all(|n| !nodes.contains(n)) {
                    self.crossings(f, &ends, &mut |_, _| crossings += 1);
                }
            });
            if crossings > 0 {
                seeds.extend(nodes);
                through.push((nodes, own, crossings));
            }
        }
        let nodes = self.inside_from(seeds).into_iter().map(|place| self.behind_others(&place));
        let deepest = nodes.fold(Deep::none(), Deep::deeper);
        if deepest.depth > 0.0 {
            return deepest;
        }
        let of_edges =
            through.into_iter().map(|(nodes, own, crossings)| self.edge_inside(nodes, own, crossings));
        of_edges.fold(Deep::none(), Deep::deeper)
    }

    /// The nodes that are inside another part of the body and can be reached from the seeds by others that are.
    fn inside_from(&self, seeds: BTreeSet<u32>) -> Vec<Place<D>> {
        let mut next_to: BTreeSet<(u32, u32)> = BTreeSet::new();
        if !seeds.is_empty() {
            self.edges.iter().for_each(|&([a, b], _)| next_to.extend([(a, b), (b, a)]));
        }
        let (mut open, mut seen, mut inside) = (Vec::from_iter(seeds.iter().copied()), seeds, Vec::new());
        while let Some(node) = open.pop() {
            let around = self.around(node);
            let place = self.place_on([node; 2], self.at(node), around[0], around.iter().copied());
            if let Some(place) = place.filter(|place| self.winds_around(place)) {
                inside.push(place);
                let others = next_to.range((node, 0)..=(node, u32::MAX)).map(|(_, other)| *other);
                open.extend(others.filter(|other| seen.insert(*other)));
            }
        }
        inside
    }

    /// What of an edge between two nodes, which goes so often through other facets, is deepest inside another part of the body.
    fn edge_inside(&self, nodes: [u32; 2], own: u32, crossings: usize) -> Deep<D> {
        let ends = nodes.map(|n| self.at(n));
        let beside = || {
            let around = self.around(nodes[0]).iter().copied();
            around.filter(|f| self.facets[*f as usize].nodes.contains(&nodes[1]))
        };
        // It may go in and out several times: then some places between are outside.
        let places = if crossings <= 2 { 3 } else { 4 * crossings };
        let places = (0..places).filter_map(|k| {
            let share = (k as f64 + 0.5) / places as f64;
            self.place_on(nodes, ends[0] + (ends[1] - ends[0]) * share, own, beside())
        });
        let inside = places.filter(|place| self.winds_around(place));
        inside.map(|place| self.behind_others(&place)).fold(Deep::none(), Deep::deeper)
    }

    /// The place `at` a node or on an edge, beside these facets; none where a slot ends that has closed: there they look at one another.
    fn place_on(
        &self,
        nodes: [u32; 2],
        at: Vector<D>,
        own: u32,
        beside: impl Iterator<Item = u32>,
    ) -> Option<Place<D>> {
        let outwards: Vector<D> = beside.map(|f| self.normal(f)).sum();
        let outwards = outwards.try_normalize(MEASURE.closed)?;
        let distance = MEASURE.before * self.diameter(own);
        Some(Place { nodes, at, before: at + outwards * distance, distance, own })
    }

    /// Whether the boundary winds around what is just before a place of it.
    fn winds_around(&self, place: &Place<D>) -> bool {
        let far = 2.0 * self.bounds().diameter();
        let ray = [place.before, place.before + Vector::from_fn(|i, _| RAY[i]) * far];
        let mut winding = 0;
        self.tree.along(&ray, |f, _| {
            self.crossings(f, &ray, &mut |_, leaves| winding += if leaves { 1 } else { -1 });
        });
        winding > 0
    }

    /// How far a place is behind the nearest facet that it is no part of.
    ///
    /// What is just before a place that touches another part is in that part, by as much as it is before the place: from there it is asked, lest
    /// the nearest facet that the place is behind is the far side of the other part.
    fn behind_others(&self, place: &Place<D>) -> Deep<D> {
        let x = &place.before;
        let position = |n: u32| self.at(n);
        let (mut depth, mut other) = (f64::INFINITY, None);
        self.tree.nearest(x, |f, _| {
            let facet = &self.facets[f as usize];
            if place.nodes.iter().all(|n| !facet.nodes.contains(n)) {
                let patch = Patch::new(facet, &position);
                let p = patch.at(&patch.closest(x));
                let offset = x - p.point;
                if normal(&p.tangents).dot(&offset) < 0.0 && offset.norm() < depth {
                    (depth, other) = (offset.norm(), Some(f));
                }
            }
            depth
        });
        depth -= place.distance;
        if other.is_some() && depth > 0.0 {
            Deep { depth, at: place.at, facet: Some(place.own), other }
        } else {
            Deep::none()
        }
    }
}

/// A node, named twice, or a place on an edge.
struct Place<const D: usize> {
    nodes: [u32; 2],
    /// Where it is [m].
    at: Vector<D>,
    /// What is just before it, and how far [m].
    before: Vector<D>,
    distance: f64,
    /// The facet that it stands for.
    own: u32,
}
