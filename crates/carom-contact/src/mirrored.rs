//! Candidates that say what others say: together they would leave the reactions undetermined and make the solvers slow.

use carom_mesh::Vector;

use crate::edge::Crossing;
use crate::project::{Reach, project};
use crate::{Candidate, ContactModel, Site, Target};

/// A node is checked once where it faces another that faces it, to this fraction of the facet; edges are not where they cross as
/// close to a node that is checked.
const MIRRORED: f64 = 0.02;

/// Cosine of the angle between normals that are those of one contact.
const ALIKE: f64 = 0.9;

impl<const D: usize> ContactModel<D> {
    /// Marks what other candidates say where nodes are at `position`.
    pub(crate) fn mark_mirrored(&self, position: &impl Fn(u32) -> Vector<D>, candidates: &mut [Candidate]) {
        for k in 0..candidates.len() {
            let c = candidates[k];
            candidates[k].mirrored = match c.site {
                Site::Node(node) => self.is_second_side(&c, node, position, candidates),
                Site::Crossing(source, target) => {
                    self.is_at_node(&c, [source, target], position, candidates)
                }
            };
        }
    }

    /// Whether both sides of the pair are sources, and a `node` of the second faces one of the first that faces it. Of a body with
    /// itself, the first of the two nodes stays.
    fn is_second_side(
        &self,
        candidate: &Candidate,
        node: u32,
        position: &impl Fn(u32) -> Vector<D>,
        candidates: &[Candidate],
    ) -> bool {
        let pair = candidate.pair as usize;
        let own = self.is_self_contact(pair).then_some(pair);
        let first_side = self.pairs[..pair].iter().position(|p| p.group == self.pairs[pair].group);
        let Some(first) = own.or(first_side) else { return false };
        let Some(faced) = self.faced_node(candidate, node, position) else { return false };
        (own.is_none() || faced < node)
            && find(candidates, first, faced)
                .is_some_and(|other| self.faced_node(other, faced, position) == Some(node))
    }

    /// The node of its facet that the `node` of a candidate stands over, if it is over one.
    fn faced_node(
        &self,
        candidate: &Candidate,
        node: u32,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> Option<u32> {
        let Target::Surface(t) = self.pairs[candidate.pair as usize].target else { return None };
        let facet = &self.surfaces[t].facets[candidate.facet? as usize];
        let p = project(&position(node), facet, Reach::Facet, position);
        p.nodes.iter().zip(&p.weights).find(|&(_, &weight)| weight >= 1.0 - MIRRORED).map(|(&n, _)| n)
    }

    /// Whether two `edges` cross at a node of one of them that is a candidate itself, in the same direction.
    fn is_at_node(
        &self,
        candidate: &Candidate,
        edges: [[u32; 2]; 2],
        position: &impl Fn(u32) -> Vector<D>,
        candidates: &[Candidate],
    ) -> bool {
        let crossing = Crossing::new(edges[0].map(position), edges[1].map(position));
        let own = self.pairs[candidate.pair as usize];
        let ends = edges.iter().zip(crossing.along).enumerate();
        ends.filter_map(|(side, (nodes, s))| {
            let near = if s <= MIRRORED { nodes[0] } else { nodes[1] };
            (s <= MIRRORED || s >= 1.0 - MIRRORED).then_some((side, near))
        })
        .any(|(side, node)| {
            (0..self.pairs.len()).filter(|&p| self.pairs[p].group == own.group).any(|p| {
                let of_source = self.pairs[p].source == own.source;
                let belongs = self.is_self_contact(p) || of_source == (side == 0);
                belongs
                    && find(candidates, p, node).is_some_and(|other| {
                        let normal = self.evaluate(other, position).frame.row(0).transpose();
                        normal.dot(&crossing.normal).abs() > ALIKE
                    })
            })
        })
    }
}

/// The candidate of a pair at a node.
fn find(candidates: &[Candidate], pair: usize, node: u32) -> Option<&Candidate> {
    let key = (pair as u32, Site::Node(node));
    candidates.binary_search_by_key(&key, Candidate::key).ok().map(|k| &candidates[k])
}
