use crate::project::Reach;

/// Where a contact is, the same from step to step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Site {
    /// A node.
    Node(u32),
    /// A multiplier of a mortar pair: its node, and the number of the side of the source there that it is on. At a corner every side has
    /// one of its own.
    Multiplier(u32, u32),
    /// Where two edges cross, that of the source first, each from its first node to its second. Their vector product points
    /// from the target to the source.
    Crossing([u32; 2], [u32; 2]),
    /// A corner of the obstacle that is the target, before a facet of the source. Corners are numbered after all nodes, for every obstacle
    /// from the same number on.
    Corner(u32),
    /// A facet of the source that is large beside the round obstacle that is the target, where it is nearest to its centre.
    Facet(u32),
    /// An edge of the source, from its first node to its second, where it is nearest to the axis of the target.
    Edge([u32; 2]),
    /// A point of an edge of the source between its nodes, so many sixteenths of the way from its first to its second, before a facet of the
    /// target. One of the two is of second order.
    Between([u32; 2], u32),
    /// A node before a second facet: beyond a concave kink it is before the facet that it came to first, and behind the next one.
    Second(u32),
}

/// What may touch its target within a step. Ordered by pair, then site: this is the order of the contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Candidate {
    /// Index of the pair.
    pub pair: u32,
    /// The source node, the edges, or the corner of the target.
    pub site: Site,
    /// The facet that a node, a corner or a point of an edge faces on the other side, or that a round obstacle is before; `None` of nodes before an
    /// obstacle without facets, of multipliers and of edges.
    pub facet: Option<u32>,
    /// Whether it says what another candidate says, and is to be left out. Of two nodes that face one another one is left out, and so is
    /// one of a node and the edges that cross at it.
    pub redundant: bool,
    /// At which ends of its facet, the first and the last, it stays with that and does not go on to the next one: see
    /// [`concave_kinks`](crate::ContactModel::concave_kinks).
    pub stays: [bool; 2],
}

impl Candidate {
    /// At a site of a pair, before a facet if it has one.
    #[must_use]
    pub fn new(pair: u32, site: Site, facet: Option<u32>) -> Self {
        Self { pair, site, facet, redundant: false, stays: [false; 2] }
    }

    /// The source `node` of a pair, facing a facet if its target has some.
    #[must_use]
    pub fn at_node(pair: u32, node: u32, facet: Option<u32>) -> Self {
        Self::new(pair, Site::Node(node), facet)
    }

    /// The multiplier of the source `node` of a mortar pair on a `side` of the source there.
    #[must_use]
    pub fn of_multiplier(pair: u32, (node, side): (u32, u32)) -> Self {
        Self::new(pair, Site::Multiplier(node, side), None)
    }

    /// How far its facet reaches beyond its edges.
    pub(crate) fn reach(&self) -> Reach {
        Reach::Own(self.stays)
    }

    /// The node, if it is at one.
    #[must_use]
    pub fn node(&self) -> Option<u32> {
        match self.site {
            Site::Node(node) | Site::Multiplier(node, _) | Site::Second(node) => Some(node),
            _ => None,
        }
    }

    /// What tells it from the others of a step: pair and site.
    #[must_use]
    pub fn key(&self) -> (u32, Site) {
        (self.pair, self.site)
    }
}
