//! The iteration matrix K̄ of each body.

use carom_fem::sparse::{Factor, NodalMatrix};
use carom_fem::{Body, Worked};
use carom_mesh::{Matrix, Vector};

use crate::StepMap;
use crate::body_step::STEADYING;
use crate::error::StepError;

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
    ///
    /// A configuration under strong compression, or a guess on the way to one, may be where K̄ is indefinite. The stiffness of the
    /// reference configuration, turned, serves there: slower, but it never is.
    pub fn factorize(
        &mut self,
        worked: &Worked<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
    ) -> Result<(), StepError> {
        self.factorize_at(worked, map, u, frame).or_else(|_| {
            self.factorize_at(
                &worked.body.after(&[]),
                map,
                &vec![Vector::zeros(); u.len()],
                &Matrix::identity(),
            )?;
            self.turn_to(frame);
            Ok(())
        })
    }

    fn factorize_at(
        &mut self,
        worked: &Worked<'_, D>,
        map: &StepMap,
        u: &[Vector<D>],
        frame: &Matrix<D>,
    ) -> Result<(), StepError> {
        let body = worked.body;
        let mut stiffness = worked.stiffness(u);
        for (&n, k) in body.massless().iter().zip(body.massless_stiffness()) {
            stiffness.values[body.graph().entry(n, n)] += Matrix::from_diagonal_element(STEADYING * k);
        }
        let (k, c, m) = (map.stiffness_coefficient(), map.damping_coefficient(), map.mass_coefficient());
        let damping = body.damping();
        let mass_coefficient = m + c * damping.mass;
        let mass: &NodalMatrix<f64> = body.mass();
        let damping_stiffness = body.damping_stiffness();
        // The force of viscosity is that of the mean rate of the step, d/Δt, whatever the scheme.
        let viscosity = body.viscosity(u);
        self.map = None;
        self.factor.factorize(|entry| {
            let mut block = stiffness.values[entry] * k
                + Matrix::from_diagonal_element(mass.values[entry] * mass_coefficient);
            if let Some(k0) = damping_stiffness {
                block += frame * k0.values[entry] * frame.transpose() * (c * damping.stiffness);
            }
            if let Some(viscosity) = &viscosity {
                block += viscosity.values[entry] / map.dt;
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
