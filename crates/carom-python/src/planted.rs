//! Contact in somebody else's time loop: arrays by the caller's numbers in, arrays out.

use carom::{ForeignMass, Outline, PlantedSpec, StepError};
use carom_contact::{Candidate, Site};
use carom_friction::Matrix;
use carom_mesh::Vector;
use numpy::{PyArray1, PyArray3, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::dimension::{Dimension, with};
use crate::error::{input_error, step_error};
use crate::threads::detached;
use crate::{arrays, friction, mesh};

/// Surfaces, obstacles and pairs, and what is known of the contacts of the present step. `carom.contact.ContactModel` checks what it is given.
#[pyclass(module = "carom._carom")]
pub struct PlantedContact {
    inner: Dimension<carom::PlantedContact<2>, carom::PlantedContact<3>>,
}

/// The mass of bodies, as a `carom.contact.mass.Mass` says it, and the first exception.
struct Mass {
    object: Py<PyAny>,
    of_nodes: Vec<f64>,
    failed: Option<PyErr>,
}

impl Mass {
    fn new(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let of_nodes: PyReadonlyArray1<'_, f64> = object.getattr("of_nodes")?.extract()?;
        Ok(Self { object: object.clone().unbind(), of_nodes: of_nodes.as_slice()?.to_vec(), failed: None })
    }
}

impl<const D: usize> ForeignMass<D> for Mass {
    fn of_node(&self, node: u32) -> f64 {
        self.of_nodes[node as usize]
    }

    fn jolt(&mut self, surface: usize, nodes: &[u32], impulse: &[Vector<D>], change: &mut [Vector<D>]) {
        let answer = Python::attach(|py| -> PyResult<Vec<Vector<D>>> {
            let nodes = PyArray1::from_iter(py, nodes.iter().map(|&n| i64::from(n)));
            let given = (surface, nodes, arrays::vectors(py, impulse)?);
            let answer: PyReadonlyArray2<'_, f64> =
                self.object.bind(py).call_method1("jolt", given)?.extract()?;
            arrays::from_rows(&answer, impulse.len())
        });
        match answer {
            Ok(answer) => change.copy_from_slice(&answer),
            Err(error) => {
                change.fill(Vector::zeros());
                self.failed.get_or_insert(error);
            }
        }
    }
}

/// A surface by its name, its facets kind by kind, and whether it may touch itself.
type Facets<'py> = (String, Vec<PyReadonlyArray2<'py, i64>>, bool);

fn outline((name, kinds, touches_itself): &Facets<'_>) -> PyResult<Outline> {
    Ok(Outline { name: name.clone(), facets: facets_of(kinds)?, touches_itself: *touches_itself })
}

/// Facets by their nodes, of all kinds.
pub fn facets_of(kinds: &[PyReadonlyArray2<'_, i64>]) -> PyResult<Vec<Vec<u32>>> {
    let number = |n: &i64| u32::try_from(*n).map_err(|_| PyValueError::new_err(format!("{n} is no node")));
    let mut facets = Vec::new();
    for kind in kinds {
        for row in kind.as_array().rows() {
            facets.push(row.iter().map(number).collect::<PyResult<_>>()?);
        }
    }
    Ok(facets)
}

/// One vector per row.
pub fn rows<const D: usize>(array: &PyReadonlyArray2<'_, f64>) -> PyResult<Vec<Vector<D>>> {
    arrays::from_rows(array, array.shape()[0])
}

#[pymethods]
impl PlantedContact {
    #[new]
    fn new(
        py: Python<'_>,
        spec: &str,
        points: PyReadonlyArray2<'_, f64>,
        surfaces: Vec<Facets<'_>>,
        held: PyReadonlyArray2<'_, bool>,
        files: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let spec: PlantedSpec =
            serde_json::from_str(spec).map_err(|e| PyValueError::new_err(format!("no contact: {e}")))?;
        let outlines = surfaces.iter().map(outline).collect::<PyResult<Vec<_>>>()?;
        fn build<const D: usize>(
            spec: &PlantedSpec,
            points: &PyReadonlyArray2<'_, f64>,
            outlines: &[Outline],
            held: &PyReadonlyArray2<'_, bool>,
            files: carom::Surfaces<D>,
        ) -> PyResult<Result<carom::PlantedContact<D>, carom::InputError>> {
            let held = held.as_array();
            let held: Vec<[bool; D]> =
                held.rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect();
            Ok(carom::PlantedContact::build(spec, &rows(points)?, outlines, &held, files))
        }
        let inner = match points.shape()[1] {
            3 => build(&spec, &points, &outlines, &held, mesh::surfaces(files)?)?.map(Dimension::Space),
            _ => build(&spec, &points, &outlines, &held, carom::Surfaces::new())?.map(Dimension::Plane),
        };
        Ok(Self { inner: inner.map_err(|e| input_error(py, &e))? })
    }

    /// The numbers of all pairs; none where they are many.
    fn all_pairs(&self) -> Vec<usize> {
        with!(&self.inner, planted => {
            let pairs = &planted.assembly().contact.pairs;
            if pairs.are_many() { Vec::new() } else { pairs.between().map(|b| pairs.place(b)).collect() }
        })
    }

    /// The two names of a pair by its number.
    fn pair_names(&self, number: usize) -> Option<[String; 2]> {
        with!(&self.inner, planted => {
            let assembly = planted.assembly();
            let between = assembly.contact.pairs.at_place(number)?;
            Some(between.map(|solid| assembly.solid_name(solid).to_string()))
        })
    }

    /// How many of what was found take part in the step.
    #[getter]
    fn count(&self) -> usize {
        with!(&self.inner, planted => planted.candidates().len())
    }

    #[getter]
    fn time(&self) -> f64 {
        with!(&self.inner, planted => planted.time())
    }

    /// Starts a step and finds what may touch in it.
    fn search(
        &mut self,
        py: Python<'_>,
        points: PyReadonlyArray2<'_, f64>,
        velocity: PyReadonlyArray2<'_, f64>,
        time_step: f64,
        reach: Option<f64>,
    ) -> PyResult<()> {
        with!(&mut self.inner, planted => {
            let (points, velocity) = (rows(&points)?, rows(&velocity)?);
            let found = detached(py, || planted.search(&points, &velocity, time_step, reach));
            found.map_err(|e| step_error::<2>(py, &e, None))
        })
    }

    /// The contacts that take part where the points are at the end of the step.
    fn evaluate<'py>(
        &mut self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        with!(&mut self.inner, planted => {
            let points = rows(&points)?;
            detached(py, || planted.evaluate(&points));
            describe(py, planted)
        })
    }

    /// Solves for the reactions with W [m/N], shape [n D, n D], from the motions without reactions [m], shape [n, D].
    fn solve<'py>(
        &mut self,
        py: Python<'py>,
        w: PyReadonlyArray2<'py, f64>,
        free: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        fn solve<'py, const D: usize>(
            py: Python<'py>,
            planted: &mut carom::PlantedContact<D>,
            w: &PyReadonlyArray2<'py, f64>,
            free: &PyReadonlyArray2<'py, f64>,
        ) -> PyResult<Bound<'py, PyDict>> {
            let count = planted.contacts().len();
            let (w, free) = (w.as_array(), arrays::from_rows(free, count)?);
            if w.dim() != (count * D, count * D) {
                return Err(PyValueError::new_err(format!("W has shape {:?}", w.dim())));
            }
            let block = |i: usize, j: usize| Matrix::from_fn(|a, b| w[(i * D + a, j * D + b)]);
            match detached(py, || planted.solve(block, &free)) {
                Ok(report) => {
                    let out = friction::describe(py, &report)?;
                    out.set_item("reactions", arrays::vectors(py, planted.reactions())?)?;
                    Ok(out)
                }
                Err(error) => Err(step_error(py, &error, Some(planted.posed_problem()))),
            }
        }
        with!(&mut self.inner, planted => solve(py, planted, &w, &free))
    }

    /// Takes reactions [N] that somebody else has solved for, shape [n, D].
    fn set_reactions(&mut self, reactions: PyReadonlyArray2<'_, f64>) -> PyResult<()> {
        with!(&mut self.inner, planted => {
            let reactions = arrays::from_rows(&reactions, planted.contacts().len())?;
            planted.set_reactions(&reactions);
            Ok(())
        })
    }

    /// Whether something was missed where the points end up.
    fn missed(&mut self, py: Python<'_>, points: PyReadonlyArray2<'_, f64>) -> PyResult<bool> {
        with!(&mut self.inner, planted => {
            let points = rows(&points)?;
            detached(py, || planted.missed(&points)).map_err(|e: StepError| step_error::<2>(py, &e, None))
        })
    }

    /// Ends the step, and says what its reactions did. With velocities and a mass these are part of what lands.
    #[pyo3(signature = (points, moving=None))]
    fn accept<'py>(
        &mut self,
        py: Python<'py>,
        points: PyReadonlyArray2<'py, f64>,
        moving: Option<(PyReadonlyArray2<'py, f64>, Bound<'py, PyAny>)>,
    ) -> PyResult<Bound<'py, PyDict>> {
        with!(&mut self.inner, planted => {
            let points = rows(&points)?;
            let step = match moving {
                Some((velocity, mass)) => {
                    let (velocity, mut mass) = (rows(&velocity)?, Mass::new(&mass)?);
                    let step = detached(py, || planted.accept_moving(&points, &velocity, &mut mass));
                    if let Some(error) = mass.failed {
                        return Err(error);
                    }
                    step
                }
                None => detached(py, || planted.accept(&points)),
            };
            let out = PyDict::new(py);
            let place = |(between, _)| planted.assembly().contact.pairs.place(between) as i64;
            out.set_item("pair", PyArray1::from_iter(py, step.pairs.iter().map(place)))?;
            let column = |of: fn(&carom::PairLedger) -> f64| PyArray1::from_iter(py, step.pairs.values().map(of));
            out.set_item("friction", column(|pair| pair.friction))?;
            out.set_item("normal_contact", column(|pair| pair.normal_contact))?;
            out.set_item("prescribed", column(|pair| pair.prescribed))?;
            out.set_item("certificate", step.certificate)?;
            out.set_item("min_gap", step.min_gap)?;
            out.set_item("pressing", step.pressing)?;
            out.set_item("landed", PyArray1::from_vec(py, step.landed))?;
            Ok(out)
        })
    }
}

/// The contacts as arrays. What is no node of the caller is left out of the stencils: obstacles, whose motion is prescribed.
fn describe<'py, const D: usize>(
    py: Python<'py>,
    planted: &carom::PlantedContact<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let contacts = planted.contacts();
    let pairs = &planted.assembly().contact.pairs;
    let out = PyDict::new(py);
    let number = |c: &Candidate| pairs.place(pairs.get(c.pair as usize).between()) as i64;
    let named = planted.candidates().iter().map(number);
    out.set_item("pair", PyArray1::from_iter(py, named))?;
    let node = |site: Site| match site {
        Site::Node(node) | Site::Multiplier(node, _) | Site::Second(node) => {
            planted.callers_node(node as usize).map_or(-1, i64::from)
        }
        _ => -1,
    };
    out.set_item("node", PyArray1::from_iter(py, planted.candidates().iter().map(|c| node(c.site))))?;
    out.set_item("gap", PyArray1::from_iter(py, contacts.iter().map(|c| c.gap)))?;
    // nalgebra stores a matrix by columns, NumPy by rows.
    let frames: Vec<Matrix<D>> = contacts.iter().map(|c| c.frame.transpose()).collect();
    let flat: &[f64] = bytemuck::cast_slice(&frames);
    let frames: Bound<'_, PyArray3<f64>> = PyArray1::from_slice(py, flat).reshape([frames.len(), D, D])?;
    out.set_item("frame", frames)?;
    let (mut starts, mut nodes, mut weights) = (vec![0_i64], Vec::new(), Vec::new());
    for contact in contacts {
        for (node, weight) in contact.stencil() {
            if let Some(node) = planted.callers_node(node) {
                nodes.push(i64::from(node));
                weights.push(weight);
            }
        }
        starts.push(nodes.len() as i64);
    }
    out.set_item("starts", PyArray1::from_vec(py, starts))?;
    out.set_item("nodes", PyArray1::from_vec(py, nodes))?;
    out.set_item("weights", PyArray1::from_vec(py, weights))?;
    out.set_item("mu", PyArray1::from_slice(py, planted.friction()))?;
    let offsets: Vec<Vector<D>> = planted.offsets().collect();
    out.set_item("offset", arrays::vectors(py, &offsets)?)?;
    out.set_item("guess", arrays::vectors(py, planted.reactions())?)?;
    Ok(out)
}
