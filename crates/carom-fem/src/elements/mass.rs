use carom_mesh::CellKind;

use crate::FemError;
use crate::elements::with_node_count;
use crate::quadrature::Integrand;
use crate::shape_table::{Cells, ShapeTable};
use crate::sparse::NodalMatrix;

/// Adds the consistent mass ∫ρ N_a N_b dV [kg] of `cells` with `density` ρ [kg/m³] to `m`.
///
/// # Errors
/// If a cell is inverted or degenerate.
pub fn add_mass<const D: usize>(
    cells: &Cells<'_, D>,
    density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    with_node_count!(D, cells.block.kind, N => add_mass_of::<D, N>(cells, density, m))
}

/// Adds a lumped mass [kg] of `cells` to the diagonal of `m`. It is that of the consistent mass, scaled cell by cell so that
/// no mass is lost (Hinton, Rock & Zienkiewicz 1976).
///
/// Row sums, which lump linear cells, would give corners of quadratic cells no mass or a negative one.
///
/// # Errors
/// If a cell is inverted or degenerate.
pub fn add_scaled_diagonal_mass<const D: usize>(
    cells: &Cells<'_, D>,
    density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    with_node_count!(D, cells.block.kind, N => add_scaled_diagonal_mass_of::<D, N>(cells, density, m))
}

fn add_mass_of<const D: usize, const N: usize>(
    cells: &Cells<'_, D>,
    density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    let table = ShapeTable::<D, N>::new(cells, Integrand::Values)?;
    for (cell, nodes) in cells.block.cells().enumerate() {
        for (p, values) in table.values.iter().enumerate() {
            let weight = density * table.weights[cell * table.points_per_cell + p];
            for a in 0..N {
                for b in 0..N {
                    let entry = m.graph().entry(nodes[a], nodes[b]);
                    m.values[entry] += weight * values[a] * values[b];
                }
            }
        }
    }
    Ok(())
}

fn add_scaled_diagonal_mass_of<const D: usize, const N: usize>(
    cells: &Cells<'_, D>,
    density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    let table = ShapeTable::<D, N>::new(cells, Integrand::Values)?;
    for (cell, nodes) in cells.block.cells().enumerate() {
        let weights = &table.weights[cell * table.points_per_cell..(cell + 1) * table.points_per_cell];
        let mut diagonal = [0.0; N];
        for (values, weight) in table.values.iter().zip(weights) {
            for a in 0..N {
                diagonal[a] += weight * values[a] * values[a];
            }
        }
        let scale = density * weights.iter().sum::<f64>() / diagonal.iter().sum::<f64>();
        for a in 0..N {
            let entry = m.graph().entry(nodes[a], nodes[a]);
            m.values[entry] += scale * diagonal[a];
        }
    }
    Ok(())
}
