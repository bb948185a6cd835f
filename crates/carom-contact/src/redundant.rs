//! Candidates that say what others say: together they would leave the reactions undetermined and make the solvers slow.

use crate::edge::Crossing;
use crate::path::Positions;
use crate::project::{Reach, project};
use crate::tolerances::{EDGES, SEARCH};
use crate::{Candidate, ContactModel, Site};

impl<const D: usize> ContactModel<D> {
    /// Marks what other candidates say where nodes are at `position`.
    pub(crate) fn mark_redundant(&self, position: &Positions<'_, D>, candidates: &mut [Candidate]) {
        for k in 0..candidates.len() {
            let c = candidates[k];
            candidates[k].redundant = match c.site {
                Site::Node(node) => self.is_second_side(&c, node, position, candidates),
                Site::Corner(corner) => self.is_at_node(&c, corner, position, candidates),
                // The facet that the node faces anyway.
                Site::Second(node) => find(candidates, c.pair, Site::Node(node))
                    .is_some_and(|first| candidates[first].facet == c.facet),
                Site::Facet(_) | Site::Edge(_) => self.is_said_before(k, position, candidates),
                Site::Multiplier(..) | Site::Crossing(..) | Site::Between(..) => false,
            };
        }
        // Nodes first: one that gives way to some edges does not make others give way.
        for nodes in [true, false] {
            for k in 0..candidates.len() {
                if let Site::Crossing(source, target) = candidates[k].site {
                    self.mark_at_node(k, [source, target], nodes, position, candidates);
                }
            }
        }
    }

    /// Whether both sides of the pair are sources, and a `node` of the second faces one of the first that faces it. Of a body with
    /// itself, the first of the two nodes stays.
    fn is_second_side(
        &self,
        candidate: &Candidate,
        node: u32,
        position: &Positions<'_, D>,
        candidates: &[Candidate],
    ) -> bool {
        let pair = candidate.pair as usize;
        let is_own = self.is_self_contact(pair);
        let first = self.pairs.directions(pair).start;
        if first == pair && !is_own {
            return false;
        }
        let Some(faced) = self.faced_node(candidate, node, position) else { return false };
        (!is_own || faced < node)
            && find(candidates, first as u32, Site::Node(faced))
                .is_some_and(|k| self.faced_node(&candidates[k], faced, position) == Some(node))
    }

    /// Whether one of `candidates`, which are in order, is a node of the second side of its pair that was left out, as one of the first stood for it, and has
    /// parted from that: nodes pass one another in a step. Nodes are at `position`; the gap [m] of the node there is less than `gap`.
    pub fn has_parted(
        &self,
        candidate: &Candidate,
        gap: f64,
        position: &Positions<'_, D>,
        candidates: &[Candidate],
    ) -> bool {
        let (Site::Node(_), true, Some(facet)) = (candidate.site, candidate.redundant, candidate.facet)
        else {
            return false;
        };
        let contact = self.evaluate(candidate, position);
        let Some(surface) = self.faced_surface(candidate).filter(|_| contact.gap < gap) else { return false };
        let normal = contact.frame.row(0);
        let of_first = self.pairs.directions(candidate.pair as usize).start as u32;
        // What stood for it pushes the other way; an edge beside it does not.
        surface.facets[facet as usize].nodes.iter().any(|&n| {
            let other = find(candidates, of_first, Site::Node(n)).map(|k| &candidates[k]);
            other.filter(|other| !other.redundant).is_some_and(|other| {
                let opposite = self.evaluate(other, position).frame.row(0).dot(&normal);
                opposite < -SEARCH.alike
            })
        })
    }

    /// Whether a corner of an obstacle faces a node of the body that faces the corner.
    fn is_at_node(
        &self,
        candidate: &Candidate,
        corner: u32,
        position: &Positions<'_, D>,
        candidates: &[Candidate],
    ) -> bool {
        let faced = self.faced_node(candidate, corner, position);
        faced
            .and_then(|node| Some((node, find(candidates, candidate.pair, Site::Node(node))?)))
            .is_some_and(|(node, k)| self.faced_node(&candidates[k], node, position) == Some(corner))
    }

    /// The node of its facet that the `node` or corner of a candidate stands over, if it is over one.
    fn faced_node(&self, candidate: &Candidate, node: u32, position: &Positions<'_, D>) -> Option<u32> {
        let facet = &self.faced_surface(candidate)?.facets[candidate.facet? as usize];
        let position = &self.placed(candidate.pair, position);
        let p = project(&position(node), facet, Reach::Facet, position);
        p.nodes.iter().zip(&p.weights).find(|&(_, &weight)| weight >= 1.0 - SEARCH.redundant).map(|(&n, _)| n)
    }

    /// Candidate `k` is two `edges` that cross at a node of one of them. If that node is a candidate too, this marks one of the two. It
    /// marks the edges, if the facet of the node looks where they do. If it is the turn of the `nodes`, it marks a node whose facet is
    /// beside the other edge and looks elsewhere. The second facet there would be as good for that node.
    ///
    /// Of a line of edges both at a node stay: where the line is dented, what crosses it there touches both.
    fn mark_at_node(
        &self,
        k: usize,
        edges: [[u32; 2]; 2],
        nodes: bool,
        position: &Positions<'_, D>,
        candidates: &mut [Candidate],
    ) {
        let pair = candidates[k].pair as usize;
        let placed = &self.placed(candidates[k].pair, position);
        let [a, b] = self.strands(&self.pairs.get(pair), edges).map(|strand| strand.line(placed));
        let crossing = Crossing::new(&a, &b);
        if self.is_mortar(pair) {
            return;
        }
        for side in (0..2).filter(|&side| crossing.reach()[side] < EDGES.at_node) {
            let node = edges[side][crossing.nearer()[side]];
            for p in self.pairs.directions(pair) {
                let node = self.surfaces[self.pairs.get(p).source].master(node);
                let at = |site| find(candidates, p as u32, site);
                let Some(j) = at(Site::Node(node)).or_else(|| at(Site::Corner(node))) else { continue };
                let other = candidates[j];
                if other.redundant {
                    continue;
                }
                let normal = self.evaluate(&other, position).frame.row(0).transpose();
                if normal.dot(&crossing.normal).abs() > SEARCH.alike {
                    candidates[k].redundant |= !nodes;
                } else if nodes && self.faces_beside(&other, &edges[1 - side]) {
                    candidates[j].redundant = true;
                }
            }
        }
    }

    /// Whether the facet that a node faces is beside an edge.
    fn faces_beside(&self, candidate: &Candidate, edge: &[u32; 2]) -> bool {
        match (self.faced_surface(candidate), candidate.facet) {
            (Some(surface), Some(f)) => {
                let facet = &surface.facets[f as usize];
                edge.iter().all(|n| facet.nodes.contains(n))
            }
            _ => false,
        }
    }
}

/// The place of the candidate of a pair at a site.
fn find(candidates: &[Candidate], pair: u32, site: Site) -> Option<usize> {
    candidates.binary_search_by_key(&(pair, site), Candidate::key).ok()
}
