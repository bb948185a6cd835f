//! How closely a motion must be looked at, so that nothing goes through anything between two looks.

use carom_mesh::Vector;

use super::shell::Shell;
use super::{Boundaries, Solid};
use crate::Obstacle;
use crate::path::Positions;

/// What moves from its start to its end. Nothing of it hangs on the axes.
struct Mover<const D: usize> {
    /// Where its nodes start and end [m].
    places: Vec<[Vector<D>; 2]>,
    /// The mean of these, and how far they are from it at most [m].
    centre: Vector<D>,
    radius: f64,
    /// The mean motion of its nodes, and how far theirs is from it at most [m].
    motion: Vector<D>,
    spread: f64,
    /// How far what is round is in front of its facets at most [m].
    arc: f64,
    thickness: f64,
}

impl<const D: usize> Mover<D> {
    fn new(places: Vec<[Vector<D>; 2]>, arc: f64, thickness: f64) -> Self {
        let count = places.len().max(1) as f64;
        let centre = places.iter().map(|[a, b]| a + b).sum::<Vector<D>>() / (2.0 * count);
        let motion = places.iter().map(|[a, b]| b - a).sum::<Vector<D>>() / count;
        let all = places.iter().flatten();
        let radius = all.map(|x| (x - centre).norm_squared()).fold(0.0, f64::max).sqrt();
        let beside = places.iter().map(|[a, b]| (b - a - motion).norm_squared());
        let spread = beside.fold(0.0, f64::max).sqrt();
        Self { places, centre, radius, motion, spread, arc, thickness }
    }

    /// Whether no plane that is at right angles to the line of their middles, or to their motion against one another, is between their ways.
    fn may_meet(&self, other: &Self) -> bool {
        let axes = [other.centre - self.centre, other.motion - self.motion];
        axes.iter().all(|axis| {
            let [own, others] = [self, other].map(|mover| mover.extent(axis));
            let arcs = (self.arc + other.arc) * axis.norm();
            own[0] <= others[1] + arcs && others[0] <= own[1] + arcs
        })
    }

    /// From where to where it reaches along an axis.
    fn extent(&self, axis: &Vector<D>) -> [f64; 2] {
        let along = self.places.iter().flatten().map(|x| axis.dot(x));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }

    /// How far something that moves by `motion` [m], give or take `spread`, moves against it at most.
    fn against(&self, motion: &Vector<D>, spread: f64) -> f64 {
        (motion - self.motion).norm() + self.spread + spread
    }
}

impl<const D: usize> Boundaries<D> {
    /// The number of equal parts that a straight motion of all nodes from `start` to `end` must be cut into for no pair that `counts` to
    /// move against one another by more than half of the smallest facet or the thinnest obstacle in one part: one where none comes near another.
    ///
    /// No node and no obstacle moves farther than `farthest` [m]: where that is little nothing else is looked at.
    #[must_use]
    pub fn parts(
        &self,
        farthest: f64,
        obstacles: &[Obstacle<D>],
        counts: impl Fn([Solid; 2]) -> bool,
        start: &Positions<'_, D>,
        end: &Positions<'_, D>,
    ) -> usize {
        let shells = self.shells.iter().map(|shell| shell.least_cell);
        let thinnest =
            shells.chain(self.skins.iter().map(|skin| skin.thickness)).fold(f64::INFINITY, f64::min);
        // Two may move towards one another.
        if parts_of(2.0 * farthest, thinnest) == 1 {
            return 1;
        }
        let movers: Vec<Mover<D>> = self.shells.iter().map(|shell| shell.mover(start, end)).collect();
        let mut parts = 1;
        for (i, a) in movers.iter().enumerate() {
            for (j, b) in movers.iter().enumerate().skip(i + 1) {
                if counts([Solid::Body(i), Solid::Body(j)]) && a.may_meet(b) {
                    let motion = a.against(&b.motion, b.spread);
                    parts = parts.max(parts_of(motion, a.thickness.min(b.thickness)));
                }
            }
            for (o, (obstacle, skin)) in obstacles.iter().zip(&self.skins).enumerate() {
                let ends = [obstacle.shift(start), obstacle.shift(end)];
                let own = ends[1] - ends[0];
                let is_near = obstacle.shape.gap(&(a.centre - ends[0])).0 <= a.radius + own.norm();
                if skin.thickness.is_finite() && is_near && counts([Solid::Body(i), Solid::Obstacle(o)]) {
                    let motion = a.against(&own, 0.0);
                    parts = parts.max(parts_of(motion, a.thickness.min(skin.thickness)));
                }
            }
        }
        parts
    }
}

/// How many halves of a thickness there are in a motion.
fn parts_of(motion: f64, thickness: f64) -> usize {
    (2.0 * motion / thickness).ceil().max(1.0) as usize
}

impl<const D: usize> Shell<D> {
    fn mover(&self, start: &Positions<'_, D>, end: &Positions<'_, D>) -> Mover<D> {
        let places = self.nodes.iter().map(|(n, _)| [start(*n), end(*n)]).collect();
        // The arc of a facet is in front of its middle; those of warped ones may be farther.
        let arc = if self.ball.is_some() { 2.0 * self.largest_arc() } else { 0.0 };
        Mover::new(places, arc, self.least_cell)
    }
}
