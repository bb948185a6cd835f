//! Parts of bodies that are of other materials than the rest.

use carom_fem::RegionSpec;
use carom_mesh::sets::ALL;
use carom_mesh::{Mesh, Vector};

use super::values::vector;
use crate::error::InputError;
use crate::scenario::{BodyEntry, MaterialSpec, RegionEntry, Scenario};

/// The material `name`, given under `key`.
pub(super) fn material<'a>(
    scenario: &'a Scenario,
    key: &str,
    name: &str,
) -> Result<&'a MaterialSpec, InputError> {
    scenario.materials.get(name).ok_or_else(|| {
        let known: Vec<&str> = scenario.materials.keys().map(String::as_str).collect();
        InputError::new(key, format!("there is no material {name:?}; known are {known:?}"))
    })
}

/// The regions of a body under `key`: no cell is of two, and one at least is of none.
pub(super) fn regions<const D: usize>(
    scenario: &Scenario,
    key: &str,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
) -> Result<Vec<RegionSpec>, InputError> {
    let mut region_of: Vec<Option<usize>> = vec![None; mesh.cell_count()];
    let mut regions = Vec::new();
    for (index, region) in entry.regions.iter().enumerate() {
        let key = format!("{key}.regions.{index}");
        let MaterialSpec { law, density, damping, viscosity } =
            material(scenario, &format!("{key}.material"), &region.material)?.clone();
        let cells = cells(&key, entry, region, mesh)?;
        for &cell in &cells {
            if let Some(other) = region_of[cell as usize].replace(index).filter(|&other| other != index) {
                let message = format!(
                    "cell {cell} of body {:?} is of region {other} too; a cell has one material",
                    entry.name
                );
                return Err(InputError::new(key, message));
            }
        }
        regions.push(RegionSpec { cells, law, density, damping, viscosity });
    }
    if region_of.iter().all(Option::is_some) {
        let message = format!(
            "every cell of body {:?} is of a region, none of its material {:?}; make that the material of a region, and leave the region out",
            entry.name,
            entry.material.as_deref().unwrap_or_default()
        );
        return Err(InputError::new(format!("{key}.material"), message));
    }
    Ok(regions)
}

/// The cells of a region.
fn cells<const D: usize>(
    key: &str,
    entry: &BodyEntry,
    region: &RegionEntry,
    mesh: &Mesh<D>,
) -> Result<Vec<u32>, InputError> {
    let refused = |at: &str, message: String| InputError::new(format!("{key}.{at}"), message);
    match (&region.on, &region.corner, &region.size) {
        (Some(name), None, None) => {
            let sets = &mesh.sets().cells;
            sets.get(name).filter(|cells| !cells.is_empty() && name != ALL).cloned().ok_or_else(|| {
                let known: Vec<&String> = sets.keys().collect();
                let message = if known.is_empty() {
                    format!("{name:?}: the mesh of body {:?} has no sets of cells; give `corner` and `size` of a box", entry.name)
                } else {
                    format!("{name:?}: body {:?} has no such set of cells; known are {known:?}", entry.name)
                };
                refused("on", message)
            })
        }
        (None, Some(corner), Some(size)) => {
            let low: Vector<D> = vector(&format!("{key}.corner"), corner)?;
            let high = low + vector::<D>(&format!("{key}.size"), size)?;
            let middle = |cell: &[u32]| -> Vector<D> {
                cell.iter().map(|&n| mesh.nodes()[n as usize]).sum::<Vector<D>>() / cell.len() as f64
            };
            let is_in = |x: Vector<D>| (0..D).all(|i| low[i] <= x[i] && x[i] <= high[i]);
            let all = mesh.blocks().iter().flat_map(|block| block.cells());
            let inside: Vec<u32> =
                (0..).zip(all).filter(|(_, cell)| is_in(middle(cell))).map(|(number, _)| number).collect();
            if inside.is_empty() {
                let message = format!(
                    "no cell of body {:?} has its middle in this box; its nodes are between {:?} and {:?}",
                    entry.name,
                    mesh.bounds().0.as_slice(),
                    mesh.bounds().1.as_slice()
                );
                return Err(refused("corner", message));
            }
            Ok(inside)
        }
        _ => Err(InputError::new(
            key,
            "a region is a set of cells, `on`, or a box with `corner` and `size`; give one of them",
        )),
    }
}
