//! How closely a motion must be looked at, so that nothing goes through anything between two looks.

use carom_mesh::Vector;

use super::shell::Shell;
use super::{Boundaries, Solid};
use crate::Obstacle;
use crate::aabb::Aabb;

/// What moves from its start to its end: boxes around its path and around its motions.
struct Mover<const D: usize> {
    path: Aabb<D>,
    motions: Aabb<D>,
    thickness: f64,
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
        start: &impl Fn(u32) -> Vector<D>,
        end: &impl Fn(u32) -> Vector<D>,
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
                if a.path.overlaps(&b.path) && counts([Solid::Body(i), Solid::Body(j)]) {
                    let motion = a.motions.union(&b.motions).diameter();
                    parts = parts.max(parts_of(motion, a.thickness.min(b.thickness)));
                }
            }
            for (o, (obstacle, skin)) in obstacles.iter().zip(&self.skins).enumerate() {
                let ends = [obstacle.shift(start), obstacle.shift(end)];
                let own = ends[1] - ends[0];
                let reach = 0.5 * a.path.diameter() + own.norm();
                let is_near = obstacle.shape.gap(&(a.path.centre() - ends[0])).0 <= reach;
                if skin.thickness.is_finite() && is_near && counts([Solid::Body(i), Solid::Obstacle(o)]) {
                    let motion = a.motions.union(&Aabb::of([own])).diameter();
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
    fn mover(&self, start: &impl Fn(u32) -> Vector<D>, end: &impl Fn(u32) -> Vector<D>) -> Mover<D> {
        let nodes = || self.nodes.iter().map(|(n, _)| (start(*n), end(*n)));
        Mover {
            path: Aabb::of(nodes().flat_map(|(a, b)| [a, b])),
            motions: Aabb::of(nodes().map(|(a, b)| b - a)),
            thickness: self.least_cell,
        }
    }
}
