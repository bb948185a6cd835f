//! Edges of surfaces in space: where two bodies meet with crossed edges no node need face a facet.

mod crossing;
mod detect;
mod edging;
mod found;
mod pierced;

use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::path::Positions;
use crate::tolerances::EDGES;

pub(crate) use crossing::Crossing;
pub(crate) use edging::SurfaceEdge;
pub(crate) use found::Found;
pub(crate) use pierced::Pierced;

/// A straight line along which a surface turns away from its outside, as it is without deformation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edge {
    /// Its ends, in the sense in which they go around the first facet.
    pub nodes: [u32; 2],
    /// The facets that meet there.
    sides: [Side; 2],
    /// Whether nodes and facets miss what crosses it: the surface turns as much as at a corner, or its facets are slender.
    is_feature: bool,
    /// At which of its ends another edge goes on along it.
    goes_on: [bool; 2],
}

/// A facet beside an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    facet: u32,
    /// Where on the facet the middle of the edge is.
    middle: [f64; 2],
}

impl Edge {
    /// The ends of an edge from and to `x` [m], farther out by this fraction where another edge goes on.
    fn gone_on<const D: usize>(&self, x: &[Vector<D>; 2], fraction: f64) -> [Vector<D>; 2] {
        let along = (x[1] - x[0]) * fraction;
        let by = self.goes_on.map(f64::from);
        [x[0] - along * by[0], x[1] + along * by[1]]
    }

    /// A box around the edge, and a little of where another goes on, on its way through a step.
    pub fn path<const D: usize>(&self, start: &Positions<'_, D>, end: &Positions<'_, D>) -> Aabb<D> {
        let ends = |x: [Vector<D>; 2]| self.gone_on(&x, EDGES.dent);
        Aabb::of([ends(self.nodes.map(start)), ends(self.nodes.map(end))].into_iter().flatten())
    }

    /// The facets that meet there.
    pub fn facets(&self) -> impl Iterator<Item = u32> {
        self.sides.iter().map(|side| side.facet)
    }
}
