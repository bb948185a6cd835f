use std::marker::PhantomData;

use carom_mesh::{Matrix, Tie, Vector};

use super::NodeGraph;

/// Tied nodes in a linear system. Let T be the map from the motions of the free nodes to those of all. A matrix A becomes Tᵀ A
/// T, a right-hand side b becomes Tᵀ b, and the solution is T x. Images keep rows of their own, so that nodes keep their
/// numbers.
#[derive(Debug)]
pub(super) struct Folding<const D: usize> {
    ties: Vec<Tie>,
    /// For every node the one that stands for it.
    pub masters: Vec<u32>,
    /// For every entry of the graph of all nodes: the one of the folded graph that it is added to.
    entries: Vec<u32>,
    /// The diagonal entries of every image and its master.
    diagonals: Vec<(usize, usize)>,
    folded_entries: usize,
    dimension: PhantomData<Matrix<D>>,
}

impl<const D: usize> Folding<D> {
    /// How a matrix over `graph` is folded, and the graph that it is over then.
    pub fn new(graph: &NodeGraph, ties: &[Tie]) -> (Self, NodeGraph) {
        let mut masters: Vec<u32> = (0..graph.node_count() as u32).collect();
        ties.iter().for_each(|t| masters[t.image as usize] = t.master);
        let folded = graph.folded(&masters);
        let mut entries = vec![0; graph.entry_count()];
        for (node, &master) in masters.iter().enumerate() {
            for (entry, neighbour) in graph.row(node) {
                entries[entry] = folded.entry(master, masters[neighbour]) as u32;
            }
        }
        let diagonal = |n: u32| folded.entry(n, n);
        let folding = Self {
            diagonals: ties.iter().map(|t| (diagonal(t.image), diagonal(t.master))).collect(),
            folded_entries: folded.entry_count(),
            dimension: PhantomData,
            ties: ties.to_vec(),
            masters,
            entries,
        };
        (folding, folded)
    }

    /// The blocks of the folded matrix, from the matrix whose block at an entry of the graph of all nodes is `block(entry)`.
    pub fn fold_matrix(&self, block: impl Fn(usize) -> Matrix<D>) -> Vec<Matrix<D>> {
        let mut blocks = vec![Matrix::zeros(); self.folded_entries];
        for (entry, &folded) in self.entries.iter().enumerate() {
            blocks[folded as usize] += block(entry);
        }
        // Any positive definite block will do for an image, whose row stands alone; its master's has the size of the others.
        for &(image, master) in &self.diagonals {
            blocks[image] = blocks[master];
        }
        blocks
    }

    /// Moves what stands at images to their masters.
    pub fn fold(&self, b: &mut [Vector<D>]) {
        for tie in &self.ties {
            let at_image = std::mem::replace(&mut b[tie.image as usize], Vector::zeros());
            b[tie.master as usize] += at_image;
        }
    }

    /// Gives images what their masters have.
    pub fn unfold(&self, x: &mut [Vector<D>]) {
        self.ties.iter().for_each(|t| x[t.image as usize] = x[t.master as usize]);
    }
}
