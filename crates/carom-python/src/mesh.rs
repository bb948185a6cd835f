//! Meshes and surfaces from NumPy arrays.

use std::collections::{BTreeMap, BTreeSet};

use carom::{InputError, Meshes};
use carom_mesh::sets::facet_key;
use carom_mesh::{CellBlock, CellKind, Mesh, Sets, Vector};
use numpy::ndarray::ArrayView1;
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays;
use crate::error::input_error;

/// A mesh as `carom.mesh_file.MeshArrays` holds it.
#[derive(FromPyObject)]
struct MeshArrays<'py> {
    /// Reference positions [m], shape [nodes, D].
    points: PyReadonlyArray2<'py, f64>,
    /// Kind and nodes of the cells of each block, shape [cells, nodes per cell].
    blocks: Vec<(String, PyReadonlyArray2<'py, i64>)>,
    node_sets: BTreeMap<String, PyReadonlyArray1<'py, i64>>,
    /// Nodes of the facets, one array for each kind of facet.
    facet_sets: BTreeMap<String, Vec<PyReadonlyArray2<'py, i64>>>,
    cell_sets: BTreeMap<String, PyReadonlyArray1<'py, i64>>,
}

/// A surface as `carom.mesh_file.SurfaceArrays` holds it.
#[derive(FromPyObject)]
struct SurfaceArrays<'py> {
    /// Vertices [m], shape [vertices, 3].
    points: PyReadonlyArray2<'py, f64>,
    /// Vertices of the triangles, shape [triangles, 3].
    triangles: PyReadonlyArray2<'py, i64>,
}

/// Vertices and triangles by the names of obstacles.
type Surfaces = BTreeMap<String, (Vec<Vector<3>>, Vec<[u32; 3]>)>;

/// The meshes of a dictionary with the names of bodies as keys.
pub fn meshes<const D: usize>(py: Python<'_>, given: Option<&Bound<'_, PyDict>>) -> PyResult<Meshes<D>> {
    let mut meshes = Meshes::new();
    for (name, arrays) in given.into_iter().flatten() {
        let name: String = name.extract()?;
        let mesh = mesh(&arrays.extract()?)?.map_err(|message| {
            let error =
                InputError { is_mesh: true, ..InputError::new(format!("bodies.{name}.mesh"), message) };
            input_error(py, &error)
        })?;
        meshes.insert(name, mesh);
    }
    Ok(meshes)
}

/// The surfaces of a dictionary with the names of obstacles as keys.
pub fn surfaces(given: Option<&Bound<'_, PyDict>>) -> PyResult<Surfaces> {
    let mut surfaces = Surfaces::new();
    for (name, arrays) in given.into_iter().flatten() {
        let arrays: SurfaceArrays<'_> = arrays.extract()?;
        let vertices = arrays::from_rows(&arrays.points, arrays.points.as_array().nrows())?;
        let triangles = arrays.triangles.as_array();
        let (shape, wanted) = (triangles.dim(), (triangles.nrows(), 3));
        if shape != wanted {
            return Err(PyValueError::new_err(format!("shape {shape:?} instead of {wanted:?}")));
        }
        let triangle = |t: ArrayView1<'_, i64>| Ok([index(t[0])?, index(t[1])?, index(t[2])?]);
        let triangles = triangles.rows().into_iter().map(triangle).collect::<PyResult<_>>()?;
        surfaces.insert(name.extract()?, (vertices, triangles));
    }
    Ok(surfaces)
}

fn mesh<const D: usize>(arrays: &MeshArrays<'_>) -> PyResult<Result<Mesh<D>, String>> {
    let points = arrays.points.as_array();
    if points.ncols() != D {
        return Err(PyValueError::new_err(format!("points have {} columns, not {D}", points.ncols())));
    }
    let nodes = points.rows().into_iter().map(|x| Vector::from_fn(|i, _| x[i])).collect();
    let mut blocks = Vec::new();
    for (name, cells) in &arrays.blocks {
        let cells = cells.as_array();
        let kind = CellKind::ALL.into_iter().find(|k| k.reference().name == name);
        let kind = kind.filter(|k| k.node_count() == cells.ncols());
        let kind =
            kind.ok_or_else(|| PyValueError::new_err(format!("no cell {name} of {} nodes", cells.ncols())))?;
        let connectivity = cells.iter().map(|&n| index(n)).collect::<PyResult<_>>()?;
        blocks.push(CellBlock { kind, connectivity });
    }
    let flat = |sets: &BTreeMap<String, PyReadonlyArray1<'_, i64>>| {
        let set = |(name, set): (&String, &PyReadonlyArray1<'_, i64>)| {
            let members = set.as_array().iter().map(|&n| index(n)).collect::<PyResult<BTreeSet<u32>>>()?;
            Ok((name.clone(), members.into_iter().collect()))
        };
        sets.iter().map(set).collect::<PyResult<BTreeMap<String, Vec<u32>>>>()
    };
    let mut sets =
        Sets { nodes: flat(&arrays.node_sets)?, cells: flat(&arrays.cell_sets)?, facets: BTreeMap::new() };
    for (name, kinds) in &arrays.facet_sets {
        let facets = sets.facets.entry(name.clone()).or_default();
        for kind in kinds {
            for facet in kind.as_array().rows() {
                let nodes = facet.iter().map(|&n| index(n)).collect::<PyResult<Vec<u32>>>()?;
                facets.insert(facet_key(&nodes));
            }
        }
    }
    let mesh = Mesh::new(nodes, blocks).and_then(|m| m.with_sets(sets));
    Ok(mesh.map_err(|e| e.to_string()))
}

fn index(value: i64) -> PyResult<u32> {
    u32::try_from(value).map_err(|_| PyValueError::new_err(format!("{value} is no index")))
}
