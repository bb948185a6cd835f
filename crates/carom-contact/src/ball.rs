//! Balls, in the plane discs, that are round whatever their mesh.

use crate::path::Positions;
use carom_mesh::{Matrix, Vector, tensor};

/// A node that is no farther than this from a plane, in radii, is in it.
const FLAT: f64 = 1e-9;

/// The weights of up to four nodes.
type Weights = [f64; 4];

/// A rigid body that is round in the eyes of what it touches. Its points follow D + 1 of its nodes, as affine combinations of them: so does
/// whatever moves rigidly.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ball {
    /// The nodes.
    nodes: Vec<u32>,
    /// Of which its centre is this combination.
    centre: Weights,
    /// Its radius [m].
    pub radius: f64,
}

impl Ball {
    /// With its `centre` and `radius` [m] where the `nodes` are at `reference` [m]. It follows those that are farthest from one another. None if
    /// they are all in one plane, or line.
    #[must_use]
    pub fn new<const D: usize>(
        centre: &Vector<D>,
        radius: f64,
        nodes: &[u32],
        reference: &Positions<'_, D>,
    ) -> Option<Self> {
        let mut chosen = vec![*nodes.first()?];
        let mut axes: Vec<Vector<D>> = Vec::new();
        for _ in 0..D {
            let beside = |n: u32| {
                let arm = reference(n) - reference(chosen[0]);
                axes.iter().fold(arm, |arm, axis| arm - axis * axis.dot(&arm))
            };
            let farthest =
                nodes.iter().copied().max_by(|&a, &b| beside(a).norm().total_cmp(&beside(b).norm()))?;
            axes.push(beside(farthest).try_normalize(FLAT * radius)?);
            chosen.push(farthest);
        }
        let mut ball = Self { nodes: chosen, centre: Weights::default(), radius };
        ball.centre = ball.weights(centre, reference);
        Some(ball)
    }

    /// The node that stands for it.
    pub fn node(&self) -> u32 {
        self.nodes[0]
    }

    /// Its centre [m].
    pub fn centre<const D: usize>(&self, position: &Positions<'_, D>) -> Vector<D> {
        let nodes = self.nodes.iter().zip(&self.centre);
        nodes.fold(Vector::zeros(), |x, (&n, weight)| x + position(n) * *weight)
    }

    /// The weights of the nodes that make a point of the ball.
    fn weights<const D: usize>(&self, x: &Vector<D>, position: &Positions<'_, D>) -> Weights {
        let first = position(self.nodes[0]);
        let mut edges = Matrix::<D>::zeros();
        for (k, &node) in self.nodes[1..].iter().enumerate() {
            edges.set_column(k, &(position(node) - first));
        }
        let others = tensor::inverse(&edges).0 * (x - first);
        let mut weights = Weights::default();
        weights[0] = 1.0 - others.sum();
        weights[1..=D].copy_from_slice(others.as_slice());
        weights
    }

    /// The weights of the point where it touches what is along `-normal` from its centre.
    pub fn touching<const D: usize>(
        &self,
        normal: &Vector<D>,
        position: &Positions<'_, D>,
    ) -> impl Iterator<Item = (u32, f64)> {
        let x = self.centre(position) - normal * self.radius;
        self.nodes.iter().copied().zip(self.weights(&x, position))
    }
}
