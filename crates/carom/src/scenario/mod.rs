//! The scenario as data: what the case file and the Python objects describe. Field names are those of the case file.

mod cohesion;
mod contact;
mod drive;
mod friction;
mod mesh_spec;
mod rigid;
mod spring;

use std::collections::BTreeMap;

use carom_fem::RayleighDamping;
use carom_fem::material::{LawSpec, Viscosity};
pub use carom_fem::{Formulation, Hypothesis};
use serde::{Deserialize, Serialize};

pub use drive::{Axis, Displacement, LoadEntry, LoadSpec, MomentSpec, MotionEntry, MotionSpec};

pub use self::cohesion::CohesionSpec;
pub use self::contact::{ContactSpec, PairEntry, SolverSpec, Sources, Targets};
pub use self::friction::{
    FrictionFormulaSpec, FrictionSpec, OrthotropicSpec, RateAndStateSpec, StaticKineticSpec,
};
pub use self::mesh_spec::{Cell, MeshSpec};
pub use self::rigid::{BodyKind, BodyMass, Inertia};
pub use self::spring::{MassEntry, PlaceEntry, SpringEntry};
use crate::{Scheme, SignalSpec};

/// Moments closer than this to one another, in time steps, differ by round-off alone.
pub(crate) const SLACK: f64 = 1e-6;

/// A complete case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// Title.
    #[serde(default)]
    pub title: String,
    /// Dimension of space: 2 or 3.
    #[serde(default = "two")]
    pub dimension: usize,
    /// What is computed.
    pub analysis: Analysis,
    /// What is kept.
    pub output: Output,
    /// Materials by name.
    pub materials: BTreeMap<String, MaterialSpec>,
    /// Bodies.
    pub bodies: Vec<BodyEntry>,
    /// Rigid obstacles.
    #[serde(default)]
    pub obstacles: Vec<ObstacleEntry>,
    /// Masses at points of bodies.
    #[serde(default)]
    pub masses: Vec<MassEntry>,
    /// Springs and dampers between bodies and other places.
    #[serde(default)]
    pub springs: Vec<SpringEntry>,
    /// Forces on bodies.
    #[serde(default)]
    pub loads: Vec<LoadEntry>,
    /// Prescribed motion of parts of bodies.
    #[serde(default)]
    pub motions: Vec<MotionEntry>,
    /// Contact.
    pub contact: ContactSpec,
    /// Analyses in sequence. Where there are any, analysis, loads, motions and contact are theirs, and those above are not used.
    #[serde(default)]
    pub stages: Vec<StageEntry>,
    /// Whether it is a stage of a case in which contact is massless in some: bodies then weigh the same in all, and what rested goes on resting.
    #[serde(skip)]
    pub(crate) has_massless_stage: bool,
}

/// A stage of a case, complete: what it does not change is written out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageEntry {
    /// Name.
    pub name: String,
    /// What is computed.
    pub analysis: Analysis,
    /// Interval of the history [s].
    pub history_every: f64,
    /// Forces on bodies.
    #[serde(default)]
    pub loads: Vec<LoadEntry>,
    /// Prescribed motion of parts of bodies.
    #[serde(default)]
    pub motions: Vec<MotionEntry>,
    /// Contact.
    pub contact: ContactSpec,
    /// Velocities that bodies are given when it starts; the others go on with theirs.
    #[serde(default)]
    pub velocities: Vec<VelocityEntry>,
}

/// The velocity that a body is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VelocityEntry {
    /// Body.
    pub body: String,
    /// Velocity [m/s]; none if not given.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Spin about the centre of mass [rad/s].
    #[serde(default)]
    pub spin: Spin,
}

impl Scenario {
    /// The case as it is in stage number `index`, as a case of one analysis. The velocities of its bodies are those that they are given there.
    pub(crate) fn in_stage(&self, index: usize) -> Self {
        let stage = &self.stages[index];
        let mut case = Self {
            analysis: stage.analysis.clone(),
            loads: stage.loads.clone(),
            motions: stage.motions.clone(),
            contact: stage.contact.clone(),
            has_massless_stage: self.stages.iter().any(|stage| stage.contact.condition.is_massless()),
            stages: Vec::new(),
            ..self.clone()
        };
        case.output.history_every = stage.history_every;
        let goes_on = !stage.analysis.starts_from_nothing();
        for body in case.bodies.iter_mut().filter(|_| goes_on) {
            let given = stage.velocities.iter().find(|given| given.body == body.name);
            body.velocity = given.and_then(|given| given.velocity.clone());
            body.spin = given.map_or(Spin::None, |given| given.spin);
        }
        case
    }
}

/// Time, scheme and iterations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Analysis {
    /// Kind of analysis.
    pub kind: AnalysisKind,
    /// When it starts [s]: what comes later than 0 goes on from a state of bodies that moved and deformed before.
    #[serde(default)]
    pub start_time: f64,
    /// When it ends [s].
    pub end_time: f64,
    /// Length of a step [s].
    pub time_step: f64,
    /// Time scheme of a dynamic analysis.
    #[serde(default = "none")]
    pub scheme: Scheme,
    /// Newton's iterations.
    pub newton: NewtonSpec,
    /// How often a step that fails is halved.
    pub max_halvings: u32,
    /// What a load step does that finds no equilibrium near the last one.
    #[serde(default)]
    pub stabilisation: Stabilisation,
    /// Gravity [m/s²].
    pub gravity: Option<Vec<f64>>,
}

impl Analysis {
    /// When it starts and when it ends [s].
    pub(crate) fn span(&self) -> [f64; 2] {
        [self.start_time, self.end_time]
    }

    /// The ends of its steps [s], after its start.
    pub(crate) fn moments(&self) -> impl Iterator<Item = f64> + use<> {
        let Self { start_time, end_time, time_step, .. } = *self;
        let steps = ((end_time - start_time) / time_step).ceil() as u64;
        (0..=steps).map(move |k| (start_time + k as f64 * time_step).min(end_time))
    }

    /// Whether bodies are as they are drawn when it starts, and have no past.
    pub(crate) fn starts_from_nothing(&self) -> bool {
        self.start_time == 0.0
    }
}

/// What a load step does that finds no equilibrium near the last one, as where a body snaps through or loses its hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stabilisation {
    /// It fails.
    #[default]
    None,
    /// It moves on with inertia until it comes to rest.
    Dynamic,
}

/// Kinds of analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum AnalysisKind {
    /// Motion in time.
    #[default]
    Dynamic,
    /// Balance of forces, step by step.
    Static,
}

/// When Newton's iterations stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NewtonSpec {
    /// Largest correction of a displacement, relative to the largest motion of a node in the step.
    pub tolerance: f64,
    /// Iterations after which the step fails.
    pub max_iterations: usize,
}

/// What is kept of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Output {
    /// Interval of the fields [s].
    pub fields_every: f64,
    /// Interval of the history [s].
    pub history_every: f64,
    /// Contact events of a pair that are closer than this are one [s]; without it the time that a pressure wave takes through its bodies.
    #[serde(default)]
    pub merge_contacts: Option<f64>,
    /// Points whose motion is in the history.
    #[serde(default)]
    pub track: Vec<TrackEntry>,
}

/// A point of a body to follow.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TrackEntry {
    /// Name, the prefix of its columns in the history.
    pub name: String,
    /// Body.
    pub body: String,
    /// Reference position [m]; the nearest node is followed.
    pub point: Vec<f64>,
}

/// A material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MaterialSpec {
    /// The law.
    #[serde(flatten)]
    pub law: LawSpec,
    /// Density [kg/m³].
    pub density: f64,
    /// Damping.
    #[serde(default)]
    pub damping: RayleighDamping,
    /// Kelvin–Voigt viscosity.
    #[serde(default)]
    pub viscosity: Viscosity,
}

/// A body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyEntry {
    /// Name.
    pub name: String,
    /// Whether it deforms.
    #[serde(default)]
    pub kind: BodyKind,
    /// Name of its material; of deformable bodies.
    #[serde(default)]
    pub material: Option<String>,
    /// Parts of it that are of other materials; of bodies that are not rigid.
    #[serde(default)]
    pub regions: Vec<RegionEntry>,
    /// Density [kg/m³] of a rigid body that does not give its mass.
    #[serde(default)]
    pub density: Option<f64>,
    /// Inertia of a rigid body about its centre of mass; that of its volume if not given.
    #[serde(default)]
    pub inertia: Option<Inertia>,
    /// What it is in space, in 2D.
    #[serde(default)]
    pub hypothesis: Hypothesis,
    /// How its deformation follows from its displacements.
    #[serde(default)]
    pub formulation: Formulation,
    /// Thickness in 2D [m]; not used of a body of revolution.
    pub thickness: f64,
    /// Mass matrix, or the mass of a rigid body.
    #[serde(default)]
    pub mass: Option<BodyMass>,
    /// Mesh.
    pub mesh: MeshSpec,
    /// Stress that it is under where it is drawn.
    #[serde(default)]
    pub initial_stress: Option<InitialStress>,
    /// Linear strain by which it would grow if nothing held it.
    #[serde(default)]
    pub growth: Option<SignalSpec>,
    /// Modes of a reduced body beside those of its contact surface.
    #[serde(default)]
    pub modes: Option<usize>,
    /// Whether what it touches sees a ball or disc in place of its mesh, of rigid bodies.
    #[serde(default)]
    pub round: bool,
    /// Sets of facets that may touch others; the whole boundary if not given.
    #[serde(default)]
    pub contact_sets: Option<Vec<String>>,
    /// Whether the body may touch itself; it may if not given.
    #[serde(default)]
    pub self_contact: Option<bool>,
    /// Initial velocity [m/s]; none if not given.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Initial spin about the centre of mass [rad/s].
    #[serde(default)]
    pub spin: Spin,
}

/// Cells of a body that are of another material than the rest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegionEntry {
    /// Name of their material.
    pub material: String,
    /// Name of a set of cells of the mesh.
    #[serde(default)]
    pub on: Option<String>,
    /// The corner with the smallest coordinates of an upright box [m]: of cells that have their middle in it.
    #[serde(default)]
    pub corner: Option<Vec<f64>>,
    /// Sides of the box [m].
    #[serde(default)]
    pub size: Option<Vec<f64>>,
}

/// A symmetric stress [Pa].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct InitialStress {
    pub xx: f64,
    pub yy: f64,
    pub zz: f64,
    pub xy: f64,
    pub yz: f64,
    pub xz: f64,
}

/// Angular velocity of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Spin {
    /// None.
    #[default]
    None,
    /// In the plane [rad/s].
    InPlane(f64),
    /// In space: (ω_x, ω_y, ω_z) [rad/s].
    InSpace([f64; 3]),
}

/// A rigid obstacle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ObstacleEntry {
    /// Name.
    pub name: String,
    /// Velocity [m/s]; none if not given.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Displacement [m], in place of a velocity.
    #[serde(default)]
    pub motion: Option<Displacement>,
    /// Shape.
    #[serde(flatten)]
    pub shape: ObstacleShape,
}

/// Shapes of rigid obstacles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum ObstacleShape {
    /// A half space.
    Plane {
        /// A point of the plane [m].
        point: Vec<f64>,
        /// Normal towards the free side, of any length.
        normal: Vec<f64>,
    },
    /// A ball, in 2D a disc.
    Sphere {
        /// Centre [m].
        centre: Vec<f64>,
        /// Radius [m].
        radius: f64,
        /// Whether the inside is free, and not the outside.
        #[serde(default)]
        cavity: bool,
    },
    /// A cylinder without ends, in 3D.
    Cylinder {
        /// A point of the axis [m].
        point: Vec<f64>,
        /// Direction of the axis, of any length.
        axis: Vec<f64>,
        /// Radius [m].
        radius: f64,
        /// Whether the inside is free, and not the outside.
        #[serde(default)]
        cavity: bool,
    },
    /// A box with sides along the axes, in 2D a rectangle.
    Box {
        /// The corner with the smallest coordinates [m].
        corner: Vec<f64>,
        /// Sides [m].
        size: Vec<f64>,
    },
    /// The inside of a polygon, in 2D.
    Polygon {
        /// Its corners in order [m], in either sense of turning.
        points: Vec<Vec<f64>>,
    },
    /// What a closed surface of triangles encloses, in 3D.
    Surface {
        /// Vertices [m].
        vertices: Vec<Vec<f64>>,
        /// The vertices of every triangle, counter-clockwise as seen from outside.
        triangles: Vec<[u32; 3]>,
    },
}

fn none() -> Scheme {
    Scheme::Static
}

fn two() -> usize {
    2
}
