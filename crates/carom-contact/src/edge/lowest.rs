//! Edges between their nodes: those of second order, and any over a facet of second order, touch there.

use carom_mesh::Vector;

use super::SurfaceEdge;
use crate::path::Positions;
use crate::project::Reach;
use crate::surface::diameter;
use crate::tolerances::{EDGES, MEASURE, SEARCH};
use crate::{ContactSurface, Path};

/// Into how many parts an edge is cut by the points of it that may touch.
///
/// They stay where they are on the edge for a step. Where it is lowest over a facet moves far along it with the least turn, the flatter
/// both are, and with it Newton's iterations did not end.
const PARTS: f64 = 16.0;

/// Where along an edge its point with a number is, from 0 at the first node to 1.
pub(crate) fn along(number: u32) -> f64 {
    f64::from(number) / PARTS
}

/// A point of an edge that has come behind a facet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Dip {
    /// How deep it is [m].
    pub depth: f64,
    /// The facet.
    pub facet: u32,
    /// The number of the point.
    pub point: u32,
}

impl Dip {
    /// The one of the two that is less deep; of equal ones that of the lower facet.
    pub fn shallower(self, other: Self) -> Self {
        let is_other = self.depth.total_cmp(&other.depth).then(self.facet.cmp(&other.facet)).is_gt();
        if is_other { other } else { self }
    }
}

impl ContactSurface {
    /// Where an edge of another surface comes behind the facet `f` between its nodes by the end of its path, if it goes in there.
    pub(crate) fn dip_of<const D: usize>(
        &self,
        f: u32,
        of_another: SurfaceEdge<'_>,
        path: &Path<'_, D>,
    ) -> Option<Dip> {
        let edge = of_another.edge;
        if edge.bow.is_none() && !self.facets[f as usize].kind.is_quadratic() {
            return None;
        }
        let [start, end] = [path.start, path.end].map(|position| edge.line(position));
        let below = |s: f64| self.project(f, &end.at(s), Reach::Beyond, path.end);
        let lowest = lowest(&|s: f64| {
            let p = below(s);
            (p.normal.dot(&(end.at(s) - p.point)), p.normal.dot(&end.slope(s)))
        });
        let point = (lowest * PARTS).round().clamp(1.0, PARTS - 1.0);
        let s = point / PARTS;
        let (there, x) = (below(s), end.at(s));
        let gap = there.normal.dot(&(x - there.point));
        let before = self.gap_at(f, &start.at(s), path.start);
        let deepest = -SEARCH.depth * diameter(&self.facets[f as usize], path.end);
        let [a, b] = of_another.normals(s, path.end);
        let is_beside = self.is_over(f, &x, path.end) && there.normal.dot(&(a + b)) < 0.0;
        let goes_in = is_beside && gap < before.min(0.0) && gap > deepest;
        goes_in.then_some(Dip { depth: -gap, facet: f, point: point as u32 })
    }

    /// Whether what is below `x` is on the facet `f`, not beyond an edge of it.
    pub(crate) fn is_over<const D: usize>(&self, f: u32, x: &Vector<D>, position: &Positions<'_, D>) -> bool {
        let [on, beyond] =
            [Reach::Facet, Reach::Beyond].map(|reach| self.project(f, x, reach, position).point);
        (on - beyond).norm() <= SEARCH.aligned * diameter(&self.facets[f as usize], position)
    }
}

/// Where between 0 and 1 a function is lowest that tells its value and its derivative: from the lowest of a few places downwards.
fn lowest(height: &impl Fn(f64) -> (f64, f64)) -> f64 {
    let place = |k: usize| k as f64 / MEASURE.places as f64;
    let at = |s: f64| (s, height(s));
    let lower = |p: (f64, (f64, f64)), q: (f64, (f64, f64))| if q.1.0 < p.1.0 { q } else { p };
    let start = (1..=MEASURE.places).map(|k| at(place(k))).fold(at(0.0), lower);
    let (mut near, (mut low, mut slope)) = start;
    let way = if slope > 0.0 { -place(1) } else { place(1) };
    let mut far = near + way;
    if slope == 0.0 || !(0.0..=1.0).contains(&far) {
        return near;
    }
    let mut far_slope = height(far).1;
    // The lowest place is where the derivative is zero: by false positions, halves of the interval where these do not lead on.
    for k in 0..EDGES.narrowings {
        let share = slope / (slope - far_slope);
        let share = if k % 3 < 2 && share > 0.0 && share < 1.0 { share } else { 0.5 };
        let s = near + (far - near) * share;
        let (value, derivative) = height(s);
        if derivative == 0.0 || (s - near).abs().min((far - s).abs()) <= EDGES.close {
            return s;
        }
        if derivative * way < 0.0 && value <= low {
            (near, low, slope) = (s, value, derivative);
        } else {
            (far, far_slope) = (s, derivative);
        }
    }
    near
}
