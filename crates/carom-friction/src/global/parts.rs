use faer::sparse::SparseColMatRef;

/// The unknowns in groups that M does not couple: bodies, or single unknowns where M is diagonal.
///
/// Parts are numbered by their first unknown, and the unknowns of a part ascend.
#[derive(Debug)]
pub(super) struct Parts {
    starts: Vec<usize>,
    dofs: Vec<u32>,
    part_of: Vec<u32>,
    place_of: Vec<u32>,
}

impl Parts {
    /// The connected components of the graph of `m`.
    pub fn of(m: SparseColMatRef<'_, usize, f64>) -> Self {
        let n = m.ncols();
        // A forest whose roots are the first unknowns of the parts.
        let mut above: Vec<u32> = (0..n as u32).collect();
        for j in 0..n {
            for (i, &value) in m.symbolic().row_idx_of_col(j).zip(m.val_of_col(j)) {
                if value != 0.0 {
                    let (a, b) = (root(&mut above, i as u32), root(&mut above, j as u32));
                    above[a.max(b) as usize] = a.min(b);
                }
            }
        }
        let (mut part_of, mut place_of) = (vec![0; n], vec![0; n]);
        let mut sizes: Vec<usize> = Vec::new();
        for dof in 0..n {
            let first = root(&mut above, dof as u32) as usize;
            if first == dof {
                part_of[dof] = sizes.len() as u32;
                sizes.push(0);
            }
            let part = part_of[first];
            part_of[dof] = part;
            place_of[dof] = sizes[part as usize] as u32;
            sizes[part as usize] += 1;
        }
        let mut starts = vec![0];
        starts.extend(sizes.iter().scan(0, |end, size| {
            *end += size;
            Some(*end)
        }));
        let mut dofs = vec![0; n];
        for dof in 0..n {
            dofs[starts[part_of[dof] as usize] + place_of[dof] as usize] = dof as u32;
        }
        Self { starts, dofs, part_of, place_of }
    }

    /// Number of parts.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The unknowns of a part, ascending.
    pub fn dofs(&self, part: usize) -> &[u32] {
        &self.dofs[self.starts[part]..self.starts[part + 1]]
    }

    /// The part that an unknown belongs to.
    pub fn part_of(&self, dof: usize) -> usize {
        self.part_of[dof] as usize
    }

    /// The place of an unknown among those of its part.
    pub fn place_of(&self, dof: usize) -> usize {
        self.place_of[dof] as usize
    }
}

/// The root above `dof`; halves the path on the way.
fn root(above: &mut [u32], mut dof: u32) -> u32 {
    while above[dof as usize] != dof {
        let next = above[above[dof as usize] as usize];
        above[dof as usize] = next;
        dof = next;
    }
    dof
}

#[cfg(test)]
mod tests {
    use faer::sparse::{SparseColMat, Triplet};

    use super::*;

    #[test]
    fn unknowns_coupled_in_either_direction_are_in_one_part() {
        let entries = [(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (4, 1), (0, 3)];
        let mut triplets: Vec<_> = entries.iter().map(|&(i, j)| Triplet::new(i, j, 1.0)).collect();
        // A stored zero couples nothing.
        triplets.push(Triplet::new(2, 0, 0.0));
        let m = SparseColMat::try_new_from_triplets(5, 5, &triplets).expect("inside");
        let parts = Parts::of(m.as_ref());
        assert_eq!(parts.len(), 3);
        assert_eq!(parts.dofs(0), [0, 3]);
        assert_eq!(parts.dofs(1), [1, 4]);
        assert_eq!(parts.dofs(2), [2]);
        assert_eq!((parts.part_of(4), parts.place_of(4)), (1, 1));
    }
}
