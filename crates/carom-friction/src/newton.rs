use crate::block_lu::NoStructure;
use crate::clock::Clock;
use crate::equation::Equation;
use crate::lu::Lu;
use crate::{ContactProblem, Matrix, Vector};

/// A contact problem with the motions w = W r + q + shift (r − centre): a step of the proximal point method.
///
/// A shift > 0 makes every linear system regular, however redundant the contacts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shifted<'a, const D: usize> {
    pub problem: &'a ContactProblem<D>,
    /// ρ of every contact [N/m]: 1/λ_max(W_ii), or a part of it.
    pub rho: &'a [f64],
    /// Compliance added to every contact [m/N].
    pub shift: f64,
    pub centre: &'a [Vector<D>],
}

impl<const D: usize> Shifted<'_, D> {
    fn motion(&self, i: usize, r: &[Vector<D>]) -> Vector<D> {
        self.problem.motion(i, r) + (r[i] - self.centre[i]) * self.shift
    }

    /// ρ where the shift is added to the compliance.
    fn rho(&self, i: usize) -> f64 {
        if self.rho[i] > 0.0 { self.rho[i] / (1.0 + self.rho[i] * self.shift) } else { 1.0 / self.shift }
    }
}

/// Semismooth Newton iterations on the contacts' equations, and their memory.
#[derive(Debug)]
pub(crate) struct Newton<const D: usize> {
    pub lu: Lu<D>,
    clock: Clock,
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
    /// Whether ‖φ‖ fell to what was wanted.
    pub converged: bool,
}

/// A full step is taken unless ‖φ‖ becomes larger than in each of the last iterations, and half of it else. More care costs
/// more than it saves, as the steps that follow a kink of the equations have to go uphill. Where Newton's method fails all
/// the same, a larger shift helps, not a shorter step.
const MEMORY: usize = 3;

impl<const D: usize> Newton<D> {
    /// With factors of at most `max_blocks` blocks.
    pub fn new(problem: &ContactProblem<D>, max_blocks: usize, clock: Clock) -> Result<Self, NoStructure> {
        let n = problem.len();
        Ok(Self {
            lu: Lu::new(&problem.w, max_blocks, clock)?,
            clock,
            by_motion: vec![Matrix::zeros(); n],
            by_reaction: vec![Matrix::zeros(); n],
            motion: vec![Vector::zeros(); n],
            step: vec![Vector::zeros(); n],
            motion_step: vec![Vector::zeros(); n],
        })
    }

    /// What an iteration costs, in products of blocks.
    pub fn cost(&self, problem: &ContactProblem<D>) -> usize {
        self.lu.products() + 3 * problem.w.block_count() + 50 * problem.len()
    }

    /// Improves `r` until ‖φ‖ ≤ `wanted` [N], or as long as `goes_on` says so of the iterations made.
    pub fn solve(
        &mut self,
        shifted: &Shifted<'_, D>,
        equation: Equation,
        r: &mut [Vector<D>],
        wanted: f64,
        goes_on: impl Fn(usize) -> bool,
    ) -> NewtonEnd {
        let problem = shifted.problem;
        let n = problem.len();
        for i in 0..n {
            self.motion[i] = shifted.motion(i, r);
        }
        // What is not a number must not outlive the iterations that it ended.
        self.step.fill(Vector::zeros());
        self.motion_step.fill(Vector::zeros());
        let mut merit = self.merit(shifted, equation, r, 0.0);
        let mut recent = [merit; MEMORY];
        let mut iterations = 0;
        while merit > wanted && merit.is_finite() && goes_on(iterations) {
            for i in 0..n {
                let at = equation.linearise(&r[i], &self.motion[i], problem.mu[i], shifted.rho(i));
                self.step[i] = -at.value;
                self.by_motion[i] = at.by_motion;
                self.by_reaction[i] = at.by_reaction;
            }
            let (a, b) = (&self.by_motion, &self.by_reaction);
            if self.lu.factorize(&problem.w, shifted.shift, a, b, self.clock).is_err() {
                return NewtonEnd { iterations: iterations + 1, converged: false };
            }
            self.lu.solve(&mut self.step);
            for i in 0..n {
                self.motion_step[i] = problem.w.row_times(i, &self.step) + self.step[i] * shifted.shift;
            }
            recent[iterations % MEMORY] = merit;
            merit = self.merit(shifted, equation, r, 1.0);
            let mut length = 1.0;
            if merit > recent.iter().fold(0.0, |a, &b| b.max(a)) {
                let half = self.merit(shifted, equation, r, 0.5);
                if half < merit {
                    (merit, length) = (half, 0.5);
                }
            }
            for i in 0..n {
                r[i] += self.step[i] * length;
                self.motion[i] += self.motion_step[i] * length;
            }
            iterations += 1;
        }
        NewtonEnd { iterations, converged: merit <= wanted }
    }

    /// ‖φ‖ at r + length · step.
    fn merit(&self, shifted: &Shifted<'_, D>, equation: Equation, r: &[Vector<D>], length: f64) -> f64 {
        let mut sum = 0.0;
        for i in 0..r.len() {
            let (r, w) = (r[i] + self.step[i] * length, self.motion[i] + self.motion_step[i] * length);
            sum += equation.value(&r, &w, shifted.problem.mu[i], shifted.rho(i)).norm_squared();
        }
        sum.sqrt()
    }
}
