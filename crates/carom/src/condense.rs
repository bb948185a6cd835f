//! The reduced problem of the contact points alone: W = H K̄⁻¹ Hᵀ and q.

use carom_contact::Contact;
use carom_fem::Body;
use carom_friction::ContactProblem;
use carom_mesh::{Matrix, Vector};

use crate::Model;
use crate::linearise::BodyOperator;

/// The blocks of K̄⁻¹ of one body between the nodes that have been in contact, computed when a node first is and kept with the
/// factor.
#[derive(Debug)]
pub(crate) struct Compliance<const D: usize> {
    /// The nodes, in the order of their first contact.
    nodes: Vec<u32>,
    /// Place of every node of the body among them, or `u32::MAX`.
    places: Vec<u32>,
    /// The blocks (K̄⁻¹)_ab in the frame of the factor, by the place of b and then that of a, which is no larger.
    blocks: Vec<Matrix<D>>,
    generation: u64,
}

impl<const D: usize> Compliance<D> {
    pub fn new(body: &Body<D>) -> Self {
        Self {
            nodes: Vec::new(),
            places: vec![u32::MAX; body.node_count()],
            blocks: Vec::new(),
            generation: 0,
        }
    }

    /// The nodes whose blocks belong to the present factor, in the order of their first contact.
    pub fn nodes_of(&self, operator: &BodyOperator<D>) -> &[u32] {
        if self.generation == operator.generation { &self.nodes } else { &[] }
    }

    /// Makes sure that the blocks between `nodes` are there and belong to the present factor.
    pub fn prepare(&mut self, operator: &mut BodyOperator<D>, nodes: &[u32]) {
        if self.generation != operator.generation {
            self.nodes.drain(..).for_each(|node| self.places[node as usize] = u32::MAX);
            self.blocks.clear();
            self.generation = operator.generation;
        }
        let known = self.nodes.len();
        for &node in nodes {
            let place = &mut self.places[node as usize];
            if *place == u32::MAX {
                *place = self.nodes.len() as u32;
                self.nodes.push(node);
            }
        }
        if self.nodes.len() == known {
            return;
        }
        operator.set_reach(self.nodes.iter().map(|&node| node as usize));
        for b in known..self.nodes.len() {
            let first = self.blocks.len();
            self.blocks.resize(first + b + 1, Matrix::zeros());
            for component in 0..D {
                if operator.respond(self.nodes[b] as usize, component) {
                    for (block, &a) in self.blocks[first..].iter_mut().zip(&self.nodes) {
                        block.set_column(component, &operator.response(a as usize));
                    }
                }
            }
        }
    }

    /// The block (K̄⁻¹)_ab of two nodes that were prepared, in the frame of the factor.
    #[inline]
    fn block(&self, a: usize, b: usize) -> Matrix<D> {
        let (a, b) = (self.places[a] as usize, self.places[b] as usize);
        if a <= b { self.blocks[b * (b + 1) / 2 + a] } else { self.blocks[a * (a + 1) / 2 + b].transpose() }
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
/// lack of the contact condition's variable. The columns of W were prepared; `row_blocks` is scratch.
pub(crate) fn condense<const D: usize>(
    model: &Model<D>,
    operators: &[BodyOperator<D>],
    compliances: &[Compliance<D>],
    contacts: &[Contact<D>],
    friction: &[f64],
    offsets: &[f64],
    motion: &[Vector<D>],
    reactions: &[Vector<D>],
    row_blocks: &mut Vec<(usize, Matrix<D>)>,
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
        row_blocks.clear();
        row_blocks.extend(contacts.iter().enumerate().filter_map(|(j, column)| {
            if j < i {
                // W is symmetric, also where round-off is not.
                return problem.w.block(j, i).map(|block| (j, block.transpose()));
            }
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
        problem.w.push_row(row_blocks.drain(..));
    }
    for (i, q) in problem.q.iter_mut().enumerate() {
        *q -= problem.w.row_times(i, reactions);
    }
}
