use std::cmp::Ordering;

use crate::{Mesh, MeshError, Tie, Vector};

/// The same body with the nodes on its last side across `direction` tied to those opposite, on the first: it repeats itself.
///
/// # Errors
/// If the nodes of the two sides, at the extremes of that coordinate, do not face one another exactly.
pub fn tie_sides<const D: usize>(mesh: Mesh<D>, direction: usize) -> Result<Mesh<D>, MeshError> {
    let extreme = |of: fn(f64, f64) -> f64| mesh.nodes().iter().map(|x| x[direction]).reduce(of);
    let side = |at: Option<f64>| {
        let mut nodes: Vec<(Vector<D>, u32)> = (0u32..)
            .zip(mesh.nodes())
            .filter(|(_, x)| Some(x[direction]) == at)
            .map(|(n, x)| (Vector::from_fn(|k, _| if k == direction { 0.0 } else { x[k] }), n))
            .collect();
        nodes.sort_by(|(a, _), (b, _)| a.iter().partial_cmp(b.iter()).unwrap_or(Ordering::Equal));
        nodes
    };
    let (first, last) = (side(extreme(f64::min)), side(extreme(f64::max)));
    if first.len() != last.len() || first.iter().zip(&last).any(|((a, _), (b, _))| a != b) {
        return Err(MeshError::UnlikeSides { direction });
    }
    let ties = first.iter().zip(&last).map(|(&(_, master), &(_, image))| Tie { image, master }).collect();
    mesh.with_ties(ties)
}
