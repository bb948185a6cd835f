//! Shape functions of the quadratic cells, from the reference coordinates of their nodes: one formula per family.

/// The ends of the edges of a tetrahedron, in the order of their middles; the first three are those of a triangle.
pub(super) const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// The quadratic polynomial of a segment that is 1 at `p` ∈ {−1, 0, 1} and 0 at the other two, and its derivative.
#[inline]
fn segment(p: f64, x: f64) -> (f64, f64) {
    if p == 0.0 { (1.0 - x * x, -2.0 * x) } else { (0.5 * x * (x + p), x + 0.5 * p) }
}

/// Products of quadratic polynomials, one per direction: line3, quad9, hex27.
pub(super) fn product(nodes: &[[f64; 3]], dimension: usize, xi: &[f64; 3], n: &mut [f64]) {
    for (n, p) in n.iter_mut().zip(nodes) {
        *n = (0..dimension).map(|k| segment(p[k], xi[k]).0).product();
    }
}

/// The gradients of [`product`].
pub(super) fn product_gradient(nodes: &[[f64; 3]], dimension: usize, xi: &[f64; 3], g: &mut [[f64; 3]]) {
    for (g, p) in g.iter_mut().zip(nodes) {
        for (i, g) in g.iter_mut().enumerate().take(dimension) {
            *g = (0..dimension)
                .map(|k| {
                    let (value, slope) = segment(p[k], xi[k]);
                    if k == i { slope } else { value }
                })
                .product();
        }
    }
}

/// Factors of a serendipity function (Zienkiewicz & Taylor, *The Finite Element Method*, vol. 1): 1 + pξ per direction,
/// 1 − ξ² along the edge of a mid-side node. Each comes with its derivative.
#[inline]
fn factor(p: f64, x: f64) -> (f64, f64) {
    if p == 0.0 { (1.0 - x * x, -2.0 * x) } else { (0.5 * (1.0 + p * x), 0.5 * p) }
}

/// Corners have Π ½(1 + pξ) (Σ pξ + 1 − d) in d dimensions, mid-side nodes (1 − ξ²) Π ½(1 + pξ): quad8, hex20.
pub(super) fn serendipity(nodes: &[[f64; 3]], dimension: usize, xi: &[f64; 3], n: &mut [f64]) {
    for (n, p) in n.iter_mut().zip(nodes) {
        *n = (0..dimension).map(|k| factor(p[k], xi[k]).0).product();
        if is_corner(p, dimension) {
            *n *= corner_sum(p, dimension, xi);
        }
    }
}

/// The gradients of [`serendipity`].
pub(super) fn serendipity_gradient(nodes: &[[f64; 3]], dimension: usize, xi: &[f64; 3], g: &mut [[f64; 3]]) {
    for (g, p) in g.iter_mut().zip(nodes) {
        let value: f64 = (0..dimension).map(|k| factor(p[k], xi[k]).0).product();
        for (i, g) in g.iter_mut().enumerate().take(dimension) {
            let slope: f64 = (0..dimension)
                .map(|k| {
                    let (value, slope) = factor(p[k], xi[k]);
                    if k == i { slope } else { value }
                })
                .product();
            *g = slope;
            if is_corner(p, dimension) {
                *g = slope * corner_sum(p, dimension, xi) + value * p[i];
            }
        }
    }
}

#[inline]
fn is_corner(p: &[f64; 3], dimension: usize) -> bool {
    p[..dimension].iter().all(|&p| p != 0.0)
}

#[inline]
fn corner_sum(p: &[f64; 3], dimension: usize, xi: &[f64; 3]) -> f64 {
    (0..dimension).map(|k| p[k] * xi[k]).sum::<f64>() + 1.0 - dimension as f64
}

/// The barycentric coordinates L of a simplex with corners at the origin and the unit vectors, and their gradients.
#[inline]
fn barycentric(dimension: usize, xi: &[f64; 3]) -> ([f64; 4], [[f64; 3]; 4]) {
    let (mut l, mut g) = ([0.0; 4], [[0.0; 3]; 4]);
    l[0] = 1.0 - xi[..dimension].iter().sum::<f64>();
    for k in 0..dimension {
        (l[k + 1], g[k + 1][k], g[0][k]) = (xi[k], 1.0, -1.0);
    }
    (l, g)
}

/// Corners have L(2L − 1), and then the middles of `edges` 4 L_i L_j: tri6, tet10.
pub(super) fn simplex(edges: &[[usize; 2]], dimension: usize, xi: &[f64; 3], n: &mut [f64]) {
    let (l, _) = barycentric(dimension, xi);
    let (corners, middles) = n.split_at_mut(dimension + 1);
    for (n, l) in corners.iter_mut().zip(&l) {
        *n = l * (2.0 * l - 1.0);
    }
    for (n, &[i, j]) in middles.iter_mut().zip(edges) {
        *n = 4.0 * l[i] * l[j];
    }
}

/// The gradients of [`simplex`].
pub(super) fn simplex_gradient(edges: &[[usize; 2]], dimension: usize, xi: &[f64; 3], g: &mut [[f64; 3]]) {
    let (l, dl) = barycentric(dimension, xi);
    let (corners, middles) = g.split_at_mut(dimension + 1);
    for k in 0..dimension {
        for (a, g) in corners.iter_mut().enumerate() {
            g[k] = (4.0 * l[a] - 1.0) * dl[a][k];
        }
        for (g, &[i, j]) in middles.iter_mut().zip(edges) {
            g[k] = 4.0 * (l[i] * dl[j][k] + l[j] * dl[i][k]);
        }
    }
}
