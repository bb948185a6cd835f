use carom_mesh::cell::MAX_FACET_NODES;
use carom_mesh::{CellKind, Facet, Vector};

use crate::closest::{Local, Parametric};
use crate::domain::Domain;
use crate::path::Positions;
use crate::tolerances::SEARCH;

/// Intervals of the grid of starting points.
const GRID: u32 = 6;

/// A facet with the positions of its nodes: a piece of line or surface s(ξ) over a segment, triangle or square.
pub struct Patch<const D: usize> {
    kind: CellKind,
    count: usize,
    nodes: [Vector<D>; MAX_FACET_NODES],
}

/// A patch at one point.
pub struct Point<const D: usize> {
    /// Shape functions N_a.
    pub weights: [f64; MAX_FACET_NODES],
    /// ∂N_a/∂ξ.
    gradients: [[f64; 3]; MAX_FACET_NODES],
    /// The point [m].
    pub point: Vector<D>,
    /// ∂s/∂ξ [m]; the second is zero for a line.
    pub tangents: [Vector<D>; 2],
}

impl<const D: usize> Patch<D> {
    /// A facet whose nodes are at `position`.
    pub fn new(facet: &Facet, position: &Positions<'_, D>) -> Self {
        let mut nodes = [Vector::zeros(); MAX_FACET_NODES];
        for (node, &a) in nodes.iter_mut().zip(&facet.nodes) {
            *node = position(a);
        }
        Self { kind: facet.kind, count: facet.nodes.len(), nodes }
    }

    /// What is at ξ.
    pub fn at(&self, xi: &[f64; 2]) -> Point<D> {
        let reference = self.kind.reference();
        let xi = [xi[0], xi[1], 0.0];
        let mut p = Point {
            weights: [0.0; MAX_FACET_NODES],
            gradients: [[0.0; 3]; MAX_FACET_NODES],
            point: Vector::zeros(),
            tangents: [Vector::zeros(); 2],
        };
        (reference.shape)(&xi, &mut p.weights[..self.count]);
        (reference.gradient)(&xi, &mut p.gradients[..self.count]);
        for ((x, weight), gradient) in self.nodes[..self.count].iter().zip(&p.weights).zip(&p.gradients) {
            p.point += x * *weight;
            for (t, g) in p.tangents.iter_mut().zip(gradient).take(D - 1) {
                *t += x * *g;
            }
        }
        p
    }

    /// What is in the middle.
    pub fn middle(&self) -> Point<D> {
        self.at(&self.domain().middle())
    }

    /// ξ of the point closest to `x`: from the best of a few points.
    pub fn closest(&self, x: &Vector<D>) -> [f64; 2] {
        self.closest_from(x, self.start(x)).0
    }

    /// Where to start from: the middle or, on a facet that is clearly curved, the closest point of a grid. Such a facet may have
    /// several points where the distance is least.
    fn start(&self, x: &Vector<D>) -> [f64; 2] {
        let middle = self.domain().middle();
        if self.is_straight() || !self.is_clearly_curved(&middle) {
            return middle;
        }
        let mut best = (f64::INFINITY, middle);
        // A line has one row; a triangle the half of a square.
        for (j, i) in (0..if D == 2 { 1 } else { GRID + 1 }).flat_map(|j| (0..=GRID).map(move |i| (j, i))) {
            let [s, t] = [i, j].map(|k| f64::from(k) / f64::from(GRID));
            let xi = match self.domain() {
                Domain::Segment => [2.0 * s - 1.0, 0.0],
                Domain::Triangle => [s * (1.0 - t), t],
                Domain::Square => [2.0 * s - 1.0, 2.0 * t - 1.0],
            };
            let distance = (x - self.at(&xi).point).norm_squared();
            if distance < best.0 {
                best = (distance, xi);
            }
        }
        best.1
    }

    /// Whether a node is off the plane, or line, through the middle by a good part of the size.
    fn is_clearly_curved(&self, middle: &[f64; 2]) -> bool {
        let m = self.at(middle);
        let size = m.tangents[0].norm_squared() + m.tangents[1].norm_squared();
        self.nodes[..self.count].iter().zip(self.kind.reference().nodes).any(|(x, xi)| {
            let flat = m.point + m.tangents[0] * (xi[0] - middle[0]) + m.tangents[1] * (xi[1] - middle[1]);
            (x - flat).norm_squared() > SEARCH.curved * SEARCH.curved * size
        })
    }

    /// ∂²s/∂ξ², ∂²s/∂ξ∂η and ∂²s/∂η² [m], but on a quad4 by central differences. These are exact: no shape function of a facet is of
    /// higher than second degree in ξ or in η.
    fn bends(&self, xi: &[f64; 2]) -> [Vector<D>; 3] {
        let mut bends = [Vector::zeros(); 3];
        if self.kind == CellKind::Quad4 {
            bends[1] = (self.nodes[0] - self.nodes[1] + self.nodes[2] - self.nodes[3]) * 0.25;
            return bends;
        }
        for i in 0..D - 1 {
            let [mut plus, mut minus] = [*xi; 2];
            plus[i] += 0.5;
            minus[i] -= 0.5;
            let (plus, minus) = (self.at(&plus), self.at(&minus));
            for j in i..D - 1 {
                bends[i + j] = plus.tangents[j] - minus.tangents[j];
            }
        }
        bends
    }
}

impl<const D: usize> Parametric<D> for Patch<D> {
    fn domain(&self) -> Domain {
        Domain::of(self.kind)
    }

    fn is_straight(&self) -> bool {
        matches!(self.kind, CellKind::Line2 | CellKind::Tri3)
    }

    fn local(&self, xi: &[f64; 2]) -> Local<D> {
        let Point { point, tangents, .. } = self.at(xi);
        let bends = if self.is_straight() { [Vector::zeros(); 3] } else { self.bends(xi) };
        Local { point, tangents, bends }
    }
}

impl<const D: usize> Point<D> {
    /// How far along the tangents the plane that they span is closest to `x`.
    pub fn foot(&self, x: &Vector<D>) -> [f64; 2] {
        foot(&(x - self.point), &self.tangents)
    }

    /// Goes straight on along the tangents.
    pub fn go_on(&mut self, by: [f64; 2]) {
        for (weight, gradient) in self.weights.iter_mut().zip(&self.gradients) {
            *weight += gradient[0] * by[0] + gradient[1] * by[1];
        }
        self.point += self.tangents[0] * by[0] + self.tangents[1] * by[1];
    }
}

/// How far along these `tangents` their combination is closest to an `offset`; in the plane there is one.
pub(crate) fn foot<const D: usize>(offset: &Vector<D>, tangents: &[Vector<D>; 2]) -> [f64; 2] {
    let (d, t) = (offset, tangents);
    let (a, b, c) = (t[0].norm_squared(), t[0].dot(&t[1]), t[1].norm_squared());
    let (p, q) = (d.dot(&t[0]), d.dot(&t[1]));
    if D == 2 {
        return [p / a, 0.0];
    }
    let det = a * c - b * b;
    [(c * p - b * q) / det, (a * q - b * p) / det]
}

/// The straight lines around a facet from node to node, of a quadratic one two on each side; of a line itself, from end to end.
pub(crate) fn rim(kind: CellKind) -> impl Iterator<Item = [usize; 2]> {
    let reference = kind.reference();
    let around = reference.facets.iter().filter(move |_| kind.dimension() == 2).flat_map(|(side, nodes)| {
        let middle = side.is_quadratic().then(|| nodes[2]);
        std::iter::once([nodes[0], middle.unwrap_or(nodes[1])]).chain(middle.map(|m| [m, nodes[1]]))
    });
    let line: &[[usize; 2]] = match (kind.dimension(), kind.is_quadratic()) {
        (1, false) => &[[0, 1]],
        (1, true) => &[[0, 2], [2, 1]],
        _ => &[],
    };
    line.iter().copied().chain(around)
}

/// The curved lines around a quadratic facet, each by its ends and the node between; of a line itself.
pub(crate) fn bows(kind: CellKind) -> impl Iterator<Item = [usize; 3]> {
    let is_curved = kind.is_quadratic();
    let sides = kind.reference().facets.iter().filter(move |_| is_curved && kind.dimension() == 2);
    let line = (is_curved && kind.dimension() == 1).then_some([0, 1, 2]);
    sides.map(|(_, nodes)| [nodes[0], nodes[1], nodes[2]]).chain(line)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A facet over the reference nodes of its kind, bent out of its plane by up to `bend` and made skew.
    fn bent(kind: CellKind, bend: f64) -> (Facet, Vec<Vector<3>>) {
        let nodes = kind.reference().nodes.iter().enumerate().map(|(k, xi)| {
            let height = bend * (1.0 + 7.3 * k as f64).sin();
            Vector::<3>::new(xi[0] + 0.6 * xi[1], 0.8 * xi[1], height)
        });
        (Facet { kind, nodes: (0..kind.node_count() as u32).collect() }, nodes.collect())
    }

    /// The smallest distance to a dense grid of points of the facet.
    fn scanned(patch: &Patch<3>, x: &Vector<3>) -> f64 {
        const N: i32 = 60;
        let grid = (0..=N).flat_map(|i| (0..=N).map(move |j| [i, j].map(|k| f64::from(k) / f64::from(N))));
        grid.map(|[a, b]| {
            if patch.kind.corner_count() == 3 { [a, b * (1.0 - a)] } else { [2.0 * a - 1.0, 2.0 * b - 1.0] }
        })
        .map(|xi| (x - patch.at(&xi).point).norm())
        .fold(f64::INFINITY, f64::min)
    }

    /// All kinds of facets of bodies in space.
    fn kinds() -> impl Iterator<Item = CellKind> {
        CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
    }

    #[test]
    fn no_point_of_a_bent_facet_is_closer_than_the_closest() {
        for (kind, bend) in kinds().flat_map(|k| [(k, 0.0), (k, 0.1), (k, 0.4)]) {
            let (facet, nodes) = bent(kind, bend);
            let patch = Patch::new(&facet, &|n| nodes[n as usize]);
            let at = [-1.9, -0.7, 0.2, 1.1, 2.0];
            for (x, y) in at.iter().flat_map(|&x| at.iter().map(move |&y| (x, y))) {
                for z in [-0.5, 0.03, 0.6] {
                    let x = Vector::<3>::new(x, y, z);
                    let xi = patch.closest(&x);
                    assert!(patch.domain().holds(xi.map(|x| x * (1.0 - 1e-14))), "{kind:?} {xi:?}");
                    let point = patch.at(&xi);
                    let distance = (x - point.point).norm();
                    assert!(
                        distance <= scanned(&patch, &x) + 1e-12,
                        "{kind:?} {bend} {x}: {xi:?} {distance}"
                    );
                }
            }
        }
    }

    #[test]
    fn inside_a_facet_the_distance_is_at_right_angles() {
        for kind in kinds() {
            let (facet, nodes) = bent(kind, 0.1);
            let patch = Patch::new(&facet, &|n| nodes[n as usize]);
            let mut inside = 0;
            for (x, y, z) in [(0.3, 0.2, 0.4), (0.4, 0.25, -0.2), (0.5, 0.2, 0.05), (0.4, 0.3, 0.01)] {
                let x = Vector::<3>::new(x, y, z);
                let xi = patch.closest(&x);
                let [from_middle, middle] = [1.01, 1.0 / 3.0];
                if !patch.domain().holds(xi.map(|x| {
                    if patch.kind.corner_count() == 3 {
                        middle + (x - middle) * from_middle
                    } else {
                        x * from_middle
                    }
                })) {
                    continue;
                }
                inside += 1;
                let point = patch.at(&xi);
                for t in &point.tangents {
                    let cosine = (x - point.point).dot(t) / t.norm();
                    assert!(cosine.abs() < 1e-13, "{kind:?}: {cosine:e}");
                }
            }
            assert!(inside >= 2, "{kind:?}");
        }
    }
}
