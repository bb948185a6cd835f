use carom_mesh::parallel::{each_chunk, share, thread_count};
use carom_mesh::{Matrix, Vector};
use nalgebra::SMatrix;

use super::NodalMatrix;
use super::control::CONTROL;
use super::moved::Moved;
use super::scaled::{Columns, Scaled};
use super::semi_iteration::{Vectors, solve, solve_within, terms};
use super::shared::Sharing;
use super::spectrum::spectrum;
use crate::FemError;

/// An approximate inverse of a symmetric matrix A of D × D blocks over a node graph, without a factor: a polynomial of A.
///
/// Let A = L (I + E) Lᵀ, where the lower triangles L of the diagonal blocks turn these into unit blocks. The inverse is L⁻ᵀ p(I + E) L⁻¹. Its p
/// is the polynomial of the Chebyshev semi-iteration (Golub & Varga 1961, *Numerische Mathematik* 3, 147), which leaves least over for all
/// spectra between two bounds.
///
/// It is linear, symmetric and positive definite like that of a factor. A force at a node is felt as many rings of nodes away as it has
/// terms, less one. So responses to forces at some nodes cost little where bodies are large.
///
/// Single precision, as its error is larger anyway.
#[derive(Debug)]
pub(super) struct Chebyshev<const D: usize> {
    matrix: Scaled<D>,
    /// ω of every term.
    weights: Vec<f32>,
    /// 1/α is the middle of the spectrum.
    alpha: f32,
    whole: Vectors<D, 1>,
    /// The effect of the forces that were added, zero outside of what is `moved`.
    added: Vectors<D, 1>,
    has_added: bool,
    /// Whether `whole` has been solved for its right-hand side.
    solved: bool,
    reach: Vec<u32>,
    /// A reach that is asked for.
    wanted: Vec<u32>,
    /// Place of every node in the reach, or `u32::MAX`.
    places: Vec<u32>,
    /// The solution there, once it was looked at.
    seen: Vec<Vector<D>>,
    /// What forces at the reach move, once it `is_grown`.
    moved: Moved,
    is_grown: bool,
    /// What threads find responses to unit forces with, each its own: none until there are any.
    units: Vec<Unit<D>>,
    /// By node that was asked for, and place of the other in the reach.
    responses: Vec<Matrix<D>>,
}

/// What responses to unit forces are found with.
#[derive(Debug)]
struct Unit<const D: usize> {
    /// Zero between two calls.
    vectors: Vectors<D, D>,
    moved: Moved,
}

/// The nodes that a thread finds the responses to unit forces at.
struct Part<'a, const D: usize> {
    unit: &'a mut Unit<D>,
    nodes: &'a [usize],
    responses: &'a mut [Matrix<D>],
}

/// Terms beyond which a factor costs less time: by nested dissection it has n log n values in the plane and n^(4/3) in space. Measured where
/// both take about as long.
fn most_terms<const D: usize>(nodes: usize) -> usize {
    let nodes = nodes as f64;
    (if D == 2 { nodes.ln() } else { nodes.cbrt() }) as usize
}

impl<const D: usize> Chebyshev<D> {
    /// None where a factor costs less, as the polynomial would have too many terms.
    ///
    /// # Errors
    /// If the matrix is seen not to be positive definite.
    pub fn of(matrix: &NodalMatrix<Matrix<D>>, sharing: Option<&Sharing>) -> Result<Option<Self>, FemError> {
        let matrix = Scaled::of(matrix, sharing).ok_or(FemError::NotPositiveDefinite)?;
        let (here, nodes) = (matrix.node_count(), matrix.graph().node_count());
        let [least, largest] = spectrum(&matrix);
        if least.is_nan() || least < -CONTROL.round_off * largest {
            return Err(FemError::NotPositiveDefinite);
        }
        let bounds =
            [(least * CONTROL.margins[0]).max(CONTROL.round_off * largest), largest * CONTROL.margins[1]];
        Ok(terms(bounds, most_terms::<D>(nodes)).map(|(middle, weights)| Self {
            matrix,
            weights,
            alpha: (1.0 / middle) as f32,
            whole: Vectors::zeros(here),
            added: Vectors::zeros(here),
            has_added: false,
            solved: false,
            reach: Vec::new(),
            wanted: Vec::new(),
            places: vec![u32::MAX; nodes],
            seen: Vec::new(),
            moved: Moved::default(),
            is_grown: false,
            units: Vec::new(),
            responses: Vec::new(),
        }))
    }

    /// Memory [bytes].
    pub fn bytes(&self) -> usize {
        let Self { matrix, whole, added, units, .. } = self;
        let of_units: usize = units.iter().map(|unit| size_of_val(&unit.vectors.b[..])).sum();
        matrix.bytes() + 3 * (size_of_val(&whole.b[..]) + size_of_val(&added.b[..]) + of_units)
    }

    /// See [`super::Factor::begin`].
    pub fn begin(&mut self, b: &[Vector<D>]) {
        let matrix = &self.matrix;
        each_chunk(&mut self.whole.b, |first, scaled| {
            for (place, scaled) in (first..).zip(scaled) {
                *scaled = matrix.scale(place, &b[matrix.node_at(place)]);
            }
        });
        if self.has_added {
            // A step was given up between what it added and the end.
            self.added.b.fill([[0.0; 1]; D]);
        }
        (self.solved, self.has_added) = (false, false);
    }

    /// See [`super::Factor::end`].
    pub fn end(&mut self, out: &mut [Vector<D>]) {
        self.solve_once();
        if self.has_added {
            self.solve_added();
        }
        let (matrix, x) = (&self.matrix, &self.whole.x);
        let Some(rows) = matrix.rows() else {
            each_chunk(out, |first, out| {
                for (node, out) in (first..).zip(out) {
                    *out = matrix.unscale(node, &x[node]);
                }
            });
            return;
        };
        out.fill(Vector::zeros());
        for (place, (&node, x)) in rows.nodes().iter().zip(x).enumerate() {
            out[node as usize] = matrix.unscale(place, x) * rows.share(place);
        }
        rows.ranks().sum(bytemuck::cast_slice_mut(out));
    }

    /// See [`super::Factor::set_reach`].
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        let Self { reach, places, wanted, .. } = self;
        wanted.clear();
        wanted.extend(nodes.map(|node| node as u32));
        if wanted == reach {
            return;
        }
        reach.drain(..).for_each(|node| places[node as usize] = u32::MAX);
        for &node in &*wanted {
            if places[node as usize] == u32::MAX {
                places[node as usize] = reach.len() as u32;
                reach.push(node);
            }
        }
        self.is_grown = false;
    }

    /// See [`super::Factor::look`].
    pub fn look(&mut self) {
        self.solve_once();
        let Self { matrix, whole, reach, seen, .. } = self;
        seen.clear();
        seen.extend(reach.iter().map(|&node| part_at(matrix, &whole.x, node as usize)));
        if let Some(rows) = matrix.rows() {
            rows.ranks().sum(bytemuck::cast_slice_mut(seen));
        }
    }

    /// See [`super::Factor::seen`].
    pub fn seen(&self, node: usize) -> Vector<D> {
        self.seen[self.places[node] as usize]
    }

    /// See [`super::Factor::add`].
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        for (node, force) in forces {
            self.has_added = true;
            let Some(place) = self.matrix.place_of(node) else { continue };
            let scaled = self.matrix.scale(place, &force);
            for (b, f) in self.added.b[place].iter_mut().zip(scaled) {
                b[0] += f[0];
            }
        }
    }

    /// See [`super::Factor::respond`].
    pub fn respond(&mut self, nodes: impl Iterator<Item = usize>) {
        let Self { matrix, weights, alpha, units, responses, reach, .. } = self;
        let nodes: Vec<usize> = nodes.collect();
        responses.clear();
        responses.resize(nodes.len() * reach.len(), Matrix::zeros());
        if responses.is_empty() {
            return;
        }
        // Messages have to be in order.
        let threads = if matrix.rows().is_some() { 1 } else { thread_count().min(nodes.len()) };
        while units.len() < threads {
            units.push(Unit { vectors: Vectors::zeros(matrix.node_count()), moved: Moved::default() });
        }
        let each = nodes.len().div_ceil(threads);
        let of_each = nodes.chunks(each).zip(responses.chunks_mut(each * reach.len()));
        let parts = units.iter_mut().zip(of_each);
        let mut parts: Vec<Part<'_, D>> =
            parts.map(|(unit, (nodes, responses))| Part { unit, nodes, responses }).collect();
        let respond = |_: usize, parts: &mut [Part<'_, D>]| {
            for Part { unit, nodes, responses } in parts {
                for (&node, responses) in nodes.iter().zip(responses.chunks_mut(reach.len())) {
                    unit.solve(node, matrix, weights, *alpha);
                    let x = &unit.vectors.x;
                    for (response, &a) in responses.iter_mut().zip(&*reach) {
                        *response = part_at(matrix, x, a as usize);
                    }
                    unit.vectors.clear(unit.moved.everywhere());
                }
            }
        };
        if threads == 1 {
            respond(0, &mut parts)
        } else {
            share(&mut parts, 1, &respond)
        }
        if let Some(rows) = matrix.rows() {
            rows.ranks().sum(bytemuck::cast_slice_mut(responses));
        }
    }

    /// See [`super::Factor::response`].
    pub fn response(&self, number: usize, node: usize) -> Matrix<D> {
        self.responses[number * self.reach.len() + self.places[node] as usize]
    }

    fn solve_once(&mut self) {
        if !std::mem::replace(&mut self.solved, true) {
            solve(&self.matrix, &self.weights, self.alpha, &mut self.whole);
        }
    }

    /// Adds the effect of the forces that were added to the solution.
    fn solve_added(&mut self) {
        let Self { matrix, weights, alpha, whole, added, reach, moved, is_grown, .. } = self;
        if !*is_grown {
            moved.grow(matrix, reach.iter().copied(), weights.len() - 1);
            *is_grown = true;
        }
        solve_within(matrix, weights, *alpha, added, moved);
        for place in moved.everywhere() {
            for (x, added) in whole.x[place].iter_mut().zip(&added.x[place]) {
                x[0] += added[0];
            }
        }
        added.clear(moved.everywhere());
        self.has_added = false;
    }
}

/// What this process has of a solution at a node of the body: the sum over all of them is the solution.
fn part_at<const D: usize, const C: usize>(
    matrix: &Scaled<D>,
    x: &[Columns<D, C>],
    node: usize,
) -> SMatrix<f64, D, C> {
    let Some(place) = matrix.place_of(node) else { return SMatrix::zeros() };
    let solution = matrix.unscale(place, &x[place]);
    matrix.rows().map_or(solution, |rows| solution * rows.share(place))
}

impl<const D: usize> Unit<D> {
    /// Solves for unit forces at a node.
    fn solve(&mut self, node: usize, matrix: &Scaled<D>, weights: &[f32], alpha: f32) {
        let Self { vectors, moved } = self;
        moved.grow(matrix, std::iter::once(node as u32), weights.len() - 1);
        if let Some(place) = matrix.place_of(node) {
            vectors.b[place] = matrix.scale(place, &Matrix::identity());
        }
        solve_within(matrix, weights, alpha, vectors, moved);
    }
}

#[cfg(test)]
mod tests;
