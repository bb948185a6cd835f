use std::sync::Arc;

use carom_mesh::{Matrix, Vector, nodal};

use super::{NodalMatrix, NodeGraph};
use crate::FemError;
use crate::ranks::{MatrixPart, RankSolver, Ranks};

/// Who has the rest of the matrices of a body, and which nodes couple in them.
#[derive(Debug, Clone)]
pub struct Sharing {
    /// All processes.
    pub ranks: Arc<dyn Ranks>,
    /// The graph of the whole matrix.
    pub graph: Arc<NodeGraph>,
}

/// The inverse of a matrix that the [ranks](Ranks) share, by what they solve with. It keeps right-hand sides and solutions of all nodes.
#[derive(Debug)]
pub(super) struct Shared<const D: usize> {
    solver: Box<dyn RankSolver>,
    is_exact: bool,
    x: Vec<Vector<D>>,
    /// Whether `x` is the solution, or still the right-hand side.
    is_solved: bool,
    /// Forces that were added since.
    added: Vec<Vector<D>>,
    has_added: bool,
    reach: Vec<u32>,
    /// Place of every node in the reach, or `u32::MAX`.
    places: Vec<u32>,
    /// By node that was asked for, and place of the other in the reach.
    responses: Vec<Matrix<D>>,
}

impl<const D: usize> Shared<D> {
    pub fn new(sharing: &Sharing) -> Self {
        let count = sharing.graph.node_count();
        Self {
            solver: sharing.ranks.solver(),
            is_exact: false,
            x: nodal::zeros(count),
            is_solved: false,
            added: nodal::zeros(count),
            has_added: false,
            reach: Vec::new(),
            places: vec![u32::MAX; count],
            responses: Vec::new(),
        }
    }

    /// Takes the matrix of which this process has a part.
    ///
    /// # Errors
    /// If it is not positive definite.
    pub fn make(&mut self, exact: bool, matrix: &NodalMatrix<Matrix<D>>) -> Result<(), FemError> {
        let graph = matrix.graph();
        let part = MatrixPart {
            dimension: D,
            starts: graph.starts(),
            columns: graph.columns(),
            values: bytemuck::cast_slice(&matrix.values),
        };
        self.is_exact = exact;
        self.solver.make(&part, exact)
    }

    pub fn is_exact(&self) -> bool {
        self.is_exact
    }

    pub fn bytes(&self) -> usize {
        self.solver.bytes() + size_of_val(&self.x[..]) + size_of_val(&self.added[..])
    }

    /// See [`super::Factor::begin`].
    pub fn begin(&mut self, b: &[Vector<D>]) {
        self.x.copy_from_slice(b);
        self.is_solved = false;
        if std::mem::take(&mut self.has_added) {
            self.added.fill(Vector::zeros());
        }
    }

    /// See [`super::Factor::look`].
    pub fn look(&mut self) {
        if !std::mem::replace(&mut self.is_solved, true) {
            self.solver.solve(bytemuck::cast_slice_mut(&mut self.x));
        }
    }

    /// See [`super::Factor::end`].
    pub fn end(&mut self, out: &mut [Vector<D>]) {
        let Self { solver, x, added, .. } = self;
        if std::mem::take(&mut self.has_added) {
            // What nobody has looked at is solved for at once.
            if self.is_solved {
                solver.solve(bytemuck::cast_slice_mut(added));
            }
            x.iter_mut().zip(&*added).for_each(|(x, added)| *x += added);
            added.fill(Vector::zeros());
        }
        self.look();
        out.copy_from_slice(&self.x);
    }

    /// See [`super::Factor::set_reach`].
    pub fn set_reach(&mut self, nodes: impl Iterator<Item = usize>) {
        let Self { reach, places, .. } = self;
        reach.drain(..).for_each(|node| places[node as usize] = u32::MAX);
        for node in nodes {
            if places[node] == u32::MAX {
                places[node] = reach.len() as u32;
                reach.push(node as u32);
            }
        }
    }

    /// See [`super::Factor::seen`].
    pub fn seen(&self, node: usize) -> Vector<D> {
        self.x[node]
    }

    /// See [`super::Factor::add`].
    pub fn add(&mut self, forces: impl Iterator<Item = (usize, Vector<D>)>) {
        for (node, force) in forces {
            self.added[node] += force;
            self.has_added = true;
        }
    }

    /// See [`super::Factor::respond`].
    pub fn respond(&mut self, nodes: impl Iterator<Item = usize>) {
        let mut unit = nodal::zeros::<D>(self.x.len());
        self.responses.clear();
        for node in nodes {
            let first = self.responses.len();
            self.responses.resize(first + self.reach.len(), Matrix::zeros());
            for j in 0..D {
                unit.fill(Vector::zeros());
                unit[node][j] = 1.0;
                self.solver.solve(bytemuck::cast_slice_mut(&mut unit));
                for (block, &a) in self.responses[first..].iter_mut().zip(&self.reach) {
                    block.set_column(j, &unit[a as usize]);
                }
            }
        }
    }

    /// See [`super::Factor::response`].
    pub fn response(&self, number: usize, node: usize) -> Matrix<D> {
        self.responses[number * self.reach.len() + self.places[node] as usize]
    }
}
