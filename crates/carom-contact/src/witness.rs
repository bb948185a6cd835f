//! Candidates where a measure has found bodies inside one another.

use crate::aabb::Aabb;
use crate::edge::{Dip, Pierced, SurfaceEdge};
use crate::patch::rim;
use crate::project::Reach;
use crate::search::Swept;
use crate::tolerances::MEASURE;
use crate::{Candidate, ContactModel, ContactSurface, Feature, Path, Search, Site, Solid, Witness};

impl<const D: usize> ContactModel<D> {
    /// Writes to `out`, ascending, the candidates that would have kept `witnesses` out on the straight `path` of all nodes: a node before the facet that was nearest at the start, an edge where it goes through another.
    ///
    /// The rules by which [`ContactModel::detect`] chooses need not foresee everything: what they leave out is found here, where it matters.
    /// Of bodies that are checked from one side alone, nodes of the other are inside by choice: these are left alone.
    pub fn witnessed(
        &self,
        witnesses: &[Witness],
        path: &Path<'_, D>,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        out.clear();
        search.sweep_where(self, &|_| true, path);
        for &Witness { of, inside, feature, depth } in witnesses {
            let (Some(there), Some(_)) = (self.pair_of(of, inside), self.pair_of(inside, of)) else {
                continue;
            };
            let (own, other) = (&self.surfaces[of], &self.surfaces[inside]);
            let swept = search.swept_mut(Solid::Body(inside));
            swept.fit(other, path);
            match feature {
                Feature::Node(node) => {
                    let node = own.master(node);
                    // Boundaries are looked at as wholes, and may touch in part alone.
                    if own.nodes.binary_search(&node).is_err() {
                        continue;
                    }
                    let facet = other.nearest_on_the_way(node, swept, path);
                    out.extend(facet.map(|f| Candidate::at_node(there as u32, node, Some(f))));
                }
                Feature::Edge(nodes) => {
                    let Some(edge) = own.edge(nodes) else { continue };
                    let own_edge = SurfaceEdge { surface: own, edge };
                    let first = self.pairs.directions(there).start;
                    let is_source = first == there;
                    let pierced = other.pierced_on_the_way(own_edge, depth, is_source, swept, path);
                    let candidate = |pair: usize, site, facet| Candidate::new(pair as u32, site, facet);
                    let crossed = pierced.map(|[a, b]| candidate(first, Site::Crossing(a, b), None));
                    out.extend(crossed.or_else(|| {
                        let dipped = other.dipped_on_the_way(own_edge, depth, swept, path);
                        dipped.map(|dip| candidate(there, Site::Between(nodes, dip.point), Some(dip.facet)))
                    }));
                }
            }
        }
        out.sort_unstable();
        out.dedup();
    }

    /// The pair in which nodes of the body `source` are checked one by one against the body `target`.
    fn pair_of(&self, source: usize, target: usize) -> Option<usize> {
        let of_both = self.pairs.of([Solid::Body(source), Solid::Body(target)]);
        of_both.into_iter().find(|&p| self.pairs.get(p).source == source && !self.is_mortar(p))
    }
}

impl ContactSurface {
    /// The facet that is nearest to where a node starts, among those that it comes near.
    fn nearest_on_the_way<const D: usize>(
        &self,
        node: u32,
        swept: &Swept<D>,
        path: &Path<'_, D>,
    ) -> Option<u32> {
        let x = (path.start)(node);
        let mut nearest: Option<(f64, u32)> = None;
        swept.tree.overlapping(&Aabb::of(path.ends(node)), |f, _| {
            let distance = (x - self.project(f, &x, Reach::Facet, path.start).point).norm();
            if nearest.is_none_or(|(least, of)| distance < least || distance == least && f < of) {
                nearest = Some((distance, f));
            }
        });
        nearest.map(|(_, f)| f)
    }

    /// The edges of the source and of the target of the crossing at which an edge of another surface, which is the source or not, goes
    /// through one of this by what accounts for its depth [m]; of several the shallowest.
    fn pierced_on_the_way<const D: usize>(
        &self,
        of_another: SurfaceEdge<'_>,
        depth: f64,
        is_source: bool,
        swept: &Swept<D>,
        path: &Path<'_, D>,
    ) -> Option<[[u32; 2]; 2]> {
        let mut best: Option<Pierced> = None;
        swept.tree.overlapping(&of_another.edge.path(path.start, path.end), |f, _| {
            let facet = &self.facets[f as usize];
            for [a, b] in rim(facet.kind) {
                let Some(other) = self.edge([facet.nodes[a], facet.nodes[b]]) else { continue };
                let sides = [of_another, SurfaceEdge { surface: self, edge: other }];
                let [source, target] = if is_source { sides } else { [sides[1], sides[0]] };
                let pierced =
                    Pierced::of(source, target, path).filter(|p| p.depth >= MEASURE.accounts * depth);
                best = pierced.into_iter().chain(best).reduce(Pierced::shallower);
            }
        });
        best.map(|pierced| pierced.edges)
    }

    /// Where an edge of another surface dips into a facet between its nodes by what accounts for its depth [m]; of several such the shallowest.
    fn dipped_on_the_way<const D: usize>(
        &self,
        of_another: SurfaceEdge<'_>,
        depth: f64,
        swept: &Swept<D>,
        path: &Path<'_, D>,
    ) -> Option<Dip> {
        let mut best: Option<Dip> = None;
        swept.tree.overlapping(&of_another.edge.path(path.start, path.end), |f, _| {
            // What is smooth is not quite what is measured.
            let accounts = if self.is_smooth_over(f) { MEASURE.witnessed } else { MEASURE.accounts };
            let dip = self.dip_of(f, of_another, path).filter(|dip| dip.depth >= accounts * depth);
            best = dip.into_iter().chain(best).reduce(Dip::shallower);
        });
        best
    }
}
