use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::edge::Found;
use crate::facing::Projected;
use crate::tolerances::SEARCH;
use crate::{ContactModel, ContactSurface, Target};

/// What the search for contacts keeps from one call to the next: room for boxes, and the trees over them.
///
/// It may be dropped at any moment: what is found does not depend on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Search<const D: usize> {
    pub(crate) surfaces: Vec<Swept<D>>,
    /// Facets near a node: how close to it they may come [m], their number, and the size of the box in which they find nodes [m].
    pub(crate) near: Vec<(f64, u32, f64)>,
    pub(crate) projected: Vec<Projected<D>>,
    /// Edges of a pair that cross.
    pub(crate) crossings: Vec<Found>,
}

impl<const D: usize> Default for Search<D> {
    fn default() -> Self {
        Self { surfaces: Vec::new(), near: Vec::new(), projected: Vec::new(), crossings: Vec::new() }
    }
}

/// A surface on its way through a step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Swept<const D: usize> {
    /// A box around the paths of its sources.
    pub sources: Aabb<D>,
    /// A box around the path of every facet.
    pub facets: Vec<Aabb<D>>,
    /// A box around all of these.
    pub whole: Aabb<D>,
    /// The boxes of the facets, with the room in which a node is found.
    pub tree: Bvh<D>,
    /// The boxes of the paths of its edges, with the room in which one that crosses it is found.
    pub edges: Bvh<D>,
    is_fitted: bool,
    edges_are_fitted: bool,
}

impl<const D: usize> Search<D> {
    /// The room around the target surface that is within `margin` [m] of it, if nodes of the source surface come into its box.
    pub(crate) fn meeting(&self, source: usize, target: usize, margin: f64) -> Option<Aabb<D>> {
        let room = self.surfaces[target].whole.inflated(margin);
        self.surfaces[source].sources.inflated(margin).overlaps(&room).then_some(room)
    }

    /// Boxes around all that moves from `start` to `end` and belongs to a pair of `model`.
    pub(crate) fn sweep(
        &mut self,
        model: &ContactModel<D>,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
    ) {
        let empty = || Swept {
            sources: Aabb::of([]),
            facets: Vec::new(),
            whole: Aabb::of([]),
            tree: Bvh::new([].into_iter()),
            edges: Bvh::new([].into_iter()),
            is_fitted: false,
            edges_are_fitted: false,
        };
        self.surfaces.resize_with(model.surfaces.len(), empty);
        for (s, (swept, surface)) in self.surfaces.iter_mut().zip(&model.surfaces).enumerate() {
            (swept.is_fitted, swept.edges_are_fitted) = (false, false);
            if model.pairs.iter().any(|p| matches!(p.target, Target::Surface(_)) && p.source == s) {
                swept.sources = Aabb::of(surface.sources.iter().flat_map(|&n| [start(n), end(n)]));
            }
            if model.pairs.iter().any(|p| p.target == Target::Surface(s)) {
                swept.sweep_facets(surface, start, end);
            }
        }
    }
}

impl<const D: usize> Swept<D> {
    fn sweep_facets(
        &mut self,
        surface: &ContactSurface,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
    ) {
        self.facets.clear();
        let facets = 0..surface.facets.len() as u32;
        self.facets.extend(facets.map(|f| surface.bounds(f, start).union(&surface.bounds(f, end))));
        self.whole = self.facets.iter().fold(Aabb::of([]), |all, b| all.union(b));
    }

    /// Brings the tree up to date, once per sweep.
    pub fn fit(&mut self, margin: f64) {
        if self.is_fitted {
            return;
        }
        let room = |f: u32| {
            let facet = self.facets[f as usize];
            facet.inflated(margin + SEARCH.depth * facet.diameter())
        };
        fit(&mut self.tree, self.facets.len(), room);
        self.is_fitted = true;
    }

    /// The same for the edges of the `surface`.
    pub fn fit_edges(
        &mut self,
        surface: &ContactSurface,
        margin: f64,
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
    ) {
        if self.edges_are_fitted {
            return;
        }
        let room = |e: u32| {
            let path = surface.edges[e as usize].path(start, end);
            path.inflated(margin + SEARCH.depth * path.diameter())
        };
        fit(&mut self.edges, surface.edges.len(), room);
        self.edges_are_fitted = true;
    }
}

/// Gives the `count` items of a tree their boxes.
fn fit<const D: usize>(tree: &mut Bvh<D>, count: usize, bounds: impl Fn(u32) -> Aabb<D>) {
    if tree.len() == count {
        tree.refit(bounds);
    } else {
        *tree = Bvh::new((0..count as u32).map(bounds));
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{CellBlock, Mesh, Surface, generate};

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
        let model = ContactModel::<D> {
            surfaces: vec![
                ContactSurface::new(&Surface::of(&mesh), 0),
                ContactSurface::new(&Surface::of(&mesh), count),
            ],
            obstacles: vec![],
            pairs: vec![
                Pair {
                    source: 0,
                    target: Target::Surface(1),
                    friction: 0.0,
                    named_pair: 0,
                    discretisation: Discretisation::default(),
                },
                Pair {
                    source: 1,
                    target: Target::Surface(0),
                    friction: 0.0,
                    named_pair: 0,
                    discretisation: Discretisation::default(),
                },
            ],
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
            model.detect(&start, &end, 0.1, &mut search, &mut tree);
            let mut flat = Search::default();
            flat.sweep(&model, &start, &end);
            for (swept, surface) in flat.surfaces.iter_mut().zip(&model.surfaces) {
                swept.tree = Bvh::flat(surface.facets.iter().map(|_| Aabb::of([])));
            }
            model.detect(&start, &end, 0.1, &mut flat, &mut scan);
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
        let model = ContactModel::<3> {
            surfaces: vec![ContactSurface::new(&surface, 0), ContactSurface::new(&surface, count)],
            obstacles: vec![],
            pairs: vec![Pair {
                source: 0,
                target: Target::Surface(1),
                friction: 0.0,
                named_pair: 0,
                discretisation: Discretisation::default(),
            }],
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
                model.detect(&at, &at, 0.01, search, &mut out);
            }
            (start.elapsed() / 10, out.len())
        };
        let tree = (time(&mut search), time(&mut search));
        search.surfaces[1].tree = Bvh::flat(surface.facets().iter().map(|_| Aabb::of([])));
        let scan = time(&mut search);
        let start = std::time::Instant::now();
        let closest = model.proximity(&model.pairs[0], &at).expect("nodes");
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
