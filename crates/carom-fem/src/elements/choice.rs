//! Which elements and dashpots a body is made of.

use carom_mesh::CellKind;

use super::block::Block;
use super::dashpots::{Dashpots, ViscousBlock};
use super::grid::Grid;
use super::kinematics::{Embedded, Solid};
use super::mean_dilatation::MeanDilatation;
use super::{Elements, with_node_count};
use crate::shape_table::Cells;
use crate::sparse::NodeGraph;
use crate::{BodySpec, FemError, Formulation, Hypothesis};

/// The elements of `cells` in a body like `spec` with this `graph`.
///
/// # Errors
/// If a material constant is out of range, a cell is inverted or degenerate, or the formulation is not one for these cells.
pub fn elements<const D: usize>(
    spec: &BodySpec,
    cells: &Cells<'_, D>,
    graph: &NodeGraph,
) -> Result<Box<dyn Elements<D>>, FemError> {
    let kind = cells.block.kind;
    match (spec.formulation, spec.hypothesis) {
        (Formulation::MeanDilatation, hypothesis) => {
            let law = spec.point_law::<3>(Hypothesis::PlaneStrain)?;
            let refuse = |remedy| FemError::Formulation { cell: kind.reference().name, remedy };
            if hypothesis == Hypothesis::PlaneStress {
                return Err(refuse("a sheet in plane stress does not lock; leave the formulation out"));
            }
            if !law.is_objective() {
                return Err(refuse("it needs a law of large displacements, such as saint-venant-kirchhoff"));
            }
            match kind {
                CellKind::Quad4 => {
                    Ok(Box::new(MeanDilatation::<D, 4, Embedded> { law, grid: Grid::new(cells, graph)? }))
                }
                CellKind::Hex8 => {
                    Ok(Box::new(MeanDilatation::<D, 8, Embedded> { law, grid: Grid::new(cells, graph)? }))
                }
                _ if kind.is_quadratic() => {
                    Err(refuse("quadratic cells hardly lock; leave the formulation out"))
                }
                _ => Err(refuse("mesh the body with quad4, hex8 or quadratic cells")),
            }
        }
        // What grows across the plane is held there: the law has to see F₃₃ = 1 less growth.
        (Formulation::Standard, hypothesis)
            if hypothesis == Hypothesis::Axisymmetric
                || D == 2 && hypothesis == Hypothesis::PlaneStrain && spec.grows =>
        {
            let law = spec.point_law::<3>(spec.hypothesis)?;
            match D {
                2 => Ok(with_node_count!(2, kind, N => {
                    Box::new(Block::<D, 3, N, Embedded> { law, grid: Grid::new(cells, graph)? })
                })),
                _ => Err(FemError::Hypothesis { name: "axisymmetric" }),
            }
        }
        (Formulation::Standard, _) => {
            let law = spec.point_law::<D>(spec.hypothesis)?;
            Ok(with_node_count!(D, kind, N => {
                Box::new(Block::<D, D, N, Solid> { law, grid: Grid::new(cells, graph)? })
            }))
        }
    }
}

/// The viscous resistance of `cells` in a body like `spec`; `objective` says whether its law is one of large displacements.
///
/// # Errors
/// If a cell is inverted or degenerate, or the body is a sheet in plane stress, whose change of thickness is not known.
pub fn dashpots<const D: usize>(
    spec: &BodySpec,
    objective: bool,
    cells: &Cells<'_, D>,
    graph: &NodeGraph,
) -> Result<Box<dyn Dashpots<D>>, FemError> {
    let viscosity = spec.viscosity;
    match spec.hypothesis {
        Hypothesis::PlaneStrain => Ok(with_node_count!(D, cells.block.kind, N => {
            Box::new(ViscousBlock::<D, D, N, Solid> { viscosity, objective, grid: Grid::new(cells, graph)? })
        })),
        Hypothesis::Axisymmetric => match D {
            2 => Ok(with_node_count!(2, cells.block.kind, N => {
                Box::new(ViscousBlock::<D, 3, N, Embedded> { viscosity, objective, grid: Grid::new(cells, graph)? })
            })),
            _ => Err(FemError::Hypothesis { name: "axisymmetric" }),
        },
        Hypothesis::PlaneStress => Err(FemError::PlaneStress { what: "viscosity" }),
    }
}
