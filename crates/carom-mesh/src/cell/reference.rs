/// The kinds of cells that bodies are meshed with, and the facets of these.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum CellKind {
    /// Linear segment, 2 nodes.
    Line2,
    /// Quadratic segment, 3 nodes.
    Line3,
    /// Linear triangle, 3 nodes.
    Tri3,
    /// Quadratic triangle, 6 nodes.
    Tri6,
    /// Bilinear quadrilateral, 4 nodes.
    Quad4,
    /// Quadratic serendipity quadrilateral, 8 nodes.
    Quad8,
    /// Biquadratic quadrilateral, 9 nodes.
    Quad9,
    /// Linear tetrahedron, 4 nodes.
    Tet4,
    /// Quadratic tetrahedron, 10 nodes.
    Tet10,
    /// Trilinear hexahedron, 8 nodes.
    Hex8,
    /// Quadratic serendipity hexahedron, 20 nodes.
    Hex20,
    /// Triquadratic hexahedron, 27 nodes.
    Hex27,
    /// Linear wedge, a swept triangle, 6 nodes.
    Wedge6,
    /// Quadratic serendipity wedge, 15 nodes.
    Wedge15,
}

/// Where and how a cell lives on its reference domain.
pub struct Reference {
    /// Name as in the case file.
    pub name: &'static str,
    /// Dimension of the reference domain.
    pub dimension: usize,
    /// Degree of the complete polynomials that the shape functions reproduce: 1 or 2.
    pub degree: usize,
    /// Reference coordinates of the nodes.
    pub nodes: &'static [[f64; 3]],
    /// Facets with their local nodes, outward normal by the right-hand rule (in 2D: the body is on the left).
    pub facets: &'static [(CellKind, &'static [usize])],
    /// Values N_a(ξ) of the shape functions.
    pub shape: fn(&[f64; 3], &mut [f64]),
    /// Reference gradients ∂N_a/∂ξ.
    pub gradient: fn(&[f64; 3], &mut [[f64; 3]]),
    /// Cell type number of VTK.
    pub vtk_type: u8,
}
