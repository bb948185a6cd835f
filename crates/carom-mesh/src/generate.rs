//! Structured meshes of simple bodies.

use crate::{CellBlock, CellKind, Mesh, MeshError, Tie, Vector};

/// The most cells a generator makes; more is a slip, and would exhaust the memory before anything else could say so.
const MAX_CELLS: f64 = 5e6;

/// Refuses `divisions` that make more cells than [`MAX_CELLS`].
fn check_size(cells: f64, divisions: &dyn std::fmt::Debug) -> Result<(), MeshError> {
    if cells <= MAX_CELLS {
        return Ok(());
    }
    Err(MeshError::Generator {
        parameter: "divisions",
        value: format!("{divisions:?}"),
        remedy: "it would have more than 5 million cells; take fewer divisions",
    })
}

/// A box of `divisions` equal cells per direction, from `corner` [m] over `size` [m]: quad4 in 2D, hex8 in 3D.
///
/// # Errors
/// If a size is not positive or a direction has no divisions.
pub fn grid<const D: usize>(
    corner: [f64; D],
    size: [f64; D],
    divisions: [usize; D],
) -> Result<Mesh<D>, MeshError> {
    if !size.iter().all(|&s| s.is_finite() && s > 0.0) {
        return Err(MeshError::Generator {
            parameter: "size",
            value: format!("{size:?}"),
            remedy: "every side must be longer than 0 m",
        });
    }
    if divisions.contains(&0) {
        return Err(MeshError::Generator {
            parameter: "divisions",
            value: format!("{divisions:?}"),
            remedy: "at least 1 cell is needed in every direction",
        });
    }
    check_size(divisions.iter().map(|&d| d as f64).product(), &divisions)?;
    let kind = match D {
        2 => CellKind::Quad4,
        3 => CellKind::Hex8,
        _ => return Err(MeshError::WrongDimension { kind: "grid", dimension: D }),
    };
    // Node and cell numbers run fastest along the first direction.
    let unravel = |mut index: usize, counts: [usize; D]| -> [usize; D] {
        counts.map(|count| {
            let i = index % count;
            index /= count;
            i
        })
    };
    let node_counts = divisions.map(|d| d + 1);
    let node =
        |index: [usize; D]| -> u32 { (0..D).rev().fold(0, |n, k| n * node_counts[k] + index[k]) as u32 };
    let nodes = (0..node_counts.iter().product())
        .map(|n| {
            let index = unravel(n, node_counts);
            Vector::from_fn(|k, _| corner[k] + size[k] * index[k] as f64 / divisions[k] as f64)
        })
        .collect();
    let mut connectivity = Vec::new();
    for cell in 0..divisions.iter().product() {
        let first = unravel(cell, divisions);
        for xi in kind.reference().nodes {
            let mut index = first;
            for k in 0..D {
                index[k] += usize::from(xi[k] > 0.0);
            }
            connectivity.push(node(index));
        }
    }
    Mesh::new(nodes, vec![CellBlock { kind, connectivity }])
}

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
        nodes.sort_by(|(a, _), (b, _)| a.iter().partial_cmp(b.iter()).unwrap_or(std::cmp::Ordering::Equal));
        nodes
    };
    let (first, last) = (side(extreme(f64::min)), side(extreme(f64::max)));
    if first.len() != last.len() || first.iter().zip(&last).any(|((a, _), (b, _))| a != b) {
        return Err(MeshError::UnlikeSides { direction });
    }
    let ties = first.iter().zip(&last).map(|(&(_, master), &(_, image))| Tie { image, master }).collect();
    mesh.with_ties(ties)
}

/// A disc meshed by an O-grid: a core of `divisions` × `divisions` cells and rings around it, boundary nodes on the circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Radius [m].
    pub radius: f64,
    /// Cells along a side of the core; a quarter of the boundary has as many.
    pub divisions: usize,
    /// Rings of cells around the core; half of `divisions` if not given.
    pub rings: Option<usize>,
}

impl Disc {
    /// Half the side of the core, relative to the radius.
    const CORE: f64 = 0.5;
    /// How much the sides of the core bulge towards the circle, relative to half its side.
    const BULGE: f64 = 0.15;

    /// The disc in quad4 cells.
    ///
    /// # Errors
    /// If the radius is not positive, or the divisions are zero, or odd while `rings` is not given.
    pub fn quadrilaterals(&self) -> Result<Mesh<2>, MeshError> {
        let n = self.divisions;
        if !(self.radius.is_finite() && self.radius > 0.0) {
            return Err(MeshError::Generator {
                parameter: "radius",
                value: format!("{}", self.radius),
                remedy: "a disc needs a radius greater than 0 m",
            });
        }
        if n == 0 || (n % 2 == 1 && self.rings.is_none()) {
            return Err(MeshError::Generator {
                parameter: "divisions",
                value: format!("{n}"),
                remedy: "a disc needs an even number, at least 2, or an explicit number of rings",
            });
        }
        let rings = self.rings.unwrap_or(n / 2);
        if rings == 0 {
            return Err(MeshError::Generator {
                parameter: "rings",
                value: format!("{rings}"),
                remedy: "at least 1 ring is needed around the core",
            });
        }
        check_size(n as f64 * (n as f64 + 4.0 * rings as f64), &n)?;
        let centre = Vector::from(self.centre);
        let parameter = |i: usize| 2.0 * i as f64 / n as f64 - 1.0;
        let core = |i: usize, j: usize| {
            let (u, v) = (parameter(i), parameter(j));
            let bulge = |w: f64| (1.0 + Self::BULGE * (1.0 - w * w)) / (1.0 + Self::BULGE);
            Vector::from([u * bulge(v), v * bulge(u)]) * (Self::CORE * self.radius)
        };
        let mut nodes: Vec<Vector<2>> = Vec::new();
        for j in 0..=n {
            nodes.extend((0..=n).map(|i| centre + core(i, j)));
        }
        let core_node = |i: usize, j: usize| (j * (n + 1) + i) as u32;
        let mut connectivity = Vec::new();
        for j in 0..n {
            for i in 0..n {
                connectivity.extend([
                    core_node(i, j),
                    core_node(i + 1, j),
                    core_node(i + 1, j + 1),
                    core_node(i, j + 1),
                ]);
            }
        }
        // The perimeter of the core counter-clockwise from its lower right corner, side by side.
        let perimeter = |k: usize| match (k / n, k % n) {
            (0, i) => core_node(n, i),
            (1, i) => core_node(n - i, n),
            (2, i) => core_node(0, n - i),
            (_, i) => core_node(i, 0),
        };
        let mut inner: Vec<u32> = (0..4 * n).map(perimeter).collect();
        let core_positions: Vec<Vector<2>> = inner.iter().map(|&a| nodes[a as usize]).collect();
        for ring in 1..=rings {
            let weight = ring as f64 / rings as f64;
            let first = nodes.len() as u32;
            for (k, &start) in core_positions.iter().enumerate() {
                let angle = (k as f64 / n as f64 - 0.5) * std::f64::consts::FRAC_PI_2;
                let end = centre + Vector::from([angle.cos(), angle.sin()]) * self.radius;
                nodes.push(start * (1.0 - weight) + end * weight);
            }
            let outer: Vec<u32> = (first..nodes.len() as u32).collect();
            for k in 0..4 * n {
                let next = (k + 1) % (4 * n);
                connectivity.extend([inner[k], outer[k], outer[next], inner[next]]);
            }
            inner = outer;
        }
        Mesh::new(nodes, vec![CellBlock { kind: CellKind::Quad4, connectivity }])
    }
}

/// The same body in tri3 cells: every quad4 cell is cut along its shorter diagonal.
///
/// # Errors
/// Only those of [`Mesh::new`], which a valid mesh does not meet.
pub fn triangulate(mesh: &Mesh<2>) -> Result<Mesh<2>, MeshError> {
    let mut connectivity = Vec::new();
    for block in mesh.blocks() {
        for cell in block.cells() {
            if let &[a, b, c, d] = cell {
                let length =
                    |p: u32, q: u32| (mesh.nodes()[p as usize] - mesh.nodes()[q as usize]).norm_squared();
                connectivity.extend(if length(a, c) <= length(b, d) {
                    [a, b, c, a, c, d]
                } else {
                    [a, b, d, b, c, d]
                });
            } else {
                connectivity.extend_from_slice(cell);
            }
        }
    }
    let block = CellBlock { kind: CellKind::Tri3, connectivity };
    Mesh::new(mesh.nodes().to_vec(), vec![block])?.with_ties(mesh.ties().to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disc_has_the_nodes_and_cells_of_its_o_grid() {
        let disc = Disc { centre: [2.0, 4.0], radius: 1.0, divisions: 8, rings: None };
        let mesh = disc.quadrilaterals().expect("valid");
        assert_eq!(mesh.nodes().len(), 209);
        assert_eq!(mesh.cell_count(), 64 + 128);
        assert_eq!(triangulate(&mesh).expect("valid").cell_count(), 2 * 192);
        let disc = Disc { divisions: 10, rings: Some(10), ..disc };
        assert_eq!(disc.quadrilaterals().expect("valid").nodes().len(), 521);
    }

    #[test]
    fn a_side_is_tied_to_the_one_opposite() {
        let mesh = grid([0.1, 0.2], [0.3, 0.7], [3, 2]).expect("valid");
        let tied = tie_sides(mesh.clone(), 0).expect("alike");
        let pairs: Vec<_> = tied.ties().iter().map(|t| (t.image, t.master)).collect();
        assert_eq!(pairs, [(3, 0), (7, 4), (11, 8)]);
        assert_eq!(triangulate(&tied).expect("valid").ties(), tied.ties());
        assert_eq!(tie_sides(mesh.clone(), 1).expect("alike").ties().len(), 4);
        let mut nodes = mesh.nodes().to_vec();
        nodes[7][1] += 0.1;
        let skewed = Mesh::new(nodes, mesh.blocks().to_vec()).expect("valid");
        assert_eq!(tie_sides(skewed, 0), Err(MeshError::UnlikeSides { direction: 0 }));
    }

    #[test]
    fn impossible_discs_and_grids_are_refused() {
        let disc = Disc { centre: [0.0; 2], radius: 1.0, divisions: 8, rings: None };
        assert!(Disc { radius: -1.0, ..disc }.quadrilaterals().is_err());
        assert!(Disc { divisions: 7, ..disc }.quadrilaterals().is_err());
        assert!(Disc { rings: Some(0), ..disc }.quadrilaterals().is_err());
        assert!(Disc { divisions: usize::MAX - 1, ..disc }.quadrilaterals().is_err());
        assert!(grid([0.0; 2], [1.0; 2], [usize::MAX, 2]).is_err());
        assert!(grid([0.0; 2], [1.0, 0.0], [1, 1]).is_err());
        assert!(grid([0.0; 3], [1.0; 3], [1, 0, 1]).is_err());
    }
}
