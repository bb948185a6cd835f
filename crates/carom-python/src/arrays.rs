//! Nodal and cell data as NumPy arrays.

use carom_mesh::{Mesh, Vector};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One row per vector.
pub fn vectors<'py, const D: usize>(py: Python<'py>, v: &[Vector<D>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: &[f64] = bytemuck::cast_slice(v);
    PyArray1::from_slice(py, flat).reshape([v.len(), D])
}

/// One row of `width` numbers after the other.
pub fn table(py: Python<'_>, values: Vec<f64>, width: usize) -> PyResult<Bound<'_, PyArray2<f64>>> {
    let rows = values.len() / width;
    PyArray1::from_vec(py, values).reshape([rows, width])
}

/// The meshes of all bodies as one unstructured grid in VTK's numbering.
pub fn grid<'py, 'a, const D: usize>(
    py: Python<'py>,
    points: &[Vector<D>],
    meshes: impl Iterator<Item = (usize, &'a Mesh<D>)>,
) -> PyResult<Bound<'py, PyDict>> {
    let (mut connectivity, mut offsets, mut types, mut body) = (vec![], vec![0_i64], vec![], vec![]);
    for (index, (first_node, mesh)) in meshes.enumerate() {
        for block in mesh.blocks() {
            for cell in block.cells() {
                connectivity.extend(cell.iter().map(|&n| i64::from(n) + first_node as i64));
                offsets.push(connectivity.len() as i64);
                types.push(block.kind.reference().vtk_type);
                body.push(index as i32);
            }
        }
    }
    let grid = PyDict::new(py);
    grid.set_item("points", vectors(py, points)?)?;
    grid.set_item("connectivity", PyArray1::from_vec(py, connectivity))?;
    grid.set_item("offsets", PyArray1::from_vec(py, offsets))?;
    grid.set_item("types", PyArray1::from_vec(py, types))?;
    grid.set_item("body", PyArray1::from_vec(py, body))?;
    Ok(grid)
}
