//! The iteration matrix K̄ of each body and the residual of its equation of motion.

use carom_fem::Body;
use carom_fem::sparse::{Factor, NodalMatrix};
use carom_mesh::{Matrix, Vector};

use crate::error::StepError;
use crate::model::{Model, ModelBody};
use crate::state::{State, dot};
use crate::{StepMap, StressRule};

/// The factor of K̄ = ξ K + ξ/(θΔt) C + M/(θΔt²) (3) of one body.
///
/// Reactions never enter K̄, so bodies are uncoupled in it and one factor serves for many steps: it is made in one
/// configuration and applied in the frame that turns with the body since (M is isotropic and an objective law turns its
/// stiffness along). Newton's iterations then converge linearly but fast, and the factor is renewed where they do not. Tied nodes are its affair
/// alone: it takes and gives vectors of all nodes (see [`Factor`]), and what starts equal at two of them stays so.
#[derive(Debug)]
pub(crate) struct BodyOperator<const D: usize> {
    factor: Factor<D>,
    /// The map that K̄ was made for.
    map: Option<StepMap>,
    /// Frame of the body in the configuration of K.
    factor_frame: Matrix<D>,
    /// Rotation since then.
    turn: Matrix<D>,
    /// Grows with every factorisation, so that what was derived from a factor knows when it is stale.
    pub generation: u64,
    scratch: Vec<Vector<D>>,
}

impl<const D: usize> BodyOperator<D> {
    pub fn new(body: &Body<D>) -> Result<Self, StepError> {
        Ok(Self {
            factor: Factor::new(body.graph(), body.mesh().ties())?,
            map: None,
            factor_frame: Matrix::identity(),
            turn: Matrix::identity(),
            generation: 0,
            scratch: vec![Vector::zeros(); body.node_count()],
        })
    }

    /// Whether the factor belongs to steps like `map`.
    pub fn fits(&self, map: &StepMap) -> bool {
        self.factor.is_factorized() && self.map == Some(*map)
    }

    /// Makes the factor with the stiffness at `u`, where the frame of the body is `frame`.
    pub fn factorize(
        &mut self,
        body: &Body<D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
    ) -> Result<(), StepError> {
        let stiffness = body.stiffness(u);
        let (k, c, m) = (map.stiffness_coefficient(), map.damping_coefficient(), map.mass_coefficient());
        let damping = body.damping();
        let mass_coefficient = m + c * damping.mass;
        let mass: &NodalMatrix<f64> = body.mass();
        let damping_stiffness = body.damping_stiffness();
        self.map = None;
        self.factor.factorize(|entry| {
            let mut block = stiffness.values[entry] * k
                + Matrix::from_diagonal_element(mass.values[entry] * mass_coefficient);
            if let Some(k0) = damping_stiffness {
                block += frame * k0.values[entry] * frame.transpose() * (c * damping.stiffness);
            }
            block
        })?;
        self.map = Some(*map);
        self.factor_frame = *frame;
        self.turn = Matrix::identity();
        self.generation += 1;
        Ok(())
    }

    /// Follows the body, whose frame is now `frame`.
    pub fn turn_to(&mut self, frame: &Matrix<D>) {
        self.turn = frame * self.factor_frame.transpose();
    }

    /// The rotation of the body since the factor was made.
    pub fn turn(&self) -> &Matrix<D> {
        &self.turn
    }

    /// Overwrites `x` with K̄⁻¹ x.
    pub fn solve(&mut self, x: &mut [Vector<D>]) {
        for (s, x) in self.scratch.iter_mut().zip(x.iter()) {
            *s = self.turn.tr_mul(x);
        }
        self.factor.solve(&mut self.scratch);
        for (s, x) in self.scratch.iter().zip(x) {
            *x = self.turn * s;
        }
    }

    /// Overwrites `x` with the factor's solution, in the frame of the factor.
    pub fn solve_in_factor_frame(&mut self, x: &mut [Vector<D>]) {
        self.factor.solve(x);
    }
}

/// Where a step stands: the part of one body of a state, of its guess for the end, and of what stays fixed in between.
pub(crate) struct BodyStep<'a, const D: usize> {
    pub body: &'a Body<D>,
    pub map: &'a StepMap,
    pub gravity: &'a Vector<D>,
    /// Frame of the body in this step.
    pub frame: &'a Matrix<D>,
    /// v at the start.
    pub velocity: &'a [Vector<D>],
    /// u at the start.
    pub start: &'a [Vector<D>],
    /// ∂E/∂u at the start.
    pub internal_force: &'a [Vector<D>],
    /// d = u₊ − u.
    pub motion: &'a [Vector<D>],
    /// u₊.
    pub displacement: &'a [Vector<D>],
}

/// Scratch vectors of one body.
#[derive(Debug)]
pub(crate) struct ResidualScratch<const D: usize> {
    a: Vec<Vector<D>>,
    b: Vec<Vector<D>>,
    c: Vec<Vector<D>>,
}

impl<const D: usize> ResidualScratch<D> {
    pub fn new(nodes: usize) -> Self {
        let zeros = vec![Vector::zeros(); nodes];
        Self { a: zeros.clone(), b: zeros.clone(), c: zeros }
    }
}

impl<'a, const D: usize> BodyStep<'a, D> {
    /// The part of body `b`, whose frame is `frame`; `motion` and `displacement` are those of the whole model.
    pub fn new(
        model: &'a Model<D>,
        b: &'a ModelBody<D>,
        map: &'a StepMap,
        frame: &'a Matrix<D>,
        state: &'a State<D>,
        motion: &'a [Vector<D>],
        displacement: &'a [Vector<D>],
    ) -> Self {
        let nodes = b.nodes();
        Self {
            body: &b.body,
            map,
            gravity: &model.gravity,
            frame,
            velocity: &state.velocity[nodes.clone()],
            start: &state.displacement[nodes.clone()],
            internal_force: &state.internal_force[nodes.clone()],
            motion: &motion[nodes.clone()],
            displacement: &displacement[nodes],
        }
    }

    /// Writes the residual F̄ + F̄_acc (3) without reactions [N] to `out`:
    /// M(g − (v₊ − v)/Δt) − f̄ − C v̄, with v̄ = (1 − ξ)v + ξv₊ and f̄ by the scheme's [`StressRule`].
    pub fn residual(&self, scratch: &mut ResidualScratch<D>, out: &mut [Vector<D>]) {
        let map = self.map;
        let ResidualScratch { a, b, .. } = scratch;
        for ((b, d), v) in b.iter_mut().zip(self.motion).zip(self.velocity) {
            *b = self.gravity - (map.end_velocity(v, d) - v) / map.dt;
        }
        self.body.mass().multiply(b, out);
        match map.stress {
            StressRule::Weighted => {
                self.body.internal_force(self.displacement, a);
                for ((out, f0), f1) in out.iter_mut().zip(self.internal_force).zip(a.iter()) {
                    *out -= f0 * (1.0 - map.xi) + f1 * map.xi;
                }
            }
            StressRule::Conserving => {
                self.body.conserving_force(self.start, self.displacement, a);
                out.iter_mut().zip(a.iter()).for_each(|(out, f)| *out -= f);
            }
        }
        if self.body.damping().is_active() {
            let viscous = self.viscous_force(scratch);
            out.iter_mut().zip(viscous).for_each(|(out, f)| *out -= f);
        }
    }

    /// Work of gravity and dissipation by damping over the step [J].
    pub fn external_and_viscous_work(&self, scratch: &mut ResidualScratch<D>) -> (f64, f64) {
        let external = self.gravity.dot(&self.body.mean(self.motion)) * self.body.total_mass();
        let damped = self.body.damping().is_active();
        let viscous = if damped { dot(self.motion, self.viscous_force(scratch)) } else { 0.0 };
        (external, viscous)
    }

    /// The viscous force C v̄ [N].
    fn viscous_force<'s>(&self, scratch: &'s mut ResidualScratch<D>) -> &'s [Vector<D>] {
        let ResidualScratch { a, b, c } = scratch;
        for ((a, d), v) in a.iter_mut().zip(self.motion).zip(self.velocity) {
            *a = self.map.mean_velocity(v, d);
        }
        self.body.damping_force(self.frame, a, b, c);
        b
    }
}

/// The largest motion of a node that free flight predicts for the step [m].
pub(crate) fn predicted_motion<const D: usize>(state: &State<D>, gravity: &Vector<D>, dt: f64) -> f64 {
    let speed = state.velocity.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
    (speed + gravity.norm() * dt) * dt
}
