use faer::dyn_stack::MemBuffer;

use super::compliance::Compliance;
use super::control::CONTROL;
use crate::clock::{Clock, TimeIsUp};
use crate::{BlockMatrix, ContactProblem, Matrix, Vector};

impl<const D: usize> Compliance<'_, D> {
    /// The same problem with W and q written out. Only contacts on a common part of M are coupled.
    pub fn condense(&self, clock: Clock) -> Result<ContactProblem<D>, TimeIsUp> {
        let mut w = self.pattern();
        let (mut x, mut memory) = (Vec::new(), self.inverse.memory(CONTROL.at_once));
        for part in 0..self.inverse.parts.len() {
            self.add_part(part, &mut w, &mut x, &mut memory, clock)?;
        }
        if self.inverse.symmetric {
            w.mirror_upper();
        }
        let q = self.motions(&self.velocities(&[]));
        Ok(ContactProblem { w, q, mu: self.problem.mu.clone() })
    }

    /// Zero blocks wherever two contacts touch the same part, and on the diagonal.
    fn pattern(&self) -> BlockMatrix<D> {
        let mut w = BlockMatrix::default();
        let mut columns: Vec<usize> = Vec::new();
        let mut seen = vec![usize::MAX; self.incidence.contacts()];
        for i in 0..self.incidence.contacts() {
            columns.clear();
            columns.push(i);
            seen[i] = i;
            for link in self.incidence.of_contact(i) {
                for other in self.incidence.of_part(link.part as usize) {
                    let j = other.contact as usize;
                    if seen[j] != i {
                        seen[j] = i;
                        columns.push(j);
                    }
                }
            }
            columns.sort_unstable();
            w.push_row(columns.iter().map(|&j| (j, Matrix::zeros())));
        }
        w
    }

    /// Adds the share of one part to W: all of it, or what is on and above the diagonal where M is symmetric.
    ///
    /// Row i is (M⁻ᵀ H_i)ᵀ H_j over all contacts j on the part, so that rows are finished one by one and nothing but W is kept.
    fn add_part(
        &self,
        part: usize,
        w: &mut BlockMatrix<D>,
        x: &mut Vec<f64>,
        memory: &mut MemBuffer,
        clock: Clock,
    ) -> Result<(), TimeIsUp> {
        let n = self.inverse.parts.dofs(part).len();
        let links: Vec<_> = self.incidence.of_part(part).collect();
        for (batch, rows) in links.chunks(CONTROL.at_once / D).enumerate() {
            clock.check()?;
            x.clear();
            x.resize(rows.len() * D * n, 0.0);
            for (link, x) in rows.iter().zip(x.chunks_exact_mut(D * n)) {
                for (dof, row) in self.incidence.rows(link) {
                    let place = self.inverse.parts.place_of(dof);
                    for k in 0..D {
                        x[k * n + place] = row[k];
                    }
                }
            }
            self.inverse.solve_part_transposed(part, x, memory);
            for (k, (link, x)) in rows.iter().zip(x.chunks_exact(D * n)).enumerate() {
                let (columns, blocks) = w.row_mut(link.contact as usize);
                let first = if self.inverse.symmetric { batch * (CONTROL.at_once / D) + k } else { 0 };
                let mut place_in_row = 0;
                for other in &links[first..] {
                    while columns[place_in_row] != other.contact {
                        place_in_row += 1;
                    }
                    for (dof, row) in self.incidence.rows(other) {
                        let place = self.inverse.parts.place_of(dof);
                        let moved = Vector::from_fn(|k, _| x[k * n + place]);
                        blocks[place_in_row] += moved * row.transpose();
                    }
                }
            }
        }
        Ok(())
    }
}
