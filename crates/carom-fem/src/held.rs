use carom_mesh::{Matrix, Vector, nodal};

use crate::sparse::NodalMatrix;

/// A component of the displacement of a node that is not free: it is prescribed, or zero by symmetry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct HeldDof {
    /// Node of the body.
    pub node: u32,
    /// Component: 0 is x.
    pub component: u8,
}

/// The displacements of a body that are held, and what that means for its matrices and vectors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Held {
    dofs: Vec<HeldDof>,
    /// A bit per component, for every node; empty where nothing is held.
    masks: Vec<u8>,
}

impl Held {
    /// What is held in a body, of which every node says it component by component; nothing if there is no entry.
    #[must_use]
    pub fn of<const D: usize>(held: &[[bool; D]]) -> Self {
        let all =
            held.iter().enumerate().flat_map(|(n, held)| (0..D).filter(|&i| held[i]).map(move |i| (n, i)));
        let mut of = Self::default();
        of.add(held.len(), all.map(|(n, i)| HeldDof { node: n as u32, component: i as u8 }));
        of
    }

    /// Adds to what is held in a body of `nodes` nodes.
    pub(crate) fn add(&mut self, nodes: usize, dofs: impl IntoIterator<Item = HeldDof>) {
        self.dofs.extend(dofs);
        self.dofs.sort_unstable();
        self.dofs.dedup();
        self.masks = vec![0; if self.dofs.is_empty() { 0 } else { nodes }];
        for dof in &self.dofs {
            self.masks[dof.node as usize] |= 1 << dof.component;
        }
    }

    /// What is held, by node and component, ascending.
    #[must_use]
    pub fn dofs(&self) -> &[HeldDof] {
        &self.dofs
    }

    /// Whether nothing is held.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.dofs.is_empty()
    }

    /// Whether a component of a node is held.
    #[inline]
    #[must_use]
    pub fn holds(&self, node: usize, component: usize) -> bool {
        self.masks.get(node).is_some_and(|mask| mask >> component & 1 == 1)
    }

    /// Whether anything of a node is held.
    #[inline]
    #[must_use]
    pub fn touches(&self, node: usize) -> bool {
        self.masks.get(node).is_some_and(|&mask| mask != 0)
    }

    /// The held components of a vector at a node; the others are zero.
    #[inline]
    #[must_use]
    pub fn part<const D: usize>(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| if self.holds(node, i) { v[i] } else { 0.0 })
    }

    /// The free components of a vector at a node; the others are zero.
    #[inline]
    #[must_use]
    pub fn free_part<const D: usize>(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| if self.holds(node, i) { 0.0 } else { v[i] })
    }

    /// Σ a·b over what is free.
    #[must_use]
    pub fn free_dot<const D: usize>(&self, a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
        let product = |dof: &HeldDof| {
            let (n, i) = (dof.node as usize, dof.component as usize);
            a[n][i] * b[n][i]
        };
        nodal::dot(a, b) - self.dofs.iter().map(product).sum::<f64>()
    }

    /// Sets what is held of a nodal vector to zero.
    pub fn clear<const D: usize>(&self, x: &mut [Vector<D>]) {
        self.dofs.iter().for_each(|dof| x[dof.node as usize][dof.component as usize] = 0.0);
    }

    /// Uncouples what is held: its rows and columns of a matrix become zero but for the diagonal.
    pub fn uncouple<const D: usize>(&self, matrix: &mut NodalMatrix<Matrix<D>>) {
        if self.is_empty() {
            return;
        }
        let graph = std::sync::Arc::clone(matrix.shared_graph());
        for node in 0..graph.node_count() {
            for (entry, neighbour) in graph.row(node) {
                let block = &mut matrix.values[entry];
                for i in 0..D {
                    for j in 0..D {
                        let diagonal = node == neighbour && i == j;
                        if !diagonal && (self.holds(node, i) || self.holds(neighbour, j)) {
                            block[(i, j)] = 0.0;
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn held_and_free_parts_make_the_whole() {
        let mut held = Held::default();
        let dof = |node, component| HeldDof { node, component };
        held.add(4, [dof(2, 1), dof(0, 0), dof(2, 1)]);
        held.add(4, [dof(0, 1)]);
        assert_eq!(held.dofs(), [dof(0, 0), dof(0, 1), dof(2, 1)]);
        let v = Vector::<2>::new(3.0, 4.0);
        assert_eq!(held.part(2, &v), Vector::<2>::new(0.0, 4.0));
        for node in 0..4 {
            assert_eq!(held.part(node, &v) + held.free_part(node, &v), v);
        }
        assert_eq!(held.free_dot(&[v; 4], &[v; 4]), 4.0 * 25.0 - (9.0 + 16.0 + 16.0));
        assert!(held.touches(2) && !held.touches(1) && !Held::default().touches(2));
    }
}
