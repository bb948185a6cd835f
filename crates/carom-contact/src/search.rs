use carom_mesh::parallel::{SURFACES, each_group};

use crate::aabb::Aabb;
use crate::bvh::{Bvh, fit};
use crate::facing::{Projected, faced};
use crate::looking::{Looking, Scratch};
use crate::project::Reach;
use crate::surface::diameter;
use crate::tolerances::SEARCH;
use crate::{ContactModel, ContactSurface, Extents, Mortar, Pair, Path, Solid, Target};

/// What the search for contacts keeps from one call to the next: room for boxes, and the trees over them.
///
/// It may be dropped at any moment: what is found does not depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Search<const D: usize> {
    pub(crate) surfaces: Vec<Swept<D>>,
    /// Those of obstacles that have facets.
    obstacles: Vec<Swept<D>>,
    /// Of every group of pairs that a thread looks at.
    pub(crate) looking: Vec<Looking<D>>,
    /// Of all surfaces on their way, where pairs are many.
    pub(crate) extents: Extents<D>,
    /// The numbers of the pairs that come near.
    pub(crate) pairs: Vec<usize>,
    /// What [`ContactModel::detect`] knows of mortar pairs.
    pub mortar: Mortar<D>,
}

impl<const D: usize> Default for Search<D> {
    fn default() -> Self {
        Self {
            surfaces: Vec::new(),
            obstacles: Vec::new(),
            looking: Vec::new(),
            extents: Extents::default(),
            pairs: Vec::new(),
            mortar: Mortar::default(),
        }
    }
}

/// The surface of a solid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SolidSurface<'a> {
    pub solid: Solid,
    pub surface: &'a ContactSurface,
}

/// A surface on its way through a step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Swept<const D: usize> {
    /// A box around the paths of its sources.
    sources: Aabb<D>,
    /// A box around the path of every facet.
    facets: Vec<Aabb<D>>,
    /// A box around all of these.
    whole: Aabb<D>,
    /// The boxes of the facets, with the room in which a node is found.
    pub tree: Bvh<D>,
    /// The boxes of the paths of its edges, with the room in which one that crosses it is found.
    pub edges: Bvh<D>,
    /// Whether its sources, and its facets, belong to a pair that counts.
    is_source: bool,
    is_faced: bool,
    /// Whether somebody asks for its facets, or its edges, by a tree.
    is_asked: bool,
    is_asked_for_edges: bool,
    is_swept: bool,
    is_fitted: bool,
}

impl<const D: usize> Search<D> {
    /// Whether one of the two comes within `margin` [m] of the other.
    pub(crate) fn meet(&self, source: Solid, target: Solid, margin: f64) -> bool {
        self.swept(source).sources.inflated(margin).overlaps(&self.room(target, margin))
    }

    /// The room within `margin` [m] of a solid on its way.
    pub(crate) fn room(&self, solid: Solid, margin: f64) -> Aabb<D> {
        self.swept(solid).whole.inflated(margin)
    }

    /// A box around the paths of the sources of a surface.
    pub(crate) fn room_of_sources(&self, surface: usize) -> &Aabb<D> {
        &self.surfaces[surface].sources
    }

    pub(crate) fn swept(&self, solid: Solid) -> &Swept<D> {
        match solid {
            Solid::Body(i) => &self.surfaces[i],
            Solid::Obstacle(o) => &self.obstacles[o],
        }
    }

    pub(crate) fn swept_mut(&mut self, solid: Solid) -> &mut Swept<D> {
        match solid {
            Solid::Body(i) => &mut self.surfaces[i],
            Solid::Obstacle(o) => &mut self.obstacles[o],
        }
    }

    /// Brings the trees of all that is asked for in `pairs` up to date.
    pub(crate) fn fit(&mut self, model: &ContactModel<D>, pairs: &[usize], path: &Path<'_, D>) {
        for &p in pairs {
            let pair = model.pairs.get(p);
            let (source, target) = (Solid::Body(pair.source), model.faceted_target(&pair));
            let Some(SolidSurface { solid, surface }) = target else { continue };
            if !self.meet(source, solid, path.margin) {
                continue;
            }
            let has_features = surface.has_features || model.surfaces[pair.source].has_features;
            let is_first = model.pairs.directions(p).start == p;
            let swept = self.swept_mut(solid);
            swept.is_asked |= !model.is_mortar(p);
            swept.is_asked_for_edges |= has_features && is_first;
            // Its corners look for facets of the body.
            self.surfaces[pair.source].is_asked |= matches!(solid, Solid::Obstacle(_));
        }
        each_group(&mut self.surfaces, SURFACES, |first, surfaces| {
            let all = surfaces.iter_mut().zip(&model.surfaces[first..]);
            all.for_each(|(swept, surface)| swept.fit_asked(surface, path));
        });
        for (swept, obstacle) in self.obstacles.iter_mut().zip(&model.obstacles) {
            if let Some(faceted) = &obstacle.faceted {
                let (start, end) = (&obstacle.placed(path.start), &obstacle.placed(path.end));
                swept.fit_asked(&faceted.surface, &Path { start, end, margin: path.margin });
            }
        }
    }

    /// Boxes around all that moves along a `path` and belongs to one of these `pairs` of `model`.
    pub(crate) fn sweep(
        &mut self,
        model: &ContactModel<D>,
        pairs: impl Iterator<Item = Pair>,
        path: &Path<'_, D>,
    ) {
        self.forget(model);
        pairs.for_each(|pair| self.expect(model, &pair));
        self.sweep_expected(model, path);
    }

    /// The same of all pairs that count, and where they are many boxes around whole surfaces on their way.
    pub(crate) fn sweep_where(
        &mut self,
        model: &ContactModel<D>,
        counts: &impl Fn(&Pair) -> bool,
        path: &Path<'_, D>,
    ) {
        self.forget(model);
        let are_many = model.pairs.are_many();
        if are_many {
            self.surfaces.iter_mut().for_each(|swept| (swept.is_source, swept.is_faced) = (true, true));
        } else {
            let pairs = model.pairs.listed().iter().filter(|pair| counts(pair));
            pairs.for_each(|pair| self.expect(model, pair));
        }
        self.sweep_expected(model, path);
        self.extents.surfaces.clear();
        if are_many {
            let whole = self.surfaces.iter().zip(&model.surfaces).map(|(swept, surface)| {
                let round = [surface.round_box(path.start), surface.round_box(path.end)];
                round.iter().fold(swept.whole.union(&swept.sources), |all, round| all.union(round))
            });
            self.extents.surfaces.extend(whole);
        }
    }

    /// Makes room for the solids of `model`, of which none is expected to move.
    fn forget(&mut self, model: &ContactModel<D>) {
        self.surfaces.resize_with(model.surfaces.len(), Swept::default);
        self.obstacles.resize_with(model.obstacles.len(), Swept::default);
        self.surfaces.iter_mut().for_each(Swept::forget);
    }

    /// Says that a pair counts.
    fn expect(&mut self, model: &ContactModel<D>, pair: &Pair) {
        let is_faced = match pair.target {
            Target::Surface(t) => {
                self.surfaces[t].is_faced = true;
                false
            }
            Target::Obstacle(o) => model.obstacles[o].faceted.is_some(),
        };
        let source = &mut self.surfaces[pair.source];
        source.is_source = true;
        source.is_faced |= is_faced;
    }

    fn sweep_expected(&mut self, model: &ContactModel<D>, path: &Path<'_, D>) {
        each_group(&mut self.surfaces, SURFACES, |first, surfaces| {
            for (swept, surface) in surfaces.iter_mut().zip(&model.surfaces[first..]) {
                if swept.is_source {
                    swept.sources = Aabb::of(surface.sources.iter().flat_map(|&n| path.ends(n)));
                }
                if swept.is_faced {
                    swept.sweep_facets(surface, path);
                    swept.whole = swept.facets.iter().fold(Aabb::of([]), |all, b| all.union(b));
                }
            }
        });
        for (swept, obstacle) in self.obstacles.iter_mut().zip(&model.obstacles) {
            swept.forget();
            if let Some(faceted) = &obstacle.faceted {
                let ends = [obstacle.shift(path.start), obstacle.shift(path.end)];
                let [start, end] = ends.map(|shift| faceted.bounds.moved(&shift));
                swept.whole = start.union(&end);
                swept.sources = swept.whole;
            }
        }
    }

    /// Tells `found` which of the sources of a surface come near facets of a `target`, and which facet each faces: the closest one half way
    /// among those that face it.
    pub(crate) fn facing(
        &self,
        source: &ContactSurface,
        target: SolidSurface<'_>,
        path: &Path<'_, D>,
        scratch: &mut Scratch<D>,
        mut found: impl FnMut(u32, u32),
    ) {
        let SolidSurface { solid, surface: target } = target;
        let room = self.room(solid, path.margin);
        let swept = self.swept(solid);
        let Scratch { near, projected, .. } = scratch;
        let middle = |n: u32| path.middle(n);
        let is_own = std::ptr::eq(source, target);
        for (k, &node) in source.sources.iter().enumerate() {
            let way = Aabb::of(path.ends(node));
            if !way.overlaps(&room) {
                continue;
            }
            let x = middle(node);
            near.clear();
            swept.tree.overlapping(&way, |f, room| {
                if is_own && !source.may_touch_itself(k, f) {
                    return;
                }
                near.push((swept.facets[f as usize].distance(&x), f, room.diameter()));
            });
            if near.is_empty() {
                continue;
            }
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let outward = source.node_normal(node, &middle);
            projected.clear();
            let mut reach = f64::INFINITY;
            // No farther is it behind a facet that it was in front of.
            let way_in = (x - (path.start)(node)).norm();
            for &(at_least, facet, size) in near.iter() {
                // Nothing farther away than a facet that the node faces squarely has a say.
                if at_least > reach + SEARCH.tie * size {
                    break;
                }
                let p = Projected::new(facet, size, &x, &target.project(facet, &x, Reach::Facet, &middle));
                // Through its own walls a node does not come.
                if is_own {
                    let deepest = -SEARCH.depth * diameter(&target.facets[facet as usize], path.start);
                    if target.gap_at(facet, &(path.start)(node), path.start) < deepest {
                        continue;
                    }
                }
                if p.faces(&outward) && p.gap <= path.margin && p.is_square() {
                    reach = reach.min(if p.gap < 0.0 { p.distance.max(way_in) } else { p.distance });
                }
                projected.push(p);
            }
            projected.sort_unstable_by_key(|p| p.facet);
            let before = |f: u32| target.gap_at(f, &(path.start)(node), path.start);
            if let Some(facet) = faced(projected, &outward, path.margin, before) {
                found(node, facet);
            }
        }
    }
}

impl<const D: usize> Default for Swept<D> {
    fn default() -> Self {
        Self {
            sources: Aabb::of([]),
            facets: Vec::new(),
            whole: Aabb::of([]),
            tree: Bvh::new([].into_iter()),
            edges: Bvh::new([].into_iter()),
            is_source: false,
            is_faced: false,
            is_asked: false,
            is_asked_for_edges: false,
            is_swept: false,
            is_fitted: false,
        }
    }
}

impl<const D: usize> Swept<D> {
    fn forget(&mut self) {
        (self.is_source, self.is_faced) = (false, false);
        (self.is_asked, self.is_asked_for_edges) = (false, false);
        (self.is_swept, self.is_fitted) = (false, false);
    }

    /// Brings the trees that somebody asks for up to date.
    fn fit_asked(&mut self, surface: &ContactSurface, path: &Path<'_, D>) {
        if self.is_asked {
            self.fit(surface, path);
        }
        if self.is_asked_for_edges {
            self.fit_edges(surface, path);
        }
    }

    fn sweep_facets(&mut self, surface: &ContactSurface, path: &Path<'_, D>) {
        self.facets.clear();
        let facets = 0..surface.facets.len() as u32;
        self.facets.extend(facets.map(|f| surface.bounds(f, path.start).union(&surface.bounds(f, path.end))));
        self.is_swept = true;
    }

    /// Brings the tree up to date, once per sweep.
    pub fn fit(&mut self, surface: &ContactSurface, path: &Path<'_, D>) {
        if self.is_fitted {
            return;
        }
        if !self.is_swept {
            self.sweep_facets(surface, path);
        }
        let room = |f: u32| {
            let facet = self.facets[f as usize];
            facet.inflated(path.margin + SEARCH.depth * facet.diameter())
        };
        fit(&mut self.tree, self.facets.len(), room);
        self.is_fitted = true;
    }

    /// The same for the edges of the `surface`.
    fn fit_edges(&mut self, surface: &ContactSurface, path: &Path<'_, D>) {
        let room = |e: u32| {
            let swept = surface.edges[e as usize].path(path.start, path.end);
            swept.inflated(path.margin + SEARCH.depth * swept.diameter())
        };
        fit(&mut self.edges, surface.edges.len(), room);
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{CellBlock, Mesh, Surface, Vector, generate};

    use super::*;
    use crate::{Discretisation, Pair};

    /// A body of cubes, or squares, pulled into a ball.
    fn ball<const D: usize>(divisions: usize) -> Mesh<D> {
        let grid = generate::grid([-1.0; D], [2.0; D], [divisions; D]).expect("valid");
        let round = |x: &Vector<D>| if x.amax() > 0.0 { x * (x.amax() / x.norm()) } else { *x };
        let blocks =
            grid.blocks().iter().map(|b| CellBlock { kind: b.kind, connectivity: b.connectivity.clone() });
        Mesh::new(grid.nodes().iter().map(round).collect(), blocks.collect()).expect("valid")
    }

    /// Two balls that graze one another, the second turned, moving through each other from `start` to `end`.
    fn same_candidates_as_a_scan<const D: usize>(divisions: usize) {
        let mesh = ball::<D>(divisions);
        let count = mesh.nodes().len() as u32;
        let reference = |n: u32| mesh.nodes()[(n % count) as usize];
        let model = ContactModel::<D> {
            surfaces: vec![
                ContactSurface::new(&Surface::of(&mesh), 0, &reference),
                ContactSurface::new(&Surface::of(&mesh), count, &reference),
            ],
            obstacles: vec![],
            pairs: vec![
                Pair {
                    source: 0,
                    target: Target::Surface(1),
                    friction: 0.0,
                    discretisation: Discretisation::default(),
                },
                Pair {
                    source: 1,
                    target: Target::Surface(0),
                    friction: 0.0,
                    discretisation: Discretisation::default(),
                },
            ]
            .into(),
        };
        let mut search = Search::default();
        let mut found = 0;
        for k in 0..8 {
            let way = 1.9 + 0.04 * f64::from(k);
            let at = |n: u32, by: f64| {
                if n < count {
                    return mesh.nodes()[n as usize];
                }
                let mut x = mesh.nodes()[(n - count) as usize];
                (x[0], x[D - 1]) = (-x[D - 1], x[0]);
                x[0] += by;
                x[1] += 0.3;
                x
            };
            let (start, end) = (|n: u32| at(n, way), |n: u32| at(n, way - 0.05));
            let (mut tree, mut scan) = (Vec::new(), Vec::new());
            let path = Path { start: &start, end: &end, margin: 0.1 };
            model.detect(&path, &mut search, &mut tree);
            let mut flat = Search::default();
            flat.sweep_where(&model, &|_| true, &path);
            for (swept, surface) in flat.surfaces.iter_mut().zip(&model.surfaces) {
                swept.tree = Bvh::flat(surface.facets.iter().map(|_| Aabb::of([])));
            }
            model.detect(&path, &mut flat, &mut scan);
            assert_eq!(tree, scan);
            found += tree.len();
        }
        assert!(found > 20, "{found}");
    }

    #[test]
    fn the_tree_finds_the_candidates_that_a_scan_finds() {
        same_candidates_as_a_scan::<2>(16);
        same_candidates_as_a_scan::<3>(8);
    }

    /// How long a search between two slabs of 10,000 facets, one on the other, takes by a scan and by the tree.
    #[test]
    #[ignore = "a measurement: run with --ignored --nocapture"]
    fn time_of_a_search_among_many_facets() {
        let mesh = generate::grid([0.0; 3], [1.0, 1.0, 0.1], [67, 67, 4]).expect("valid");
        let count = mesh.nodes().len() as u32;
        let surface = Surface::of(&mesh);
        let reference = |n: u32| mesh.nodes()[(n % count) as usize];
        let model = ContactModel::<3> {
            surfaces: [0, count].map(|first| ContactSurface::new(&surface, first, &reference)).to_vec(),
            obstacles: vec![],
            pairs: vec![Pair {
                source: 0,
                target: Target::Surface(1),
                friction: 0.0,
                discretisation: Discretisation::default(),
            }]
            .into(),
        };
        let at = |n: u32| {
            let x = mesh.nodes()[(n % count) as usize];
            if n < count { x } else { x + Vector::<3>::new(0.003, 0.004, 0.1001) }
        };
        let mut search = Search::default();
        let mut out = Vec::new();
        let mut time = |search: &mut Search<3>| {
            let start = std::time::Instant::now();
            for _ in 0..10 {
                model.detect(&Path::resting(&at, 0.01), search, &mut out);
            }
            (start.elapsed() / 10, out.len())
        };
        let tree = (time(&mut search), time(&mut search));
        search.surfaces[1].tree = Bvh::flat(surface.facets().iter().map(|_| Aabb::of([])));
        let scan = time(&mut search);
        let start = std::time::Instant::now();
        let closest = model.proximity(&model.pairs.get(0), &at).expect("nodes");
        println!("closest {:e} m after {:?}", closest.gap, start.elapsed());
        println!(
            "{} facets: tree {:?} (first {:?}), scan {:?}",
            surface.facets().len(),
            tree.1,
            tree.0,
            scan
        );
    }
}
