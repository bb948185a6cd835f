use carom_mesh::Vector;

/// How nodes move through a step, with positions [m] as functions of the node, and within which distance of it something is near.
pub struct Path<'a, const D: usize, S, E> {
    /// Where a node is at the start of the step.
    pub start: &'a S,
    /// Where it is predicted to be at the end.
    pub end: &'a E,
    /// How far away counts as near [m].
    pub margin: f64,
}

impl<'a, const D: usize, S: Fn(u32) -> Vector<D>> Path<'a, D, S, S> {
    /// That of nodes which stay `at` their place.
    pub fn resting(at: &'a S, margin: f64) -> Self {
        Self { start: at, end: at, margin }
    }
}

impl<const D: usize, S: Fn(u32) -> Vector<D>, E: Fn(u32) -> Vector<D>> Path<'_, D, S, E> {
    /// Where a node is half way.
    pub(crate) fn middle(&self, node: u32) -> Vector<D> {
        ((self.start)(node) + (self.end)(node)) * 0.5
    }

    /// Where a node starts and ends.
    pub(crate) fn ends(&self, node: u32) -> [Vector<D>; 2] {
        [(self.start)(node), (self.end)(node)]
    }
}
