//! Nodal and cell data as NumPy arrays.

use carom::{ModelBody, VibrationEnergies};
use carom_mesh::{CellKind, Mesh, Surface, Vector};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// One row per vector.
pub fn vectors<'py, const D: usize>(py: Python<'py>, v: &[Vector<D>]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: &[f64] = bytemuck::cast_slice(v);
    PyArray1::from_slice(py, flat).reshape([v.len(), D])
}

/// One vector per row of an array of shape [count, D]; ValueError if it has another.
pub fn from_rows<const D: usize>(
    array: &PyReadonlyArray2<'_, f64>,
    count: usize,
) -> PyResult<Vec<Vector<D>>> {
    let rows = array.as_array();
    if rows.dim() != (count, D) {
        return Err(PyValueError::new_err(format!("shape {:?} instead of {:?}", rows.dim(), (count, D))));
    }
    Ok(rows.rows().into_iter().map(|row| Vector::from_fn(|i, _| row[i])).collect())
}

/// Mass [kg] and stiffness [N/m] of a body where nothing has moved, as blocks of pairs of nodes, and which displacements are held.
pub fn matrices<'py, const D: usize>(py: Python<'py>, part: &ModelBody<D>) -> PyResult<Bound<'py, PyDict>> {
    let body = &part.body;
    let (graph, mass) = (body.graph(), body.mass());
    let stiffness = body.stiffness(&vec![Vector::zeros(); body.node_count()]);
    let (mut rows, mut columns) = (vec![0; graph.entry_count()], vec![0; graph.entry_count()]);
    for row in 0..graph.node_count() {
        for (entry, column) in graph.row(row) {
            (rows[entry], columns[entry]) = (row as i64, column as i64);
        }
    }
    let blocks = stiffness
        .values
        .iter()
        .flat_map(|block| (0..D).flat_map(move |i| (0..D).map(move |j| block[(i, j)])));
    let held = (0..body.node_count()).flat_map(|n| (0..D).map(move |i| body.held().holds(n, i)));
    let out = PyDict::new(py);
    out.set_item("rows", PyArray1::from_vec(py, rows))?;
    out.set_item("columns", PyArray1::from_vec(py, columns))?;
    out.set_item("mass", PyArray1::from_slice(py, &mass.values))?;
    out.set_item("stiffness", table(py, blocks.collect(), D * D)?)?;
    out.set_item("held", PyArray1::from_iter(py, held))?;
    Ok(out)
}

/// The vibrations of a reduced body.
pub fn vibrations<'py>(py: Python<'py>, own: &VibrationEnergies) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("frequencies", PyArray1::from_slice(py, &own.frequencies))?;
    out.set_item("kinetic", PyArray1::from_slice(py, &own.kinetic))?;
    out.set_item("strain", PyArray1::from_slice(py, &own.strain))?;
    out.set_item("rigid", own.rigid)?;
    Ok(out)
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
    let mut cells = Cells::default();
    for (index, (first_node, mesh)) in meshes.enumerate() {
        for block in mesh.blocks() {
            for cell in block.cells() {
                cells.push(index, first_node, cell, block.kind);
            }
        }
    }
    cells.grid(py, points)
}

/// The facets of all bodies that may touch others as one unstructured grid.
pub fn surface_grid<'py, 'a, const D: usize>(
    py: Python<'py>,
    points: &[Vector<D>],
    surfaces: impl Iterator<Item = (usize, &'a Surface)>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut cells = Cells::default();
    for (index, (first_node, surface)) in surfaces.enumerate() {
        surface.facets().iter().for_each(|f| cells.push(index, first_node, &f.nodes, f.kind));
    }
    cells.grid(py, points)
}

/// Cells as VTK wants them.
#[derive(Default)]
struct Cells {
    connectivity: Vec<i64>,
    ends: Vec<i64>,
    types: Vec<u8>,
    body: Vec<i32>,
}

impl Cells {
    fn push(&mut self, body: usize, first_node: usize, nodes: &[u32], kind: CellKind) {
        self.connectivity.extend(nodes.iter().map(|&n| i64::from(n) + first_node as i64));
        self.ends.push(self.connectivity.len() as i64);
        self.types.push(kind.reference().vtk_type);
        self.body.push(body as i32);
    }

    fn grid<'py, const D: usize>(
        self,
        py: Python<'py>,
        points: &[Vector<D>],
    ) -> PyResult<Bound<'py, PyDict>> {
        let grid = PyDict::new(py);
        grid.set_item("points", vectors(py, points)?)?;
        grid.set_item("connectivity", PyArray1::from_vec(py, self.connectivity))?;
        grid.set_item("offsets", PyArray1::from_iter(py, std::iter::once(0).chain(self.ends)))?;
        grid.set_item("types", PyArray1::from_vec(py, self.types))?;
        grid.set_item("body", PyArray1::from_vec(py, self.body))?;
        Ok(grid)
    }
}
