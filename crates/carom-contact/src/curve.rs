use carom_mesh::{Facet, Vector};

use crate::parts::parts;
use crate::path::Positions;
use crate::project::{Projection, Reach, Weights, normal};
use crate::tolerances::{EDGES, SEARCH};

/// A curve through the nodes of a boundary line with a continuous tangent, except at corners and on sides that are straight in the
/// reference configuration: those are where their cells say, and turn where these do.
///
/// Each segment is a cubic in ξ from 0 to 1. Its tangents at the ends are those of the parabola through the node and its two
/// neighbours, with the distances of the reference configuration as parameter (Catmull–Rom). A point of given ξ is so a fixed
/// combination of four nodes, and its weights sum to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    segments: Vec<Segment>,
}

/// The curve over one facet.
#[derive(Debug, Clone, PartialEq)]
struct Segment {
    /// The nodes of the facet, then the neighbours on the curve, as far as there are any.
    nodes: [u32; 4],
    len: usize,
    /// Weights of the nodes as coefficients of 1, ξ, ξ², ξ³.
    weights: [[f64; 4]; 4],
    /// The segments before and behind; none at a corner and at the end of an open line.
    neighbours: [Option<u32>; 2],
    /// Where nothing is smoothed, because the line is straight in the reference configuration.
    is_flat: [bool; 2],
}

/// Newton or bisection steps; Newton alone needs about four.
const MAX_STEPS: usize = 100;

/// The ends of a segment in ξ.
const ENDS: [f64; 2] = [0.0, 1.0];

/// The facet of a boundary line that goes on behind an end of facet `f`, 0 or 1, without a corner in the `reference` configuration; `around` are
/// the facets around a node.
///
/// Quadratic facets have the directions of their halves.
pub(crate) fn smooth_neighbour<'a, const D: usize>(
    facets: &[Facet],
    f: u32,
    end: usize,
    around: &impl Fn(u32) -> &'a [u32],
    reference: &Positions<'_, D>,
) -> Option<u32> {
    let direction = |f: u32, end: usize| {
        let facet = &facets[f as usize];
        let parts = parts(facet.kind);
        let (_, ends) = parts[if end == 0 { 0 } else { parts.len() - 1 }];
        reference(facet.nodes[ends[1]]) - reference(facet.nodes[ends[0]])
    };
    let node = |f: u32, end: usize| facets[f as usize].nodes[end];
    // More than two facets at a node: two parts of the boundary touch there, which is a corner.
    let &[g, h] = around(node(f, end)) else { return None };
    let (next, own) = (if g == f { h } else { g }, direction(f, end));
    let there = direction(next, 1 - end);
    let goes_on = there.dot(&own) >= SEARCH.corner * there.norm() * own.norm();
    (node(next, 1 - end) == node(f, end) && goes_on).then_some(next)
}

impl Curve {
    /// The curve through the nodes of `facets`, which are lines, one segment per facet; `around` are the facets around a node.
    pub fn through<'a, const D: usize>(
        facets: &[Facet],
        around: &impl Fn(u32) -> &'a [u32],
        reference: &Positions<'_, D>,
    ) -> Self {
        let segment = |f: u32| Segment::new(facets, f, around, reference);
        Self { segments: (0..facets.len() as u32).map(segment).collect() }
    }

    /// The point closest to `x`: of one segment or, if it may reach beyond, of the part of the curve between corners. Beyond a corner
    /// the curve goes on straight for half a facet.
    ///
    /// The search starts on the segment `start` and walks on while the distance falls beyond an end. As the tangent is continuous,
    /// so is the sign of that slope from one segment to the next, and the walk does not turn back.
    pub fn project<const D: usize>(
        &self,
        start: u32,
        x: &Vector<D>,
        reach: Reach,
        position: &Positions<'_, D>,
    ) -> Projection<'_, D> {
        let mut segment = &self.segments[start as usize];
        let mut offset = Cubic::new(segment, x, position);
        let mut from = None;
        // A walk visits no segment twice.
        for _ in 0..self.segments.len() {
            let Some(end) = offset.falls_beyond(from) else {
                return segment.foot(&offset, x, offset.closest(), 0.0);
            };
            if reach == Reach::Facet {
                return segment.foot(&offset, x, ENDS[end], 0.0);
            }
            let next = segment.neighbours[end].map(|next| &self.segments[next as usize]);
            let next = next.map(|next| (next, Cubic::new(next, x, position)));
            let beyond = offset.beyond(ENDS[end]);
            // Before a kink a point is beside both segments: it stays with the one it came to first.
            let stays = |there: &Cubic<D>| {
                let is_its_own = || match reach {
                    Reach::Own(kinks) => from.is_none() && kinks[end] && beyond.abs() < SEARCH.beyond,
                    _ => false,
                };
                segment.is_flat[end] && (there.falls(1 - end) || is_its_own())
            };
            match next {
                Some((next, there)) if !stays(&there) => {
                    (segment, offset, from) = (next, there, Some(1 - end));
                }
                _ => {
                    let beyond = beyond.clamp(-SEARCH.beyond, SEARCH.beyond);
                    return segment.foot(&offset, x, ENDS[end], beyond);
                }
            }
        }
        segment.foot(&offset, x, ENDS[from.unwrap_or(0)], 0.0)
    }

    /// Whether a segment is more than the straight line between its ends.
    pub fn is_curved(&self, segment: u32) -> bool {
        self.segments[segment as usize].len > 2
    }

    /// At which ends of a segment, the first and the last, the line has a concave kink.
    pub fn concave_kinks<const D: usize>(&self, segment: u32, position: &Positions<'_, D>) -> [bool; 2] {
        let segment = &self.segments[segment as usize];
        let line = |segment| Cubic::new(segment, &Vector::zeros(), position);
        std::array::from_fn(|end| {
            let next = segment.neighbours[end].filter(|_| segment.is_flat[end]);
            next.is_some_and(|next| line(segment).is_concave(end, &line(&self.segments[next as usize])))
        })
    }

    /// The nodes that a segment is a combination of.
    pub fn nodes(&self, segment: u32) -> &[u32] {
        let segment = &self.segments[segment as usize];
        &segment.nodes[..segment.len]
    }

    /// Their weights at a point of the segment.
    pub fn weights(&self, segment: u32, xi: f64) -> Weights {
        self.segments[segment as usize].at(&powers(xi))
    }

    /// Points [m] whose convex hull holds a segment.
    pub fn control_points<const D: usize>(
        &self,
        segment: u32,
        position: &Positions<'_, D>,
    ) -> [Vector<D>; 4] {
        let Cubic(c) = Cubic::new(&self.segments[segment as usize], &Vector::zeros(), position);
        [c[0], c[0] + c[1] / 3.0, c[0] + (c[1] * 2.0 + c[2]) / 3.0, c[0] + c[1] + c[2] + c[3]]
    }
}

impl Segment {
    fn new<'a, const D: usize>(
        facets: &[Facet],
        f: u32,
        around: &impl Fn(u32) -> &'a [u32],
        reference: &Positions<'_, D>,
    ) -> Self {
        let ends = |f: u32| {
            let nodes = &facets[f as usize].nodes;
            [nodes[0], nodes[1]]
        };
        let chord = |f: u32| {
            let [a, b] = ends(f);
            reference(b) - reference(a)
        };
        let length = chord(f).norm();
        let neighbours = [0, 1].map(|end| smooth_neighbour(facets, f, end, around, reference));
        let [a, b] = ends(f);
        let (mut nodes, mut len) = ([a, b, b, b], 2);
        // The tangents as weights of the nodes: the chord, and where there is a neighbour, a share of its slope.
        let mut tangents = [[-1.0, 1.0, 0.0, 0.0]; 2];
        let mut is_flat = [false; 2];
        for (end, g) in neighbours.iter().enumerate().filter_map(|(end, g)| g.map(|g| (end, g))) {
            let other = chord(g).norm();
            is_flat[end] = chord(g).dot(&chord(f)) > EDGES.flat * other * length;
            if is_flat[end] {
                continue;
            }
            let own_share = other / (length + other);
            let slope = (1.0 - own_share) * length / other;
            let sign = if end == 0 { 1.0 } else { -1.0 };
            tangents[end][0] = -own_share;
            tangents[end][1] = own_share;
            tangents[end][end] += sign * slope;
            tangents[end][len] = -sign * slope;
            nodes[len] = ends(g)[end];
            len += 1;
        }
        let values = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]];
        let mut weights = [[0.0; 4]; 4];
        for (k, weight) in weights.iter_mut().enumerate() {
            let (rise, t) = (values[1][k] - values[0][k], tangents.map(|t| t[k]));
            *weight = [values[0][k], t[0], 3.0 * rise - 2.0 * t[0] - t[1], t[0] + t[1] - 2.0 * rise];
        }
        Self { nodes, len, weights, neighbours, is_flat }
    }

    /// The weights of the nodes for a combination of 1, ξ, ξ², ξ³.
    fn at(&self, basis: &[f64; 4]) -> Weights {
        let weight = |own: &[f64; 4]| own.iter().zip(basis).map(|(c, b)| c * b).sum();
        self.weights[..self.len].iter().map(weight).collect()
    }

    /// What belongs to the point at `xi`, or straight on from there by `beyond`.
    fn foot<const D: usize>(
        &self,
        offset: &Cubic<D>,
        x: &Vector<D>,
        xi: f64,
        beyond: f64,
    ) -> Projection<'_, D> {
        let (value, slope) = (powers(xi), slopes(xi));
        let basis: [f64; 4] = std::array::from_fn(|j| value[j] + beyond * slope[j]);
        let weights = self.at(&basis);
        let normal = normal(&[offset.combine(&slope), Vector::zeros()]);
        Projection { nodes: &self.nodes[..self.len], weights, point: x + offset.combine(&basis), normal }
    }
}

/// The offset of a segment from a point, as coefficients of 1, ξ, ξ², ξ³. Offsets have less round-off than positions.
struct Cubic<const D: usize>([Vector<D>; 4]);

impl<const D: usize> Cubic<D> {
    fn new(segment: &Segment, x: &Vector<D>, position: &Positions<'_, D>) -> Self {
        let mut c = [Vector::zeros(); 4];
        for (&node, weights) in segment.nodes.iter().zip(&segment.weights).take(segment.len) {
            let offset = position(node) - x;
            for (c, &weight) in c.iter_mut().zip(weights) {
                *c += offset * weight;
            }
        }
        Self(c)
    }

    fn combine(&self, basis: &[f64; 4]) -> Vector<D> {
        self.0.iter().zip(basis).fold(Vector::zeros(), |sum, (c, &b)| sum + c * b)
    }

    /// Half the slope of the squared distance, and its own slope.
    fn slope(&self, xi: f64) -> (f64, f64) {
        let [d, t, k] = [powers(xi), slopes(xi), bends(xi)].map(|basis| self.combine(&basis));
        (d.dot(&t), t.norm_squared() + d.dot(&k))
    }

    /// The end beyond which the distance falls, if there is one other than that which the walk came `from`. If it falls
    /// beyond both, the point is farther away than the centre of curvature: the closer one.
    fn falls_beyond(&self, from: Option<usize>) -> Option<usize> {
        let falls = |end: usize| from != Some(end) && self.falls(end);
        match [falls(0), falls(1)] {
            [false, false] => None,
            [true, false] => Some(0),
            [false, true] => Some(1),
            [true, true] => {
                let distance = |end: usize| self.combine(&powers(ENDS[end])).norm_squared();
                Some(usize::from(distance(1) < distance(0)))
            }
        }
    }

    /// Whether the distance falls beyond an end.
    fn falls(&self, end: usize) -> bool {
        let (slope, _) = self.slope(ENDS[end]);
        if end == 0 { slope > 0.0 } else { slope < 0.0 }
    }

    /// How far from an end the straight line along its tangent is closest, in tangents.
    fn beyond(&self, end: f64) -> f64 {
        let t = self.combine(&slopes(end));
        -self.slope(end).0 / t.norm_squared()
    }

    /// Whether the line turns to its outer side from an end on to the segment `there`.
    fn is_concave(&self, end: usize, there: &Self) -> bool {
        let [own, next] = [self.combine(&slopes(ENDS[end])), there.combine(&slopes(ENDS[1 - end]))];
        let left = own[0] * next[1] - own[1] * next[0];
        if end == 1 { left < 0.0 } else { left > 0.0 }
    }

    /// ξ of the closest point between ends beyond which the distance does not fall: Newton, with bisection where it leaves the
    /// interval in which the slope changes its sign.
    fn closest(&self) -> f64 {
        let (mut low, mut high) = (0.0, 1.0);
        // On a straight segment the slope is linear, and this is the root.
        let [at_start, at_end] = ENDS.map(|end| self.slope(end).0);
        let mut xi = if at_end > at_start { (at_start / (at_start - at_end)).clamp(low, high) } else { 0.5 };
        for _ in 0..MAX_STEPS {
            let (slope, own_slope) = self.slope(xi);
            if slope < 0.0 {
                low = xi;
            } else {
                high = xi;
            }
            let newton = xi - slope / own_slope;
            let next = if low <= newton && newton <= high { newton } else { 0.5 * (low + high) };
            let change = (next - xi).abs();
            xi = next;
            if change < 1e-15 {
                break;
            }
        }
        xi
    }
}

fn powers(xi: f64) -> [f64; 4] {
    [1.0, xi, xi * xi, xi * xi * xi]
}

fn slopes(xi: f64) -> [f64; 4] {
    [0.0, 1.0, 2.0 * xi, 3.0 * xi * xi]
}

fn bends(xi: f64) -> [f64; 4] {
    [0.0, 0.0, 2.0, 6.0 * xi]
}
