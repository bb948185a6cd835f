use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::bvh::Bvh;
use crate::path::Positions;
use crate::project::Reach;
use crate::tolerances::MEASURE;
use crate::{Candidate, Contact, ContactModel, ContactSurface, Pair, Search, Site, Solid, Target};

/// The place where the two sides of a pair are closest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Proximity<const D: usize> {
    /// Signed distance [m]; negative = overlap.
    pub gap: f64,
    /// The point [m].
    pub at: Vector<D>,
}

impl<const D: usize> ContactModel<D> {
    /// Where the source of `pair` is closest to, or deepest inside, the target: a node of it, or what is round.
    #[must_use]
    pub fn proximity(&self, pair: &Pair, position: &Positions<'_, D>) -> Option<Proximity<D>> {
        self.round_proximity(pair, position).or_else(|| {
            let nodes = self.surfaces[pair.source].sources.iter().map(|&n| position(n));
            self.closest(nodes, pair.target, position)
        })
    }

    /// Which of these points [m] is closest to, or deepest inside, a target.
    ///
    /// Unlike a candidate's gap this needs no margin and no history: the sign comes from the closest point of the whole target.
    #[must_use]
    pub fn closest(
        &self,
        points: impl Iterator<Item = Vector<D>>,
        target: Target,
        position: &Positions<'_, D>,
    ) -> Option<Proximity<D>> {
        let mut closest: Option<Proximity<D>> = None;
        let mut keep = |gap: f64, at: Vector<D>| {
            // One is the closest even where it is infinitely far away.
            if closest.is_none_or(|c| gap < c.gap) {
                closest = Some(Proximity { gap, at });
            }
        };
        match target {
            Target::Obstacle(o) => {
                points.for_each(|x| keep(self.obstacles[o].gap(&x, position).0, x));
            }
            Target::Surface(t) => {
                let target = &self.surfaces[t];
                let boxes = || (0..target.facets.len() as u32).map(|f| target.bounds(f, position));
                let whole = boxes().fold(Aabb::of([]), |all, b| all.union(&b));
                // The nearest to the target's box first, so that most points need no closer look.
                let mut points: Vec<(f64, Vector<D>)> = points.map(|x| (whole.distance(&x), x)).collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                let tree = Bvh::new(boxes());
                let mut smallest = f64::INFINITY;
                for (distance, x) in points {
                    if distance > smallest.max(0.0) {
                        break;
                    }
                    // Outside of the box of the target nothing is behind a facet: what is farther than the smallest so far has no say.
                    let reach = if distance > 0.0 { smallest } else { f64::INFINITY };
                    let gap = signed_distance_within(reach, &x, target, &tree, position);
                    smallest = smallest.min(gap);
                    keep(gap, x);
                }
            }
        }
        closest
    }

    /// Whether a candidate of the last [`ContactModel::detect`] that is behind its facet is outside of what it faces all the same, by more than
    /// `distance` [m]. It is then on the far side of a thin body. The nodes are at `position`, the start of that search, where the candidate
    /// is this `contact`.
    ///
    /// A node that is a little inside at the very edge of its target may be outside by round-off.
    #[must_use]
    pub fn is_beyond(
        &self,
        candidate: &Candidate,
        contact: &Contact<D>,
        distance: f64,
        position: &Positions<'_, D>,
        search: &Search<D>,
    ) -> bool {
        let pair = candidate.pair as usize;
        let Pair { source, target, .. } = self.pairs.get(pair);
        if self.is_mortar(pair) || self.is_self_contact(pair) || self.balls(&self.pairs.get(pair)).is_some() {
            return false;
        }
        let from = |x: &Vector<D>, solid: Solid, surface: &ContactSurface| {
            signed_distance(x, surface, &search.swept(solid).tree, position)
        };
        match (candidate.site, target) {
            (site, Target::Surface(t)) => {
                let x = contact.source_point(position);
                from(&x, Solid::Body(t), &self.surfaces[t]) > distance || {
                    // Of two edges neither is the source by right.
                    let y = contact.target_point(position);
                    matches!(site, Site::Crossing(..))
                        && self.is_two_sided(pair)
                        && from(&y, Solid::Body(source), &self.surfaces[source]) > distance
                }
            }
            (Site::Corner(corner), Target::Obstacle(o)) => {
                let x = self.obstacles[o].placed(position)(corner);
                from(&x, Solid::Body(source), &self.surfaces[source]) > distance
            }
            (_, Target::Obstacle(o)) => {
                self.obstacles[o].gap(&contact.source_point(position), position).0 > distance
            }
        }
    }
}

/// Distance of `x` to a closed surface, negative inside; the boxes of the `tree` hold its facets.
fn signed_distance<const D: usize>(
    x: &Vector<D>,
    surface: &ContactSurface,
    tree: &Bvh<D>,
    position: &Positions<'_, D>,
) -> f64 {
    signed_distance_within(f64::INFINITY, x, surface, tree, position)
}

/// The same where only distances up to `reach` [m] matter: a larger one may come out larger still, also infinite.
pub(crate) fn signed_distance_within<const D: usize>(
    reach: f64,
    x: &Vector<D>,
    surface: &ContactSurface,
    tree: &Bvh<D>,
    position: &Positions<'_, D>,
) -> f64 {
    let (mut distance, mut side) = (f64::INFINITY, 0.0);
    // Whatever is as near as a facet within reach, and may tell its side, is looked at.
    let looked_at = reach + 2.0 * MEASURE.same * tree.bounds().diameter();
    tree.nearest_within(looked_at, x, |f, facet_box| {
        let tie = MEASURE.same * facet_box.diameter();
        let p = surface.project(f, x, Reach::Facet, position);
        let d = (x - p.point).norm();
        let front = p.normal.dot(&(x - p.point));
        if d > reach + tie {
            // Its box is within reach and it is not, nor need what would tell its side be.
        } else if d < distance - tie {
            (distance, side) = (d, front);
        } else if d <= distance + tie {
            distance = distance.min(d);
            // At a shared corner the facet seen most squarely decides the side, of two the one that it is behind: whichever is met first.
            if front.abs() > side.abs() || front.abs() == side.abs() && front < side {
                side = front;
            }
        }
        looked_at.min(distance + tie)
    });
    distance.copysign(side)
}

#[cfg(test)]
mod tests {
    use carom_mesh::{CellKind, Surface, generate};

    use super::*;
    use crate::{Discretisation, Obstacle, Path, Search};

    fn two_discs(distance: f64) -> (ContactModel<2>, Vec<Vector<2>>) {
        let disc = |x: f64| {
            generate::Disc { centre: [x, 0.0], radius: 1.0, divisions: 8, rings: None }
                .quadrilaterals()
                .expect("valid")
        };
        let (a, b) = (disc(0.0), disc(distance));
        let x: Vec<Vector<2>> = a.nodes().iter().chain(b.nodes()).copied().collect();
        let at = |n: u32| x[n as usize];
        let model = ContactModel {
            surfaces: vec![
                ContactSurface::new(&Surface::of(&a), 0, &at),
                ContactSurface::new(&Surface::of(&b), a.nodes().len() as u32, &at),
            ],
            obstacles: vec![Obstacle::plane(Vector::<2>::new(0.0, -2.0), Vector::<2>::new(0.0, 1.0))],
            pairs: vec![
                Pair {
                    source: 0,
                    target: Target::Surface(1),
                    friction: 0.0,
                    discretisation: Discretisation::NodeToSegment,
                },
                Pair {
                    source: 0,
                    target: Target::Obstacle(0),
                    friction: 0.0,
                    discretisation: Discretisation::NodeToSegment,
                },
            ]
            .into(),
        };
        (model, a.nodes().iter().chain(b.nodes()).copied().chain([Vector::zeros()]).collect())
    }

    #[test]
    fn discs_are_as_far_apart_as_drawn() {
        let (model, x) = two_discs(2.5);
        let at = |n: u32| x[n as usize];
        let between = model.proximity(&model.pairs.get(0), &at).expect("nodes");
        // The node on the axis faces the vertex on the axis of the other disc.
        assert!((between.gap - 0.5).abs() < 1e-12);
        assert!((model.proximity(&model.pairs.get(1), &at).expect("nodes").gap - 1.0).abs() < 1e-12);
        let mut candidates = Vec::new();
        model.detect(&Path::resting(&at, 0.1), &mut Search::default(), &mut candidates);
        assert!(candidates.is_empty());
    }

    #[test]
    fn overlap_is_measured_however_deep() {
        let (model, x) = two_discs(1.5);
        let deepest = model.proximity(&model.pairs.get(0), &|n| x[n as usize]).expect("nodes");
        assert!((deepest.gap + 0.5).abs() < 0.01, "{}", deepest.gap);
        assert!((deepest.at - Vector::<2>::new(1.0, 0.0)).norm() < 1e-12);
    }

    #[test]
    fn touching_nodes_face_the_right_facet_and_rigid_motion_leaves_the_gap() {
        let (model, x) = two_discs(2.01);
        let at = |n: u32| x[n as usize];
        let mut candidates = Vec::new();
        model.detect(&Path::resting(&at, 0.02), &mut Search::default(), &mut candidates);
        assert!(!candidates.is_empty());
        for candidate in &candidates {
            let contact = model.evaluate(candidate, &at);
            assert!(contact.frame[(0, 0)] < -0.9, "the normal points from the right disc to the left one");
            assert!(contact.gap > 0.0 && contact.gap < 0.06);
            let rigid = contact.relative(|_| Vector::<2>::new(0.3, -0.7));
            assert!(rigid.norm() < 1e-15, "a translation of both bodies is no relative motion");
            // Action = reaction, and equal moments as the force acts along the line between the two points.
            let mut f = vec![Vector::zeros(); x.len()];
            contact.add_force(&Vector::<2>::new(2.0, 0.0), &mut f);
            assert!(f.iter().sum::<Vector<2>>().norm() < 1e-14);
        }
    }

    /// Symptom guarded against: a corner node of a bar chose the side of the other bar, whose gap was 0, and fell through.
    #[test]
    fn corner_nodes_of_equal_bars_face_the_end_and_not_the_side() {
        let left = generate::grid([-1.0, 0.0], [1.0, 1.0], [4, 4]).expect("valid");
        let right = generate::grid([1e-9, 0.0], [1.0, 1.0], [4, 4]).expect("valid");
        let count = left.nodes().len() as u32;
        let x: Vec<Vector<2>> = left.nodes().iter().chain(right.nodes()).copied().collect();
        let at = |n: u32| x[n as usize];
        let faceted = ContactSurface::new(&Surface::of(&right), count, &at);
        let smooth = faceted.clone().smoothed(&at);
        for target in [faceted, smooth] {
            let model = ContactModel::<2> {
                surfaces: vec![ContactSurface::new(&Surface::of(&left), 0, &at), target],
                obstacles: vec![],
                pairs: vec![Pair {
                    source: 0,
                    target: Target::Surface(1),
                    friction: 0.0,
                    discretisation: Discretisation::NodeToSegment,
                }]
                .into(),
            };
            for shift in [-1e-3, 0.0, 1e-9, 1e-3] {
                let at = |n: u32| x[n as usize] + Vector::<2>::new(if n < count { shift } else { 0.0 }, 0.0);
                let mut candidates = Vec::new();
                model.detect(&Path::resting(&at, 0.01), &mut Search::default(), &mut candidates);
                assert_eq!(candidates.len(), 5);
                for candidate in &candidates {
                    let contact = model.evaluate(candidate, &at);
                    assert!((contact.frame[(0, 0)] + 1.0).abs() < 1e-12);
                    assert!((contact.gap - (1e-9 - shift)).abs() < 1e-12);
                }
            }
        }
    }

    /// Symptom guarded against: boxes of second-order cells, one above the other, were told that they overlap.
    #[test]
    fn boxes_are_as_far_apart_as_drawn_whatever_their_cells() {
        for kind in [
            CellKind::Tet4,
            CellKind::Hex8,
            CellKind::Tet10,
            CellKind::Hex20,
            CellKind::Hex27,
            CellKind::Wedge15,
        ] {
            for (divisions, distance) in [(1, 0.01), (1, 1.0), (2, 0.3), (2, 1.0), (3, 0.01), (3, 0.3)] {
                let boxed = |z: f64| {
                    let grid =
                        generate::Grid { corner: [0.0, 0.0, z], size: [1.0; 3], divisions: [divisions; 3] };
                    grid.mesh(kind).expect("valid")
                };
                let (below, above) = (boxed(0.0), boxed(1.0 + distance));
                let at = |n: u32| above.nodes()[n as usize];
                let model = ContactModel::<3> {
                    surfaces: vec![ContactSurface::new(&Surface::of(&above), 0, &at)],
                    obstacles: vec![],
                    pairs: vec![].into(),
                };
                let centres = below.blocks().iter().flat_map(|block| block.cells()).map(|cell| {
                    cell.iter().map(|&n| below.nodes()[n as usize]).sum::<Vector<3>>() / cell.len() as f64
                });
                let points = below.nodes().iter().copied().chain(centres);
                let closest = model.closest(points, Target::Surface(0), &at).expect("points");
                assert!(
                    (closest.gap - distance).abs() < 1e-12,
                    "{kind:?} {divisions}: {} for {distance}",
                    closest.gap
                );
            }
        }
    }
}
