//! Places of bodies that springs and masses are attached to.

use carom_mesh::{Mesh, Vector};
use nalgebra::{DMatrix, DVector};

use crate::error::InputError;

/// A point is far from a body if the nearest node is farther than this, in diameters of the body.
const FAR: f64 = 0.25;

/// A node closer to a point of a rigid body than this, relative to the diameter of the body, is there.
const SAME: f64 = 1e-12;

/// A rigid body that is no thicker than this, relative to its diameter, is a line or a sheet.
const THIN: f64 = 1e-9;

/// The nodes of a set of the body `name`.
pub(super) fn of_set<const D: usize>(
    key: &str,
    name: &str,
    on: &str,
    mesh: &Mesh<D>,
) -> Result<Vec<u32>, InputError> {
    mesh.nodes_of(on).filter(|nodes| !nodes.is_empty()).ok_or_else(|| {
        let known = mesh.sets().names();
        let message = format!("{on:?}: body {name:?} has no such set; known are {known:?}");
        InputError::new(format!("{key}.on"), message)
    })
}

/// The node of the body `name` nearest to a point.
pub(super) fn nearest<const D: usize>(
    key: &str,
    name: &str,
    point: &Vector<D>,
    mesh: &Mesh<D>,
) -> Result<u32, InputError> {
    let distance = |n: &u32| (mesh.nodes()[*n as usize] - point).norm();
    let nearest = (0..mesh.nodes().len() as u32).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.filter(|n| distance(n) <= FAR * mesh.diameter()).ok_or_else(|| {
        let message =
            format!("{:?} is far from body {name:?}; give a point of it as it is drawn", point.as_slice());
        InputError::new(format!("{key}.point"), message)
    })
}

/// Nodes of a rigid body, and shares that add up to one, whose mean by these is the `point` however the body moves. They are as far apart as the
/// body lets them.
pub(super) fn of_rigid<const D: usize>(point: &Vector<D>, mesh: &Mesh<D>) -> Vec<(u32, f64)> {
    let (nodes, size) = (mesh.nodes(), mesh.diameter());
    let farthest = |distance: &dyn Fn(&Vector<D>) -> f64| {
        let by_distance = |a: &usize, b: &usize| distance(&nodes[*a]).total_cmp(&distance(&nodes[*b]));
        (0..nodes.len()).max_by(by_distance).unwrap_or_default()
    };
    let origin = farthest(&|x| -(x - point).norm());
    if (nodes[origin] - point).norm() <= SAME * size {
        return vec![(origin as u32, 1.0)];
    }
    let (mut chosen, mut axes) = (Vec::new(), Vec::<Vector<D>>::new());
    for _ in 0..D {
        let beside = |x: &Vector<D>| {
            let arm = x - nodes[origin];
            axes.iter().fold(arm, |rest, axis| rest - axis * axis.dot(&arm))
        };
        let next = farthest(&|x| beside(x).norm());
        let Some(axis) = beside(&nodes[next]).try_normalize(THIN * size) else { break };
        chosen.push(next);
        axes.push(axis);
    }
    let offset = DVector::from_fn(D, |i, _| point[i] - nodes[origin][i]);
    let arms = DMatrix::from_fn(D, chosen.len(), |i, k| nodes[chosen[k]][i] - nodes[origin][i]);
    let shares = arms.svd(true, true).solve(&offset, 0.0).unwrap_or_else(|_| DVector::zeros(chosen.len()));
    let others = chosen.iter().zip(shares.iter()).map(|(&n, &share)| (n as u32, share));
    std::iter::once((origin as u32, 1.0 - shares.sum())).chain(others).collect()
}
