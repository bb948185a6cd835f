//! Round obstacles before facets and edges that are large beside them: they touch these between the nodes.

use carom_mesh::Vector;
use smallvec::SmallVec;

use crate::aabb::Aabb;
use crate::edge::{Edge, SurfaceEdge};
use crate::frame::frame;
use crate::path::{Path, Positions};
use crate::project::Reach;
use crate::surface::diameter;
use crate::tolerances::SEARCH;
use crate::{Candidate, Contact, ContactModel, ContactSurface, Obstacle, Pair, RigidShape, Site, Target};

/// The point of a facet or an edge that is nearest to the middle of a round obstacle: its centre, or its axis.
pub(crate) struct Nearest<const D: usize> {
    /// The nodes that it follows, with their weights.
    pub stencil: SmallVec<[(u32, f64); 8]>,
    point: Vector<D>,
    /// From the middle of the obstacle to the point [m].
    offset: Vector<D>,
    /// Direction out of the source there, of any length.
    outward: Vector<D>,
}

impl<const D: usize> Nearest<D> {
    /// Whether the middle of the obstacle is on the outside of the source.
    fn is_in_front(&self) -> bool {
        self.outward.dot(&self.offset) < 0.0
    }

    /// The distance from an obstacle of this `radius` [m], negative inside, and the unit vector from the obstacle to the source. What has gone
    /// past the middle of the obstacle is deeper in it.
    fn gap(&self, radius: f64) -> (f64, Vector<D>) {
        let (distance, side) = (self.offset.norm(), if self.is_in_front() { 1.0 } else { -1.0 });
        let direction = if distance > SEARCH.touching * radius { self.offset * side } else { -self.outward };
        (distance * side - radius, direction.normalize())
    }
}

impl<const D: usize> ContactModel<D> {
    /// Adds to `out` the facets of a pair, before a cylinder the edges, that come near a round obstacle and are larger than its radius. Where
    /// they are smaller, nodes keep it out but for what it bulges between them.
    ///
    /// What is behind the middle of the obstacle at the start of the step is the far side of a thin body.
    pub(crate) fn detect_between(
        &self,
        pair: usize,
        obstacle: &Obstacle<D>,
        path: &Path<'_, D>,
        out: &mut Vec<Candidate>,
    ) {
        let Some(radius) = obstacle.shape.bulging_radius() else { return };
        let source = &self.surfaces[self.pairs.get(pair).source];
        let is_large = |f: u32| diameter(&source.facets[f as usize], path.start) > radius;
        let comes_near = |site: Site| {
            let Some(first) = source.nearest(site, obstacle, path.start) else { return false };
            let last = source.nearest(site, obstacle, path.end);
            let is_near = |nearest: &Nearest<D>| nearest.gap(radius).0 <= path.margin;
            first.is_in_front() && (is_near(&first) || last.is_some_and(|last| is_near(&last)))
        };
        let mut add = |site, facet| out.push(Candidate::new(pair as u32, site, facet));
        match obstacle.shape {
            RigidShape::Cylinder { .. } => {
                for edge in source.all_edges().filter(|edge| comes_near(Site::Edge(edge.nodes))) {
                    if edge.facets().any(is_large) {
                        add(Site::Edge(edge.nodes), None);
                    }
                }
            }
            RigidShape::Sphere { centre, .. } => {
                let way = [obstacle.shift(path.start), obstacle.shift(path.end)].map(|shift| centre + shift);
                let way = Aabb::of(way).inflated(radius + path.margin);
                for f in 0..source.facets.len() as u32 {
                    let room = source.bounds(f, path.start).union(&source.bounds(f, path.end));
                    if room.overlaps(&way) && is_large(f) && comes_near(Site::Facet(f)) {
                        add(Site::Facet(f), Some(f));
                    }
                }
            }
            _ => {}
        }
    }

    /// Whether a pair has such a facet or edge, before what it may touch between its nodes.
    #[must_use]
    pub fn has_between_nodes(&self, pair: usize, site: Site) -> bool {
        let Pair { source, target, .. } = self.pairs.get(pair);
        let source = &self.surfaces[source];
        let shape = match target {
            Target::Surface(_) => None,
            Target::Obstacle(o) => Some(&self.obstacles[o].shape),
        };
        match (site, shape) {
            (Site::Facet(f), Some(RigidShape::Sphere { cavity: false, .. })) => {
                (f as usize) < source.facets.len()
            }
            (Site::Edge(nodes), Some(RigidShape::Cylinder { cavity: false, .. }))
            | (Site::Between(nodes, _), None) => source.edge(nodes).is_some(),
            _ => false,
        }
    }

    /// The contact of a facet or an edge with a round obstacle.
    pub(crate) fn before_round(
        &self,
        candidate: &Candidate,
        obstacle: &Obstacle<D>,
        position: &Positions<'_, D>,
    ) -> Option<Contact<D>> {
        let source = &self.surfaces[self.pairs.get(candidate.pair as usize).source];
        let nearest = source.nearest(candidate.site, obstacle, position)?;
        let (gap, normal) = nearest.gap(obstacle.shape.bulging_radius()?);
        let (nodes, weights): (SmallVec<[u32; 8]>, SmallVec<[f64; 8]>) =
            nearest.stencil.iter().copied().unzip();
        Some(Contact::before_obstacle(gap, frame(&normal), &nodes, &weights, obstacle.node))
    }

    /// Whether a facet or an edge before a round obstacle is nearest to it where a node is, which says the same, or where one of the candidates
    /// before it is.
    pub(crate) fn is_said_before(
        &self,
        k: usize,
        position: &Positions<'_, D>,
        candidates: &[Candidate],
    ) -> bool {
        let candidate = &candidates[k];
        let Pair { source, target, .. } = self.pairs.get(candidate.pair as usize);
        let Target::Obstacle(o) = target else { return false };
        let (source, obstacle) = (&self.surfaces[source], &self.obstacles[o]);
        let Some(nearest) = source.nearest(candidate.site, obstacle, position) else { return false };
        if nearest.stencil.iter().any(|&(_, weight)| weight >= 1.0 - SEARCH.redundant) {
            return true;
        }
        let size = Aabb::of(nearest.stencil.iter().map(|&(n, _)| position(n))).diameter();
        let same = |other: &Candidate| {
            source
                .nearest(other.site, obstacle, position)
                .is_some_and(|other| (other.point - nearest.point).norm() <= SEARCH.redundant * size)
        };
        let before = candidates[..k].iter().rev().take_while(|c| c.pair == candidate.pair);
        before.filter(|c| matches!(c.site, Site::Facet(_)) && !c.redundant).any(same)
    }
}

impl ContactSurface {
    /// Where the facet or the edge of a site is nearest to the middle of a round obstacle; none of other sites.
    fn nearest<const D: usize>(
        &self,
        site: Site,
        obstacle: &Obstacle<D>,
        position: &Positions<'_, D>,
    ) -> Option<Nearest<D>> {
        let shift = obstacle.shift(position);
        match (site, &obstacle.shape) {
            (Site::Facet(f), RigidShape::Sphere { centre, .. }) => {
                let centre = centre + shift;
                let p = self.project(f, &centre, Reach::Facet, position);
                let stencil = p.nodes.iter().copied().zip(p.weights).collect();
                Some(Nearest { stencil, point: p.point, offset: p.point - centre, outward: p.normal })
            }
            (Site::Edge(nodes), shape) => {
                let edge = self.edge(nodes)?;
                let ends = nodes.map(position);
                let offsets = ends.map(|x| shape.offset_of(&(x - shift)));
                let across = offsets[1] - offsets[0];
                let s = -across.dot(&offsets[0]) / across.norm_squared();
                // Along the axis all places are equally near, and the ends of the edge are nodes.
                let s = if s.is_finite() { s.clamp(0.0, 1.0) } else { 0.0 };
                let [a, b] = SurfaceEdge { surface: self, edge }.normals(0.5, position);
                Some(Nearest {
                    stencil: [(nodes[0], 1.0 - s), (nodes[1], s)].into_iter().collect(),
                    point: ends[0] + (ends[1] - ends[0]) * s,
                    offset: offsets[0] + across * s,
                    outward: a + b,
                })
            }
            _ => None,
        }
    }

    /// Its edges in space, sharp or not.
    fn all_edges(&self) -> impl Iterator<Item = &Edge> {
        self.edges.iter().chain(&self.flat_edges)
    }
}

impl<const D: usize> RigidShape<D> {
    /// The radius of what is round and bulges.
    pub(crate) fn bulging_radius(&self) -> Option<f64> {
        match self {
            Self::Sphere { radius, cavity: false, .. } | Self::Cylinder { radius, cavity: false, .. } => {
                Some(*radius)
            }
            _ => None,
        }
    }

    /// From the middle of a sphere or cylinder, the centre or the axis, to `x` [m]; of other shapes `x`.
    pub(crate) fn offset_of(&self, x: &Vector<D>) -> Vector<D> {
        match self {
            Self::Sphere { centre, .. } => x - centre,
            Self::Cylinder { point, axis, .. } => {
                let offset = x - point;
                offset - axis * axis.dot(&offset)
            }
            _ => *x,
        }
    }
}
