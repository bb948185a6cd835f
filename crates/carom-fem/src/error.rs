use thiserror::Error;

/// What can go wrong in building or using a body.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum FemError {
    /// A cell is inverted or has no volume in the reference configuration.
    #[error(
        "cell {cell} with nodes {nodes:?} near {at:?} is {}{}; \
         list its nodes counter-clockwise and give it a volume",
        if *.volume < 0.0 { "inverted" } else { "degenerate" },
        and_more(.others)
    )]
    InvertedCell {
        /// Index of the cell in its mesh.
        cell: usize,
        /// Its nodes.
        nodes: Vec<u32>,
        /// Position of its first node [m].
        at: Vec<f64>,
        /// Jacobian determinant relative to the size of the cell.
        volume: f64,
        /// More such cells of its kind.
        others: Vec<usize>,
    },
    /// A material constant is out of range.
    #[error("{name} = {value}: {remedy}")]
    MaterialConstant {
        /// Name as in the case file.
        name: &'static str,
        /// The value that was given.
        value: f64,
        /// What is allowed.
        remedy: &'static str,
    },
    /// A hypothesis of the plane was given to a body in space.
    #[error("hypothesis {name:?} is one of 2D bodies; leave it out in 3D")]
    Hypothesis {
        /// Name as in the case file.
        name: &'static str,
    },
    /// A material of which a sheet in plane stress cannot be.
    #[error("{what} has no plane-stress hypothesis; choose another hypothesis or leave it out")]
    PlaneStress {
        /// What the material has.
        what: &'static str,
    },
    /// A body that can be under no initial stress.
    #[error("{what} cannot be under an initial stress: {remedy}")]
    InitialStress {
        /// What it is.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// Materials that one body cannot be of.
    #[error("the materials of one body {what}: {remedy}")]
    Mixed {
        /// What they differ in.
        what: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A formulation is not one for the cells, the law or the hypothesis of a body.
    #[error("formulation \"mean-dilatation\" does not suit this body of {cell} cells: {remedy}")]
    Formulation {
        /// Name of the cells.
        cell: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A node of a body of revolution lies on the wrong side of the axis.
    #[error(
        "node {node} at {at:?} has a negative radius; the axis of an axisymmetric body is x = 0, with the body at x ≥ 0"
    )]
    NegativeRadius {
        /// The node.
        node: usize,
        /// Its position [m].
        at: Vec<f64>,
    },
    /// A massless node has no massive nodes near it that could carry its mass.
    #[error(
        "the mass of boundary node {node} at {at:?} finds no nodes inside to move to; \
         refine the mesh, name fewer contact_sets, or choose a contact condition that keeps the mass, such as \"gap\""
    )]
    NoMassInside {
        /// The node.
        node: u32,
        /// Its position [m].
        at: Vec<f64>,
    },
    /// A matrix that should be positive definite is not.
    #[error(
        "the iteration matrix is not positive definite: the step is too long for the inertia of what moves in it"
    )]
    NotPositiveDefinite,
    /// A body has motions beside rigid ones that nothing resists.
    #[error(
        "the cells do not hang together, so that parts of the body move for nothing; make one body of each part"
    )]
    InPieces,
    /// A factor would outgrow the memory.
    #[error(
        "a factor of {unknowns} unknowns takes {needed:.1} GB of memory at least, and {free:.1} GB are free: \
         take larger cells, or in time steps in which a wave crosses no more than a cell or two, for which large bodies need no factor"
    )]
    Memory {
        /// Unknowns of the body.
        unknowns: usize,
        /// What the factor takes [GB].
        needed: f64,
        /// What there is [GB].
        free: f64,
    },
    /// The ordering of a sparse matrix failed.
    #[error("the symbolic factorisation failed: {0}")]
    Symbolic(String),
}

/// How many other cells there are and which: the first few.
fn and_more(cells: &[usize]) -> String {
    match cells {
        [] => String::new(),
        _ if cells.len() <= 5 => format!(", and so are {} more: {cells:?}", cells.len()),
        _ => format!(", and so are {} more, the first of them {:?}", cells.len(), &cells[..5]),
    }
}
