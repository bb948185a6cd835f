//! Facets as they appear in a plane: where two of them are compared.

use carom_mesh::{CellKind, Matrix, Vector};

use super::clip::{Point, Polygon, orient};
use crate::frame::frame;
use crate::parts::{self, MAX_FACET_NODES};
use crate::project;

/// A plane in space, or a line in the plane, with coordinates of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plane<const D: usize> {
    origin: Vector<D>,
    /// Rows n, t₁, t₂.
    frame: Matrix<D>,
}

impl<const D: usize> Plane<D> {
    /// The plane that fits these corners of a facet, with its outward normal; none if they are on a line.
    pub fn through(corners: &[Vector<D>]) -> Option<Self> {
        let last = corners.len() - 1;
        // Right-handed: a side of a segment, the diagonals of a quadrilateral, two sides of a triangle.
        let tangents = if D == 2 {
            [corners[1] - corners[0]; 2]
        } else {
            [corners[2] - corners[0], corners[last] - corners[1]]
        };
        let normal = project::normal(&tangents);
        let origin = corners.iter().sum::<Vector<D>>() / corners.len() as f64;
        normal.iter().all(|x| x.is_finite()).then(|| Self { origin, frame: frame(&normal) })
    }

    /// Outward unit normal of the facet.
    pub fn normal(&self) -> Vector<D> {
        self.frame.row(0).transpose()
    }

    /// Where a point [m] is in the plane, seen along the normal.
    pub fn coordinates(&self, x: &Vector<D>) -> Point {
        let offset = self.frame * (x - self.origin);
        std::array::from_fn(|k| if k + 1 < D { offset[k + 1] } else { 0.0 })
    }

    /// How high `other`, which is not at right angles to it, is above a point of the plane [m].
    pub fn height(&self, other: &Self, point: &Point) -> f64 {
        let across = |k: usize| self.frame.row(k + 1).transpose() * point[k];
        let x = (0..D - 1).fold(self.origin, |x, k| x + across(k));
        other.normal().dot(&(other.origin - x)) / other.normal().dot(&self.normal())
    }
}

/// A facet in a plane.
#[derive(Debug, Clone, Copy)]
pub(super) struct Image {
    kind: CellKind,
    nodes: [Point; MAX_FACET_NODES],
}

/// Newton steps on a facet with curved coordinates; straight ones need one.
const MAX_STEPS: usize = 20;

impl Image {
    /// The image of a facet of this kind, node by node.
    pub fn new(kind: CellKind, nodes: impl Iterator<Item = Point>) -> Self {
        let mut image = Self { kind, nodes: [[0.0; 2]; MAX_FACET_NODES] };
        image.nodes.iter_mut().zip(nodes).for_each(|(own, node)| *own = node);
        image
    }

    /// The polygon with these nodes as corners.
    pub fn polygon(&self, corners: &[usize]) -> Polygon {
        let mut polygon: Polygon = corners.iter().map(|&a| self.nodes[a]).collect();
        orient(self.kind.dimension(), &mut polygon);
        polygon
    }

    /// The shape functions of the facet at a point of the plane, also somewhat beyond its edges.
    pub fn shape_at(&self, point: &Point, shape: &mut [f64; MAX_FACET_NODES]) {
        let reference = self.kind.reference();
        let n = reference.nodes.len();
        let mut xi = if parts::is_triangle(self.kind) { [1.0 / 3.0; 3] } else { [0.0; 3] };
        let mut gradient = [[0.0; 3]; MAX_FACET_NODES];
        for _ in 0..MAX_STEPS {
            (reference.shape)(&xi, &mut shape[..n]);
            (reference.gradient)(&xi, &mut gradient[..n]);
            let mut rest = *point;
            let mut jacobian = [[0.0; 2]; 2];
            for (a, x) in self.nodes[..n].iter().enumerate() {
                for i in 0..2 {
                    rest[i] -= shape[a] * x[i];
                    (0..2).for_each(|j| jacobian[i][j] += x[i] * gradient[a][j]);
                }
            }
            let [[a, b], [c, d]] = jacobian;
            let step = if reference.dimension == 1 {
                [rest[0] / a, 0.0]
            } else {
                let det = a * d - b * c;
                [(d * rest[0] - b * rest[1]) / det, (a * rest[1] - c * rest[0]) / det]
            };
            (0..2).for_each(|i| xi[i] += step[i]);
            if step.iter().all(|s| s.abs() < 1e-13) {
                break;
            }
        }
        (reference.shape)(&xi, &mut shape[..n]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_has_the_outward_normal_of_its_facet() {
        let line = Plane::through(&[Vector::<2>::new(1.0, 2.0), Vector::<2>::new(3.0, 2.0)]).expect("a line");
        assert!((line.normal() - Vector::<2>::new(0.0, -1.0)).norm() < 1e-15);
        assert_eq!(line.coordinates(&Vector::<2>::new(2.5, 7.0)), [0.5, 0.0]);
        let corners =
            [[0.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 1.0]].map(Vector::<3>::from);
        for count in [3, 4] {
            let plane = Plane::through(&corners[..count]).expect("a plane");
            assert!((plane.normal() - Vector::<3>::new(0.0, 0.0, 1.0)).norm() < 1e-15);
        }
        assert!(Plane::through(&[corners[0]; 3]).is_none());
    }

    /// Σ N_a x_a = x at every point, for any kind and straight or skew facets.
    #[test]
    fn shape_functions_reproduce_the_point() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() < 3) {
            let reference = kind.reference();
            let skew = |xi: &[f64; 3]| {
                let lift = if reference.dimension == 1 { 0.0 } else { 1.0 };
                [
                    2.0 * xi[0] + 0.2 * xi[0] * xi[1] + 0.1,
                    lift * (1.5 * xi[1] - 0.3 * xi[0] + 0.1 * xi[0] * xi[1]),
                ]
            };
            let image = Image::new(kind, reference.nodes.iter().map(skew));
            let mut shape = [0.0; MAX_FACET_NODES];
            for xi in [[0.2, 0.3, 0.0], [0.0, 0.7, 0.0], [0.5, 0.5, 0.0]] {
                let point = skew(&xi);
                image.shape_at(&point, &mut shape);
                for i in 0..2 {
                    let sum: f64 = shape.iter().zip(&image.nodes).map(|(n, x)| n * x[i]).sum();
                    assert!((sum - point[i]).abs() < 1e-14, "{kind:?}");
                }
            }
        }
    }
}
