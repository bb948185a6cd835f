//! Which cells of a body are of which material.

use std::borrow::Cow;
use std::sync::Arc;

use carom_mesh::{CellBlock, Matrix, Mesh, Vector};

use crate::material::PointLaw;
use crate::shape_table::{Cells, Depth, volume_of};
use crate::{BodySpec, FemError};

/// What a body has of one of its materials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OfMaterial {
    /// Number of its cells.
    pub cells: usize,
    /// Their volume in the reference configuration [m³].
    pub volume: f64,
    /// Their mass [kg].
    pub mass: f64,
    /// Speed of pressure waves in the reference configuration [m/s].
    pub wave_speed: f64,
    /// Speed of shear waves [m/s].
    pub shear_wave_speed: f64,
    /// The shortest distance between neighbouring nodes along an edge of its cells [m].
    pub smallest_edge: f64,
}

/// The laws of the materials of a body: of the rest, then of its regions.
///
/// # Errors
/// If a constant is out of range, or one body cannot be of all of them.
pub(crate) fn laws<const D: usize>(spec: &BodySpec) -> Result<Vec<Arc<dyn PointLaw<D>>>, FemError> {
    let of = |spec: &BodySpec| {
        spec.check::<D>()?;
        spec.law.point_law::<D>(spec.hypothesis)
    };
    let laws = spec.by_material().iter().map(of).collect::<Result<Vec<_>, _>>()?;
    if laws.iter().any(|law| law.is_objective() != laws[0].is_objective()) {
        return Err(FemError::Mixed {
            what: "are some of small, some of large displacements",
            remedy: "the body turns or it does not; give all of them \"linear-elastic\", or none",
        });
    }
    if spec.regions.iter().any(|region| region.damping.mass != spec.damping.mass) {
        return Err(FemError::Mixed {
            what: "differ in damping.mass",
            remedy: "it brakes the flight of the whole body; give all of them the same, and damp each by damping.stiffness",
        });
    }
    Ok(laws)
}

/// What the body has of each of its materials.
///
/// # Errors
/// If a cell is inverted or degenerate.
pub(crate) fn materials_of<const D: usize>(
    mesh: &Mesh<D>,
    depth: Depth,
    spec: &BodySpec,
    laws: &[Arc<dyn PointLaw<D>>],
) -> Result<Vec<OfMaterial>, FemError> {
    // Of every rank's cells: what a body is does not depend on who has them.
    let spec = &BodySpec { share: None, ..spec.clone() };
    let mut all = Vec::new();
    for (index, (of, law)) in spec.by_material().iter().zip(laws).enumerate() {
        let (_, tangent) = law.stress_and_tangent(&Matrix::identity());
        let speed = |modulus: f64| (modulus / of.density).sqrt();
        let (mut cells, mut volume, mut smallest_edge) = (0, 0.0, f64::INFINITY);
        for_each_piece_of(index, mesh, depth, spec, |piece, _| {
            cells += piece.numbers.len();
            volume += volume_of(piece)?;
            for nodes in piece.block.cells() {
                let at = |a: usize| -> Vector<D> { mesh.nodes()[nodes[a] as usize] };
                smallest_edge = piece.block.kind.smallest_edge(&at).min(smallest_edge);
            }
            Ok(())
        })?;
        all.push(OfMaterial {
            cells,
            volume,
            mass: volume * of.density,
            wave_speed: speed(tangent[0][0][0][0]),
            shear_wave_speed: speed(tangent[0][1][0][1]),
            smallest_edge,
        });
    }
    Ok(all)
}

/// Does something with the cells of every block of a mesh, material by material, each with a body that is all of that material.
pub(crate) fn for_each_piece<const D: usize>(
    mesh: &Mesh<D>,
    depth: Depth,
    spec: &BodySpec,
    mut with: impl FnMut(&Cells<'_, D>, &BodySpec) -> Result<(), FemError>,
) -> Result<(), FemError> {
    (0..=spec.regions.len()).try_for_each(|index| for_each_piece_of(index, mesh, depth, spec, &mut with))
}

/// The same with those of material number `index` alone: 0 is that of the rest.
pub(crate) fn for_each_piece_of<const D: usize>(
    index: usize,
    mesh: &Mesh<D>,
    depth: Depth,
    spec: &BodySpec,
    mut with: impl FnMut(&Cells<'_, D>, &BodySpec) -> Result<(), FemError>,
) -> Result<(), FemError> {
    let own = match index {
        0 => Cow::Borrowed(spec),
        _ => Cow::Owned(spec.all_of(&spec.regions[index - 1])),
    };
    let materials = materials_of_cells(mesh, spec);
    let mut first = 0;
    for block in mesh.blocks() {
        let count = block.cells().len();
        let all = first as u32..(first + count) as u32;
        let is_own = |cell: u32| spec.share.as_ref().is_none_or(|share| share.owns[cell as usize]);
        let numbers: Vec<u32> =
            all.filter(|&cell| materials[cell as usize] == index && is_own(cell)).collect();
        let region = if numbers.len() == count {
            Cow::Borrowed(block)
        } else {
            let nodes = block.kind.node_count();
            let of = |&cell: &u32| {
                let start = (cell as usize - first) * nodes;
                block.connectivity[start..start + nodes].iter().copied()
            };
            Cow::Owned(CellBlock { kind: block.kind, connectivity: numbers.iter().flat_map(of).collect() })
        };
        if !numbers.is_empty() {
            with(&Cells { mesh, block: &region, numbers: &numbers, depth }, &own)?;
        }
        first += count;
    }
    Ok(())
}

/// The number of the material of every cell.
fn materials_of_cells<const D: usize>(mesh: &Mesh<D>, spec: &BodySpec) -> Vec<usize> {
    let mut materials = vec![0; mesh.cell_count()];
    for (index, region) in spec.regions.iter().enumerate() {
        for &cell in &region.cells {
            if let Some(material) = materials.get_mut(cell as usize) {
                *material = index + 1;
            }
        }
    }
    materials
}
