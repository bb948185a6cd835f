use carom_mesh::Vector;

/// Where nodes are [m], asked one by one: only those in question are ever evaluated.
///
/// One type for all who ask, so that what searches and measures is compiled once for each dimension.
pub type Positions<'a, const D: usize> = dyn Fn(u32) -> Vector<D> + Sync + 'a;

/// How nodes move through a step, with positions [m] as functions of the node, and within which distance of it something is near.
pub struct Path<'a, const D: usize> {
    /// Where a node is at the start of the step.
    pub start: &'a Positions<'a, D>,
    /// Where it is predicted to be at the end.
    pub end: &'a Positions<'a, D>,
    /// How far away counts as near [m].
    pub margin: f64,
}

impl<'a, const D: usize> Path<'a, D> {
    /// That of nodes which stay `at` their place.
    pub fn resting(at: &'a Positions<'a, D>, margin: f64) -> Self {
        Self { start: at, end: at, margin }
    }
}

impl<const D: usize> Path<'_, D> {
    /// Where a node is half way.
    pub(crate) fn middle(&self, node: u32) -> Vector<D> {
        ((self.start)(node) + (self.end)(node)) * 0.5
    }

    /// Where a node starts and ends.
    pub(crate) fn ends(&self, node: u32) -> [Vector<D>; 2] {
        [(self.start)(node), (self.end)(node)]
    }
}
