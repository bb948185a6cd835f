//! W = H K̄⁻¹ Hᵀ and q of the contact points alone. In blended steps a body with mass feels [more](super::on_masses) of a reaction than contacts say, and W
//! has as much of its K̄⁻¹.

use carom_contact::Contact;
use carom_friction::ContactProblem;
use carom_mesh::parallel::each_group;
use carom_mesh::{Matrix, Vector};

use super::active::ActiveSet;
use super::compliance::Compliance;
use super::control::CONTROL;
use super::coupling::Coupling;
use super::made_of::MadeOf;
use super::stiffened::Stiffened;
use crate::model::assembly::Assembly;

/// The blocks of K̄⁻¹ at the contact nodes of every body, and what makes W of them.
#[derive(Debug)]
pub(crate) struct Delassus<const D: usize> {
    pub compliances: Vec<Compliance<D>>,
    coupling: Coupling,
    /// The tangents of a load step.
    pub stiffened: Stiffened<D>,
    /// Rows of W on their way to the problem.
    rows: Vec<Row<D>>,
    /// What W of the problem was made of last.
    made_of: MadeOf<D>,
    /// One of them, complete.
    for_row: Vec<(usize, Matrix<D>)>,
    /// What of W stands in for the compliance of directions that are held, contact by contact [m/N]: nothing moves by it.
    pub stand_ins: Vec<Matrix<D>>,
}

/// What threads make of a row of W.
#[derive(Debug, Clone)]
struct Row<const D: usize> {
    /// The contacts that may respond, ascending.
    partners: Vec<u32>,
    /// What their blocks are, but of those before it whose rows have them.
    blocks: Vec<Option<Matrix<D>>>,
}

/// Rows that are made before they are put where they belong, and rows that a thread takes at a time.
const ROWS: usize = 256;
const GROUP: usize = 16;

impl<const D: usize> Default for Row<D> {
    fn default() -> Self {
        Self { partners: Vec::new(), blocks: Vec::new() }
    }
}

impl<const D: usize> Delassus<D> {
    /// Of the bodies of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let bodies = 0..assembly.body_count();
        Self {
            compliances: bodies.map(|i| Compliance::new(assembly.nodes(i).len())).collect(),
            coupling: Coupling::new(assembly.node_count(), assembly.body_count()),
            stiffened: Stiffened::new(assembly),
            rows: Vec::new(),
            made_of: MadeOf::nothing(),
            for_row: Vec::new(),
            stand_ins: Vec::new(),
        }
    }

    /// How many times what contact `k` says the body of a node feels of its reaction.
    pub fn felt(&self, assembly: &Assembly<D>, active: &ActiveSet<D>, k: usize, node: usize) -> f64 {
        assembly.body_of(node).map_or(1.0, |b| felt_by(b, &self.compliances, active, k))
    }

    /// Says that W of the next problem is not that of the last one.
    pub fn begin_anew(&mut self) {
        self.made_of.forget();
    }

    /// Writes W, q and μ of the contacts to `problem`, which has W of the last call unless [`Self::begin_anew`] was called since.
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
        let ActiveSet { contacts, reactions, .. } = active;
        problem.mu.clear();
        problem.mu.extend_from_slice(&active.friction);
        problem.q.resize(contacts.len(), Vector::zeros());
        let tangent = &self.stiffened;
        each_group(&mut problem.q, ROWS, |first, q| {
            for (i, q) in (first..).zip(q) {
                *q = contacts[i].relative(|n| motion[n]) + offsets[i];
                if tangent.leaves_out() {
                    *q += tangent.unseen(i);
                }
            }
        });
        if tangent.is_needed() || !self.made_of.is(contacts, &self.compliances) {
            self.couple(assembly, active, motion, problem);
            if self.stiffened.is_needed() {
                self.made_of.forget();
            } else {
                self.made_of.take_note(assembly, contacts, &self.compliances);
            }
        }
        let ContactProblem { w, q, .. } = problem;
        each_group(q, ROWS, |first, q| {
            (first..).zip(q).for_each(|(i, q)| *q -= w.row_times(i, reactions));
        });
    }

    /// Writes W of the contacts to `problem`, whose q are the motions, and adds to these what stands in for what supports hold.
    fn couple(
        &mut self,
        assembly: &Assembly<D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        problem: &mut ContactProblem<D>,
    ) {
        let stiffened = self.stiffened.is_needed();
        let leaves_out = self.stiffened.leaves_out();
        let Self { compliances, coupling, rows, for_row, stand_ins, stiffened: tangent, .. } = self;
        stand_ins.clear();
        let ActiveSet { contacts, reactions, .. } = active;
        problem.w.clear();
        coupling.list(assembly, contacts);
        let make = |i: usize, Row { partners, blocks }: &mut Row<D>| {
            let row = &contacts[i];
            if stiffened {
                // Through one another's contacts all respond to all.
                partners.clear();
                partners.extend(0..contacts.len() as u32);
            } else {
                coupling.partners(assembly, compliances, (i, row), partners);
            }
            blocks.clear();
            blocks.extend(partners.iter().map(|&j| j as usize).map(|j| {
                if j < i && !leaves_out {
                    None
                } else if stiffened {
                    let felt = |k: usize, n| {
                        assembly.body_of(n).map_or(1.0, |b| felt_by(b, compliances, active, k)).sqrt()
                    };
                    let mut block =
                        stiffened_block(tangent, (row, |n| felt(i, n)), (&contacts[j], |n| felt(j, n)));
                    if leaves_out {
                        block += tangent.unseen_block(i, &contacts[j]);
                    }
                    Some(block)
                } else {
                    let felt = |b| {
                        let [one, other] = [i, j].map(|k| felt_by(b, compliances, active, k));
                        (one * other).sqrt()
                    };
                    coupling_block(assembly, compliances, row, &contacts[j], felt)
                }
            }));
        };
        rows.resize_with(rows.len().max(contacts.len().min(ROWS)), Row::default);
        for (batch, of_batch) in contacts.chunks(ROWS).enumerate() {
            let (first, rows) = (batch * ROWS, &mut rows[..of_batch.len()]);
            each_group(rows, GROUP, |offset, rows| {
                (first + offset..).zip(rows).for_each(|(i, row)| make(i, row));
            });
            for ((i, contact), row) in (first..).zip(of_batch).zip(&*rows) {
                let partners = row.partners.iter().map(|&j| j as usize).zip(&row.blocks);
                let w = &problem.w;
                // W is symmetric, also where round-off is not, unless rows leave something out.
                let known = |(j, block): (usize, &Option<Matrix<D>>)| {
                    let before = || (j < i && !leaves_out).then(|| w.block(j, i).map(Matrix::transpose))?;
                    Some((j, block.or_else(before).or_else(|| (i == j).then(Matrix::zeros))?))
                };
                for_row.clear();
                for_row.extend(partners.filter_map(known));
                stand_ins.push(Matrix::zeros());
                for (_, block) in for_row.iter_mut().filter(|(j, _)| *j == i) {
                    // A stand-in, which moves nothing: it has no part in the motion.
                    let support = support(assembly, contact, &problem.q[i], motion, block);
                    problem.q[i] += support * reactions[i];
                    *block += support;
                    stand_ins[i] = support;
                }
                problem.w.push_row(for_row.drain(..));
            }
        }
        coupling.forget(assembly, contacts);
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

/// The block of W between two contacts by the tangents of a load step; of a reaction the body of a node feels the square of what is given with each.
fn stiffened_block<const D: usize>(
    tangent: &Stiffened<D>,
    (row, felt_of_row): (&Contact<D>, impl Fn(usize) -> f64),
    (column, felt_of_column): (&Contact<D>, impl Fn(usize) -> f64),
) -> Matrix<D> {
    let mut response = Matrix::zeros();
    for (m, column_weight) in column.stencil() {
        for (n, row_weight) in row.stencil() {
            if let Some(yields) = tangent.block(n, m) {
                response += yields * (row_weight * felt_of_row(n) * column_weight * felt_of_column(m));
            }
        }
    }
    row.frame * response * column.frame.transpose()
}

/// How many times what contact `k` says body `b` feels of its reaction. W has the geometric mean of two contacts, as it is symmetric, and bodies are given what
/// each says: it is the same once reactions no longer change.
fn felt_by<const D: usize>(b: usize, compliances: &[Compliance<D>], active: &ActiveSet<D>, k: usize) -> f64 {
    if active.conditions[k].is_massless() { compliances[b].felt() } else { 1.0 }
}

/// The block of W between two contacts, if nodes of a body respond to one another; of a reaction a body feels so many times what contacts say.
fn coupling_block<const D: usize>(
    assembly: &Assembly<D>,
    compliances: &[Compliance<D>],
    row: &Contact<D>,
    column: &Contact<D>,
    felt: impl Fn(usize) -> f64,
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
            let part = row.frame * turn * response * turn.transpose() * column.frame.transpose() * felt(b);
            block = Some(block.map_or(part, |sum| sum + part));
        }
    }
    block
}
