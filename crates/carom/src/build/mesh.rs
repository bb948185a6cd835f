use carom_mesh::{Mesh, MeshError, generate};

use crate::error::InputError;
use crate::scenario::{MeshSpec, PlaneCell};

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
    let (mesh, cell) = match *spec {
        MeshSpec::Disc { centre, radius, divisions, rings, cell } => {
            (generate::Disc { centre, radius, divisions, rings }.quadrilaterals()?, cell)
        }
        MeshSpec::Rectangle { corner, size, divisions, cell, periodic } => {
            let mesh = generate::grid(corner, size, divisions)?;
            (if periodic { generate::tie_sides(mesh, 0)? } else { mesh }, cell)
        }
        _ => return Ok(None),
    };
    let mesh = match cell {
        PlaneCell::Quad4 => mesh,
        PlaneCell::Tri3 => generate::triangulate(&mesh)?,
    };
    Ok(Some(match spec {
        MeshSpec::Rectangle { .. } => mesh.with_sides([["left", "right"], ["bottom", "top"]]),
        _ => mesh.with_facet_set("surface", |_| true),
    }))
}

/// Shapes in space.
fn solid(spec: &MeshSpec) -> Result<Option<Mesh<3>>, MeshError> {
    Ok(match *spec {
        MeshSpec::Box { corner, size, divisions } => {
            let sides = [["left", "right"], ["front", "back"], ["bottom", "top"]];
            Some(generate::grid(corner, size, divisions)?.with_sides(sides))
        }
        _ => None,
    })
}
