//! Which facets of two surfaces may press on one another in a step.

use carom_mesh::{Facet, Vector};
use smallvec::SmallVec;

use super::plane::Plane;
use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::path::Positions;
use crate::surface::diameter;
use crate::tolerances::MORTAR;
use crate::{ContactModel, ContactSurface, Path, Target};

/// A facet of the source and one of the target that may touch. Ordered by pair, source and target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Facing {
    /// Index of the pair.
    pub pair: u32,
    /// Index of the facet of the source.
    pub source: u32,
    /// Index of the facet of the target.
    pub target: u32,
}

impl<const D: usize> ContactModel<D> {
    /// Adds the facets of a pair that may face one another between the start and the end of the `path`.
    pub(super) fn find_facing(&self, pair: usize, path: &Path<'_, D>, out: &mut Vec<Facing>) {
        let Target::Surface(target) = self.pairs.get(pair).target else { return };
        let (source, target) = (&self.surfaces[self.pairs.get(pair).source], &self.surfaces[target]);
        let middle = |n: u32| path.middle(n);
        let [of_source, of_target] = [source, target].map(|surface| {
            let rooms = surface.facets.iter().map(|facet| Room::swept(facet, path));
            rooms.collect::<Vec<_>>()
        });
        let whole = |rooms: &[Room<D>]| rooms.iter().fold(Aabb::of([]), |all, r| all.union(&r.bounds()));
        // The facets that come near the other side at all.
        let near = |surface: &ContactSurface, rooms: &[Room<D>], other: &Aabb<D>| -> Vec<Near<D>> {
            let all = rooms.iter().enumerate();
            all.filter(|(_, room)| room.bounds().overlaps(other))
                .filter_map(|(f, room)| Near::new(f as u32, &surface.facets[f], *room, &middle))
                .collect()
        };
        let targets = near(target, &of_target, &whole(&of_source));
        if targets.is_empty() {
            return;
        }
        let tree = Bvh::new(targets.iter().map(|t| t.room.bounds()));
        for own in near(source, &of_source, &whole(&of_target)) {
            let first = out.len();
            tree.overlapping(&own.room.bounds(), |k, _| {
                let other = &targets[k as usize];
                if own.room.meets(&other.room) && own.faces(other) {
                    out.push(Facing { pair: pair as u32, source: own.facet, target: other.facet });
                }
            });
            out[first..].sort_unstable();
        }
    }
}

/// A ball around the path of a facet and what it reaches: the same however both are turned.
#[derive(Debug, Clone, Copy)]
struct Room<const D: usize> {
    centre: Vector<D>,
    /// Its radius [m].
    radius: f64,
}

impl<const D: usize> Room<D> {
    fn swept(facet: &Facet, path: &Path<'_, D>) -> Self {
        let places = || facet.nodes.iter().flat_map(|&n| path.ends(n));
        let centre = places().sum::<Vector<D>>() / (2 * facet.nodes.len()) as f64;
        let around = places().map(|x| (x - centre).norm_squared()).fold(0.0, f64::max).sqrt();
        Self { centre, radius: around + path.margin + MORTAR.reach[1] * diameter(facet, &|n| path.middle(n)) }
    }

    fn bounds(&self) -> Aabb<D> {
        Aabb::of([self.centre]).inflated(self.radius)
    }

    fn meets(&self, other: &Self) -> bool {
        (self.centre - other.centre).norm_squared() <= (self.radius + other.radius).powi(2)
    }
}

/// A facet that is near the other side.
struct Near<const D: usize> {
    facet: u32,
    room: Room<D>,
    /// Outward unit normal in the middle of the step.
    normal: Vector<D>,
}

impl<const D: usize> Near<D> {
    fn new(number: u32, facet: &Facet, room: Room<D>, position: &Positions<'_, D>) -> Option<Self> {
        let corners: SmallVec<[Vector<D>; 4]> =
            facet.nodes[..facet.kind.corner_count()].iter().map(|&n| position(n)).collect();
        Some(Self { facet: number, room, normal: Plane::through(&corners)?.normal() })
    }

    /// Whether a facet looks the other way at all. How much it counts is known where the rows are made.
    fn faces(&self, other: &Self) -> bool {
        self.normal.dot(&other.normal) < 0.0
    }
}
