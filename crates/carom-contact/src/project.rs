use carom_mesh::{CellKind, Facet, Vector, cell};

/// The point of a facet, or of the curve over it, closest to a given one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection<'a, const D: usize> {
    /// The nodes that the point follows.
    pub nodes: &'a [u32],
    /// Their weights.
    pub weights: [f64; cell::MAX_FACET_NODES],
    /// The point [m].
    pub point: Vector<D>,
    /// Outward unit normal there.
    pub normal: Vector<D>,
}

/// Newton steps on a curved (quad4) facet; straight ones need one.
const MAX_STEPS: usize = 20;

/// How far a facet reaches beyond its edges with `Reach::Beyond`, in widths.
pub const BEYOND: f64 = 0.5;

/// Whether a facet reaches beyond its edges when a point is projected on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// Not at all: the closest point of the facet itself.
    Facet,
    /// On every side, by `BEYOND`. A node that slides past the edge of its facet within a step is so still at right angles to
    /// the point it presses on, and the pair of forces has no moment.
    Beyond,
}

/// Projects `x` on `facet`, whose nodes are at `position`.
pub fn project<'a, const D: usize>(
    x: &Vector<D>,
    facet: &'a Facet,
    reach: Reach,
    position: &impl Fn(u32) -> Vector<D>,
) -> Projection<'a, D> {
    let reference = facet.kind.reference();
    let n = facet.nodes.len();
    let mut nodes = [Vector::zeros(); cell::MAX_FACET_NODES];
    for (node, &a) in nodes.iter_mut().zip(&facet.nodes) {
        *node = position(a);
    }
    let mut xi = if facet.kind == CellKind::Tri3 { [1.0 / 3.0; 3] } else { [0.0; 3] };
    let mut weights = [0.0; cell::MAX_FACET_NODES];
    let mut gradients = [[0.0; 3]; cell::MAX_FACET_NODES];
    let mut tangents = [Vector::zeros(); 2];
    for _ in 0..MAX_STEPS {
        (reference.gradient)(&xi, &mut gradients[..n]);
        for (k, t) in tangents.iter_mut().enumerate() {
            *t = (0..n).fold(Vector::zeros(), |s, a| s + nodes[a] * gradients[a][k]);
        }
        (reference.shape)(&xi, &mut weights[..n]);
        let point = (0..n).fold(Vector::zeros(), |s, a| s + nodes[a] * weights[a]);
        let next = clamp(facet.kind, reach, step(&xi, &(x - point), &tangents, D));
        let change = (0..2).map(|k| (next[k] - xi[k]).abs()).fold(0.0, f64::max);
        xi = next;
        if change < 1e-14 {
            break;
        }
    }
    (reference.shape)(&xi, &mut weights[..n]);
    let point = (0..n).fold(Vector::zeros(), |s, a| s + nodes[a] * weights[a]);
    Projection { nodes: &facet.nodes, weights, point, normal: normal(&tangents) }
}

/// ξ after a Gauss–Newton step that brings the distance vector `d` at right angles to the tangents.
fn step<const D: usize>(xi: &[f64; 3], d: &Vector<D>, t: &[Vector<D>; 2], dimension: usize) -> [f64; 3] {
    let mut next = *xi;
    if dimension == 2 {
        next[0] += d.dot(&t[0]) / t[0].norm_squared();
    } else {
        let (a, b, c) = (t[0].norm_squared(), t[0].dot(&t[1]), t[1].norm_squared());
        let (p, q) = (d.dot(&t[0]), d.dot(&t[1]));
        let det = a * c - b * b;
        next[0] += (c * p - b * q) / det;
        next[1] += (a * q - b * p) / det;
    }
    next
}

/// The closest point of the reference facet, or of what it reaches, component by component.
fn clamp(kind: CellKind, reach: Reach, xi: [f64; 3]) -> [f64; 3] {
    let beyond = if reach == Reach::Beyond { BEYOND } else { 0.0 };
    if kind != CellKind::Tri3 {
        let end = 1.0 + 2.0 * beyond;
        return xi.map(|x| x.clamp(-end, end));
    }
    let mut xi = xi.map(|x| x.max(-beyond));
    let sum = 1.0 + beyond;
    let excess = xi[0] + xi[1] - sum;
    if excess > 0.0 {
        xi[0] = (xi[0] - 0.5 * excess).clamp(-beyond, sum + beyond);
        xi[1] = sum - xi[0];
    }
    xi
}

/// Outward unit normal by the right-hand rule; in 2D to the right of the tangent.
pub fn normal<const D: usize>(t: &[Vector<D>; 2]) -> Vector<D> {
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
    n.normalize()
}

#[cfg(test)]
mod tests {
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

    #[test]
    fn projection_on_a_warped_quadrilateral_is_at_right_angles() {
        let nodes =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [1.1, 1.0, -0.1], [0.0, 0.9, 0.05]].map(Vector::<3>::from);
        let facet = Facet { kind: CellKind::Quad4, nodes: vec![0, 1, 2, 3] };
        let x = Vector::<3>::new(0.4, 0.6, 0.5);
        let p = project(&x, &facet, Reach::Facet, &|n| nodes[n as usize]);
        let d = (x - p.point).normalize();
        assert!((d.dot(&p.normal) - 1.0).abs() < 1e-12, "{}", d.dot(&p.normal));
    }

    #[test]
    fn projection_on_a_triangle_stays_inside() {
        let nodes = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector::<3>::from);
        let facet = Facet { kind: CellKind::Tri3, nodes: vec![0, 1, 2] };
        let at =
            |x: [f64; 3]| project(&Vector::<3>::from(x), &facet, Reach::Facet, &|n| nodes[n as usize]).point;
        assert!((at([0.2, 0.3, 0.4]) - Vector::<3>::new(0.2, 0.3, 0.0)).norm() < 1e-15);
        assert!((at([1.0, 1.0, 0.4]) - Vector::<3>::new(0.5, 0.5, 0.0)).norm() < 1e-15);
        assert!((at([-1.0, 0.5, 0.4]) - Vector::<3>::new(0.0, 0.5, 0.0)).norm() < 1e-15);
    }
}
