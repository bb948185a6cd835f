//! Touch: which nodes may meet which facets or obstacles, how far apart they are, and in which frame.
//!
//! A [`ContactModel`] lists surfaces, rigid [`Obstacle`]s and [`Pair`]s. [`ContactModel::detect`] finds the [`Candidate`]s of a
//! step on the [`Path`] of its nodes. [`ContactModel::evaluate`] turns a candidate into a [`Contact`]. That has a gap [m]
//! (negative = penetration), a frame (rows n, t₁, t₂, with n from target to source) and the stencil that maps nodal to relative
//! motion. Positions are passed as functions of the node, so that only the nodes in question are ever evaluated. A surface
//! consists of its facets or, once [smoothed](ContactSurface::smoothed), of a curve through its nodes. Nothing here knows of
//! materials, forces or friction laws.

mod aabb;
mod ball;
mod balls;
mod bvh;
mod candidate;
mod closest;
mod contact;
mod curve;
mod detect;
mod distance;
mod domain;
mod edge;
mod extents;
mod facing;
mod frame;
mod gauge;
mod kept;
mod looking;
mod manifold;
mod model;
mod mortar;
mod neighbours;
mod obstacle;
mod pair;
mod pairs;
mod parts;
mod patch;
mod path;
mod penetration;
mod project;
mod redundant;
mod round;
mod search;
mod self_contact;
mod sheet;
mod sides;
mod surface;
mod tolerances;
mod witness;

pub use candidate::{Candidate, Site};
pub use contact::{Contact, shares};
pub use distance::Proximity;
pub use extents::Extents;
pub use gauge::{Gauge, KnownGaps};
pub use model::ContactModel;
pub use mortar::Mortar;
pub use obstacle::{ClosedSurface, Obstacle, PolygonDefect, RigidShape, SurfaceDefect};
pub use pair::{Discretisation, Pair, Target};
pub use pairs::{Directions, PairRule, PairRules, Pairs, Side};
pub use path::{Path, Positions};
pub use penetration::{Boundaries, Feature, Penetration, Solid, Witness};
pub use search::Search;
pub use surface::ContactSurface;
