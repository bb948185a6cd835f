use carom_mesh::Vector;
use carom_mesh::parallel::each_group;
use smallvec::SmallVec;

use crate::edge::{Crossing, along};
use crate::frame::frame;
use crate::looking::{Looking, Scratch};
use crate::path::Positions;
use crate::project::{Projection, Reach};
use crate::search::SolidSurface;
use crate::{Candidate, Contact, ContactModel, Obstacle, Pair, Path, Search, Site, Solid, Target};

/// Pairs that a thread looks at at a time.
const PAIRS: usize = 64;

impl<const D: usize> ContactModel<D> {
    /// Finds the nodes that on their `path` come near their target or are inside it, and the facets they face; of obstacles with corners also
    /// those that come near facets of the body, and before round obstacles the facets or edges that are large beside them. In space it also finds
    /// the edges that cross those of the target.
    ///
    /// A node keeps its facet for the whole step: the closest one at the predicted middle among those that face it. Facing decides at corners, where
    /// the closest facet alone is ambiguous. Nodes are found inside a target to a depth of half a facet. On a smooth target
    /// the closest point may move on to other facets. Of mortar pairs it finds the multipliers.
    ///
    /// A node that slides over the rim of its target while it is a little
    /// inside, as the condition `midpoint` lets it, is beside the target from then on.
    pub fn detect(&self, path: &Path<'_, D>, search: &mut Search<D>, out: &mut Vec<Candidate>) {
        self.detect_node_by_node(|_| true, path, search, out);
        let mut mortar = std::mem::take(&mut search.mortar);
        self.detect_mortar(path, &mut mortar, out);
        search.mortar = mortar;
    }

    /// [`ContactModel::detect`] of the pairs that count, but for multipliers, which [`ContactModel::detect_mortar`] finds.
    pub fn detect_node_by_node(
        &self,
        counts: impl Fn(&Pair) -> bool,
        path: &Path<'_, D>,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        search.sweep_where(self, &counts, path);
        let mut pairs = std::mem::take(&mut search.pairs);
        // Both come closer by the margin.
        self.within(2.0 * path.margin, &search.extents, &mut pairs);
        pairs.retain(|&p| counts(&self.pairs.get(p)));
        self.detect_among(&pairs, path, search, out);
        search.pairs = pairs;
    }

    /// The same of a body with itself.
    pub fn detect_itself(
        &self,
        body: usize,
        path: &Path<'_, D>,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        let itself = self.pairs.of([Solid::Body(body); 2]);
        search.sweep(self, itself.clone().map(|p| self.pairs.get(p)), path);
        let mut pairs = std::mem::take(&mut search.pairs);
        pairs.clear();
        pairs.extend(itself);
        self.detect_among(&pairs, path, search, out);
        search.pairs = pairs;
    }

    /// Finds the candidates of these `pairs`, ascending, of which the boxes are swept.
    fn detect_among(
        &self,
        pairs: &[usize],
        path: &Path<'_, D>,
        search: &mut Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        search.fit(self, pairs, path);
        let mut looking = std::mem::take(&mut search.looking);
        let groups = pairs.len().div_ceil(PAIRS);
        looking.resize_with(looking.len().max(groups), Looking::default);
        each_group(&mut looking[..groups], 1, |first, looking| {
            for (pairs, Looking { scratch, found }) in pairs.chunks(PAIRS).skip(first).zip(looking) {
                found.clear();
                pairs.iter().for_each(|&p| self.detect_pair(p, path, search, (scratch, found)));
            }
        });
        out.clear();
        looking[..groups].iter().for_each(|looking| out.extend_from_slice(&looking.found));
        search.looking = looking;
        self.mark_redundant(&|n| path.middle(n), out);
    }

    /// Adds the candidates of one pair to those found.
    fn detect_pair(
        &self,
        p: usize,
        path: &Path<'_, D>,
        search: &Search<D>,
        (scratch, out): (&mut Scratch<D>, &mut Vec<Candidate>),
    ) {
        let pair = self.pairs.get(p);
        match pair.target {
            Target::Obstacle(o) => match &self.obstacles[o].faceted {
                None => match &self.surfaces[pair.source].ball {
                    Some(ball) => self.detect_ball((p, ball), &self.obstacles[o], path, out),
                    None => {
                        self.detect_round(p, &self.obstacles[o], path, search, out);
                        self.detect_between(p, &self.obstacles[o], path, out);
                    }
                },
                Some(_) => {
                    let obstacle = &self.obstacles[o];
                    let (start, end) = (&obstacle.placed(path.start), &obstacle.placed(path.end));
                    let path = Path { start, end, margin: path.margin };
                    self.detect_faceted(p, &path, search, (scratch, out));
                }
            },
            Target::Surface(_) if self.balls(&pair).is_some() => self.detect_balls(p, path, out),
            Target::Surface(_) => self.detect_faceted(p, path, search, (scratch, out)),
        }
    }

    /// What has facets on the other side of a pair that is found by them.
    pub(crate) fn faceted_target(&self, pair: &Pair) -> Option<SolidSurface<'_>> {
        match pair.target {
            Target::Obstacle(o) => {
                let faceted = self.obstacles[o].faceted.as_ref()?;
                Some(SolidSurface { solid: Solid::Obstacle(o), surface: &faceted.surface })
            }
            Target::Surface(t) => Some(SolidSurface { solid: Solid::Body(t), surface: &self.surfaces[t] }),
        }
    }

    /// Adds to `out` the nodes of a pair that come near an obstacle without facets.
    fn detect_round(
        &self,
        pair: usize,
        obstacle: &Obstacle<D>,
        path: &Path<'_, D>,
        search: &Search<D>,
        out: &mut Vec<Candidate>,
    ) {
        // The distance from an obstacle changes by no more than the way.
        let room = search.room_of_sources(self.pairs.get(pair).source);
        let (centre, reach) = (room.centre(), path.margin + room.reach());
        if !(obstacle.is_near(&centre, reach, path.start) || obstacle.is_near(&centre, reach, path.end)) {
            return;
        }
        let near = |&&node: &&u32| {
            obstacle.is_near(&(path.start)(node), path.margin, path.start)
                || obstacle.is_near(&(path.end)(node), path.margin, path.end)
        };
        let source = &self.surfaces[self.pairs.get(pair).source];
        let candidate = |&node: &u32| Candidate::at_node(pair as u32, node, None);
        out.extend(source.sources.iter().filter(near).map(candidate));
    }

    /// Adds to those found the nodes of a pair that come near facets of the target, in space the edges that cross, and the corners of an obstacle
    /// that come near facets of the source.
    fn detect_faceted(
        &self,
        pair: usize,
        path: &Path<'_, D>,
        search: &Search<D>,
        (scratch, out): (&mut Scratch<D>, &mut Vec<Candidate>),
    ) {
        let me = Solid::Body(self.pairs.get(pair).source);
        let Some(target) = self.faceted_target(&self.pairs.get(pair)) else { return };
        if !search.meet(me, target.solid, path.margin) {
            return;
        }
        let (source, pair_index) = (&self.surfaces[self.pairs.get(pair).source], pair as u32);
        if !self.is_mortar(pair) {
            search.facing(source, target, path, scratch, |node, facet| {
                out.push(Candidate::at_node(pair_index, node, Some(facet)));
            });
        }
        // From the other side they are the same.
        if self.pairs.directions(pair).start == pair {
            self.detect_crossings(pair, path, search, &mut scratch.crossings, out);
        }
        if matches!(target.solid, Solid::Obstacle(_)) {
            search.facing(
                target.surface,
                SolidSurface { solid: me, surface: source },
                path,
                scratch,
                |corner, facet| {
                    let site = Site::Corner(corner);
                    out.push(Candidate::new(pair_index, site, Some(facet)));
                },
            );
        }
    }

    /// Gap, frame and stencil of a candidate where the nodes are at `position`. Many are evaluated at once by [`ContactModel::evaluate_all`], which
    /// integrates every facet of a mortar pair once for all its multipliers.
    ///
    /// The normal row of the map from nodal to relative motion is the gradient of the gap. It is not half a facet or more
    /// beyond the edge of a facet, or beyond a corner of a smooth target. Beyond an edge in space that is warped, or round, it is the gradient
    /// where the tangent plane does not turn along the edge.
    #[must_use]
    pub fn evaluate(&self, candidate: &Candidate, position: &Positions<'_, D>) -> Contact<D> {
        let pair = self.pairs.get(candidate.pair as usize);
        match pair.target {
            Target::Obstacle(o) => {
                self.before_obstacle(candidate, &self.obstacles[o], position).anchored(position)
            }
            Target::Surface(t) => match (candidate.site, candidate.facet) {
                (Site::Node(node) | Site::Second(node), Some(f)) => {
                    let x = position(node);
                    let p = self.surfaces[t].project(f, &x, candidate.reach(), position);
                    let gap = p.normal.dot(&(x - p.point));
                    Contact::new(gap, frame(&p.normal), node, p.nodes, &p.weights)
                }
                (Site::Crossing(source, target), _) => {
                    let strands = self.strands(&pair, [source, target]);
                    let [a, b] = strands.map(|strand| strand.line(position));
                    let c = Crossing::new(&a, &b).clamped();
                    let [s, t] = c.along;
                    Contact::of_edge(
                        c.gap,
                        &c.normal,
                        &strands[0].weights(s),
                        strands[1].weights(t).into_iter(),
                    )
                }
                (Site::Between(nodes, point), Some(f)) => {
                    let strand = self.surfaces[pair.source].strand(nodes);
                    let x = strand.line(position).at(along(point));
                    let p = self.surfaces[t].project(f, &x, Reach::Beyond, position);
                    let below = p.nodes.iter().copied().zip(p.weights);
                    let gap = p.normal.dot(&(x - p.point));
                    Contact::of_edge(gap, &p.normal, &strand.weights(along(point)), below)
                }
                (Site::Multiplier(node, side), _) => {
                    self.multiplier(candidate.pair as usize, (node, side), position)
                }
                (site, _) => {
                    let pair = candidate.pair as usize;
                    let nearest = || match site {
                        Site::Node(node) => self.before_nearest(pair, node, position),
                        _ => Contact::with_nothing(),
                    };
                    self.between_balls(pair, position).unwrap_or_else(nearest)
                }
            },
        }
    }

    /// The contact of a node of a pair with the facet of its target that is nearest to it; where that has no facets, one with nothing.
    pub(crate) fn before_nearest(&self, pair: usize, node: u32, position: &Positions<'_, D>) -> Contact<D> {
        let x = position(node);
        let target = match self.pairs.get(pair).target {
            Target::Surface(t) => Some(&self.surfaces[t]),
            Target::Obstacle(_) => None,
        };
        let facets = target.into_iter().flat_map(|t| (0..t.facets.len() as u32).map(move |f| (t, f)));
        let projections = facets.map(|(t, f)| t.project(f, &x, Reach::Facet, position));
        let distance = |p: &Projection<'_, D>| (x - p.point).norm_squared();
        match projections.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
            Some(p) => {
                Contact::new(p.normal.dot(&(x - p.point)), frame(&p.normal), node, p.nodes, &p.weights)
            }
            None => Contact::with_nothing(),
        }
    }

    /// [`ContactModel::evaluate`] of a candidate whose target is an `obstacle`.
    fn before_obstacle(
        &self,
        candidate: &Candidate,
        obstacle: &Obstacle<D>,
        position: &Positions<'_, D>,
    ) -> Contact<D> {
        let position = &obstacle.placed(position);
        if let Some(contact) = self.ball_before_obstacle(candidate.pair as usize, obstacle, position)
            && matches!(candidate.site, Site::Node(_))
        {
            return contact;
        }
        let pair = self.pairs.get(candidate.pair as usize);
        let source = &self.surfaces[pair.source];
        let contact = |gap, normal: &Vector<D>, nodes: &[u32], weights: &[f64]| {
            Contact::before_obstacle(gap, frame(normal), nodes, weights, obstacle.node)
        };
        match (candidate.site, &obstacle.faceted, candidate.facet) {
            (Site::Node(node) | Site::Second(node), Some(faceted), Some(f)) => {
                let x = position(node);
                let p = faceted.surface.project(f, &x, candidate.reach(), position);
                contact(p.normal.dot(&(x - p.point)), &p.normal, &[node], &[1.0])
            }
            (Site::Node(node), ..) => {
                let (gap, normal) = obstacle.gap(&position(node), position);
                contact(gap, &normal, &[node], &[1.0])
            }
            (Site::Corner(corner), _, Some(f)) => {
                let x = position(corner);
                let p = source.project(f, &x, Reach::Beyond, position);
                contact(p.normal.dot(&(x - p.point)), &-p.normal, p.nodes, &p.weights)
            }
            (Site::Crossing(source, target), ..) => {
                let strands = self.strands(&pair, [source, target]);
                let [a, b] = strands.map(|strand| strand.line(position));
                let c = Crossing::new(&a, &b).clamped();
                let (nodes, weights): (SmallVec<[u32; 3]>, SmallVec<[f64; 3]>) =
                    strands[0].weights(c.along[0]).into_iter().unzip();
                contact(c.gap, &c.normal, &nodes, &weights)
            }
            (Site::Facet(_) | Site::Edge(_), ..) => {
                self.before_round(candidate, obstacle, position).unwrap_or_else(Contact::with_nothing)
            }
            (Site::Corner(_), _, None) | (Site::Multiplier(..) | Site::Between(..) | Site::Second(_), ..) => {
                Contact::with_nothing()
            }
        }
    }
}
