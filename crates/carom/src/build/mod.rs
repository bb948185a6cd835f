//! From a scenario to a model, a method and the state at t = 0. Everything that can be wrong is found here.

mod body;
pub(crate) mod cohesion;
pub(crate) mod contact;
pub(crate) mod drive;
pub(crate) mod foreign;
pub(crate) mod friction_law;
mod growth;
mod guide;
mod inputs;
mod interference;
mod masses;
mod mesh;
pub(crate) mod method;
pub(crate) mod mortar;
pub(crate) mod obstacle;
mod orthotropy;
mod overlaps;
mod places;
mod reduced;
mod regions;
mod restitution;
mod rigid;
mod roundness;
pub(crate) mod side;
mod signals;
mod spare_mass;
mod springs;
mod support_name;
pub(crate) mod values;
mod velocity;

use carom_mesh::Vector;
use carom_mesh::compiled;

use self::friction_law::friction_laws;
pub use self::inputs::{Engine, Inputs, Laws, Meshes};
pub use self::obstacle::Surfaces;
use self::values::vector;
pub(crate) use self::velocity::RigidMotion;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::model::method::Method;
use crate::scenario::{BodyKind, Scenario};
use crate::{ContactCondition, Scheme, State};

type BuildModel<const D: usize> =
    fn(&Scenario, Meshes<D>) -> Result<(Model<D>, Method<D>, State<D>), InputError>;

/// Builds what a scenario in D dimensions describes; `meshes` are those that it takes from files.
///
/// # Errors
/// If a value is out of range, a mesh has an inverted cell, or bodies overlap or are outside their obstacles at the start.
pub fn build<const D: usize>(
    scenario: &Scenario,
    meshes: Meshes<D>,
) -> Result<(Model<D>, Method<D>, State<D>), InputError> {
    compiled!(D, build_model as BuildModel)(scenario, meshes)
}

fn build_model<const D: usize>(
    scenario: &Scenario,
    meshes: Meshes<D>,
) -> Result<(Model<D>, Method<D>, State<D>), InputError> {
    let Built { model, method, motions } = built(scenario, meshes.into())?;
    let state = start(&model, &method, &motions, scenario.analysis.start_time)?;
    Ok((model, method, state))
}

/// The state at `time` [s] in which bodies are as they are drawn, and move like this unless the analysis is static.
///
/// # Errors
/// If its energy is not finite.
pub(crate) fn start<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    motions: &[RigidMotion<D>],
    time: f64,
) -> Result<State<D>, InputError> {
    let moving = model.bodies.iter().zip(motions);
    let mut state = match method.scheme {
        Scheme::Static => model.state_at_rest(),
        _ => model.initial_state(
            moving.flat_map(|(b, motion)| motion.velocities(b, b.body.mesh().nodes())).collect(),
        ),
    };
    state.time = time;
    cohesion::bond(&model.assembly, &mut state);
    if state.is_finite(&model.assembly) {
        return Ok(state);
    }
    let message = "the initial energy is not finite; check velocities and material constants";
    Err(InputError::new("bodies", message))
}

/// What a scenario describes but for the state that it starts from.
pub(crate) struct Built<const D: usize> {
    pub model: Model<D>,
    pub method: Method<D>,
    /// How its bodies are made to move at the start.
    pub motions: Vec<RigidMotion<D>>,
}

/// Builds model and method. Whether bodies overlap is asked of those alone that are as they are drawn.
///
/// # Errors
/// See [`build`].
pub(crate) fn built<const D: usize>(scenario: &Scenario, inputs: Inputs<D>) -> Result<Built<D>, InputError> {
    let Inputs { mut meshes, surfaces, mut laws, engine } = inputs;
    if scenario.dimension != D {
        return Err(InputError::new(
            "dimension",
            format!("{}: the core was asked for {D}", scenario.dimension),
        ));
    }
    let mut method = method::method(scenario)?;
    masses::refuse_unknown(scenario)?;
    let mut bodies: Vec<ModelBody<D>> = Vec::new();
    for (i, entry) in scenario.bodies.iter().enumerate() {
        let first_node = bodies.last().map_or(0, |b| b.nodes().end);
        let given = meshes.remove(&entry.name);
        bodies.push(if entry.kind == BodyKind::Rigid {
            let (body, spec) = rigid::rigid_body(scenario, i, entry, given)?;
            ModelBody::new(&entry.name, body, first_node).rigid(&spec)
        } else if entry.kind == BodyKind::Reduced {
            let (body, part) = reduced::reduced_body(scenario, i, entry, given)?;
            ModelBody::new(&entry.name, body, first_node).reduced(part)
        } else if entry.kind == BodyKind::Foreign {
            let given = (given, laws.remove(&entry.name));
            let (body, law) = foreign::foreign_body(scenario, i, entry, given)?;
            ModelBody::new(&entry.name, body, first_node).foreign(law)
        } else {
            let body = body::body(scenario, i, entry, given, engine.as_deref())?;
            let growth = growth::growth(scenario, i, entry)?;
            ModelBody { growth, ..ModelBody::new(&entry.name, body, first_node) }
        });
    }
    if bodies.is_empty() {
        return Err(InputError::new("bodies", "there is no body; add one [[bodies]] table at least"));
    }
    if method.condition.is_massless() && bodies.iter().all(|b| b.body.massless().is_empty()) {
        // What pairs are ruled by that have mass on both sides.
        method.condition = ContactCondition::Midpoint;
    }
    let contact = contact::contact(scenario, &bodies, surfaces)?;
    let obstacles = scenario.obstacles.iter().map(|o| o.name.clone()).collect();
    let gravity: Vector<D> = match &scenario.analysis.gravity {
        Some(g) => vector("analysis.gravity", g)?,
        None => Vector::<D>::zeros(),
    };
    let axial = bodies.iter().find(|b: &&ModelBody<D>| b.body.is_axisymmetric());
    if let Some(ModelBody { name, .. }) = axial.filter(|_| gravity[0] != 0.0) {
        let message = format!("{:?} has a part across the axis of body {name:?}", gravity.as_slice());
        return Err(InputError::new("analysis.gravity", message + "; let it point along y"));
    }
    let model = drive::drive(scenario, Model::new(bodies, contact, obstacles, gravity))?;
    let model = springs::springs(scenario, model)?;
    let model = interference::interference(scenario, model)?;
    let mut model = restitution::restitution(scenario, model)?;
    let is_static = method.scheme == Scheme::Static;
    model.assembly.friction_laws = friction_laws(&scenario.contact, is_static, &model.assembly)?;
    model.assembly.cohesions = cohesion::cohesions(&scenario.contact, &model.assembly)?;
    model.assembly.bearing = friction_law::bearing(scenario, &model)?;
    model.assembly.orthotropies = orthotropy::orthotropies(scenario, &model)?;
    if scenario.analysis.starts_from_nothing() {
        overlaps::check_overlaps(scenario, &model, &method)?;
    }
    let motions = velocity::rigid_motions(scenario, &model)?;
    Ok(Built { model, method, motions })
}
