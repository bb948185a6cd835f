use faer::sparse::SparseColMat;

use crate::Vector;

/// Find r, v and w with M v = H r + f and w = Hᵀ v + b, so that r and w obey Signorini's and Coulomb's laws.
///
/// In any consistent units: v may be velocities and r impulses, or v displacements and r forces.
///
/// ```
/// use carom_friction::{GlobalMethod, GlobalProblem, SolverKind, SparseColMat, StoppingRule, Triplet, Vector};
///
/// // Two masses of 1 on a spring, the first pressed down with 1 and pushed sideways with 2, friction 0.5.
/// let matrix = |entries: &[(usize, usize, f64)], columns| {
///     let triplets: Vec<_> = entries.iter().map(|&(i, j, x)| Triplet::new(i, j, x)).collect();
///     SparseColMat::try_new_from_triplets(4, columns, &triplets).expect("inside")
/// };
/// let problem = GlobalProblem::<2> {
///     m: matrix(&[(0, 0, 1.0), (1, 1, 2.0), (1, 3, -1.0), (2, 2, 1.0), (3, 1, -1.0), (3, 3, 2.0)], 4),
///     h: matrix(&[(0, 0, 1.0), (1, 1, 1.0)], 2),
///     f: vec![-1.0, 2.0, 0.0, 0.0],
///     b: vec![Vector::zeros()],
///     mu: vec![0.5],
/// };
/// let mut r = vec![Vector::zeros()];
/// let answer = problem.solve(&mut r, GlobalMethod::Auto, SolverKind::Auto, &StoppingRule::default())?;
/// assert!(answer.report.is_solved());
/// assert!((r[0] - Vector::<2>::new(1.0, -0.5)).norm() < 1e-7);
/// assert!((answer.velocities[3] - 0.5).abs() < 1e-7);
/// # Ok::<(), carom_friction::SingularMatrix>(())
/// ```
#[derive(Debug, Clone)]
pub struct GlobalProblem<const D: usize> {
    /// Mass or stiffness matrix M, n_dof × n_dof, regular; symmetric positive definite as a rule.
    pub m: SparseColMat<usize, f64>,
    /// Maps reactions to forces on the unknowns: H, n_dof × n D, the columns of contact i being i D, …, i D + D − 1.
    pub h: SparseColMat<usize, f64>,
    /// Forces on the unknowns, n_dof.
    pub f: Vec<f64>,
    /// Motion of the contacts where the bodies rest, n.
    pub b: Vec<Vector<D>>,
    /// Friction coefficient of every contact, n.
    pub mu: Vec<f64>,
}

impl<const D: usize> GlobalProblem<D> {
    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.b.len()
    }

    /// Whether there is no contact at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.b.is_empty()
    }
}
