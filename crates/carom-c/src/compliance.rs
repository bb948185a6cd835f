//! K̄⁻¹ as the caller knows it, and W = Hᵀ K̄⁻¹ H.

use std::ffi::{c_int, c_void};

use crate::status::{Failure, carom_status};

/// Solves K x = b for several right-hand sides with the caller's symmetric, positive definite K.
///
/// `right_hand_sides` [N] and `solutions` [m] have `columns` columns of `unknowns` numbers each, one column after the other; solutions are zero before.
/// `context` is what was given with the function. 0 says that they were found, everything else that the solver failed. It must not call carom with
/// the handle that it is called for, and no exception or longjmp may leave it.
#[allow(non_camel_case_types)]
pub type carom_solver = Option<
    unsafe extern "C" fn(
        context: *mut c_void,
        unknowns: usize,
        columns: usize,
        right_hand_sides: *const f64,
        solutions: *mut f64,
    ) -> c_int,
>;

/// Right-hand sides that a solver is given at once: enough to go through its factor once for many, and no more memory than so many vectors.
const AT_ONCE: usize = 16;

/// Asymmetry of W relative to its largest entry above which K̄⁻¹ is not taken for symmetric; less is what solvers that iterate leave.
const LARGEST_ASYMMETRY: f64 = 0.01;

/// H by columns: the unknowns that a component of a reaction acts on, and how much. An unknown may be there several times.
#[derive(Debug, Default)]
pub struct Columns {
    /// Where each column starts, and the end of the last.
    pub starts: Vec<usize>,
    pub unknowns: Vec<usize>,
    pub values: Vec<f64>,
}

impl Columns {
    /// Takes the entries of every column.
    pub fn set(&mut self, columns: Vec<Vec<(usize, f64)>>) {
        *self = Self { starts: vec![0], ..Self::default() };
        for column in columns {
            let (mut unknowns, mut values) = column.into_iter().unzip();
            self.unknowns.append(&mut unknowns);
            self.values.append(&mut values);
            self.starts.push(self.unknowns.len());
        }
    }

    pub fn count(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    fn column(&self, j: usize) -> impl Iterator<Item = (usize, f64)> {
        let entries = self.starts[j]..self.starts[j + 1];
        self.unknowns[entries.clone()].iter().copied().zip(self.values[entries].iter().copied())
    }

    /// Adds column j times a factor.
    fn add_to(&self, j: usize, factor: f64, out: &mut [f64]) {
        self.column(j).for_each(|(unknown, value)| out[unknown] += factor * value);
    }

    /// Column j times a vector.
    fn dot(&self, j: usize, vector: &[f64]) -> f64 {
        self.column(j).map(|(unknown, value)| value * vector[unknown]).sum()
    }

    /// H r [N].
    pub fn times(&self, reactions: &[f64], unknowns: usize) -> Vec<f64> {
        let mut out = vec![0.0; unknowns];
        reactions.iter().enumerate().for_each(|(j, &r)| self.add_to(j, r, &mut out));
        out
    }

    /// Hᵀ d [m].
    pub fn transposed_times(&self, motion: &[f64]) -> Vec<f64> {
        (0..self.count()).map(|j| self.dot(j, motion)).collect()
    }
}

/// The caller's solver with its context.
pub struct Compliance {
    solver: carom_solver,
    context: *mut c_void,
    unknowns: usize,
}

impl Compliance {
    /// # Safety
    /// The function may be called with the context for as long as this lives.
    pub unsafe fn new(solver: carom_solver, context: *mut c_void, unknowns: usize) -> Self {
        Self { solver, context, unknowns }
    }

    /// K̄⁻¹ times columns, one after the other.
    pub fn apply(&self, right_hand_sides: &[f64]) -> Result<Vec<f64>, Failure> {
        let solver = self.solver.ok_or_else(|| {
            Failure::invalid("solver is a null pointer; give a function that solves with K")
        })?;
        let mut solutions = vec![0.0; right_hand_sides.len()];
        let columns = right_hand_sides.len() / self.unknowns.max(1);
        let (given, found) = (right_hand_sides.as_ptr(), solutions.as_mut_ptr());
        // SAFETY: the promise of `new`; both arrays have `columns` columns of `unknowns` numbers.
        let code = unsafe { solver(self.context, self.unknowns, columns, given, found) };
        if code != 0 {
            let message = format!("solver: the function that solves with K returned {code}");
            return Err(Failure::new(carom_status::SOLVER_FAILED, message));
        }
        match solutions.iter().position(|x| !x.is_finite()) {
            Some(k) => Err(Failure::invalid(format!(
                "solver: its answer is {} at unknown {}; K must be regular, so support what moves freely or give it mass",
                solutions[k],
                k % self.unknowns,
            ))),
            None => Ok(solutions),
        }
    }
}

/// W = Hᵀ K̄⁻¹ H [m/N], row by row, made symmetric where round-off is not.
pub fn condensed(h: &Columns, compliance: &Compliance) -> Result<Vec<f64>, Failure> {
    let (size, unknowns) = (h.count(), compliance.unknowns);
    let mut w = vec![0.0; size * size];
    if unknowns == 0 {
        return Ok(w);
    }
    for first in (0..size).step_by(AT_ONCE) {
        let columns = first..size.min(first + AT_ONCE);
        let mut right_hand_sides = vec![0.0; columns.len() * unknowns];
        for (j, out) in columns.clone().zip(right_hand_sides.chunks_exact_mut(unknowns)) {
            h.add_to(j, 1.0, out);
        }
        let solutions = compliance.apply(&right_hand_sides)?;
        for (j, solution) in columns.zip(solutions.chunks_exact(unknowns)) {
            (0..size).for_each(|i| w[i * size + j] = h.dot(i, solution));
        }
    }
    let largest = w.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
    for i in 0..size {
        for j in 0..i {
            let (below, above) = (w[i * size + j], w[j * size + i]);
            let asymmetry = (below - above).abs();
            if asymmetry > LARGEST_ASYMMETRY * largest {
                return Err(Failure::invalid(format!(
                    "solver: W is asymmetric by {:.2} of its largest entry, at [{i}, {j}], where {LARGEST_ASYMMETRY} is allowed; give the solver of a symmetric K, and solve it more accurately if it iterates",
                    asymmetry / largest,
                )));
            }
            (w[i * size + j], w[j * size + i]) = (0.5 * (below + above), 0.5 * (below + above));
        }
    }
    Ok(w)
}

/// Refuses a W by which a force along the normal moves its contact against itself, or not at all.
pub fn refuse_rigid(w: &[f64], size: usize, dimension: usize) -> Result<(), Failure> {
    for contact in 0..size / dimension {
        let yields = w[contact * dimension * (size + 1)];
        if yields.is_nan() || yields <= 0.0 {
            return Err(Failure::invalid(format!(
                "solver: a force along the normal of contact {contact} moves it by {yields} m/N; K must be positive definite"
            )));
        }
    }
    Ok(())
}
