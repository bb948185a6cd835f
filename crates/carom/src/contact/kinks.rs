//! Nodes at a concave kink of their target, before one of its two facets and behind the other one, have a contact with each.

use carom_contact::{Candidate, ContactModel, Positions, Site};

/// Makes those of the candidates `missed` at the end of a step that are of nodes beside the facets that they were `found` before, and are before another one
/// there, second facets of their nodes.
pub(super) fn find_seconds<const D: usize>(
    contact: &ContactModel<D>,
    found: &[Candidate],
    end: &Positions<'_, D>,
    missed: &mut [Candidate],
) {
    for m in missed {
        if let (Site::Node(node), Some(first)) = (m.site, known(found, m.key()))
            && first.facet != m.facet
            && contact.is_beside(first, end)
        {
            m.site = Site::Second(node);
        }
    }
}

/// The contact of a node with its first facet, for a candidate that is the second one.
pub(super) fn first_of<'a>(candidate: &Candidate, found: &'a [Candidate]) -> Option<&'a Candidate> {
    match candidate.site {
        Site::Second(node) => known(found, (candidate.pair, Site::Node(node))),
        _ => None,
    }
}

/// Lets nodes that had a second facet in the last attempt at a step, where these candidates were `found`, have both again: one that now faces the second of them
/// has the first one as its second.
pub(super) fn keep_both_facets(found: &[Candidate], candidates: &mut [Candidate]) {
    for second in candidates.iter_mut().filter(|c| c.redundant && matches!(c.site, Site::Second(_))) {
        let both = [first_of(second, found), known(found, second.key())];
        let mut facets = both.into_iter().flatten().filter_map(|c| c.facet);
        if let Some(other) = facets.find(|&other| Some(other) != second.facet) {
            (second.facet, second.redundant) = (Some(other), false);
        }
    }
}

/// The candidate of a pair and site among those `found`, ascending.
pub(super) fn known(found: &[Candidate], key: (u32, Site)) -> Option<&Candidate> {
    found.binary_search_by_key(&key, Candidate::key).ok().map(|k| &found[k])
}
