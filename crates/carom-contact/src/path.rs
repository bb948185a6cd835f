use carom_mesh::Vector;

/// How nodes move through a step: where they start, where they are predicted to end [m], and how far away `margin` [m] counts as near.
pub(crate) struct Path<'a, const D: usize, S, E> {
    pub start: &'a S,
    pub end: &'a E,
    pub margin: f64,
}

impl<const D: usize, S: Fn(u32) -> Vector<D>, E: Fn(u32) -> Vector<D>> Path<'_, D, S, E> {
    /// Where a node is half way.
    pub fn middle(&self, node: u32) -> Vector<D> {
        ((self.start)(node) + (self.end)(node)) * 0.5
    }

    /// Where a node starts and ends.
    pub fn ends(&self, node: u32) -> [Vector<D>; 2] {
        [(self.start)(node), (self.end)(node)]
    }
}
