use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::edge::Crossing;
use crate::facing::{Projected, faced};
use crate::frame::frame;
use crate::project::Reach;
use crate::tolerances::SEARCH;
use crate::{Candidate, Contact, ContactModel, Search, Site, Target};

impl<const D: usize> ContactModel<D> {
    /// Finds the nodes that come within `margin` [m] of their target or are inside it, and the facets they face. In space it also
    /// finds the edges that cross those of the target.
    ///
    /// `start` and `end` are the positions at the start of the step and those predicted for its end. A node keeps its facet for
    /// the whole step: the closest one at the predicted middle among those that face it. Facing decides at corners, where
    /// the closest facet alone is ambiguous. Nodes are found inside a target to a depth of half a facet. On a smooth target
    /// the closest point may move on to other facets. Mortar pairs are left to `detect_mortar`.
    ///
    /// A node that slides over the rim of its target while it is a little
    /// inside, as the condition `midpoint` lets it, is beside the target from then on.
    pub fn detect(
        &self,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
        margin: f64,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        out.clear();
        search.sweep(self, start, end);
        for (p, pair) in self.pairs.iter().enumerate() {
            let pair_index = p as u32;
            let source = &self.surfaces[pair.source];
            match pair.target {
                Target::Obstacle(o) => {
                    let obstacle = &self.obstacles[o];
                    let near = |&&node: &&u32| {
                        obstacle.is_near(&start(node), margin, start)
                            || obstacle.is_near(&end(node), margin, end)
                    };
                    let candidate = |&node: &u32| Candidate::at_node(pair_index, node, None);
                    out.extend(source.sources.iter().filter(near).map(candidate));
                }
                Target::Surface(_) if self.is_mortar(p) => {}
                Target::Surface(t) => {
                    let Some(room) = search.meeting(pair.source, t, margin) else { continue };
                    self.detect_facets(pair_index, t, &room, start, end, margin, search, out);
                    // From the other side they are the same.
                    if self.directions(p).start == p {
                        self.detect_crossings(pair_index, t, &room, start, end, margin, search, out);
                    }
                }
            }
        }
        self.mark_mirrored(&|n| (start(n) + end(n)) * 0.5, out);
    }

    /// Adds to the candidates `out` of [`ContactModel::detect`] those of nodes that were `known` before and are not among them, with the
    /// facets that they faced then.
    pub fn recall(
        &self,
        known: &[Candidate],
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
        out: &mut Vec<Candidate>,
    ) {
        let found = out.len();
        for candidate in known.iter().filter(|c| !self.is_mortar(c.pair as usize)) {
            if out[..found].binary_search_by_key(&candidate.key(), Candidate::key).is_err() {
                out.push(Candidate { redundant: false, ..*candidate });
            }
        }
        out.sort_unstable();
        self.mark_mirrored(&|n| (start(n) + end(n)) * 0.5, out);
    }

    /// Adds to `out` the nodes of a pair that come into the `room` around its target and near it, and the facets they face.
    fn detect_facets(
        &self,
        pair: u32,
        target: usize,
        room: &Aabb<D>,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
        margin: f64,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        let Search { surfaces, near, projected, .. } = search;
        let swept = &mut surfaces[target];
        swept.fit(margin);
        let (source, target) = (&self.surfaces[self.pairs[pair as usize].source], &self.surfaces[target]);
        let middle = |n: u32| (start(n) + end(n)) * 0.5;
        let is_own = self.is_self_contact(pair as usize);
        for (k, &node) in source.sources.iter().enumerate() {
            let (x0, x1) = (start(node), end(node));
            if !(room.contains(&x0) || room.contains(&x1)) {
                continue;
            }
            let x = middle(node);
            near.clear();
            swept.tree.overlapping(&Aabb::of([x0, x1]), |f, room| {
                if is_own && !source.may_touch_itself(k, f) {
                    return;
                }
                near.push((swept.facets[f as usize].distance(&x), f, room.diameter()));
            });
            if near.is_empty() {
                continue;
            }
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let outward = source.node_normal(node, &middle);
            projected.clear();
            let mut reach = f64::INFINITY;
            for &(at_least, facet, size) in near.iter() {
                // Nothing farther away than a facet that the node faces squarely has a say.
                if at_least > reach + SEARCH.tie * size {
                    break;
                }
                let p = Projected::new(facet, size, &x, &target.project(facet, &x, Reach::Facet, &middle));
                if p.faces(&outward) && p.gap <= margin && p.is_square() {
                    reach = reach.min(p.distance);
                }
                projected.push(p);
            }
            projected.sort_unstable_by_key(|p| p.facet);
            if let Some(facet) = faced(projected, &outward, margin) {
                out.push(Candidate::at_node(pair, node, Some(facet)));
            }
        }
    }

    /// Gap, frame and stencil of a candidate where the nodes are at `position`.
    ///
    /// The normal row of the map from nodal to relative motion is the gradient of the gap. It is not half a facet or more
    /// beyond the edge of a facet, or beyond a corner of a smooth target.
    #[must_use]
    pub fn evaluate(&self, candidate: &Candidate, position: &impl Fn(u32) -> Vector<D>) -> Contact<D> {
        let node = match candidate.site {
            Site::Node(node) => node,
            Site::Crossing(source, target) => {
                let c = Crossing::new(source.map(position), target.map(position)).clamped();
                return Contact::of_crossing(&c, source, target);
            }
        };
        let x = position(node);
        match (self.pairs[candidate.pair as usize].target, candidate.facet) {
            (Target::Surface(t), Some(f)) => {
                let p = self.surfaces[t].project(f, &x, Reach::Beyond, position);
                let gap = p.normal.dot(&(x - p.point));
                Contact::new(gap, frame(&p.normal), node, p.nodes, &p.weights)
            }
            (Target::Obstacle(o), _) => {
                let obstacle = &self.obstacles[o];
                let (gap, normal) = obstacle.gap(&x, position);
                Contact::new(gap, frame(&normal), node, &[obstacle.node], &[1.0])
            }
            (Target::Surface(_), None) => unreachable!("detect gives nodes before a surface their facet"),
        }
    }
}
