//! W = H K̄⁻¹ Hᵀ and q of the contact points alone.

use carom_contact::Contact;
use carom_friction::ContactProblem;
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::compliance::Compliance;
use super::control::CONTROL;
use super::coupling::Coupling;
use super::stiffened::Stiffened;
use crate::model::assembly::Assembly;

/// The blocks of K̄⁻¹ at the contact nodes of every body, and what makes W of them.
#[derive(Debug)]
pub(crate) struct Delassus<const D: usize> {
    pub compliances: Vec<Compliance<D>>,
    coupling: Coupling,
    /// The tangents of a load step.
    pub stiffened: Stiffened<D>,
    /// A row of W on its way to the problem.
    row_blocks: Vec<(usize, Matrix<D>)>,
}

impl<const D: usize> Delassus<D> {
    /// Of the bodies of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let bodies = 0..assembly.body_count();
        Self {
            compliances: bodies.map(|i| Compliance::new(assembly.nodes(i).len())).collect(),
            coupling: Coupling::new(assembly.node_count(), assembly.body_count()),
            stiffened: Stiffened::new(assembly),
            row_blocks: Vec::new(),
        }
    }

    /// Writes W, q and μ of the contacts to `problem`.
    ///
    /// `motion` is the nodal motion d that the step would make with the reactions known so far, and q what W leaves of it without them. Once
    /// these no longer change, the law holds for the motion itself, however accurate W is. `offsets` are what the motions lack of
    /// the contact condition's variable. The columns of W were prepared.
    pub fn condense(
        &mut self,
        assembly: &Assembly<D>,
        active: &ActiveSet<D>,
        offsets: &[Vector<D>],
        motion: &[Vector<D>],
        problem: &mut ContactProblem<D>,
    ) {
        let stiffened = self.stiffened.is_needed();
        let leaves_out = self.stiffened.leaves_out();
        let Self { compliances, coupling, row_blocks, stiffened: tangent } = self;
        let ActiveSet { contacts, reactions, .. } = active;
        problem.w.clear();
        problem.q.clear();
        problem.mu.clear();
        problem.mu.extend_from_slice(&active.friction);
        coupling.list(assembly, contacts);
        for (i, row) in contacts.iter().enumerate() {
            let mut q = row.relative(|n| motion[n]);
            q += offsets[i];
            if leaves_out {
                q[0] += tangent.unseen(i);
            }
            problem.q.push(q);
            row_blocks.clear();
            // Through one another's contacts all respond to all.
            let all = if stiffened { 0..contacts.len() as u32 } else { 0..0 };
            let near = if stiffened { &[] } else { coupling.partners(assembly, compliances, i, row) };
            for j in all.chain(near.iter().copied()) {
                let j = j as usize;
                // W is symmetric, also where round-off is not, unless rows leave something out.
                let block = if j < i && !leaves_out {
                    problem.w.block(j, i).map(Matrix::transpose)
                } else if stiffened {
                    let mut block = stiffened_block(tangent, row, &contacts[j]);
                    if leaves_out {
                        block.set_row(0, &(block.row(0) + tangent.unseen_block(i, &contacts[j]).transpose()));
                    }
                    Some(block)
                } else {
                    coupling_block(assembly, compliances, row, &contacts[j])
                };
                let Some(mut block) = block.or_else(|| (i == j).then(Matrix::zeros)) else { continue };
                if i == j {
                    // A stand-in, which moves nothing: it has no part in the motion.
                    let support = support(assembly, row, &q, motion, &block);
                    problem.q[i] += support * reactions[i];
                    block += support;
                }
                row_blocks.push((j, block));
            }
            problem.w.push_row(row_blocks.drain(..));
        }
        coupling.forget(assembly, contacts);
        for (i, q) in problem.q.iter_mut().enumerate() {
            *q -= problem.w.row_times(i, reactions);
        }
    }
}

/// What makes the compliance `block` of a contact regular where supports hold its nodes along the facet and W would be singular.
pub(crate) fn support<const D: usize>(
    assembly: &Assembly<D>,
    contact: &Contact<D>,
    q: &Vector<D>,
    motion: &[Vector<D>],
    block: &Matrix<D>,
) -> Matrix<D> {
    let mut support = Matrix::zeros();
    for (node, _) in contact.stencil() {
        if assembly.body_of(node).is_none() {
            continue;
        }
        let held = assembly.held(node);
        for component in (0..D).filter(|&i| held[i]) {
            let mut along: Vector<D> = contact.frame.column(component).into();
            along[0] = 0.0;
            let Some(along) = along.try_normalize(CONTROL.rigid) else { continue };
            let block = block + support;
            let response = block * along;
            // A tilted facet couples both directions: what counts is how far the pair of them is from singular.
            if along.dot(&response) - response[0] * response[0] / block[(0, 0)]
                < CONTROL.rigid * block[(0, 0)]
            {
                let driven = contact.relative(|n| assembly.prescribed_part(n, &motion[n]));
                let slides = along.dot(&driven).abs() > CONTROL.no_sliding * q.amax();
                let compliance = CONTROL.held_compliance[usize::from(slides)] * block[(0, 0)];
                support += along * along.transpose() * compliance;
            }
        }
    }
    support
}

/// The block of W between two contacts by the tangents of a load step.
fn stiffened_block<const D: usize>(
    tangent: &Stiffened<D>,
    row: &Contact<D>,
    column: &Contact<D>,
) -> Matrix<D> {
    let mut response = Matrix::zeros();
    for (m, column_weight) in column.stencil() {
        for (n, row_weight) in row.stencil() {
            if let Some(yields) = tangent.block(n, m) {
                response += yields * (row_weight * column_weight);
            }
        }
    }
    row.frame * response * column.frame.transpose()
}

/// The block of W between two contacts, if nodes of a body respond to one another.
fn coupling_block<const D: usize>(
    assembly: &Assembly<D>,
    compliances: &[Compliance<D>],
    row: &Contact<D>,
    column: &Contact<D>,
) -> Option<Matrix<D>> {
    let mut block: Option<Matrix<D>> = None;
    for (m, column_weight) in column.stencil() {
        // The motion of obstacles is prescribed: they do not respond.
        let Some((b, own)) = assembly.place_of(m) else { continue };
        let first = m - own;
        let mut response: Option<Matrix<D>> = None;
        for (n, row_weight) in row.stencil().filter(|&(n, _)| assembly.body_of(n) == Some(b)) {
            if let Some(yields) = compliances[b].block(n - first, own) {
                let yields = yields * (row_weight * column_weight);
                response = Some(response.map_or(yields, |sum| sum + yields));
            }
        }
        if let Some(response) = response {
            let turn = &compliances[b].turn;
            let part = row.frame * turn * response * turn.transpose() * column.frame.transpose();
            block = Some(block.map_or(part, |sum| sum + part));
        }
    }
    block
}
