use carom_mesh::{CellKind, Mesh, MeshError, generate};

use crate::error::InputError;
use crate::scenario::{Cell, MeshSpec};

/// The mesh that `spec`, under `key` in the case file, describes; `given` is the one that was read from a file.
pub(super) fn mesh<const D: usize>(
    key: &str,
    spec: &MeshSpec,
    given: Option<Mesh<D>>,
) -> Result<Mesh<D>, InputError> {
    if let MeshSpec::File { file, .. } = spec {
        let remedy = "pass the mesh of every body that comes from a file along with the scenario";
        return given.ok_or_else(|| InputError::mesh(format!("{key}.file"), format!("{file:?}: {remedy}")));
    }
    if matches!(spec, MeshSpec::Given) {
        let message = "the mesh of a body of another code comes along with it; give its cells";
        return given.ok_or_else(|| InputError::mesh(key, message));
    }
    let shape = spec.name();
    let wrong = || {
        let message = format!("a {shape} is no body in {D}D; choose another shape or set `dimension`");
        InputError::mesh(format!("{key}.kind"), message)
    };
    match D {
        2 => plane(spec).map(|m| m.and_then(Mesh::in_space)),
        _ => solid(spec).map(|m| m.and_then(Mesh::in_space)),
    }
    .map_err(|e| match e {
        MeshError::Generator { parameter, .. } => {
            InputError::mesh(format!("{key}.{parameter}"), e.to_string())
        }
        _ => InputError::mesh(key, e.to_string()),
    })?
    .ok_or_else(wrong)
}

/// Shapes in the plane.
fn plane(spec: &MeshSpec) -> Result<Option<Mesh<2>>, MeshError> {
    let kind = |cell: Option<Cell>| cell.map_or(CellKind::Quad4, |cell| cell.0);
    let mesh = match *spec {
        MeshSpec::Disc { centre, radius, divisions, rings, cell } => {
            generate::Disc { centre, radius, divisions, rings }.mesh(kind(cell))?
        }
        MeshSpec::Rectangle { corner, size, divisions, cell, periodic } => {
            let mesh = generate::Grid { corner, size, divisions }.mesh(kind(cell))?;
            if periodic { generate::tie_sides(mesh, 0)? } else { mesh }
        }
        MeshSpec::Ring { centre, inner_radius, outer_radius, divisions, cell } => {
            generate::Ring { centre, inner_radius, outer_radius, divisions }.mesh(kind(cell))?
        }
        _ => return Ok(None),
    };
    Ok(Some(mesh))
}

/// Shapes in space.
fn solid(spec: &MeshSpec) -> Result<Option<Mesh<3>>, MeshError> {
    let kind = |cell: Option<Cell>| cell.map_or(CellKind::Hex8, |cell| cell.0);
    let mesh = match *spec {
        MeshSpec::Box { corner, size, divisions, cell } => {
            generate::Grid { corner, size, divisions }.mesh(kind(cell))?
        }
        MeshSpec::Ball { centre, radius, divisions, rings, cell } => {
            generate::Ball { centre, radius, divisions, rings }.mesh(kind(cell))?
        }
        MeshSpec::Cylinder { base, axis, radius, height, divisions, rings, layers, cell } => {
            let axis = generate::Axis { base, direction: axis, height };
            generate::Cylinder { axis, radius, divisions, rings, layers }.mesh(kind(cell))?
        }
        MeshSpec::Tube { base, axis, inner_radius, outer_radius, height, divisions, cell } => {
            let axis = generate::Axis { base, direction: axis, height };
            generate::Tube { axis, inner_radius, outer_radius, divisions }.mesh(kind(cell))?
        }
        _ => return Ok(None),
    };
    Ok(Some(mesh))
}
