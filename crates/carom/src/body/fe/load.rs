use carom_fem::{Body, FacetPatch};
use carom_mesh::{Facet, Matrix, Vector};

use crate::Signal;

/// Forces on a body that are given as functions of time.
#[derive(Debug, Clone)]
pub enum Load<const D: usize> {
    /// Forces on nodes that do not depend on the motion.
    Dead(DeadLoad<D>),
    /// Pressure that follows the body: always against the normal, on the current area.
    Follower(FollowerPressure),
}

/// Forces Σ s(t) p_a on nodes, each a signal times a pattern.
#[derive(Debug, Clone, PartialEq)]
pub struct DeadLoad<const D: usize> {
    /// The signals and their patterns, by node of the body.
    terms: Vec<(Signal, Vec<(u32, Vector<D>)>)>,
}

/// Pressure on the present area of facets.
#[derive(Debug, Clone)]
pub struct FollowerPressure {
    patch: FacetPatch,
    pressure: Signal,
}

impl<const D: usize> Load<D> {
    /// The same `force` [N], component by component, on each of these nodes.
    #[must_use]
    pub fn nodal_force(nodes: &[u32], force: [Signal; D]) -> Self {
        Self::weighted(nodes.iter().map(|&n| (n, 1.0)), force)
    }

    /// A `traction` [Pa], component by component, per reference area of these facets.
    #[must_use]
    pub fn traction(body: &Body<D>, facets: Vec<Facet>, traction: [Signal; D]) -> Self {
        Self::weighted(FacetPatch::new(body, facets).areas(body), traction)
    }

    /// A `pressure` [Pa] on the reference area of these facets, against their reference normals.
    #[must_use]
    pub fn dead_pressure(body: &Body<D>, facets: Vec<Facet>, pressure: Signal) -> Self {
        let mut forces = std::collections::BTreeMap::new();
        let still = vec![Vector::zeros(); body.node_count()];
        FacetPatch::new(body, facets).area_vectors(body, &still, |node, area| {
            *forces.entry(node).or_insert_with(Vector::zeros) -= area;
        });
        Self::Dead(DeadLoad { terms: vec![(pressure, forces.into_iter().collect())] })
    }

    /// A `pressure` [Pa] on these facets that follows them.
    #[must_use]
    pub fn follower_pressure(body: &Body<D>, facets: Vec<Facet>, pressure: Signal) -> Self {
        Self::Follower(FollowerPressure { patch: FacetPatch::new(body, facets), pressure })
    }

    /// Each component of `force` times the weights of the nodes.
    fn weighted(weights: impl IntoIterator<Item = (u32, f64)>, force: [Signal; D]) -> Self {
        let weights: Vec<(u32, f64)> = weights.into_iter().collect();
        let terms = force.into_iter().enumerate().filter(|(_, signal)| !signal.is_zero());
        let pattern = |i: usize| {
            let vector = |w: f64| Vector::from_fn(|k, _| if k == i { w } else { 0.0 });
            weights.iter().map(|&(n, w)| (n, vector(w))).collect()
        };
        Self::Dead(DeadLoad { terms: terms.map(|(i, signal)| (signal, pattern(i))).collect() })
    }

    /// Whether it is the same at two times [s].
    pub(crate) fn is_alike(&self, [a, b]: [f64; 2]) -> bool {
        let is_alike = |s: &Signal| s.at(a).value == s.at(b).value;
        match self {
            Self::Dead(load) => load.terms.iter().all(|(signal, _)| is_alike(signal)),
            Self::Follower(load) => is_alike(&load.pressure),
        }
    }

    /// Adds the force [N] at a moment to `f`: `value` says what a signal is then, and `u` are the displacements [m].
    pub(crate) fn add(
        &self,
        body: &Body<D>,
        value: impl Fn(&Signal) -> f64,
        u: &[Vector<D>],
        f: &mut [Vector<D>],
    ) {
        match self {
            Self::Dead(load) => {
                for (signal, pattern) in &load.terms {
                    let size = value(signal);
                    pattern.iter().for_each(|(node, p)| f[*node as usize] += p * size);
                }
            }
            Self::Follower(load) => {
                let size = value(&load.pressure);
                load.patch.area_vectors(body, u, |node, area| f[node as usize] -= area * size);
            }
        }
    }

    /// Calls `add` with the blocks −∂f/∂u [N/m] of the stiffness at a moment, made symmetric: where a patch has an edge it is not, and K̄ is.
    pub(crate) fn add_stiffness(
        &self,
        body: &Body<D>,
        value: impl Fn(&Signal) -> f64,
        u: &[Vector<D>],
        mut add: impl FnMut(u32, u32, Matrix<D>),
    ) {
        let Self::Follower(load) = self else { return };
        let half = 0.5 * value(&load.pressure);
        load.patch.area_gradients(body, u, |a, b, gradient| {
            add(a, b, gradient * half);
            add(b, a, gradient.transpose() * half);
        });
    }

    /// Whether the force depends on the displacements.
    #[must_use]
    pub fn follows(&self) -> bool {
        matches!(self, Self::Follower(_))
    }
}
