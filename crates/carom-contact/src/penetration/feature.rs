/// A part of a boundary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// A node.
    Node(u32),
    /// A line between two nodes.
    Edge([u32; 2]),
}
