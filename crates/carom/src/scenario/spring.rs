//! Springs, dampers and masses at points, as the case file names them.

use serde::{Deserialize, Serialize};

/// A spring and a damper, side by side, between two places.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SpringEntry {
    /// Name, the prefix of its columns in the history.
    pub name: String,
    /// The two places.
    pub between: [PlaceEntry; 2],
    /// Stiffness [N/m].
    #[serde(default)]
    pub stiffness: Option<f64>,
    /// Tension over elongation, in place of a stiffness.
    #[serde(default)]
    pub force: Option<ForceTable>,
    /// Tension per rate of the length [N s/m].
    #[serde(default)]
    pub damping: f64,
    /// The length without tension [m]; that as drawn if not given.
    #[serde(default)]
    pub free_length: Option<f64>,
}

/// A mass beside that of the volume of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MassEntry {
    /// Body.
    pub body: String,
    /// A point of it, as it is drawn [m].
    #[serde(default)]
    pub point: Option<Vec<f64>>,
    /// A set of it, whose nodes take equal parts.
    #[serde(default)]
    pub on: Option<String>,
    /// Mass [kg].
    pub mass: f64,
}

/// A place that a spring is attached to: of a body a point or a set, of an obstacle a point, or a point that stays where it is.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct PlaceEntry {
    /// Body.
    #[serde(default)]
    pub body: Option<String>,
    /// Obstacle.
    #[serde(default)]
    pub obstacle: Option<String>,
    /// A set of the body, whose nodes take equal parts.
    #[serde(default)]
    pub on: Option<String>,
    /// A point as the case is drawn [m].
    #[serde(default)]
    pub point: Option<Vec<f64>>,
}

/// Forces over elongations, linear between them and beyond them as beside them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ForceTable {
    /// Elongations [m], ascending.
    pub elongation: Vec<f64>,
    /// The tension at each [N].
    pub force: Vec<f64>,
}
