use carom_mesh::{Matrix, Vector, cell};

/// A source node near its target: gap, frame, and the stencil that maps nodal to relative motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contact<const D: usize> {
    /// Distance along the normal [m]; negative = penetration.
    pub gap: f64,
    /// Rows n, t₁, t₂; n points from the target to the source.
    pub frame: Matrix<D>,
    nodes: [u32; cell::MAX_FACET_NODES + 1],
    weights: [f64; cell::MAX_FACET_NODES + 1],
    len: usize,
}

impl<const D: usize> Contact<D> {
    /// A contact of the node `source` with a target whose `nodes` follow the target point with these `weights`.
    pub(crate) fn new(gap: f64, frame: Matrix<D>, source: u32, target: &[u32], weights: &[f64]) -> Self {
        let mut contact = Self {
            gap,
            frame,
            nodes: [source; cell::MAX_FACET_NODES + 1],
            weights: [0.0; cell::MAX_FACET_NODES + 1],
            len: 1 + target.len(),
        };
        contact.weights[0] = 1.0;
        for (k, (&node, &weight)) in target.iter().zip(weights).enumerate() {
            contact.nodes[k + 1] = node;
            contact.weights[k + 1] = -weight;
        }
        contact
    }

    /// The nodes involved with their weights: +1 for the source, minus the shape functions for the target.
    #[inline]
    pub fn stencil(&self) -> impl ExactSizeIterator<Item = (usize, f64)> {
        self.nodes[..self.len].iter().map(|&n| n as usize).zip(self.weights[..self.len].iter().copied())
    }

    /// H d: the relative motion in the frame of a nodal motion `d`.
    #[inline]
    #[must_use]
    pub fn relative(&self, d: impl Fn(usize) -> Vector<D>) -> Vector<D> {
        self.frame * self.stencil().fold(Vector::zeros(), |s, (n, weight)| s + d(n) * weight)
    }

    /// Adds the nodal forces Hᵀ r [N] of a reaction `r` to `f`.
    #[inline]
    pub fn add_force(&self, r: &Vector<D>, f: &mut [Vector<D>]) {
        let force = self.frame.tr_mul(r);
        for (node, weight) in self.stencil() {
            f[node] += force * weight;
        }
    }
}
