//! The continuum: what a deformable body stores, how it resists and how it moves, by total Lagrangian finite elements.
//!
//! A [`Body`] is built once from a mesh and a [`material`] law; its methods map nodal displacements [m] and velocities [m/s]
//! to forces [N], energies [J] and matrices. Nothing here knows of contact.

mod body;
mod body_spec;
mod composition;
mod elements;
mod error;
mod facets;
mod growth;
mod held;
mod hypothesis;
mod impulse;
mod loose;
mod massless;
pub mod material;
mod point_mass;
mod quadrature;
mod ranks;
mod reduction;
mod rigid;
mod shape_table;
pub mod sparse;
mod vibration;
mod with_history;

pub use body::Body;
pub use body_spec::{BodySpec, MassKind, RayleighDamping, RegionSpec};
pub use composition::OfMaterial;
pub use elements::{CellState, Elements, Past, StepForces};
pub use error::FemError;
pub use facets::FacetPatch;
pub use growth::Growth;
pub use held::{Held, HeldDof};
pub use hypothesis::{Formulation, Hypothesis};
pub use impulse::MassSolver;
pub use loose::rigid_motion;
pub use point_mass::PointMass;
pub use ranks::{MatrixPart, RankSolver, Ranks, Share};
pub use reduction::{Content, Reduction};
pub use rigid::{KineticParts, Momenta, RigidMass};
pub use vibration::Vibration;
pub use with_history::BodyWithHistory;
