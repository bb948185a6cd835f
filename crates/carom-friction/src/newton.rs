use crate::block_lu::BlockLu;
use crate::equation::Equation;
use crate::{ContactProblem, Matrix, Vector};

/// Semismooth Newton iterations on the contacts' equations with the motions w = W r + q + shift (r − centre).
///
/// A shift > 0 is a step of the proximal point method; it makes every linear system regular, however redundant the contacts.
#[derive(Debug)]
pub(crate) struct Newton<const D: usize> {
    equation: Equation,
    lu: BlockLu<D>,
    by_motion: Vec<Matrix<D>>,
    by_reaction: Vec<Matrix<D>>,
    motion: Vec<Vector<D>>,
    step: Vec<Vector<D>>,
    motion_step: Vec<Vector<D>>,
}

/// How Newton's iterations ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct NewtonEnd {
    pub iterations: usize,
    /// ‖φ‖ at the last point [N].
    pub merit: f64,
}

/// Halvings of a step in the search for a smaller merit.
const HALVINGS: usize = 8;

impl<const D: usize> Newton<D> {
    /// None if the factors would need more than `max_blocks` blocks.
    pub fn new(problem: &ContactProblem<D>, equation: Equation, max_blocks: usize) -> Option<Self> {
        let n = problem.len();
        Some(Self {
            equation,
            lu: BlockLu::new(&problem.w, max_blocks)?,
            by_motion: vec![Matrix::zeros(); n],
            by_reaction: vec![Matrix::zeros(); n],
            motion: vec![Vector::zeros(); n],
            step: vec![Vector::zeros(); n],
            motion_step: vec![Vector::zeros(); n],
        })
    }

    /// Improves `r` until ‖φ‖ ≤ `wanted`, no step helps or `max_iterations` are made.
    #[allow(clippy::too_many_arguments)]
    pub fn solve(
        &mut self,
        problem: &ContactProblem<D>,
        rho: &[f64],
        shift: f64,
        centre: &[Vector<D>],
        r: &mut [Vector<D>],
        wanted: f64,
        max_iterations: usize,
    ) -> NewtonEnd {
        let n = problem.len();
        for i in 0..n {
            self.motion[i] = problem.motion(i, r) + (r[i] - centre[i]) * shift;
        }
        let mut merit = self.merit(problem, rho, shift, r, 0.0);
        for iteration in 0..max_iterations {
            if merit <= wanted || !merit.is_finite() {
                return NewtonEnd { iterations: iteration, merit };
            }
            for i in 0..n {
                let rho = rho[i] / (1.0 + rho[i] * shift);
                let at = self.equation.linearise(&r[i], &self.motion[i], problem.mu[i], rho);
                self.step[i] = -at.value;
                self.by_motion[i] = at.by_motion;
                self.by_reaction[i] = at.by_reaction;
            }
            if self.lu.factorize(&problem.w, shift, &self.by_motion, &self.by_reaction).is_err() {
                return NewtonEnd { iterations: iteration + 1, merit };
            }
            self.lu.solve(&mut self.step);
            for i in 0..n {
                self.motion_step[i] = problem.w.row_times(i, &self.step) + self.step[i] * shift;
            }
            let (mut length, mut best) = (1.0, (f64::INFINITY, 0.0));
            for _ in 0..HALVINGS {
                let trial = self.merit(problem, rho, shift, r, length);
                if trial < best.0 {
                    best = (trial, length);
                }
                if trial < (1.0 - 1e-4 * length) * merit {
                    break;
                }
                length *= 0.5;
            }
            let (trial, length) = best;
            if length == 0.0 {
                return NewtonEnd { iterations: iteration + 1, merit };
            }
            for i in 0..n {
                r[i] += self.step[i] * length;
                self.motion[i] += self.motion_step[i] * length;
            }
            merit = trial;
        }
        NewtonEnd { iterations: max_iterations, merit }
    }

    /// ‖φ‖ at r + length · step.
    fn merit(
        &self,
        problem: &ContactProblem<D>,
        rho: &[f64],
        shift: f64,
        r: &[Vector<D>],
        length: f64,
    ) -> f64 {
        let mut sum = 0.0;
        for i in 0..problem.len() {
            let rho = rho[i] / (1.0 + rho[i] * shift);
            let (r, w) = (r[i] + self.step[i] * length, self.motion[i] + self.motion_step[i] * length);
            sum += self.equation.value(&r, &w, problem.mu[i], rho).norm_squared();
        }
        sum.sqrt()
    }
}
