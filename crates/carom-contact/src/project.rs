use carom_mesh::{Facet, Vector};
use smallvec::SmallVec;

use crate::domain::Domain;
use crate::patch::Patch;
use crate::path::Positions;

/// Weights of the nodes that a point follows; without an allocation for as many as there are around most facets.
pub type Weights = SmallVec<[f64; 32]>;

/// The point of a facet, or of the curve or smooth surface over it, closest to a given one.
#[derive(Debug, Clone, PartialEq)]
pub struct Projection<'a, const D: usize> {
    /// The nodes that the point follows.
    pub nodes: &'a [u32],
    /// Their weights.
    pub weights: Weights,
    /// The point [m].
    pub point: Vector<D>,
    /// Outward unit normal there.
    pub normal: Vector<D>,
}

/// Whether a facet reaches beyond its edges when a point is projected on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// Not at all: the closest point of the facet itself.
    Facet,
    /// On every side, by half its width, straight on along its tangents at the edge. So a node that slides past the edge of its facet
    /// within a step is still at right angles to the point it presses on. The pair of forces then has no moment.
    Beyond,
    /// So, but at these ends, the first and the last, not on to the next facet: those where sides that were straight have concave kinks.
    Own([bool; 2]),
}

/// Projects `x` on `facet`, whose nodes are at `position`.
pub fn project<'a, const D: usize>(
    x: &Vector<D>,
    facet: &'a Facet,
    reach: Reach,
    position: &Positions<'_, D>,
) -> Projection<'a, D> {
    let patch = Patch::new(facet, position);
    let xi = patch.closest(x);
    let mut at = patch.at(&xi);
    if reach != Reach::Facet {
        // Only at an edge is there a way to go on; inside, the distance is at right angles to the tangents already.
        let foot = at.foot(x);
        let straight = Domain::of(facet.kind).reached([xi[0] + foot[0], xi[1] + foot[1]]);
        at.go_on([straight[0] - xi[0], straight[1] - xi[1]]);
    }
    let weights = Weights::from_slice(&at.weights[..facet.nodes.len()]);
    Projection { nodes: &facet.nodes, weights, point: at.point, normal: normal(&at.tangents) }
}

/// The tangents' product [m^(D−1)], outward by the right-hand rule; in 2D to the right of the tangent.
pub fn area_normal<const D: usize>(t: &[Vector<D>; 2]) -> Vector<D> {
    let mut n = Vector::<D>::zeros();
    if D == 2 {
        n[0] = t[0][1];
        n[1] = -t[0][0];
    } else {
        for i in 0..D {
            let (j, k) = ((i + 1) % D, (i + 2) % D);
            n[i] = t[0][j] * t[1][k] - t[0][k] * t[1][j];
        }
    }
    n
}

/// Outward unit normal.
pub fn normal<const D: usize>(t: &[Vector<D>; 2]) -> Vector<D> {
    area_normal(t).normalize()
}

#[cfg(test)]
mod tests {
    use carom_mesh::CellKind;

    use super::*;

    #[test]
    fn projection_on_a_segment_is_at_right_angles_or_at_its_end() {
        let nodes = [Vector::<2>::new(0.0, 0.0), Vector::<2>::new(2.0, 0.0)];
        let facet = Facet { kind: CellKind::Line2, nodes: vec![0, 1] };
        let at =
            |x: f64, y: f64| project(&Vector::<2>::new(x, y), &facet, Reach::Facet, &|n| nodes[n as usize]);
        let p = at(0.5, -0.3);
        assert!((p.point - Vector::<2>::new(0.5, 0.0)).norm() < 1e-15);
        assert!((p.normal - Vector::<2>::new(0.0, -1.0)).norm() < 1e-15);
        assert!((p.weights[0] - 0.75).abs() < 1e-15 && (p.weights[1] - 0.25).abs() < 1e-15);
        assert!((at(3.0, 1.0).point - nodes[1]).norm() < 1e-15);
        let x = Vector::<2>::new(2.4, 1.0);
        let beyond = project(&x, &facet, Reach::Beyond, &|n| nodes[n as usize]);
        assert!((beyond.point - Vector::<2>::new(2.4, 0.0)).norm() < 1e-15);
    }

    /// Symptom guarded against: beyond the edge of a skew or warped facet the force was not along the line between the points.
    #[test]
    fn beyond_an_edge_the_distance_is_along_the_normal() {
        let nodes =
            [[0.0, 0.0, 0.0], [1.0, 0.1, 0.1], [1.4, 1.0, -0.1], [0.3, 0.9, 0.05]].map(Vector::<3>::from);
        let at = |n: u32| nodes[n as usize];
        for (kind, facet) in [(CellKind::Quad4, vec![0, 1, 2, 3]), (CellKind::Tri3, vec![0, 1, 3])] {
            let facet = Facet { kind, nodes: facet };
            for x in [[1.1, 0.3, 0.2], [0.5, 1.2, -0.3], [-0.2, -0.1, 0.4], [0.4, 0.6, 0.5]] {
                let x = Vector::<3>::from(x);
                let p = project(&x, &facet, Reach::Beyond, &at);
                let d = x - p.point;
                assert!((d - p.normal * p.normal.dot(&d)).norm() < 1e-14, "{kind:?} {x}");
                let weighted = p.nodes.iter().zip(&p.weights).map(|(&n, &w)| at(n) * w).sum::<Vector<3>>();
                assert!((weighted - p.point).norm() < 1e-15);
                assert!((p.weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            }
        }
    }
}
