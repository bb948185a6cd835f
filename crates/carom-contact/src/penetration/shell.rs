//! The boundary of a body in its present place.

use std::collections::{BTreeMap, BTreeSet};

use carom_mesh::{CellKind, Facet, Surface, Vector, nodal};

use super::deep::Deep;
use super::feature::Feature;
use super::skin::Skin;
use crate::aabb::Aabb;
use crate::ball::Ball;
use crate::bvh::Bvh;
use crate::patch::{Patch, bows, foot, rim};
use crate::path::Positions;
use crate::project::normal;
use crate::surface::{diameter, overshoot};
use crate::tolerances::{MEASURE, SEARCH};

/// The facets, nodes and edges of the boundary of a body.
#[derive(Debug, Clone)]
pub(super) struct Shell<const D: usize> {
    pub facets: Vec<Facet>,
    /// Its nodes, ascending, and the facets around each, the smallest first.
    pub nodes: Vec<(u32, Vec<u32>)>,
    /// Its edges from node to node, and the smaller of their facets; in the plane the facets themselves. Those of second order are in two parts.
    pub edges: Vec<([u32; 2], u32)>,
    /// Those of second order, each once, by their ends and the node between.
    pub curved: Vec<[u32; 3]>,
    /// The nodes between.
    between: BTreeSet<u32>,
    /// Diameters of its facets [m] where it was first, and of its smallest and its largest one.
    cells: Vec<f64>,
    pub least_cell: f64,
    pub largest_cell: f64,
    /// The arcs that its facets stood for there [m].
    arcs: Vec<f64>,
    /// How thick the wall behind each of its facets was there [m].
    walls: Vec<f64>,
    /// What it is before what has no corners, and before others that are round, if that is round; and where its centre is [m].
    pub ball: Option<(Ball, Vector<D>)>,
    /// Nodes at which the boundary ends: where a tied side begins.
    ends: BTreeSet<u32>,
    first: u32,
    /// Where its nodes are [m], from that with the number `first` on.
    x: Vec<Vector<D>>,
    /// Where they were first: where normals turn there by more than that of a round side there is a corner, for ever.
    reference: Vec<Vector<D>>,
    pub tree: Bvh<D>,
    bounds: Aabb<D>,
    is_fitted: bool,
}

impl<const D: usize> Shell<D> {
    pub fn new(surface: &Surface, first: u32) -> Self {
        let facets: Vec<Facet> = surface.facets().iter().map(|f| f.numbered_from(first)).collect();
        let mut nodes = BTreeMap::new();
        let mut edges: BTreeMap<[u32; 2], (u32, usize)> = BTreeMap::new();
        let mut curved = BTreeSet::new();
        for (f, facet) in (0..).zip(&facets) {
            facet.nodes.iter().for_each(|&n| nodes.entry(n).or_insert_with(Vec::new).push(f));
            for [a, b] in rim(facet.kind) {
                let [a, b] = [facet.nodes[a], facet.nodes[b]];
                edges.entry([a.min(b), a.max(b)]).or_insert((f, 0)).1 += 1;
            }
            for nodes in bows(facet.kind) {
                let [a, b, middle] = nodes.map(|k| facet.nodes[k]);
                curved.insert([a.min(b), a.max(b), middle]);
            }
        }
        let ends = if D == 2 {
            let mut count: BTreeMap<u32, usize> = BTreeMap::new();
            edges.keys().flatten().for_each(|&n| *count.entry(n).or_default() += 1);
            count.into_iter().filter(|&(_, count)| count == 1).map(|(n, _)| n).collect()
        } else {
            edges.iter().filter(|(_, (_, count))| *count == 1).flat_map(|(nodes, _)| *nodes).collect()
        };
        Self {
            x: nodal::zeros(nodes.keys().next_back().map_or(0, |last| (last - first) as usize + 1)),
            nodes: nodes.into_iter().collect(),
            edges: edges.into_iter().map(|(nodes, (f, _))| (nodes, f)).collect(),
            between: curved.iter().map(|[_, _, middle]| *middle).collect(),
            curved: curved.into_iter().collect(),
            is_fitted: false,
            facets,
            cells: Vec::new(),
            least_cell: f64::INFINITY,
            largest_cell: 0.0,
            reference: Vec::new(),
            arcs: Vec::new(),
            walls: Vec::new(),
            ball: None,
            ends,
            first,
            tree: Bvh::new(std::iter::empty()),
            bounds: Aabb::of([]),
        }
    }

    /// Takes note of where its nodes are.
    pub fn place(&mut self, position: &Positions<'_, D>) {
        self.is_fitted = false;
        for (node, _) in &self.nodes {
            self.x[(*node - self.first) as usize] = position(*node);
        }
        self.bounds = if !self.curved.is_empty() {
            let facets = self.facets.iter().map(|facet| self.room(facet));
            facets.fold(Aabb::of([]), |all, room| all.union(&room))
        } else {
            Aabb::of(self.nodes.iter().map(|(n, _)| self.at(*n)))
        };
        if let Some((ball, centre)) = &mut self.ball {
            *centre = ball.centre(position);
            self.bounds = self.bounds.union(&Aabb::of([*centre]).inflated(ball.radius));
        }
    }

    /// A box around a facet.
    fn room(&self, facet: &Facet) -> Aabb<D> {
        Aabb::of(facet.nodes.iter().map(|&n| self.at(n))).scaled(overshoot(facet.kind))
    }

    /// Brings the boxes of its facets to where they are, once per place.
    pub fn fit(&mut self) {
        if self.is_fitted {
            return;
        }
        let mut tree = std::mem::replace(&mut self.tree, Bvh::new(std::iter::empty()));
        let room = |f: u32| self.room(&self.facets[f as usize]);
        if tree.len() == self.facets.len() {
            tree.refit(room);
        } else {
            tree = Bvh::new((0..self.facets.len() as u32).map(room));
        }
        self.tree = tree;
        self.is_fitted = true;
    }

    /// Takes note of how large and how round its facets are, and how thick the walls behind them.
    pub fn size_up(&mut self) {
        self.fit();
        let facets = || 0..self.facets.len() as u32;
        self.walls = facets().map(|f| self.thickness_behind(f)).collect();
        let cells: Vec<f64> = facets().map(|f| self.diameter(f)).collect();
        self.reference.clone_from(&self.x);
        self.arcs = facets().map(|f| self.arc(f)).collect();
        let bounds = (f64::INFINITY, 0.0);
        (self.least_cell, self.largest_cell) =
            cells.iter().fold(bounds, |(least, largest), d| (d.min(least), d.max(largest)));
        // Which of its facets stands for a node or an edge must not hang on their numbers.
        let smaller = |f: &u32, g: &u32| cells[*f as usize].total_cmp(&cells[*g as usize]);
        self.nodes.iter_mut().for_each(|(_, around)| around.sort_by(smaller));
        let mut edges = std::mem::take(&mut self.edges);
        for ([a, b], f) in &mut edges {
            let beside = self.around(*a).iter().find(|f| self.facets[**f as usize].nodes.contains(b));
            *f = *beside.unwrap_or(f);
        }
        (self.edges, self.cells) = (edges, cells);
    }

    /// The [`Self::arc`] of a facet where it was first [m].
    pub fn first_arc(&self, facet: u32) -> f64 {
        self.arcs[facet as usize]
    }

    /// The largest [`Self::arc`] where its facets were first [m].
    pub fn largest_arc(&self) -> f64 {
        self.arcs.iter().copied().fold(0.0, f64::max)
    }

    pub fn bounds(&self) -> &Aabb<D> {
        &self.bounds
    }

    /// Where a node is [m].
    pub fn at(&self, node: u32) -> Vector<D> {
        self.x[(node - self.first) as usize]
    }

    /// Diameter of a facet [m].
    pub fn diameter(&self, facet: u32) -> f64 {
        diameter(&self.facets[facet as usize], &|n| self.at(n))
    }

    /// How far the arc through a facet, whose neighbours are turned against it, is in front of its middle [m]; not at corners. One of second
    /// order turns by itself, too, and is two of half its length, as the node between is kept out: these are a quarter as high.
    pub fn arc(&self, facet: u32) -> f64 {
        let own = self.normal(facet);
        let Facet { kind, nodes } = &self.facets[facet as usize];
        let around = nodes.iter().flat_map(|&n| self.around(n).iter().map(move |&f| (n, f)));
        let smooth = around.filter(|&(n, f)| self.was_smooth(n, [facet, f]));
        let turn = smooth.map(|(_, f)| own.dot(&self.normal(f))).fold(1.0, f64::min).max(-1.0);
        if !kind.is_quadratic() {
            return self.diameter(facet) * turn.acos() / 8.0;
        }
        let at = |n| own.dot(&self.normal_at(n, facet, &self.x));
        let half = nodes.iter().map(|&n| at(n)).fold(1.0, f64::min).max(-1.0);
        self.diameter(facet) * turn.acos().max(2.0 * half.acos()) / 32.0
    }

    /// Whether there was no corner between two facets at a node of both.
    fn was_smooth(&self, node: u32, facets: [u32; 2]) -> bool {
        let [a, b] = facets.map(|f| self.normal_at(node, f, &self.reference));
        a.dot(&b) > SEARCH.corner
    }

    /// The normal of a facet at a node of it, where nodes are at `x`. What is straight has that of its middle.
    fn normal_at(&self, node: u32, f: u32, x: &[Vector<D>]) -> Vector<D> {
        let facet = &self.facets[f as usize];
        let patch = Patch::new(facet, &|n| x[(n - self.first) as usize]);
        let place = facet.nodes.iter().position(|&n| n == node).filter(|_| facet.kind.is_quadratic());
        let at = place.map_or_else(
            || patch.middle(),
            |k| {
                let [xi, eta, _] = facet.kind.reference().nodes[k];
                patch.at(&[xi, eta])
            },
        );
        normal(&at.tangents)
    }

    /// The edges that are straight, each with the smaller of its facets.
    pub fn straight(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        let is_straight = |nodes: &[u32; 2]| nodes.iter().all(|n| !self.between.contains(n));
        self.edges.iter().copied().filter(move |(nodes, _)| is_straight(nodes))
    }

    /// The facets around a node.
    pub fn around(&self, node: u32) -> &[u32] {
        self.nodes.binary_search_by_key(&node, |(n, _)| *n).map_or(&[], |k| &self.nodes[k].1)
    }

    /// The normal in the middle of a facet.
    pub fn normal(&self, f: u32) -> Vector<D> {
        normal(&Patch::new(&self.facets[f as usize], &|n| self.at(n)).middle().tangents)
    }

    /// How thick the wall behind the middle of a facet was where it was first [m]; infinite where nothing was behind it.
    pub fn wall(&self, f: u32) -> f64 {
        self.walls[f as usize]
    }

    /// How thick the wall behind the middle of a facet is [m]; infinite where nothing is behind it.
    fn thickness_behind(&self, f: u32) -> f64 {
        let middle = Patch::new(&self.facets[f as usize], &|n| self.at(n)).middle();
        let reach = 2.0 * self.bounds.diameter();
        let ends = [middle.point, middle.point - normal(&middle.tangents) * reach];
        let mut thickness = f64::INFINITY;
        self.tree.along(&ends, |g, _| {
            if g != f {
                self.crossings(g, &ends, &mut |share, _| thickness = thickness.min(share * reach));
            }
        });
        thickness
    }

    /// How deep `x` is inside, or zero, and the facet that it is closest to; zero too where nothing is within `reach` [m].
    fn depth(&self, x: &Vector<D>, reach: f64) -> (f64, u32) {
        let (distance, nearest) = self.signed_distance(x, reach);
        ((-distance).max(0.0), nearest)
    }

    /// The distance of `x` from the boundary, negative inside, and the facet that it is closest to; infinite where nothing is within `reach` [m].
    /// Beyond its end a boundary has no inside.
    ///
    /// The side is that of the normals around the closest point, weighted by the angles of their facets there (Bærentzen & Aanæs 2005).
    pub fn signed_distance(&self, x: &Vector<D>, reach: f64) -> (f64, u32) {
        let (mut distance, mut side, mut nearest, mut is_end) = (f64::INFINITY, 0.0, 0, false);
        let position = |n: u32| self.at(n);
        self.tree.nearest_within(reach, x, |f, facet_box| {
            let facet = &self.facets[f as usize];
            let patch = Patch::new(facet, &position);
            let xi = patch.closest(x);
            let p = patch.at(&xi);
            let offset = x - p.point;
            let d = offset.norm();
            let tie = MEASURE.same * facet_box.diameter();
            if d <= distance + tie {
                let front = normal(&p.tangents).dot(&offset) * angle(facet.kind, &xi, &p.tangents);
                if d < distance - tie {
                    (side, is_end, nearest) = (0.0, false, f);
                }
                distance = distance.min(d);
                side += front;
                let closest = facet.nodes.iter().zip(&p.weights).find(|(_, w)| **w > 1.0 - MEASURE.same);
                is_end |= closest.is_some_and(|(n, _)| self.ends.contains(n));
            }
            reach.min(distance + tie)
        });
        (if side < 0.0 && !is_end { -distance } else { distance }, nearest)
    }

    /// What of this boundary is deepest inside another. Tells `witness` of all that is.
    ///
    /// What is inside at all has a part that is not deep: only if that is farther in than a facet is large, all are looked at.
    pub fn inside_of(&self, other: &Self, mut witness: impl FnMut(Feature, f64)) -> Deep<D> {
        let near = self.inside_within(2.0 * other.largest_cell, other, &mut witness);
        if near.depth <= other.largest_cell {
            return near;
        }
        self.inside_within(f64::INFINITY, other, &mut |_, _| ())
    }

    fn inside_within(&self, reach: f64, other: &Self, witness: &mut impl FnMut(Feature, f64)) -> Deep<D> {
        let mut deepest = Deep::none();
        let mut note = |deep: Deep<D>, feature: Feature, f: u32| {
            let arcs = self.arcs[f as usize] + deep.other.map_or(0.0, |o| other.arcs[o as usize]);
            if deep.depth > MEASURE.witnessed * self.cells[f as usize] + arcs {
                witness(feature, deep.depth);
            }
            deepest = deepest.deeper(deep);
        };
        for (node, around) in &self.nodes {
            let x = self.at(*node);
            if other.bounds.contains(&x) {
                note(other.deep(&x, reach, around.first().copied()), Feature::Node(*node), around[0]);
            }
        }
        if D == 3 && !other.curved.is_empty() {
            self.lines_inside_of(other, |deep, nodes, f| note(deep, Feature::Edge(nodes), f));
        } else {
            for (nodes, f) in self.straight() {
                let ends = nodes.map(|n| self.at(n));
                note(other.deepest_of_segment(&ends, Some(f)), Feature::Edge(nodes), f);
            }
        }
        self.curves_inside_of(other, |deep, nodes, f| note(deep, Feature::Edge(nodes), f));
        deepest
    }

    /// What of the corners and edges of an obstacle that has moved by `shift` [m] is deepest inside.
    pub fn deepest_of(&self, skin: &Skin<D>, shift: &Vector<D>) -> Deep<D> {
        let (mut deepest, reach) = (Deep::none(), f64::INFINITY);
        for x in &skin.corners {
            let x = x + shift;
            if self.bounds.contains(&x) {
                deepest = deepest.deeper(self.deep(&x, reach, None));
            }
        }
        // A ball may be inside without a node of the body in it. Where its middle is not, the boundary is seen to go into it.
        if let Some((centre, radius)) = skin.ball {
            let centre = centre + shift;
            let deep =
                if self.bounds.contains(&centre) { self.deep(&centre, reach, None) } else { Deep::none() };
            if deep.depth > 0.0 {
                deepest = deepest.deeper(Deep { depth: deep.depth + radius, ..deep });
            }
        }
        for ends in &skin.edges {
            let ends = ends.map(|x| x + shift);
            deepest = deepest.deeper(self.deepest_of_segment(&ends, None));
        }
        deepest
    }

    /// How deep `x` is inside, a point of a `facet` of another boundary.
    fn deep(&self, x: &Vector<D>, reach: f64, facet: Option<u32>) -> Deep<D> {
        let (depth, other) = self.depth(x, reach);
        Deep { depth, at: *x, facet, other: Some(other) }
    }

    /// What of the segment between two points is deepest inside, if it goes through the boundary.
    fn deepest_of_segment(&self, ends: &[Vector<D>; 2], facet: Option<u32>) -> Deep<D> {
        let path = Aabb::of(*ends);
        if !self.bounds.overlaps(&path) {
            return Deep::none();
        }
        let (mut first, mut last) = (1.0_f64, 0.0_f64);
        let mut crossings = 0;
        let mut note = |t: f64, _: bool| {
            (first, last) = (first.min(t), last.max(t));
            crossings += 1;
        };
        self.tree.overlapping(&path, |f, _| self.crossings(f, ends, &mut note));
        if crossings == 0 {
            return Deep::none();
        }
        // Through a body that is not convex a segment may go in and out several times: then some places between are outside.
        let places = if crossings <= 2 { 3 } else { 4 * crossings };
        let (from, to) = if crossings == 1 { (0.0, 1.0) } else { (first, last) };
        let way = (ends[1] - ends[0]) * (to - from);
        let look = |share: f64| {
            self.deep(&(ends[0] + (ends[1] - ends[0]) * from + way * share), f64::INFINITY, facet)
        };
        let mut step = 0.5 / places as f64;
        let shares = (0..places).map(|k| (2 * k + 1) as f64 * step);
        let (mut share, mut deepest) = (0.5, Deep::none());
        for s in shares {
            let deep = look(s);
            if deep.depth > deepest.depth {
                (share, deepest) = (s, deep);
            }
        }
        // Along a flush face all places are inside by round-off alone.
        if deepest.depth <= MEASURE.same * way.norm() {
            return deepest;
        }
        // The depth changes by no more than the way.
        while step * way.norm() > MEASURE.finest * deepest.depth {
            for s in [share - step, share + step] {
                let deep = look(s.clamp(0.0, 1.0));
                if deep.depth > deepest.depth {
                    (share, deepest) = (s.clamp(0.0, 1.0), deep);
                }
            }
            step *= 0.5;
        }
        deepest
    }

    /// Calls `found` with the places at which a segment goes through a facet, as parts of its length, and whether it leaves the body there.
    pub fn crossings(&self, f: u32, ends: &[Vector<D>; 2], found: &mut impl FnMut(f64, bool)) {
        let facet = &self.facets[f as usize];
        let position = |n: u32| self.at(n);
        if D == 2 {
            for [a, b] in rim(facet.kind) {
                through(ends, &[position(facet.nodes[a]), position(facet.nodes[b])], found);
            }
            return;
        }
        if facet.kind == CellKind::Tri3 {
            through(ends, &[0, 1, 2].map(|k| position(facet.nodes[k])), found);
            return;
        }
        let middle = Patch::new(facet, &position).middle().point;
        for [a, b] in rim(facet.kind) {
            through(ends, &[position(facet.nodes[a]), position(facet.nodes[b]), middle], found);
        }
    }
}

/// Calls `found` with where on a segment it goes through a simplex of `D` corners, if it does, and whether it comes from behind.
fn through<const D: usize>(ends: &[Vector<D>; 2], corners: &[Vector<D>], found: &mut impl FnMut(f64, bool)) {
    let tangents = [corners[1] - corners[0], if D == 2 { Vector::zeros() } else { corners[2] - corners[0] }];
    let n = normal(&tangents);
    let [before, after] = ends.map(|x| n.dot(&(x - corners[0])));
    if before * after > 0.0 || before == after {
        return;
    }
    // What is behind its plane by round-off alone does not go through it. Edges that end on a flush face, or lie in it, are many.
    let size = tangents.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
    if before.min(after) >= -MEASURE.same * size {
        return;
    }
    let t = before / (before - after);
    let x = ends[0] + (ends[1] - ends[0]) * t - corners[0];
    let [s, r] = foot(&x, &tangents);
    if s >= -MEASURE.same && r >= -MEASURE.same && s + r <= 1.0 + MEASURE.same {
        found(t, before < 0.0);
    }
}

/// The angle of a facet at ξ, by which its normal counts there.
fn angle<const D: usize>(kind: CellKind, xi: &[f64; 2], tangents: &[Vector<D>; 2]) -> f64 {
    use std::f64::consts::PI;
    if D == 2 {
        return 1.0;
    }
    let [t0, t1] = tangents;
    let is_at = |x: f64, end: f64| (x - end).abs() <= MEASURE.same;
    if kind.corner_count() == 3 {
        let sides = [is_at(xi[0], 0.0), is_at(xi[1], 0.0), is_at(xi[0] + xi[1], 1.0)];
        return match sides {
            [false, false, false] => 2.0 * PI,
            [true, true, _] => t0.angle(t1),
            [false, true, true] => t0.angle(&(t0 - t1)),
            [true, false, true] => t1.angle(&(t1 - t0)),
            _ => PI,
        };
    }
    match xi.map(|x| is_at(x.abs(), 1.0)) {
        [false, false] => 2.0 * PI,
        [true, true] if xi[0] * xi[1] > 0.0 => t0.angle(t1),
        [true, true] => PI - t0.angle(t1),
        _ => PI,
    }
}
