//! Edges of surfaces in space: where two bodies meet with crossed edges no node need face a facet.

mod by_nodes;
mod crossing;
mod detect;
mod edging;
mod found;
mod line;
mod lowest;
mod pierced;
mod strand;

use crate::aabb::Aabb;
use crate::path::Positions;
use crate::tolerances::EDGES;

pub(crate) use crossing::Crossing;
pub(crate) use edging::SurfaceEdge;
pub(crate) use found::Found;
pub(crate) use line::Line;
pub(crate) use lowest::{Dip, along};
pub(crate) use pierced::Pierced;
pub(crate) use strand::{Bow, Strand};

/// A line from node to node along which a surface turns away from its outside, as it is without deformation.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Edge {
    /// Its ends, in the sense in which they go around the first facet.
    pub nodes: [u32; 2],
    /// The curve that it is half of, beside facets of second order.
    bow: Option<Bow>,
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
    /// Where on the facet the ends of the edge are.
    ends: [[f64; 2]; 2],
}

impl Edge {
    /// The edge by its nodes.
    pub fn strand(&self) -> Strand {
        Strand { nodes: self.nodes, bow: self.bow }
    }

    /// Where it is.
    pub fn line<const D: usize>(&self, position: &Positions<'_, D>) -> Line<D> {
        self.strand().line(position)
    }

    /// Its line, farther out by this fraction where another edge goes on.
    fn gone_on<const D: usize>(&self, fraction: f64, position: &Positions<'_, D>) -> Line<D> {
        self.line(position).gone_on(self.goes_on.map(|goes_on| fraction * f64::from(goes_on)))
    }

    /// A box around the edge, and a little of where another goes on, on its way through a step.
    pub fn path<const D: usize>(&self, start: &Positions<'_, D>, end: &Positions<'_, D>) -> Aabb<D> {
        let there = |position| self.gone_on(EDGES.dent, position).bounds();
        there(start).union(&there(end))
    }

    /// The facets that meet there.
    pub fn facets(&self) -> impl Iterator<Item = u32> {
        self.sides.iter().map(|side| side.facet)
    }
}
