//! Nodes without mass: what they carried moves inside, with total mass, centre and inertia kept.
//!
//! The velocity of a massless node is taken to follow those of massive nodes near it by weights that reproduce affine fields,
//! v_b = Σ e_bk v_k. With P the map from massive to all nodes, the mass PᵀMP has the kinetic energy of that field. It is as
//! positive definite as M and, as rigid motions are affine, no mass, centre or inertia is lost.
//!
//! (Khenous, Laborde & Renard 2008 asked for the same invariants by the least change of M; that mass may be indefinite where
//! few layers of cells are left.)

use std::collections::BTreeSet;
use std::sync::Arc;

use carom_mesh::{Matrix, Mesh, Surface, Vector};
use nalgebra::DMatrix;

use crate::FemError;
use crate::sparse::{NodalMatrix, NodeGraph};

/// How a massless node follows massive ones: nodes and weights.
pub(crate) type Follower = Vec<(u32, f64)>;

/// Among which nodes the mass of one of the boundary is shared out, and how well.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Control {
    /// Layers of nodes that share the mass of a boundary node: with fewer the nearest get so much of it that contact rings.
    layers: usize,
    /// Most nodes per layer.
    nodes_per_layer: usize,
    /// Weights whose magnitudes sum to more amplify noise: more nodes per layer are tried first.
    amplification: f64,
    /// How well affine fields must be reproduced.
    reproduced: f64,
    /// Nodes this alike, relative to how far away they are, are as far aside from the inward normal.
    tie: f64,
}

/// The thresholds of every mesh.
const CONTROL: Control =
    Control { layers: 5, nodes_per_layer: 4, amplification: 2.5, reproduced: 1e-9, tie: 1e-9 };

/// For every node of `surface`, the massive nodes that it follows.
///
/// # Errors
/// If the massive nodes near one cannot carry a rigid motion, as where no cell is left inside.
pub(crate) fn followers<const D: usize>(
    mesh: &Mesh<D>,
    graph: &NodeGraph,
    surface: &Surface,
) -> Result<Vec<Follower>, FemError> {
    surface
        .nodes()
        .iter()
        .map(|&node| {
            follower(mesh, graph, surface, node).ok_or_else(|| FemError::NoMassInside {
                node,
                at: mesh.nodes()[node as usize].iter().copied().collect(),
            })
        })
        .collect()
}

/// The weights of least norm that reproduce affine fields at `node`, over few massive nodes in line with it: the fewer, the
/// sparser the mass.
fn follower<const D: usize>(
    mesh: &Mesh<D>,
    graph: &NodeGraph,
    surface: &Surface,
    node: u32,
) -> Option<Follower> {
    let origin = mesh.nodes()[node as usize];
    let arm = |n: u32| mesh.nodes()[n as usize] - origin;
    let mut layers = massive_layers(graph, surface.nodes(), node);
    let around = surface.facets().iter().filter(|f| f.nodes.contains(&node));
    let inward = -around.map(|f| f.area_vector(mesh)).sum::<Vector<D>>().try_normalize(0.0)?;
    let aside = |n: u32| (arm(n) - inward * inward.dot(&arm(n))).norm();
    for layer in &mut layers {
        layer.sort_by(|&a, &b| aside(a).total_cmp(&aside(b)));
    }
    let mut best: Option<(f64, Follower)> = None;
    for count in 1..=CONTROL.nodes_per_layer {
        // Nodes that are equally far aside go together: which of them has the lower number decides nothing.
        let as_far = |layer: &[u32]| {
            let last =
                layer.get(count - 1).map_or(f64::INFINITY, |&n| aside(n) + CONTROL.tie * arm(n).norm());
            layer.iter().take_while(|&&n| aside(n) <= last).count()
        };
        let nodes: Vec<u32> =
            layers.iter().flat_map(|layer| layer[..as_far(layer)].iter().copied()).collect();
        let arms: Vec<Vector<D>> = nodes.iter().map(|&n| arm(n)).collect();
        let Some(weights) = affine_weights(&arms) else { continue };
        let amplification: f64 = weights.iter().map(|w| w.abs()).sum();
        // Round-off decides neither whether more nodes are better nor whether these will do.
        if best.as_ref().is_none_or(|(least, _)| amplification < least * (1.0 - CONTROL.tie)) {
            best = Some((amplification, nodes.into_iter().zip(weights).collect()));
        }
        if amplification <= CONTROL.amplification * (1.0 + CONTROL.tie) {
            break;
        }
    }
    best.map(|(_, follower)| follower)
}

/// The massive nodes around `node` by their distance in the graph, the nearest layers that have any.
fn massive_layers(graph: &NodeGraph, massless: &[u32], node: u32) -> Vec<Vec<u32>> {
    let mut seen = BTreeSet::from([node]);
    let mut front = vec![node];
    let mut layers = Vec::new();
    while !front.is_empty() && layers.len() < CONTROL.layers {
        let around: BTreeSet<u32> =
            front.iter().flat_map(|&n| graph.row(n as usize).map(|(_, k)| k as u32)).collect();
        front = around.into_iter().filter(|n| seen.insert(*n)).collect();
        let massive: Vec<u32> =
            front.iter().copied().filter(|n| massless.binary_search(n).is_err()).collect();
        if !massive.is_empty() {
            layers.push(massive);
        }
    }
    layers
}

/// The weights e of least norm with Σe = 1 and Σ e x = 0 for nodes at `arms` from the origin, if there are any. They are e =
/// c + g·x, where c and g solve a small symmetric system.
///
/// Directions in which all arms are zero are left alone, so that nodes on one line serve a node of that line.
fn affine_weights<const D: usize>(arms: &[Vector<D>]) -> Option<Vec<f64>> {
    let size = arms.iter().map(Vector::norm).fold(0.0, f64::max);
    let scaled: Vec<Vector<D>> = arms.iter().map(|x| x / size).collect();
    let first: Vector<D> = scaled.iter().sum();
    let second: Matrix<D> = scaled.iter().map(|x| x * x.transpose()).sum();
    // Σ e x = 0 gives c first + second g = 0, and Σ e = 1 fixes c. The pseudo-inverse leaves empty directions out.
    let inverse = DMatrix::from_fn(D, D, |i, j| second[(i, j)]).pseudo_inverse(1e-10 * second.norm()).ok()?;
    let gradient = -(Matrix::<D>::from_fn(|i, j| inverse[(i, j)]) * first);
    let sum = scaled.len() as f64 + gradient.dot(&first);
    let weights: Vec<f64> = scaled.iter().map(|x| (1.0 + gradient.dot(x)) / sum).collect();
    let moment = scaled.iter().zip(&weights).fold(Vector::zeros(), |s, (x, &w)| s + x * w);
    let reproduced = weights.iter().all(|w| w.is_finite())
        && (weights.iter().sum::<f64>() - 1.0).abs() < CONTROL.reproduced
        && moment.norm() < CONTROL.reproduced;
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
