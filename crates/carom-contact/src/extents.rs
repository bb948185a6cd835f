//! How far apart two solids are at least, by boxes around them: few pairs of many need a closer look.

use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::{ContactModel, ContactSurface, Pair, Target};

/// Boxes around all surfaces at one moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Extents<const D: usize> {
    surfaces: Vec<Aabb<D>>,
}

impl<const D: usize> Extents<D> {
    /// The same where some `points` [m] belong to a surface, too.
    pub fn include(&mut self, surface: usize, points: impl Iterator<Item = Vector<D>>) {
        let own = &mut self.surfaces[surface];
        *own = own.union(&Aabb::of(points));
    }
}

impl<const D: usize> ContactModel<D> {
    /// Boxes around the facets and sources of all surfaces, where the nodes are at `position`.
    #[must_use]
    pub fn extents(&self, position: &impl Fn(u32) -> Vector<D>) -> Extents<D> {
        let around = |s: &ContactSurface| {
            let facets = (0..s.facets.len() as u32).map(|f| s.bounds(f, position));
            let sources = Aabb::of(s.sources.iter().map(|&n| position(n)));
            facets.fold(sources, |all, facet| all.union(&facet))
        };
        Extents { surfaces: self.surfaces.iter().map(around).collect() }
    }

    /// A number that no gap of a pair is smaller than [m]; without bound where the boxes overlap.
    #[must_use]
    pub fn at_least(&self, pair: &Pair, extents: &Extents<D>, position: &impl Fn(u32) -> Vector<D>) -> f64 {
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

    /// The smallest gap of all pairs beyond the `least` that each may have [m]; infinite without a pair.
    #[must_use]
    pub fn smallest_gap(&self, least: impl Fn(&Pair) -> f64, position: &impl Fn(u32) -> Vector<D>) -> f64 {
        let extents = self.extents(position);
        let bound = |pair: &Pair| self.at_least(pair, &extents, position) - least(pair);
        let beyond = |pair: &Pair| self.proximity(pair, position).map(|near| near.gap - least(pair));
        let bounds = self.pairs.iter().map(|pair| (bound(pair), pair));
        let nearest = bounds.min_by(|a, b| a.0.total_cmp(&b.0));
        let mut smallest = nearest.and_then(|(_, pair)| beyond(pair)).unwrap_or(f64::INFINITY);
        for pair in &self.pairs {
            if bound(pair) < smallest {
                smallest = beyond(pair).map_or(smallest, |gap| gap.min(smallest));
            }
        }
        smallest
    }
}

#[cfg(test)]
mod tests {
    use carom_mesh::{Surface, generate};

    use super::*;
    use crate::{Discretisation, Obstacle};

    /// Eight discs in a row that is bent, above a floor, and every pair of them.
    fn row(smooth: bool) -> (ContactModel<2>, Vec<Vector<2>>) {
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
        for source in 0..8 {
            let pair = |target| Pair {
                source,
                target,
                friction: 0.0,
                named_pair: 0,
                discretisation: Discretisation::NodeToSegment,
            };
            model.pairs.push(pair(Target::Obstacle(0)));
            model.pairs.extend((0..8).filter(|&t| t != source).map(|t| pair(Target::Surface(t))));
        }
        x.push(Vector::zeros());
        (model, x)
    }

    #[test]
    fn boxes_bound_every_gap_and_find_the_smallest_of_all() {
        for smooth in [false, true] {
            let (model, x) = row(smooth);
            for shift in [0.0, 0.05, -0.4] {
                // Every other disc is moved along the row, into its neighbour in the end.
                let at = |n: u32| {
                    let own = model.surfaces.iter().position(|s| s.sources.contains(&n));
                    x[n as usize] + Vector::<2>::new(own.map_or(0.0, |k| shift * (k % 2) as f64), 0.0)
                };
                let extents = model.extents(&at);
                let gap = |pair: &Pair| model.proximity(pair, &at).expect("nodes").gap;
                let mut known = 0;
                for pair in &model.pairs {
                    let bound = model.at_least(pair, &extents, &at);
                    assert!(bound <= gap(pair) + 1e-12, "{bound} of {}", gap(pair));
                    known += usize::from(bound > 0.0);
                }
                assert!(known > model.pairs.len() / 2, "{known} pairs are known to be apart");
                // With a pair that may be closer than the others.
                let least = |pair: &Pair| if pair.source == 5 { -0.3 } else { 0.01 };
                let all = model.pairs.iter().map(|pair| gap(pair) - least(pair));
                assert_eq!(model.smallest_gap(least, &at), all.fold(f64::INFINITY, f64::min));
            }
        }
    }
}
