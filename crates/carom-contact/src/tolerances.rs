//! Every geometric threshold of contact, and what it is relative to.

use std::f64::consts::FRAC_1_SQRT_2;

/// Which node faces which point of a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SearchTolerances {
    /// How deep inside a target surface a node is still found, in diameters of the facet it faces.
    pub depth: f64,
    /// How far behind a facet a node still belongs to the other side of the same wall, in diameters of the facet.
    pub wall: f64,
    /// How far a facet reaches beyond its edges with `Reach::Beyond`, in widths.
    pub beyond: f64,
    /// A node this close to lying on a facet, relative to its size, is not beside it.
    pub aligned: f64,
    /// A contact that pressed is kept this far from its facet or beyond the edge of it, relative to its size.
    pub kept: f64,
    /// Distances that differ by no more than this fraction of the size of the facet are equal.
    pub tie: f64,
    /// A node is checked once where it faces another that faces it, to this fraction of the facet.
    pub redundant: f64,
    /// Cosine of the angle between two normals up to which they are those of one contact.
    pub alike: f64,
    /// Cosine of the turning angle in the reference configuration from which on a surface has a corner: 40°. The slack keeps the nonagon,
    /// whose angles are 40° up to round-off, alike at all nodes.
    pub corner: f64,
    /// How far a node of a facet is off the plane, or line, through its middle, relative to its tangents, from which on it is clearly
    /// curved.
    pub curved: f64,
    /// Distances below this, relative to the size of an obstacle or the largest depth of edges, are round-off.
    pub touching: f64,
    /// Weights of corners below this are zero: the closest point is on an edge or a corner.
    pub on_edge: f64,
}

/// The tolerances of every search.
pub(crate) const SEARCH: SearchTolerances = SearchTolerances {
    depth: 0.5,
    wall: 3.0,
    beyond: 0.5,
    aligned: 1e-6,
    kept: 1e-4,
    tie: 1e-12,
    redundant: 1e-6,
    alike: 0.9,
    corner: 0.766_044_443_118_978 - 1e-9,
    curved: 0.1,
    touching: 1e-9,
    on_edge: 1e-12,
};

/// Which edges of a surface count, and which of them cross.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EdgeTolerances {
    /// A crossing this close to the end of an edge, in its lengths, is at its node.
    pub at_node: f64,
    /// The angle by which an edge of two facets may look beyond either of them and still be what is in front [rad]. Deformed facets are
    /// neither flat nor exactly where their edges say.
    pub turn: f64,
    /// How far an edge may end before another crosses it where a further one goes on and crosses no more, in its lengths.
    pub dent: f64,
    /// Cosine of the turning angle from which on a surface has an edge and is not flat there: 1°.
    pub flat: f64,
    /// Length of an edge, in widths of the facets beside it, from which on it is a feature though the surface is round there. The nodes
    /// along it are far apart for how much it turns.
    pub slender: f64,
    /// The least sine of the angle between edges that cross: where they are closer to parallel, nodes face facets.
    pub parallel: f64,
    /// Edges that end this little before they cross do cross, in their lengths.
    pub round_off: f64,
    /// A facet is what keeps two bodies apart if its plane does so by more than the edges do, less this fraction.
    pub decided: f64,
    /// Where two edges of second order cross, or one is lowest over a facet, is found to this part of it, or in so many iterations.
    pub close: f64,
    pub newton: usize,
    pub narrowings: usize,
}

/// The tolerances of all edges.
pub(crate) const EDGES: EdgeTolerances = EdgeTolerances {
    at_node: 0.01,
    turn: 0.05,
    dent: 0.1,
    flat: 0.999_847_695_156_391,
    slender: 2.0,
    parallel: 0.05,
    round_off: 1e-6,
    decided: 0.1,
    close: 1e-14,
    newton: 20,
    narrowings: 60,
};

/// Which facets face one another, and how much of one the other covers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MortarTolerances {
    /// Cosines of the angles between a normal and the opposite one at which facets begin to face one another, 60°, and from which they do
    /// wholly, 45°. Those at the sides of bodies that stand on one another do not.
    pub opposed: [f64; 2],
    /// How far apart facets face one another wholly, and where they end to, in diameters of both.
    pub reach: [f64; 2],
    /// How deep a facet is behind another where they face one another wholly, and where they end to, in diameters of the smaller: the far sides of
    /// thin bodies that touch are deeper.
    pub depth: [f64; 2],
    /// Overlaps of two parts smaller than this fraction of the one on the source are round-off.
    pub negligible: f64,
    /// A multiplier that covers less than this fraction of its whole has no contact.
    pub covered: f64,
}

/// The tolerances of all mortar pairs.
pub(crate) const MORTAR: MortarTolerances = MortarTolerances {
    opposed: [0.5, FRAC_1_SQRT_2],
    reach: [0.25, 0.5],
    depth: [0.125, 0.25],
    negligible: 1e-14,
    covered: 1e-12,
};

/// What distances and the measure of penetration take for one point, for inside, and for worth a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MeasureTolerances {
    /// Points this close to one another, relative to the diameter of the facet that they are on, are one. What is behind a facet by less, or an
    /// edge that is by less inside, relative to its length, is on the surface.
    pub same: f64,
    /// How far before a node of a body it is asked whether something else of it is there, in diameters of its facet: farther than round-off
    /// reaches, and nearer than anything that is told.
    pub before: f64,
    /// The least sum of the unit normals around a node by which it has an outside.
    pub closed: f64,
    /// How well the depth of an edge is known, relative to itself.
    pub finest: f64,
    /// Steps in search of the deepest place of a segment in an obstacle; each leaves two thirds of it.
    pub thirds: usize,
    /// Into how many parts an edge is cut in search of its lowest place, and how many parabolas lead there from the best of their ends.
    pub places: usize,
    pub parabolas: usize,
    /// What is deeper than this, relative to the diameter of its facet, and than the arcs that facets stand for, is a witness. Facets of four
    /// nodes that are not quite flat go through one another by a tenth of it where flat sides slide on one another; with a thousandth of it
    /// such steps took four times as many iterations.
    pub witnessed: f64,
    /// Edges that have gone through one another by less than this part of the depth of one of them do not account for it.
    pub accounts: f64,
}

/// The tolerances of every measure.
pub(crate) const MEASURE: MeasureTolerances = MeasureTolerances {
    same: 1e-9,
    before: 1e-6,
    closed: 1e-3,
    finest: 0.01,
    thirds: 40,
    places: 8,
    parabolas: 2,
    witnessed: 1e-6,
    accounts: 0.5,
};
