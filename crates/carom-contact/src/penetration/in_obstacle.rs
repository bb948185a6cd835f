//! Boundaries of bodies inside obstacles.

use carom_mesh::Vector;

use super::deep::Deep;
use super::shell::Shell;
use crate::RigidShape;
use crate::patch::Patch;
use crate::tolerances::MEASURE;

impl<const D: usize> Shell<D> {
    /// What of this boundary is deepest inside an obstacle that has moved by `shift` [m].
    pub fn inside_of_obstacle(&self, shape: &RigidShape<D>, shift: &Vector<D>) -> Deep<D> {
        let gap = |x: &Vector<D>| shape.gap(&(x - shift)).0;
        // The distance from an obstacle changes by no more than the way.
        if gap(&self.bounds().centre()) > self.bounds().reach() {
            return Deep::none();
        }
        let mut deepest = self.curves_behind(&gap);
        let mut look = |x: Vector<D>, f: u32| {
            let depth = -gap(&x);
            if depth > deepest.depth {
                deepest = Deep { depth, at: x, facet: Some(f), other: None };
            }
        };
        self.nodes.iter().for_each(|(node, around)| look(self.at(*node), around[0]));
        // Of a half space and of a cavity no point of a straight line is deeper than its ends.
        let bulges = match shape {
            RigidShape::Plane { .. } => false,
            RigidShape::Sphere { cavity, .. } | RigidShape::Cylinder { cavity, .. } => !cavity,
            RigidShape::Box { .. } | RigidShape::Surface(_) => true,
        };
        if !bulges {
            return deepest;
        }
        for (nodes, f) in self.straight() {
            let ends = nodes.map(|n| self.at(n));
            let length = (ends[1] - ends[0]).norm();
            if ends.iter().map(gap).sum::<f64>() < length {
                look(lowest(&ends, &gap), f);
            }
        }
        if D == 3 {
            for (f, facet) in (0..).zip(&self.facets) {
                let patch = Patch::new(facet, &|n| self.at(n));
                let middle = patch.middle().point;
                let x = match shape {
                    RigidShape::Sphere { centre, .. } => patch.at(&patch.closest(&(centre + shift))).point,
                    RigidShape::Cylinder { point, axis, .. } => {
                        self.pierced_by(f, &(point + shift), axis, &middle).unwrap_or(middle)
                    }
                    _ => middle,
                };
                look(x, f);
            }
        }
        deepest
    }

    /// Where a line through `point` along a unit vector goes through a facet that has this `middle`. Elsewhere the place of the facet that is
    /// nearest to the line is on one of its edges.
    fn pierced_by(
        &self,
        f: u32,
        point: &Vector<D>,
        along: &Vector<D>,
        middle: &Vector<D>,
    ) -> Option<Vector<D>> {
        let (foot, reach) = (along.dot(&(middle - point)), self.diameter(f));
        let ends = [foot - reach, foot + reach].map(|s| point + along * s);
        let mut place = None;
        self.crossings(f, &ends, &mut |t, _| place = Some(ends[0] + (ends[1] - ends[0]) * t));
        place
    }
}

/// Where on a segment a function that has one minimum is lowest.
fn lowest<const D: usize>(ends: &[Vector<D>; 2], value: &impl Fn(&Vector<D>) -> f64) -> Vector<D> {
    let at = |t: f64| ends[0] + (ends[1] - ends[0]) * t;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..MEASURE.thirds {
        let third = (high - low) / 3.0;
        if value(&at(low + third)) <= value(&at(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    at(0.5 * (low + high))
}
