use crate::{
    Admm, Auto, FrictionSolver, GaussSeidel, Local, NewtonAlartCurnier, NewtonNaturalMap, ProjectedGradient,
    Proximal, SolverKind, Uzawa,
};

impl SolverKind {
    /// The solver of this kind.
    #[must_use]
    pub fn solver<const D: usize>(self) -> Box<dyn FrictionSolver<D>> {
        match self {
            SolverKind::Auto => Box::new(Auto),
            SolverKind::GaussSeidel => Box::new(GaussSeidel { local: Local::Bipotential }),
            SolverKind::GaussSeidelEnumerative => Box::new(GaussSeidel { local: Local::Enumerative }),
            SolverKind::GaussSeidelAlartCurnier => Box::new(GaussSeidel { local: Local::AlartCurnier }),
            SolverKind::Uzawa => Box::new(Uzawa),
            SolverKind::ProjectedGradient => Box::new(ProjectedGradient),
            SolverKind::Admm => Box::new(Admm),
            SolverKind::Proximal => Box::new(Proximal),
            SolverKind::NewtonAlartCurnier => Box::new(NewtonAlartCurnier),
            SolverKind::NewtonNaturalMap => Box::new(NewtonNaturalMap),
        }
    }
}
