//! What drives the bodies in a step: prescribed motion and loads.

use carom_mesh::Vector;

use crate::body::fe::equation::BodyStep;
use crate::error::StepError;
use crate::model::state::State;
use crate::step::workspace::Workspace;
use crate::{Model, ObstacleMotion, Signal, StepMap};

/// What drives one body in a step. Loads are empty where there is none.
#[derive(Debug, Default)]
pub(crate) struct BodyDrive<const D: usize> {
    /// v₊ [m/s] of everything held, in the order of `Body::held`.
    pub rates: Vec<f64>,
    /// F̄ [N], the loads as the scheme weighs them; those that follow the body at the present guess.
    pub mean: Vec<Vector<D>>,
    /// F₊ [N], the loads at the end of the step.
    pub end: Vec<Vector<D>>,
    /// u between start and end, where loads that follow the body act.
    between: Vec<Vector<D>>,
}

impl<const D: usize> BodyDrive<D> {
    /// The drive of body `index`.
    pub fn new(model: &Model<D>, index: usize) -> Self {
        let b = &model.bodies[index];
        let loads = if model.loads[index].is_empty() { 0 } else { b.body.node_count() };
        Self {
            rates: vec![0.0; b.body.held().dofs().len()],
            mean: vec![Vector::zeros(); loads],
            end: vec![Vector::zeros(); loads],
            between: vec![Vector::zeros(); loads],
        }
    }
}

/// Evaluates the loads of body `index` at the present guess.
pub(crate) fn load_body<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
    index: usize,
) {
    let loads = &model.loads[index];
    if loads.is_empty() {
        return;
    }
    let (body, nodes) = (&model.bodies[index].body, model.bodies[index].nodes());
    let BodyDrive { mean, end, between, .. } = &mut work.drives[index];
    let motion = &work.motion[nodes.clone()];
    for ((x, u), d) in between.iter_mut().zip(&state.displacement[nodes.clone()]).zip(motion) {
        *x = u + d * map.xi;
    }
    let times = [state.time, state.time + map.dt];
    let weighted = |s: &Signal| (1.0 - map.xi) * s.at(times[0]).value + map.xi * s.at(times[1]).value;
    mean.fill(Vector::zeros());
    end.fill(Vector::zeros());
    for load in loads {
        load.add(body, weighted, between, mean);
        load.add(body, |s| s.at(times[1]).value, &next.displacement[nodes.clone()], end);
    }
}

/// Sets the motion of everything that is prescribed to what the step asks for; returns the largest of it [m].
///
/// # Errors
/// If a function of time is not finite.
pub(crate) fn prescribe<const D: usize>(
    model: &Model<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<f64, StepError> {
    let end = state.time + map.dt;
    let mut largest: f64 = 0.0;
    let mut sum = 0.0;
    for (i, b) in model.bodies.iter().enumerate() {
        let rates = &mut work.drives[i].rates;
        for ((dof, driver), rate) in b.body.held().dofs().iter().zip(model.drivers(i)).zip(rates) {
            let (node, component) = (b.first_node + dof.node as usize, dof.component as usize);
            let there = driver.map_or_else(Default::default, |k| model.signal(k, component, end));
            let d = there.value - state.displacement[node][component];
            work.motion[node][component] = d;
            *rate = if map.is_static() { 0.0 } else { there.rate };
            largest = largest.max(d.abs());
            sum += d + there.rate;
        }
    }
    let obstacles = model.node_count()..;
    for ((d, u), motion) in work.motion[obstacles.clone()]
        .iter_mut()
        .zip(&state.displacement[obstacles])
        .zip(&model.obstacle_motions)
    {
        *d = motion.increment(u, end, map.dt);
        if let ObstacleMotion::Displacement(_) = motion {
            largest = largest.max(d.norm());
        }
        sum += d.sum();
    }
    if sum.is_finite() { Ok(largest) } else { Err(StepError::NotFinite("prescribed motion")) }
}

/// What the supports of body `index` do, at the final motion of a step.
///
/// `residual` is that of the body without reactions, scaled as the step's; its held rows are what the supports make up for:
/// with R = −residual, the force of a support less what contact presses on it, their work is Σ R·d plus, where v₊ is not what the
/// scheme makes of d, [M(v₊ − v)]·(½(v + v₊) − d/Δt). The change of kinetic energy is then closed whatever the motion.
pub(crate) fn support_work<const D: usize>(
    step: &BodyStep<'_, D>,
    rates: &[f64],
    residual: &[Vector<D>],
    momentum_change: &[Vector<D>],
) -> f64 {
    let mut work = 0.0;
    for (dof, rate) in step.body.held().dofs().iter().zip(rates) {
        let (n, i) = (dof.node as usize, dof.component as usize);
        let d = step.motion[n][i];
        work -= residual[n][i] * d;
        if !step.map.is_static() {
            let mean = 0.5 * (step.velocity[n][i] + rate);
            work += momentum_change[n][i] * (mean - d / step.map.dt);
        }
    }
    work
}
