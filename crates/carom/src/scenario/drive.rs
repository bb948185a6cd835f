//! Loads and prescribed motion, as the case file names them.

use serde::{Deserialize, Serialize};

use crate::SignalSpec;

/// Forces on a named set of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoadEntry {
    /// Body.
    pub body: String,
    /// The set; of resultants none.
    #[serde(default)]
    pub on: String,
    /// What acts on it.
    #[serde(flatten)]
    pub load: LoadSpec,
}

/// Kinds of loads.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LoadSpec {
    /// The same force on every node of the set [N].
    Force {
        /// Its components.
        force: Vec<SignalSpec>,
    },
    /// A force per reference area of the facets of the set [Pa].
    Traction {
        /// Its components.
        traction: Vec<SignalSpec>,
    },
    /// A pressure against the facets of the set [Pa].
    Pressure {
        /// The pressure.
        pressure: SignalSpec,
        /// Whether it acts on the present area and normal, or on those of the reference configuration.
        #[serde(default)]
        follower: bool,
    },
    /// A force and a moment on a rigid body.
    Resultant {
        /// The force [N].
        #[serde(default)]
        force: Option<Vec<SignalSpec>>,
        /// The moment [N m].
        #[serde(default)]
        moment: Option<MomentSpec>,
        /// Where the force acts, as the body is drawn [m]; its centre of mass if not given.
        #[serde(default)]
        point: Option<Vec<f64>>,
    },
}

/// A moment [N m].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum MomentSpec {
    /// In space, about its axes.
    InSpace(Vec<SignalSpec>),
    /// In the plane.
    InPlane(SignalSpec),
}

/// Prescribed displacements of a named set of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MotionEntry {
    /// Body.
    pub body: String,
    /// The set; of guided bodies none.
    #[serde(default)]
    pub on: String,
    /// How it moves.
    #[serde(flatten)]
    pub motion: MotionSpec,
    /// Since when [s]: displacements are those since then.
    #[serde(default)]
    pub since: f64,
}

/// Kinds of prescribed motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum MotionSpec {
    /// No displacement.
    Fixed {
        /// Components that are held; all if not given.
        #[serde(default)]
        components: Option<Vec<Axis>>,
    },
    /// Displacements [m]; components that are not given are free.
    Prescribed(Displacement),
    /// Displacements of the centre of mass of a rigid body [m] and angles about the axes of space [rad]; what is not given is free.
    Guided {
        /// Along x.
        #[serde(default)]
        x: Option<SignalSpec>,
        /// Along y.
        #[serde(default)]
        y: Option<SignalSpec>,
        /// Along z.
        #[serde(default)]
        z: Option<SignalSpec>,
        /// About x.
        #[serde(default)]
        turn_x: Option<SignalSpec>,
        /// About y.
        #[serde(default)]
        turn_y: Option<SignalSpec>,
        /// About z.
        #[serde(default)]
        turn_z: Option<SignalSpec>,
    },
}

/// A displacement by components [m].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Displacement {
    /// Along x.
    #[serde(default)]
    pub x: Option<SignalSpec>,
    /// Along y.
    #[serde(default)]
    pub y: Option<SignalSpec>,
    /// Along z.
    #[serde(default)]
    pub z: Option<SignalSpec>,
}

/// Axes of space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// What they are called, in this order.
    pub(crate) const NAMES: [&str; 3] = ["x", "y", "z"];
}
