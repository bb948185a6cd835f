//! The reduced problem of the contact points alone: W = H K̄⁻¹ Hᵀ and q.

use carom_contact::Contact;
use carom_fem::Body;
use carom_friction::ContactProblem;
use carom_mesh::{Matrix, Vector};

use crate::Model;
use crate::linearise::BodyOperator;

/// Columns of K̄⁻¹ of one body at boundary nodes, computed when a node first comes into contact and kept with the factor.
#[derive(Debug)]
pub(crate) struct Compliance<const D: usize> {
    /// Place of each node on the boundary, or `u32::MAX` inside.
    boundary_index: Vec<u32>,
    boundary: Vec<u32>,
    /// For a boundary node: the blocks (K̄⁻¹)_ab for every boundary node a, in the frame of the factor.
    columns: Vec<Option<Vec<Matrix<D>>>>,
    generation: u64,
    scratch: Vec<Vector<D>>,
}

impl<const D: usize> Compliance<D> {
    pub fn new(body: &Body<D>) -> Self {
        let boundary = body.surface().nodes().to_vec();
        let mut boundary_index = vec![u32::MAX; body.node_count()];
        for (k, &node) in boundary.iter().enumerate() {
            boundary_index[node as usize] = k as u32;
        }
        Self {
            columns: vec![None; boundary.len()],
            scratch: vec![Vector::zeros(); body.node_count() * D],
            boundary_index,
            boundary,
            generation: 0,
        }
    }

    /// Makes sure that the column of a boundary node is there and belongs to the present factor.
    pub fn prepare(&mut self, operator: &mut BodyOperator<D>, node: usize) {
        if self.generation != operator.generation {
            self.columns.fill(None);
            self.generation = operator.generation;
        }
        let b = self.boundary_index[node] as usize;
        if self.columns[b].is_some() {
            return;
        }
        let n = self.boundary_index.len();
        self.scratch.fill(Vector::zeros());
        for (j, column) in self.scratch.chunks_exact_mut(n).enumerate() {
            column[node][j] = 1.0;
            operator.solve_in_factor_frame(column);
        }
        let column = self
            .boundary
            .iter()
            .map(|&a| Matrix::from_fn(|i, j| self.scratch[j * n + a as usize][i]))
            .collect();
        self.columns[b] = Some(column);
    }

    /// The block (K̄⁻¹)_ab of two boundary nodes in the frame of the factor; that of `b` was prepared.
    #[inline]
    fn block(&self, a: usize, b: usize) -> Matrix<D> {
        let (a, b) = (self.boundary_index[a] as usize, self.boundary_index[b] as usize);
        self.columns[b].as_ref().map_or_else(Matrix::zeros, |column| column[a])
    }
}

/// A direction along a facet that yields less than this where the normal is held, relative to the normal, is held itself.
const RIGID: f64 = 1e-6;
/// What a held direction yields in W, relative to the normal, where nothing is driven along it, and where something is: any
/// number serves, as no force moves it, so long as it is the prescribed sliding that decides the friction.
const HELD_COMPLIANCE: [f64; 2] = [1.0, 1e-3];
/// Sliding below this, relative to the motion of the contact, is round-off.
const NO_SLIDING: f64 = 1e-9;

/// What makes the compliance `block` of a contact regular where supports hold its nodes along the facet and W would be singular.
fn support<const D: usize>(
    model: &Model<D>,
    contact: &Contact<D>,
    q: &Vector<D>,
    motion: &[Vector<D>],
    block: &Matrix<D>,
) -> Matrix<D> {
    let mut support = Matrix::zeros();
    for (node, _) in contact.stencil() {
        let Some(&b) = model.body_of_node.get(node) else { continue };
        let b = &model.bodies[b as usize];
        let held = b.body.held();
        if !held.touches(node - b.first_node) {
            continue;
        }
        for component in (0..D).filter(|&i| held.holds(node - b.first_node, i)) {
            let mut along: Vector<D> = contact.frame.column(component).into();
            along[0] = 0.0;
            let Some(along) = along.try_normalize(RIGID) else { continue };
            let block = block + support;
            let response = block * along;
            // A tilted facet couples both directions: what counts is how far the pair of them is from singular.
            if along.dot(&response) - response[0] * response[0] / block[(0, 0)] < RIGID * block[(0, 0)] {
                let driven = contact.relative(|n| model.prescribed_part(n, &motion[n]));
                let slides = along.dot(&driven).abs() > NO_SLIDING * q.amax();
                let compliance = HELD_COMPLIANCE[usize::from(slides)] * block[(0, 0)];
                support += along * along.transpose() * compliance;
            }
        }
    }
    support
}

/// Writes W, q and μ of `contacts` to `problem`.
///
/// `motion` is the nodal motion d that the step would make with the `reactions` known so far, and q what W leaves of it without them:
/// once these no longer change, the law holds for the motion itself, whatever the accuracy of W. `offsets` are what the normal components
/// lack of the contact condition's variable. The columns of W were prepared.
pub(crate) fn condense<const D: usize>(
    model: &Model<D>,
    operators: &[BodyOperator<D>],
    compliances: &[Compliance<D>],
    contacts: &[Contact<D>],
    friction: &[f64],
    offsets: &[f64],
    motion: &[Vector<D>],
    reactions: &[Vector<D>],
    problem: &mut ContactProblem<D>,
) {
    // The motion of obstacles is prescribed: they do not respond.
    let body_of = |node: usize| model.body_of_node.get(node).map(|&b| b as usize);
    problem.w.clear();
    problem.q.clear();
    problem.mu.clear();
    problem.mu.extend_from_slice(friction);
    for (i, row) in contacts.iter().enumerate() {
        let mut q = row.relative(|n| motion[n]);
        q[0] += offsets[i];
        problem.q.push(q);
        problem.w.push_row(contacts.iter().enumerate().filter_map(|(j, column)| {
            // Nodes of one body respond to one another; contacts that share no body do not couple.
            let mut block = Matrix::zeros();
            let mut coupled = i == j;
            for (m, column_weight) in column.stencil() {
                let Some(b) = body_of(m) else { continue };
                let first = model.bodies[b].first_node;
                let mut response = Matrix::zeros();
                let mut touched = false;
                for (n, row_weight) in row.stencil().filter(|&(n, _)| body_of(n) == Some(b)) {
                    response += compliances[b].block(n - first, m - first) * (row_weight * column_weight);
                    touched = true;
                }
                if touched {
                    let turn = operators[b].turn();
                    block += row.frame * turn * response * turn.transpose() * column.frame.transpose();
                    coupled = true;
                }
            }
            if i == j {
                // A stand-in, which moves nothing: it has no part in the motion.
                let support = support(model, row, &q, motion, &block);
                problem.q[i] += support * reactions[i];
                block += support;
            }
            coupled.then_some((j, block))
        }));
    }
    for (i, q) in problem.q.iter_mut().enumerate() {
        *q -= problem.w.row_times(i, reactions);
    }
}
