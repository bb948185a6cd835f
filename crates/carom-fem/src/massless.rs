//! Nodes without mass: what they carried moves inside, with total mass, centre and inertia kept.
//!
//! The velocity of a massless node is taken to follow those of massive nodes near it by weights that reproduce affine fields,
//! v_b = Σ e_bk v_k. With P the map from massive to all nodes, the mass PᵀMP has the kinetic energy of that field: it is as
//! positive definite as M, and as rigid motions are affine, no mass, centre or inertia is lost. (Khenous, Laborde & Renard 2008
//! asked for the same invariants by the least change of M; that mass may be indefinite where few layers of cells are left.)

use std::sync::Arc;

use carom_mesh::{Matrix, Mesh, Vector};
use nalgebra::DMatrix;

use crate::FemError;
use crate::sparse::{NodalMatrix, NodeGraph};

/// How a massless node follows massive ones: nodes and weights.
pub(crate) type Follower = Vec<(u32, f64)>;

/// Layers of neighbours that are searched for massive nodes.
const MAX_LAYERS: usize = 8;
/// Weights whose magnitudes sum to more amplify noise: a wider neighbourhood is tried first.
const AMPLIFICATION: f64 = 4.0;
/// How well affine fields must be reproduced.
const REPRODUCED: f64 = 1e-9;

/// For every node of `massless` (ascending), the massive nodes that it follows.
///
/// # Errors
/// If the massive nodes near one cannot carry a rigid motion, as where no cell is left inside.
pub(crate) fn followers<const D: usize>(
    mesh: &Mesh<D>,
    graph: &NodeGraph,
    massless: &[u32],
) -> Result<Vec<Follower>, FemError> {
    massless
        .iter()
        .map(|&node| {
            follower(mesh, graph, massless, node).ok_or_else(|| FemError::NoMassInside {
                node,
                at: mesh.nodes()[node as usize].iter().copied().collect(),
            })
        })
        .collect()
}

/// The weights of least weighted norm that reproduce affine fields at `node`; the nearer a node, the more it counts.
fn follower<const D: usize>(
    mesh: &Mesh<D>,
    graph: &NodeGraph,
    massless: &[u32],
    node: u32,
) -> Option<Follower> {
    let origin = mesh.nodes()[node as usize];
    let mut near = vec![node];
    let mut best: Option<(f64, Follower)> = None;
    for _ in 0..MAX_LAYERS {
        let mut wider: Vec<u32> =
            near.iter().flat_map(|&n| graph.row(n as usize).map(|(_, k)| k as u32)).collect();
        wider.sort_unstable();
        wider.dedup();
        if wider.len() == near.len() {
            break;
        }
        near = wider;
        let massive: Vec<u32> = near.iter().copied().filter(|n| massless.binary_search(n).is_err()).collect();
        let arms: Vec<Vector<D>> = massive.iter().map(|&n| mesh.nodes()[n as usize] - origin).collect();
        let Some(weights) = affine_weights(&arms) else { continue };
        let amplification = weights.iter().map(|w| w.abs()).sum();
        if best.as_ref().is_none_or(|(least, _)| amplification < *least) {
            best = Some((amplification, massive.into_iter().zip(weights).collect()));
        }
        if amplification <= AMPLIFICATION {
            break;
        }
    }
    best.map(|(_, follower)| follower)
}

/// Weights e with Σe = 1 and Σ e x = 0 for nodes at `arms` from the origin, if there are any.
///
/// Of all such e this is the one of least Σ e²/ω with ω = |x|⁻⁴: e = ω (c + g·x), where c and g solve a small symmetric system.
/// Directions in which all arms are zero are left alone, so that nodes on one line serve a node of that line.
fn affine_weights<const D: usize>(arms: &[Vector<D>]) -> Option<Vec<f64>> {
    let size = arms.iter().map(Vector::norm).fold(f64::INFINITY, f64::min);
    if !size.is_finite() {
        return None;
    }
    let (mut zeroth, mut first, mut second) = (0.0, Vector::zeros(), Matrix::zeros());
    let importance = |x: &Vector<D>| x.norm_squared().powi(-2);
    let scaled: Vec<Vector<D>> = arms.iter().map(|x| x / size).collect();
    for x in &scaled {
        let w = importance(x);
        zeroth += w;
        first += x * w;
        second += x * x.transpose() * w;
    }
    // Σ e x = 0 gives c first + second g = 0, and Σ e = 1 fixes c. The pseudo-inverse leaves empty directions out.
    let inverse = DMatrix::from_fn(D, D, |i, j| second[(i, j)]).pseudo_inverse(1e-10 * second.norm()).ok()?;
    let gradient = -(Matrix::<D>::from_fn(|i, j| inverse[(i, j)]) * first);
    let sum = zeroth + gradient.dot(&first);
    let weights: Vec<f64> = scaled.iter().map(|x| importance(x) * (1.0 + gradient.dot(x)) / sum).collect();
    let moment = scaled.iter().zip(&weights).fold(Vector::zeros(), |s, (x, &w)| s + x * w);
    let reproduced = weights.iter().all(|w| w.is_finite())
        && (weights.iter().sum::<f64>() - 1.0).abs() < REPRODUCED
        && moment.norm() < REPRODUCED;
    reproduced.then_some(weights)
}

/// PᵀMP on a graph that has its entries beside those of `mass`: rows and columns of the massless nodes are zero.
pub(crate) fn redistributed(
    mass: &NodalMatrix<f64>,
    massless: &[u32],
    followers: &[Follower],
) -> NodalMatrix<f64> {
    let carriers = |node: usize| -> Follower {
        match massless.binary_search(&(node as u32)) {
            Ok(k) => followers[k].clone(),
            Err(_) => vec![(node as u32, 1.0)],
        }
    };
    let mut terms: Vec<(u32, u32, f64)> = Vec::new();
    for a in 0..mass.graph().node_count() {
        let rows = carriers(a);
        for (entry, b) in mass.graph().row(a) {
            let value = mass.values[entry];
            if value == 0.0 {
                continue;
            }
            for &(i, row_weight) in &rows {
                for (j, column_weight) in carriers(b) {
                    terms.push((i, j, row_weight * value * column_weight));
                }
            }
        }
    }
    let graph = Arc::new(mass.graph().extended(terms.iter().map(|&(i, j, _)| (i, j))));
    let mut moved = NodalMatrix::filled(&graph, 0.0);
    for (i, j, value) in terms {
        moved.values[graph.entry(i, j)] += value;
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_on_a_line_extrapolate_along_it() {
        let arms = [1.0, 2.0].map(|x| Vector::<2>::new(x, 0.0));
        let weights = affine_weights(&arms).expect("a line");
        assert!((weights[0] - 2.0).abs() < 1e-14 && (weights[1] + 1.0).abs() < 1e-14);
        assert!(affine_weights(&[Vector::<2>::new(1.0, 0.5)]).is_none());
    }
}
