use std::ops::Range;

use carom_mesh::Mesh;

/// Which nodes couple: those that share a cell, each with itself, and those that share a mass; rows ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct NodeGraph {
    starts: Vec<usize>,
    neighbours: Vec<u32>,
}

impl NodeGraph {
    /// The graph of `mesh`.
    #[must_use]
    pub fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        Self::of_cells(mesh, |_| true)
    }

    /// The graph of some cells of `mesh`, named by their numbers, and of all its nodes with themselves.
    #[must_use]
    pub fn of_cells<const D: usize>(mesh: &Mesh<D>, counts: impl Fn(usize) -> bool) -> Self {
        let cells = || mesh.blocks().iter().flat_map(|block| block.cells()).enumerate();
        let own = || cells().filter(|(number, _)| counts(*number)).map(|(_, cell)| cell);
        // The cells around every node, so that no row is longer than it will be for longer than it takes to sort it.
        let count = mesh.nodes().len();
        let mut ends = vec![0; count + 1];
        own().flatten().for_each(|&n| ends[n as usize + 1] += 1);
        (0..count).for_each(|n| ends[n + 1] += ends[n]);
        let mut around: Vec<&[u32]> = vec![&[]; ends[count]];
        let mut next = ends.clone();
        for cell in own() {
            for &n in cell {
                around[next[n as usize]] = cell;
                next[n as usize] += 1;
            }
        }
        let (mut starts, mut neighbours, mut row) = (vec![0], Vec::new(), Vec::new());
        for n in 0..count {
            row.clear();
            row.push(n as u32);
            around[ends[n]..ends[n + 1]].iter().for_each(|cell| row.extend_from_slice(cell));
            row.sort_unstable();
            row.dedup();
            neighbours.extend_from_slice(&row);
            starts.push(neighbours.len());
        }
        neighbours.shrink_to_fit();
        Self { starts, neighbours }
    }

    /// The graph of so many nodes, each with itself, and of these `pairs`.
    #[must_use]
    pub fn of_pairs(count: usize, pairs: impl Iterator<Item = (u32, u32)>) -> Self {
        let mut rows: Vec<Vec<u32>> = (0..count as u32).map(|n| vec![n]).collect();
        pairs.for_each(|(a, b)| rows[a as usize].push(b));
        Self::of_rows(rows)
    }

    /// This graph and the node pairs `more`.
    #[must_use]
    pub fn extended(&self, more: impl Iterator<Item = (u32, u32)>) -> Self {
        let mut rows: Vec<Vec<u32>> =
            self.starts.windows(2).map(|range| self.neighbours[range[0]..range[1]].to_vec()).collect();
        for (a, b) in more {
            rows[a as usize].push(b);
        }
        Self::of_rows(rows)
    }

    /// The graph with every node replaced by its master; what nodes other than their own are left with is themselves.
    pub(super) fn folded(&self, masters: &[u32]) -> Self {
        let mut rows: Vec<Vec<u32>> = (0..masters.len() as u32).map(|n| vec![n]).collect();
        for (node, &master) in masters.iter().enumerate() {
            rows[master as usize].extend(self.row(node).map(|(_, m)| masters[m]));
        }
        Self::of_rows(rows)
    }

    /// The graph of these rows, each of them ascending.
    pub(super) fn of_ascending(rows: impl Iterator<Item = impl Iterator<Item = u32>>) -> Self {
        let (mut starts, mut neighbours) = (vec![0], Vec::new());
        for row in rows {
            neighbours.extend(row);
            starts.push(neighbours.len());
        }
        neighbours.shrink_to_fit();
        Self { starts, neighbours }
    }

    fn of_rows(mut rows: Vec<Vec<u32>>) -> Self {
        let mut starts = vec![0];
        let mut neighbours = Vec::new();
        for row in &mut rows {
            row.sort_unstable();
            row.dedup();
            neighbours.append(row);
            starts.push(neighbours.len());
        }
        Self { starts, neighbours }
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Where the entries of every row start, and where the last ones end.
    pub(super) fn starts(&self) -> &[usize] {
        &self.starts
    }

    /// The neighbours of all nodes, row by row.
    pub(super) fn columns(&self) -> &[u32] {
        &self.neighbours
    }

    /// Number of node pairs.
    #[must_use]
    pub fn entry_count(&self) -> usize {
        self.neighbours.len()
    }

    /// The entries and neighbours of a node.
    #[inline]
    pub fn row(&self, node: usize) -> impl ExactSizeIterator<Item = (usize, usize)> {
        let (range, neighbours) = self.neighbours(node);
        range.zip(neighbours.iter().map(|&n| n as usize))
    }

    /// The entries of a node and its neighbours.
    #[inline]
    pub(super) fn neighbours(&self, node: usize) -> (Range<usize>, &[u32]) {
        let range = self.starts[node]..self.starts[node + 1];
        (range.clone(), &self.neighbours[range])
    }

    /// Where the pair (a, b) stands, if it does.
    #[must_use]
    pub fn find(&self, a: u32, b: u32) -> Option<usize> {
        let (range, row) = self.neighbours(a as usize);
        row.binary_search(&b).ok().map(|k| range.start + k)
    }

    /// Where the pair (a, b) stands.
    ///
    /// # Panics
    /// If the nodes share no cell.
    #[must_use]
    pub fn entry(&self, a: u32, b: u32) -> usize {
        let start = self.starts[a as usize];
        let row = &self.neighbours[start..self.starts[a as usize + 1]];
        start + row.binary_search(&b).expect("the nodes of a cell are neighbours in the graph of its mesh")
    }
}
