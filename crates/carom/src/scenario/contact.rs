//! Contact as data: its condition, solver and discretisation, and what is different for a pair.

use carom_contact::Discretisation;
use carom_friction::SolverKind;
use serde::{Deserialize, Serialize};

use super::cohesion::CohesionSpec;
use super::friction::FrictionSpec;
use crate::{ContactCondition, SignalSpec};

/// Contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ContactSpec {
    /// Where in time the unilateral condition is written.
    pub condition: ContactCondition,
    /// Friction of every pair that names none.
    pub friction: FrictionSpec,
    /// Solver of the reduced problem.
    pub solver: SolverSpec,
    /// Whose nodes are checked in pairs of bodies that say nothing else; `None`: both; of mortar pairs the finer.
    pub sources: Option<Sources>,
    /// What they are checked against.
    pub targets: Targets,
    /// How contact between two bodies is written in pairs that say nothing else.
    #[serde(default)]
    pub discretisation: Discretisation,
    /// The bi-potential gap of a step that a certified run may have, relative to the largest energy of the run.
    pub certificate_tolerance: f64,
    /// How deep solids may be in one another in a completed run, in diameters of the facet that is there.
    pub penetration_tolerance: f64,
    /// Whether overlaps at the start are taken up, in pairs that say nothing else.
    #[serde(default)]
    pub resolve_overlap: bool,
    /// When they are [s]; at the end of the run if not given.
    #[serde(default)]
    pub overlap_resolved_at: Option<f64>,
    /// Coefficient of restitution of every pair of what is rigid that names none.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// How every pair that says nothing else holds together.
    #[serde(default)]
    pub cohesion: Option<CohesionSpec>,
    /// Exceptions for pairs.
    #[serde(default)]
    pub pairs: Vec<PairEntry>,
}

impl ContactSpec {
    /// The exception of the pair of two names, in either order, with its index.
    pub(crate) fn entry_of(&self, [a, b]: &[String; 2]) -> Option<(usize, &PairEntry)> {
        let is_it = |entry: &PairEntry| {
            let [x, y] = &entry.between;
            (x == a && y == b) || (x == b && y == a)
        };
        self.pairs.iter().enumerate().find(|(_, entry)| is_it(entry))
    }
}

/// The friction solver and when it stops.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SolverSpec {
    /// Solver.
    pub kind: SolverKind,
    /// Residual at which it stops.
    pub tolerance: f64,
    /// Iterations after which it gives up.
    pub max_iterations: usize,
    /// Whether a second solver solves the problem of every step again.
    #[serde(default)]
    pub cross_check: bool,
}

/// Whose nodes are checked against whose facets in a pair of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sources {
    /// Nodes of the body with the finer boundary against facets of the other; of the first if they are alike.
    Finer,
    /// Nodes of the first body against facets of the second.
    First,
    /// Nodes of the second body against facets of the first.
    Second,
    /// Both.
    Both,
}

/// The shape of a body's boundary in the eyes of the nodes that meet it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Targets {
    /// A curve or, in space, a surface through the nodes with a continuous tangent, but for corners and edges of more than 40°.
    #[default]
    Smooth,
    /// The facets of the mesh.
    Faceted,
}

/// What is different for a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PairEntry {
    /// The two names.
    pub between: [String; 2],
    /// Friction.
    pub friction: Option<FrictionSpec>,
    /// Coefficient of restitution.
    #[serde(default)]
    pub restitution: Option<f64>,
    /// How the two hold together.
    #[serde(default)]
    pub cohesion: Option<CohesionSpec>,
    /// Whose nodes are checked.
    pub sources: Option<Sources>,
    /// How contact between the two is written.
    pub discretisation: Option<Discretisation>,
    /// By how much their surfaces are pushed apart [m].
    #[serde(default)]
    pub interference: Option<SignalSpec>,
    /// Whether overlaps at the start are taken up.
    #[serde(default)]
    pub resolve_overlap: Option<bool>,
    /// Whether the two may touch at all.
    #[serde(default = "enabled")]
    pub enabled: bool,
}

/// Pairs touch where nothing else is said.
fn enabled() -> bool {
    true
}
