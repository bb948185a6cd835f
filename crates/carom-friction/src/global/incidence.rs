use std::ops::Range;

use faer::sparse::SparseColMat;

use super::parts::Parts;
use crate::Vector;

/// H by contacts and parts: which parts a contact touches, which contacts touch a part, and the rows of H in between.
pub(super) struct Incidence<const D: usize> {
    /// By contact, then part.
    links: Vec<Link>,
    by_contact: Vec<usize>,
    /// Links by part, then contact.
    of_part: Vec<u32>,
    by_part: Vec<usize>,
    dofs: Vec<u32>,
    rows: Vec<Vector<D>>,
}

/// A contact that touches a part.
#[derive(Debug, Clone)]
pub(super) struct Link {
    pub contact: u32,
    pub part: u32,
    entries: Range<usize>,
}

impl<const D: usize> Incidence<D> {
    /// Sorts the columns of `h`, D for each contact.
    pub fn new(h: &SparseColMat<usize, f64>, parts: &Parts) -> Self {
        let contacts = h.ncols() / D;
        let mut by_part = vec![0; parts.len() + 1];
        let (mut links, mut by_contact): (Vec<Link>, _) = (Vec::new(), vec![0]);
        let (mut dofs, mut rows) = (Vec::new(), Vec::new());
        let mut entries: Vec<(usize, usize, usize, f64)> = Vec::new();
        for contact in 0..contacts {
            entries.clear();
            for k in 0..D {
                let column = contact * D + k;
                let nonzero = h.symbolic().row_idx_of_col(column).zip(h.val_of_col(column));
                let nonzero = nonzero.filter(|&(_, &value)| value != 0.0);
                entries.extend(nonzero.map(|(dof, &value)| (parts.part_of(dof), dof, k, value)));
            }
            entries.sort_unstable_by_key(|&(part, dof, k, _)| (part, dof, k));
            let mut last = None;
            for &(part, dof, k, value) in &entries {
                if last.is_none_or(|(last_part, _)| last_part != part) {
                    let entries = dofs.len()..dofs.len();
                    links.push(Link { contact: contact as u32, part: part as u32, entries });
                    by_part[part + 1] += 1;
                }
                if last != Some((part, dof)) {
                    dofs.push(dof as u32);
                    rows.push(Vector::zeros());
                }
                last = Some((part, dof));
                if let (Some(link), Some(row)) = (links.last_mut(), rows.last_mut()) {
                    link.entries.end = dofs.len();
                    row[k] = value;
                }
            }
            by_contact.push(links.len());
        }
        for part in 0..parts.len() {
            by_part[part + 1] += by_part[part];
        }
        let (mut next, mut of_part) = (by_part.clone(), vec![0; links.len()]);
        for (index, link) in links.iter().enumerate() {
            of_part[next[link.part as usize]] = index as u32;
            next[link.part as usize] += 1;
        }
        Self { links, by_contact, of_part, by_part, dofs, rows }
    }

    /// Number of contacts.
    pub fn contacts(&self) -> usize {
        self.by_contact.len() - 1
    }

    /// The links of a contact, one for each part that it touches.
    pub fn of_contact(&self, contact: usize) -> &[Link] {
        &self.links[self.by_contact[contact]..self.by_contact[contact + 1]]
    }

    /// The links of a part, by ascending contact.
    pub fn of_part(&self, part: usize) -> impl ExactSizeIterator<Item = &Link> + Clone {
        self.of_part[self.by_part[part]..self.by_part[part + 1]].iter().map(|&k| &self.links[k as usize])
    }

    /// The rows of H that couple the part and the contact of a link: (unknown, D numbers).
    pub fn rows(&self, link: &Link) -> impl Iterator<Item = (usize, &Vector<D>)> {
        let dofs = self.dofs[link.entries.clone()].iter().map(|&d| d as usize);
        dofs.zip(&self.rows[link.entries.clone()])
    }

    /// All rows of H in which a contact has numbers: (unknown, D numbers).
    pub fn rows_of_contact(&self, contact: usize) -> impl Iterator<Item = (usize, &Vector<D>)> {
        self.of_contact(contact).iter().flat_map(|link| self.rows(link))
    }

    /// (Hᵀ v)_i of contact `i`.
    pub fn motion(&self, i: usize, v: &[f64]) -> Vector<D> {
        self.rows_of_contact(i).map(|(dof, row)| row * v[dof]).sum()
    }

    /// x += H r.
    pub fn add_forces(&self, r: &[Vector<D>], x: &mut [f64]) {
        for (i, r) in r.iter().enumerate() {
            for (dof, row) in self.rows_of_contact(i) {
                x[dof] += row.dot(r);
            }
        }
    }
}
