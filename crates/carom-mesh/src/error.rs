use thiserror::Error;

/// What can be wrong with a mesh. Cells and nodes are numbered from 0 in the order of the mesh.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum MeshError {
    /// A generator was given parameters that describe no mesh.
    #[error("{parameter} = {value} makes no mesh: {remedy}")]
    Generator {
        /// Name of the parameter, as in the case file.
        parameter: &'static str,
        /// The value that was given.
        value: String,
        /// What is allowed.
        remedy: &'static str,
    },
    /// A node has a coordinate that is not a finite number.
    #[error("node {node} has a coordinate that is not finite; every coordinate must be a number in metres")]
    NonFiniteNode {
        /// Index of the node.
        node: usize,
    },
    /// A cell refers to a node that does not exist.
    #[error("cell {cell} refers to node {node}, but the mesh has {nodes} nodes (numbered from 0)")]
    UnknownNode {
        /// Index of the cell.
        cell: usize,
        /// The node it refers to.
        node: usize,
        /// How many nodes there are.
        nodes: usize,
    },
    /// The cells are not of the dimension of space.
    #[error("{kind} cells cannot fill a body in {dimension}D; use cells of dimension {dimension}")]
    WrongDimension {
        /// Name of the cell kind.
        kind: &'static str,
        /// Dimension of space.
        dimension: usize,
    },
    /// A node belongs to no cell and would have no mass.
    #[error("node {node} belongs to no cell and would have no mass; remove it from the mesh")]
    OrphanNode {
        /// Index of the node.
        node: usize,
    },
    /// A tie refers to a node that does not exist.
    #[error("a tie refers to node {node}, but the mesh has {nodes} nodes (numbered from 0)")]
    TieOfUnknownNode {
        /// The node it refers to.
        node: usize,
        /// How many nodes there are.
        nodes: usize,
    },
    /// A node follows two nodes, or one that follows another.
    #[error("node {node} is tied twice; a node can follow one other, which follows none")]
    TiedTwice {
        /// Index of the node.
        node: usize,
    },
    /// A named set refers to a node or cell that does not exist.
    #[error("the set {set:?} refers to {what} {index}, but the mesh has {count} (numbered from 0)")]
    UnknownInSet {
        /// Name of the set.
        set: String,
        /// Node or cell.
        what: &'static str,
        /// What it refers to.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// The two sides to be tied do not fit together.
    #[error(
        "the sides across direction {direction} cannot be tied: their nodes are not opposite one another"
    )]
    UnlikeSides {
        /// Index of the direction.
        direction: usize,
    },
    /// The mesh has no cells.
    #[error("the mesh has no cells; a body needs at least one")]
    Empty,
}
