use super::check::{check, check_size, is_length};
use super::lattice::{Block, Lattice, span, unravel};
use crate::{CellKind, Mesh, MeshError, Vector};

/// An upright box, or a rectangle in 2D, of equal cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid<const D: usize> {
    /// Corner of the smallest coordinates [m].
    pub corner: [f64; D],
    /// Sides [m].
    pub size: [f64; D],
    /// Cells along each side.
    pub divisions: [usize; D],
}

impl<const D: usize> Grid<D> {
    /// The box in these cells, with the sets left and right (x), in 3D front and back (y), and bottom and top (the last direction).
    ///
    /// # Errors
    /// If a size is not positive, a direction has no divisions, there are too many, or the cells are not of dimension `D`.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<D>, MeshError> {
        let Self { corner, size, divisions } = *self;
        let sides_are_lengths = size.iter().all(|&side| is_length(side));
        check(sides_are_lengths, "size", &size, "every side must be longer than 0 m")?;
        let some = !divisions.contains(&0);
        check(some, "divisions", &divisions, "at least 1 cell is needed in every direction")?;
        check_size(divisions.iter().map(|&d| d as f64).product(), &divisions)?;
        let intervals = divisions.map(|d| d * span(kind));
        let counts = intervals.map(|n| n + 1);
        let points = (0..counts.iter().product())
            .map(|n| {
                let place = unravel(n, counts);
                Vector::from_fn(|k, _| corner[k] + size[k] * place[k] as f64 / intervals[k] as f64)
            })
            .collect();
        let point = |place: [usize; D]| (0..D).rev().fold(0, |n, k| n * counts[k] + place[k]) as u32;
        let lattice = Lattice { points, blocks: vec![Block::new(intervals, point)] };
        let sides = [["left", "right"], ["front", "back"], ["bottom", "top"]];
        Ok(lattice
            .mesh(kind)?
            .with_sides(std::array::from_fn(|axis| if axis + 1 == D { sides[2] } else { sides[axis] })))
    }
}

/// A [`Grid`] of quad4 cells in 2D, hex8 in 3D.
///
/// # Errors
/// Those of [`Grid::mesh`].
pub fn grid<const D: usize>(
    corner: [f64; D],
    size: [f64; D],
    divisions: [usize; D],
) -> Result<Mesh<D>, MeshError> {
    let kind = if D == 2 { CellKind::Quad4 } else { CellKind::Hex8 };
    Grid { corner, size, divisions }.mesh(kind)
}
