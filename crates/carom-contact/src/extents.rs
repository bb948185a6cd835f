//! How far apart two solids are at least, by boxes around them: few pairs of many need a closer look.

use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::neighbours::Neighbours;
use crate::path::Positions;
use crate::{ContactModel, ContactSurface, Pair, Solid, Target};

/// Boxes around all surfaces at one moment, or on their way.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Extents<const D: usize> {
    pub(crate) surfaces: Vec<Aabb<D>>,
}

impl<const D: usize> Extents<D> {
    /// The same where some `points` [m] belong to a surface, too.
    pub fn include(&mut self, surface: usize, points: impl Iterator<Item = Vector<D>>) {
        let own = &mut self.surfaces[surface];
        *own = own.union(&Aabb::of(points));
    }

    /// Boxes that hold those of both.
    #[must_use]
    pub(crate) fn union(mut self, other: &Self) -> Self {
        for (own, other) in self.surfaces.iter_mut().zip(&other.surfaces) {
            *own = own.union(other);
        }
        self
    }

    /// Tells `found` who may be within `reach` [m] of whom, two by two and ascending: surfaces, each with itself too, and every surface with
    /// every one of so many `obstacles`.
    fn neighbours(&self, obstacles: usize, reach: f64, mut found: impl FnMut([Solid; 2])) {
        let mut near = Neighbours::default();
        near.find(self.surfaces.len(), reach, |i| &self.surfaces[i]);
        for i in 0..self.surfaces.len() {
            let me = Solid::Body(i);
            found([me, me]);
            near.of(i).filter(|&j| j > i).for_each(|j| found([me, Solid::Body(j)]));
            (0..obstacles).for_each(|o| found([me, Solid::Obstacle(o)]));
        }
    }
}

impl<const D: usize> ContactModel<D> {
    /// Boxes around the facets and sources of all surfaces, where the nodes are at `position`.
    #[must_use]
    pub fn extents(&self, position: &Positions<'_, D>) -> Extents<D> {
        let around = |s: &ContactSurface| {
            let facets = (0..s.facets.len() as u32).map(|f| s.bounds(f, position));
            let sources = Aabb::of(s.sources.iter().map(|&n| position(n)));
            facets.fold(sources.union(&s.round_box(position)), |all, facet| all.union(&facet))
        };
        Extents { surfaces: self.surfaces.iter().map(around).collect() }
    }

    /// Writes to `out` the numbers of pairs, ascending, among which are all whose solids come within `reach` [m] of one another: of many pairs
    /// those whose boxes do and all with obstacles, of few all that there are.
    pub fn within(&self, reach: f64, extents: &Extents<D>, out: &mut Vec<usize>) {
        out.clear();
        if self.pairs.are_many() {
            extents.neighbours(self.obstacles.len(), reach, |between| out.extend(self.pairs.of(between)));
        } else {
            out.extend(0..self.pairs.listed().len());
        }
    }

    /// A number that no gap of a pair is smaller than [m]; without bound where the boxes overlap.
    #[must_use]
    pub fn at_least(&self, pair: &Pair, extents: &Extents<D>, position: &Positions<'_, D>) -> f64 {
        let source = &extents.surfaces[pair.source];
        match pair.target {
            // The distance from an obstacle changes by no more than the way.
            Target::Obstacle(o) => self.obstacles[o].gap(&source.centre(), position).0 - source.reach(),
            Target::Surface(t) => match source.gap(&extents.surfaces[t]) {
                gap if gap > 0.0 => gap,
                _ => f64::NEG_INFINITY,
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use carom_mesh::{Surface, generate};

    use super::*;
    use crate::{
        Directions, Discretisation, Gauge, KnownGaps, Obstacle, PairRule, PairRules, Pairs, Path, Search,
        Side,
    };

    /// Eight discs in a row that is bent, above a floor, and every pair of them: listed if they are no more than `many`.
    fn row(smooth: bool, many: usize) -> (ContactModel<2>, Vec<Vector<2>>) {
        let (mut x, mut model) = (Vec::new(), ContactModel::default());
        model.obstacles.push(Obstacle::plane(Vector::<2>::new(0.0, -3.0), Vector::<2>::new(0.6, 0.8)));
        for k in 0..8 {
            let (along, angle) = (2.2 * f64::from(k), f64::from(k * k));
            let disc = generate::Disc {
                centre: [along, 0.4 * angle.sin()],
                radius: 1.0 + 0.09 * angle.cos(),
                divisions: 2,
                rings: None,
            };
            let mesh = disc.quadrilaterals().expect("valid");
            let first = x.len() as u32;
            x.extend_from_slice(mesh.nodes());
            let surface = ContactSurface::new(&Surface::of(&mesh), first, &|n| x[n as usize]);
            let surface = if smooth { surface.smoothed(&|n| x[n as usize]) } else { surface };
            model.surfaces.push(surface);
        }
        let rule = PairRule {
            friction: 0.0,
            discretisation: Discretisation::NodeToSegment,
            directions: Directions::Both,
        };
        let side = Side { touches_itself: false, facet_width: 1.0, mass: 1.0 };
        let rules = PairRules { sides: vec![side; 8], obstacles: 1, rule, exceptions: BTreeMap::new() };
        model.pairs = Pairs::by(rules, many);
        x.push(Vector::zeros());
        (model, x)
    }

    /// Every other disc is moved along the row, into its neighbour in the end.
    fn moved<'a>(
        model: &'a ContactModel<2>,
        x: &'a [Vector<2>],
        shift: f64,
    ) -> impl Fn(u32) -> Vector<2> + use<'a> {
        move |n| {
            let own = model.surfaces.iter().position(|s| s.sources.contains(&n));
            x[n as usize] + Vector::<2>::new(own.map_or(0.0, |k| shift * (k % 2) as f64), 0.0)
        }
    }

    #[test]
    fn boxes_bound_every_gap_and_find_the_smallest_of_all() {
        for (smooth, many) in [(false, 100), (true, 100), (false, 0), (true, 0)] {
            let (model, x) = row(smooth, many);
            assert_eq!(model.pairs.are_many(), many == 0);
            let mut gauge = Gauge::default();
            let pairs: Vec<Pair> = model.pairs.iter().map(|(_, pair)| pair).collect();
            for shift in [0.0, 0.05, -0.4] {
                let at = moved(&model, &x, shift);
                let extents = model.extents(&at);
                let gap = |pair: &Pair| model.proximity(pair, &at).expect("nodes").gap;
                let mut known = 0;
                for pair in &pairs {
                    let bound = model.at_least(pair, &extents, &at);
                    assert!(bound <= gap(pair) + 1e-12, "{bound} of {}", gap(pair));
                    known += usize::from(bound > 0.0);
                }
                assert!(known > pairs.len() / 2, "{known} pairs are known to be apart");
                // With a pair that may be closer than the others, and one that is pushed apart from far away.
                let least = |pair: &Pair| match pair.source {
                    5 => -0.3,
                    2 if pair.target == Target::Surface(6) => 6.0,
                    _ => 0.01,
                };
                let all = pairs.iter().map(|pair| gap(pair) - least(pair));
                let smallest = all.fold(f64::INFINITY, f64::min);
                let deepest = pairs.iter().map(|pair| -gap(pair)).fold(0.0, f64::max);
                for known in [f64::INFINITY, smallest + 0.3, smallest] {
                    for deepest in [f64::INFINITY, deepest] {
                        let gaps = KnownGaps { least, most: 6.0, known, deepest, suspects: None };
                        assert_eq!(gauge.smallest_gap(&model, &gaps, &at), smallest);
                    }
                }
            }
        }
    }

    #[test]
    fn of_pairs_that_are_not_listed_the_same_contacts_are_found() {
        for smooth in [false, true] {
            let ((listed, x), (ruled, _)) = (row(smooth, 100), row(smooth, 0));
            let mut count = 0;
            for (shift, margin) in [(-0.2, 0.01), (-0.4, 0.0), (0.3, 0.1), (0.0, 2.0)] {
                let found = |model: &ContactModel<2>| {
                    let (start, end) = (moved(model, &x, 0.0), moved(model, &x, shift));
                    let (mut search, mut out) = (Search::default(), Vec::new());
                    model.detect(&Path { start: &start, end: &end, margin }, &mut search, &mut out);
                    let named = |c: &crate::Candidate| {
                        (model.pairs.get(c.pair as usize), c.site, c.facet, c.redundant)
                    };
                    out.iter().map(named).collect::<Vec<_>>()
                };
                let same = found(&listed);
                assert_eq!(same, found(&ruled));
                count += same.len();
            }
            assert!(count > 20, "{count} contacts");
        }
    }
}
