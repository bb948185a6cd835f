use carom_mesh::Vector;

use super::crossing::is_foremost;
use super::{Crossing, Edge};
use crate::aabb::Aabb;
use crate::search::DEPTH;
use crate::{Candidate, ContactModel, ContactSurface, Search, Site};

/// The least sine of the angle between edges that cross: where they are closer to parallel, nodes face facets.
const PARALLEL: f64 = 0.05;

/// Edges that end this little before they cross do cross, in their lengths.
const ROUND_OFF: f64 = 1e-6;

/// The same, where another edge goes on and crosses no more than this one.
const DENT: f64 = 0.1;

/// A facet is what keeps two bodies apart if its plane does so by more than the edges do, less this fraction.
const DECIDED: f64 = 0.1;

impl<const D: usize> ContactModel<D> {
    /// Adds to `out` the edges of a pair that cross within `margin` [m] of one another, or a little way through one another.
    ///
    /// Of two edges one has to be sharp: where both are edges of something round, nodes and facets are as good. An edge counts if
    /// the line from the one to the other is between the normals of its facets, and if no plane of these facets keeps the two
    /// edges apart any better. As the bodies may be inside one another at the predicted middle of the step, this is decided
    /// at its start; where they cross, at the middle.
    pub(crate) fn detect_crossings(
        &self,
        pair: u32,
        target: usize,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
        margin: f64,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        let source_index = self.pairs[pair as usize].source;
        let (source, target_surface) = (&self.surfaces[source_index], &self.surfaces[target]);
        let source_box = search.surfaces[source_index].sources.inflated(margin);
        let swept = &mut search.surfaces[target];
        let target_box = swept.whole.inflated(margin);
        let is_sharp = |s: &ContactSurface| s.edges.iter().any(|e| e.is_sharp);
        if !(is_sharp(source) || is_sharp(target_surface)) || !source_box.overlaps(&target_box) {
            return;
        }
        swept.fit_edges(target_surface, margin, start, end);
        let is_own = self.is_self_contact(pair as usize);
        let found = &mut search.crossings;
        found.clear();
        for (k, edge) in source.edges.iter().enumerate() {
            let path = path(edge, start, end);
            if !path.overlaps(&target_box) {
                continue;
            }
            swept.edges.overlapping(&path, |other, _| {
                let other_edge = &target_surface.edges[other as usize];
                let may_touch = !is_own || (other as usize) > k && source.edges_may_touch(edge, other_edge);
                if may_touch && (edge.is_sharp || other_edge.is_sharp) {
                    found.extend(crossing(source, edge, target_surface, other_edge, start, end, margin));
                }
            });
        }
        found.sort_unstable();
        let stays =
            |c: &Found| c.beyond.is_none_or(|end| !found.iter().any(|other| other.takes_over(c, end)));
        out.extend(found.iter().filter(|c| stays(c)).map(|c| {
            let [source, target] = c.edges;
            Candidate { pair, site: Site::Crossing(source, target), facet: None, mirrored: false }
        }));
    }
}

/// Edges that cross, and the side and node of the edge that ends a little before it does if one goes on there: at a dent in the line of the
/// two, what has come into it crosses neither.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Found {
    /// Of the source, and of the target so that their vector product points to the source.
    edges: [[u32; 2]; 2],
    beyond: Option<(usize, u32)>,
}

impl Found {
    /// Whether what would cross `before` beyond its end crosses here, on the edge that goes on there.
    fn takes_over(&self, before: &Self, (side, node): (usize, u32)) -> bool {
        let is_same = |a: [u32; 2], b: [u32; 2]| a == b || a == [b[1], b[0]];
        let (here, there) = (self.edges, before.edges);
        self.beyond.is_none() && here[side].contains(&node) && is_same(here[1 - side], there[1 - side])
    }
}

/// A box around an edge on its way through a step.
pub(crate) fn path<const D: usize>(
    edge: &Edge,
    start: &impl Fn(u32) -> Vector<D>,
    end: &impl Fn(u32) -> Vector<D>,
) -> Aabb<D> {
    Aabb::of(edge.nodes.iter().flat_map(|&n| [start(n), end(n)]))
}

/// The crossing of two edges, if they are what the surfaces would touch with.
fn crossing<const D: usize>(
    source: &ContactSurface,
    s: &Edge,
    target: &ContactSurface,
    t: &Edge,
    start: &impl Fn(u32) -> Vector<D>,
    end: &impl Fn(u32) -> Vector<D>,
    margin: f64,
) -> Option<Found> {
    let middle = |n: u32| (start(n) + end(n)) * 0.5;
    let there = Crossing::new(s.nodes.map(middle), t.nodes.map(middle));
    let ends = [0, 1].map(|side| (there.reach()[side], [s, t][side], there.nearer()[side]));
    let ends_before = |&(reach, edge, end): &(f64, &Edge, usize)| {
        reach < if edge.goes_on[end] { -DENT } else { -ROUND_OFF }
    };
    let is_beyond = |&(reach, ..): &(f64, &Edge, usize)| reach < -ROUND_OFF;
    if there.sine < PARALLEL || ends.iter().any(ends_before) || ends.iter().all(is_beyond) {
        return None;
    }
    let beyond = ends.iter().position(is_beyond).map(|side| (side, ends[side].1.nodes[ends[side].2]));
    let (a, b) = (s.nodes.map(start), t.nodes.map(start));
    let (e, f) = (a[1] - a[0], b[1] - b[0]);
    let at_start = Crossing::new(a, b);
    let normals = target.normals(t, start);
    // So that the normal points out of the target.
    let sign = if at_start.normal.dot(&(normals[0] + normals[1])) > 0.0 { 1.0 } else { -1.0 };
    let (n, gap) = (at_start.normal * sign, at_start.gap * sign);
    let deepest = -DEPTH * e.norm().min(f.norm());
    if at_start.sine < PARALLEL
        || there.gap * sign > margin
        || gap < deepest
        || !is_foremost(&n, &f, &normals)
    {
        return None;
    }
    let opposite = source.normals(s, start);
    if !is_foremost(&-n, &e, &opposite) {
        return None;
    }
    let before =
        |m: &Vector<D>, x: &[Vector<D>; 2], of: &Vector<D>| m.dot(&(x[0] - of)).min(m.dot(&(x[1] - of)));
    let (whole_a, whole_b) = (s.gone_on(&a), t.gone_on(&b));
    let by_target = normals.iter().map(|m| before(m, &whole_a, &b[0]));
    let by_source = opposite.iter().map(|m| before(m, &whole_b, &a[0]));
    let by_plane = by_target.chain(by_source).fold(f64::NEG_INFINITY, f64::max);
    if by_plane > gap + DECIDED * gap.abs() {
        return None;
    }
    let [from, to] = t.nodes;
    Some(Found { edges: [s.nodes, if sign > 0.0 { [from, to] } else { [to, from] }], beyond })
}
