use super::NodeGraph;

/// Nodes around others in a graph, ring by ring.
#[derive(Debug, Default)]
pub struct Region {
    /// Ascending within a ring.
    nodes: Vec<u32>,
    /// Where each ring ends; the first is that of the nodes in the middle.
    ends: Vec<usize>,
    /// Whether a node is within; all false between two calls of `grow`.
    within: Vec<bool>,
}

impl Region {
    /// Takes the nodes that are at most so many `rings` from those in the `middle`.
    pub fn grow(&mut self, graph: &NodeGraph, middle: impl Iterator<Item = u32>, rings: usize) {
        let Self { nodes, ends, within } = self;
        within.resize(graph.node_count(), false);
        nodes.clear();
        ends.clear();
        nodes.extend(middle.filter(|&node| !std::mem::replace(&mut within[node as usize], true)));
        nodes.sort_unstable();
        ends.push(nodes.len());
        let mut start = 0;
        for _ in 0..rings {
            let end = nodes.len();
            for k in start..end {
                for (_, neighbour) in graph.row(nodes[k] as usize) {
                    if !std::mem::replace(&mut within[neighbour], true) {
                        nodes.push(neighbour as u32);
                    }
                }
            }
            nodes[end..].sort_unstable();
            ends.push(nodes.len());
            start = end;
        }
        nodes.iter().for_each(|&node| within[node as usize] = false);
    }

    /// Its nodes up to the given ring; all of them beyond the last.
    #[must_use]
    pub fn up_to(&self, ring: usize) -> &[u32] {
        &self.nodes[..self.ends[ring.min(self.ends.len() - 1)]]
    }

    /// Its rings, from the middle on.
    pub(super) fn rings(&self) -> impl Iterator<Item = &[u32]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.nodes[start..end])
    }

    /// Its nodes, ring by ring.
    #[must_use]
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use carom_mesh::generate;

    #[test]
    fn rings_of_a_grid_are_squares() {
        let mesh = generate::grid([0.0; 2], [1.0; 2], [8, 8]).expect("valid");
        let graph = NodeGraph::of(&mesh);
        let at = |x: f64, y: f64| {
            let near = |p: &carom_mesh::Vector<2>| (p[0] - x).abs() + (p[1] - y).abs() < 1e-9;
            mesh.nodes().iter().position(near).expect("a node") as u32
        };
        let mut region = Region::default();
        for _ in 0..2 {
            region.grow(&graph, [at(0.5, 0.5), at(0.5, 0.5)].into_iter(), 3);
            assert_eq!([0, 1, 2, 3, 9].map(|ring| region.up_to(ring).len()), [1, 9, 25, 49, 49]);
            region.grow(&graph, [at(0.0, 0.0)].into_iter(), 2);
            assert_eq!(region.nodes().len(), 9);
        }
    }
}
