//! Candidates that were known before.

use crate::edge::{Crossing, along};
use crate::path::Positions;
use crate::project::Reach;
use crate::surface::diameter;
use crate::tolerances::{EDGES, SEARCH};
use crate::{Candidate, ContactModel, Path, Site};

impl<const D: usize> ContactModel<D> {
    /// Adds to the candidates `out` of [`ContactModel::detect`] those that were `known` before and are not among them, with the facets
    /// that they faced then.
    pub fn recall(&self, known: &[Candidate], path: &Path<'_, D>, out: &mut Vec<Candidate>) {
        let found = out.len();
        // Multipliers are what the search finds of them. A pair may have been of nodes in an analysis before.
        let lasts = |c: &&Candidate| match c.site {
            Site::Node(_) | Site::Second(_) => !self.is_mortar(c.pair as usize),
            Site::Multiplier(..) => false,
            _ => true,
        };
        for candidate in known.iter().filter(lasts) {
            if out[..found].binary_search_by_key(&candidate.key(), Candidate::key).is_err() {
                out.push(Candidate { redundant: false, ..*candidate });
            }
        }
        if out.len() > found {
            out.sort_unstable();
            self.mark_redundant(&|n| path.middle(n), out);
        }
    }

    /// At which ends of the facet of a node, the first and the last, a smooth target of the plane has a concave kink: where a side that was straight has bent.
    #[must_use]
    pub fn concave_kinks(&self, candidate: &Candidate, position: &Positions<'_, D>) -> [bool; 2] {
        let (Site::Node(_) | Site::Second(_), Some(f)) = (candidate.site, candidate.facet) else {
            return [false; 2];
        };
        let position = &self.placed(candidate.pair, position);
        self.faced_surface(candidate).map_or([false; 2], |surface| surface.concave_kinks(f, position))
    }

    /// Whether a node is beside the facet that it was found before, so that another one may be its [second](Site::Second).
    #[must_use]
    pub fn is_beside(&self, first: &Candidate, position: &Positions<'_, D>) -> bool {
        let (Site::Node(node), Some(f)) = (first.site, first.facet) else { return false };
        let position = &self.placed(first.pair, position);
        self.faced_surface(first).is_some_and(|surface| {
            let [on, beyond] = [Reach::Facet, Reach::Beyond]
                .map(|reach| surface.project(f, &position(node), reach, position).point);
            (on - beyond).norm() > SEARCH.tie * diameter(&surface.facets[f as usize], position)
        })
    }

    /// Whether a candidate that pressed before, `apart` from what it faced or inside it by so much [m], still touches it, up to a little beyond
    /// the edge of that. There the trembling of round-off would decide from step to step which of two nodes that face one another is found.
    #[must_use]
    pub fn still_touches(&self, candidate: &Candidate, apart: f64, position: &Positions<'_, D>) -> bool {
        let position = &self.placed(candidate.pair, position);
        match candidate.site {
            Site::Node(node) | Site::Corner(node) | Site::Second(node) => {
                let faced = self.faced_surface(candidate).zip(candidate.facet);
                faced.is_some_and(|(surface, f)| {
                    let x = position(node);
                    let near = apart + SEARCH.kept * diameter(&surface.facets[f as usize], position);
                    (x - surface.project(f, &x, Reach::Facet, position).point).norm() <= near
                })
            }
            Site::Between(nodes, point) => {
                let source = &self.surfaces[self.pairs.get(candidate.pair as usize).source];
                let faced = self.faced_surface(candidate).zip(candidate.facet);
                faced.is_some_and(|(surface, f)| {
                    let x = source.strand(nodes).line(position).at(along(point));
                    let near = apart + SEARCH.kept * diameter(&surface.facets[f as usize], position);
                    surface.gap_at(f, &x, position) <= near && surface.is_over(f, &x, position)
                })
            }
            // Found again wherever they come near.
            Site::Multiplier(..) | Site::Facet(_) | Site::Edge(_) => false,
            Site::Crossing(source, target) => {
                let pair = self.pairs.get(candidate.pair as usize);
                let [a, b] = self.strands(&pair, [source, target]).map(|strand| strand.line(position));
                let length = a.chord().norm().min(b.chord().norm());
                let there = Crossing::new(&a, &b);
                there.sine > EDGES.parallel
                    && there.gap.abs() <= apart + SEARCH.kept * length
                    && there.reach().into_iter().all(|reach| reach >= -SEARCH.kept)
            }
        }
    }
}
