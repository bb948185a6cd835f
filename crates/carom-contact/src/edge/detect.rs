use carom_mesh::Vector;

use super::crossing::is_foremost;
use super::{Crossing, Edge, Found, Line, SurfaceEdge};
use crate::search::SolidSurface;
use crate::tolerances::{EDGES, SEARCH};
use crate::{Candidate, ContactModel, Path, Search, Site, Solid};

impl<const D: usize> ContactModel<D> {
    /// Adds to `out` the edges of a pair that, on their `path`, cross near one another, or a little way through one another.
    ///
    /// Of two edges one has to be a feature: where both are of something round, nodes and facets are as good. An edge counts if
    /// the line from the one to the other is between the normals of its facets. Also, no plane of these facets may keep the two
    /// edges apart any better. As the bodies may be inside one another at the predicted middle of the step, this is decided at
    /// its start; where they cross, at the middle.
    ///
    /// Of a mortar pair they count where no facet beside them looks where they do: there multipliers have the mean of gaps that open on
    /// both sides, and what the facets carry is theirs.
    pub(crate) fn detect_crossings(
        &self,
        pair: usize,
        path: &Path<'_, D>,
        search: &Search<D>,
        found: &mut Vec<Found>,
        out: &mut Vec<Candidate>,
    ) {
        let source = &self.surfaces[self.pairs.get(pair).source];
        let target = self.faceted_target(&self.pairs.get(pair));
        let Some(SolidSurface { solid, surface: target }) = target else { return };
        if !(source.has_features || target.has_features) {
            return;
        }
        let room = search.room(solid, path.margin);
        let swept = search.swept(solid);
        let (is_own, is_mortar) = (self.is_self_contact(pair), self.is_mortar(pair));
        found.clear();
        // Edges of obstacles are as long as they please: between their ends they meet facets at the edges of these alone.
        let flat: &[Edge] = if matches!(solid, Solid::Obstacle(_)) { &source.flat_edges } else { &[] };
        for (k, edge) in source.edges.iter().chain(flat).enumerate() {
            let way = edge.path(path.start, path.end);
            if !way.overlaps(&room) {
                continue;
            }
            swept.edges.overlapping(&way, |other, _| {
                let other_edge = &target.edges[other as usize];
                let may_touch = !is_own || (other as usize) > k && source.edges_may_touch(edge, other_edge);
                if may_touch && (edge.is_feature || other_edge.is_feature) {
                    let other = SurfaceEdge { surface: target, edge: other_edge };
                    found.extend(crossing(SurfaceEdge { surface: source, edge }, other, is_mortar, path));
                }
            });
        }
        found.sort_unstable();
        let stays = |c: &Found| !(c.is_beyond() && found.iter().any(|other| other.takes_over(c)));
        out.extend(found.iter().filter(|c| stays(c)).map(|c| {
            let [source, target] = c.edges;
            let site = Site::Crossing(source, target);
            Candidate::new(pair as u32, site, None)
        }));
    }
}

/// The crossing of two edges, if they are what the surfaces would touch with.
fn crossing<const D: usize>(
    source: SurfaceEdge<'_>,
    target: SurfaceEdge<'_>,
    is_mortar: bool,
    path: &Path<'_, D>,
) -> Option<Found> {
    let [s, t] = [source.edge, target.edge];
    let (start, middle) = (path.start, |n: u32| path.middle(n));
    let there = Crossing::new(&s.line(&middle), &t.line(&middle));
    let mut beyond = [None; 2];
    for (side, SurfaceEdge { surface, edge }) in [source, target].into_iter().enumerate() {
        let (reach, end) = (there.reach()[side], there.nearer()[side]);
        if reach < -EDGES.round_off {
            if !edge.goes_on[end] || reach < -EDGES.dent {
                return None;
            }
            beyond[side] = Some(surface.master(edge.nodes[end]));
        }
    }
    let (a, b) = (s.line(start), t.line(start));
    let at_start = Crossing::new(&a, &b);
    let [on_s, on_t] = at_start.along;
    let (e, f) = (a.slope(on_s), b.slope(on_t));
    let normals = target.normals(on_t, start);
    // So that the normal points out of the target.
    let sign = if at_start.normal.dot(&(normals[0] + normals[1])) > 0.0 { 1.0 } else { -1.0 };
    let (n, gap) = (at_start.normal * sign, at_start.gap * sign);
    let deepest = -SEARCH.depth * a.chord().norm().min(b.chord().norm());
    let is_turned = there.normal.dot(&at_start.normal) <= 0.0;
    if there.sine.min(at_start.sine) < EDGES.parallel
        || is_turned
        || there.gap * sign > path.margin
        || gap < deepest
        || !is_foremost(&n, &f, &normals)
    {
        return None;
    }
    let opposite = source.normals(on_s, start);
    if !is_foremost(&-n, &e, &opposite) {
        return None;
    }
    if is_mortar && normals.iter().chain(&opposite).any(|m| m.dot(&n).abs() > SEARCH.alike) {
        return None;
    }
    // How far a line is before the plane through a point of the other that has the normal m.
    let before = |m: &Vector<D>, line: &Line<D>, of: &Vector<D>| line.least_along(m) - m.dot(of);
    let (whole_a, whole_b) = (s.gone_on(SEARCH.beyond, start), t.gone_on(SEARCH.beyond, start));
    let by_target = normals.iter().map(|m| before(m, &whole_a, &b.at(on_t)));
    let by_source = opposite.iter().map(|m| before(m, &whole_b, &a.at(on_s)));
    let by_plane = by_target.chain(by_source).fold(f64::NEG_INFINITY, f64::max);
    if by_plane > gap + EDGES.decided * gap.abs() - SEARCH.touching * deepest {
        return None;
    }
    let [from, to] = t.nodes;
    let edges = [s.nodes, if sign > 0.0 { [from, to] } else { [to, from] }];
    let masters = [edges[0].map(|n| source.surface.master(n)), edges[1].map(|n| target.surface.master(n))];
    Some(Found { edges, masters, beyond })
}
