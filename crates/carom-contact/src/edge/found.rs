/// Edges that cross.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Found {
    /// Of the source, and of the target so that their vector product points to the source.
    pub edges: [[u32; 2]; 2],
    /// The same with the nodes that these follow.
    pub masters: [[u32; 2]; 2],
    /// For each edge, the node at which it ends a little before the other crosses it, if another edge goes on there. What has come
    /// into a dent in the line of the two crosses neither.
    pub beyond: [Option<u32>; 2],
}

impl Found {
    /// Whether an edge ends before the other crosses it.
    pub fn is_beyond(&self) -> bool {
        self.beyond.iter().any(Option::is_some)
    }

    /// Whether what would cross `before` beyond the end of an edge crosses here, on the edge that goes on there.
    pub fn takes_over(&self, before: &Self) -> bool {
        let ends = |c: &Self| c.beyond.iter().flatten().count();
        let fits = |side: usize| {
            let (here, [a, b]) = (self.masters[side], before.masters[side]);
            let goes_on = before.beyond[side].is_some_and(|node| here.contains(&node));
            here == [a, b] || here == [b, a] || goes_on
        };
        ends(self) < ends(before) && fits(0) && fits(1)
    }
}
