use serde::{Deserialize, Serialize};

/// The solvers by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SolverKind {
    /// Starts cheaply and escalates where that does not converge.
    #[default]
    Auto,
    /// Block Gauss–Seidel with the bi-potential fixed point on each contact.
    GaussSeidel,
    /// Block Gauss–Seidel with closed forms on each contact.
    GaussSeidelEnumerative,
    /// Block Gauss–Seidel with Newton's method on each contact.
    GaussSeidelAlartCurnier,
    /// The bi-potential fixed point on all contacts at once, with a step that adapts itself.
    Uzawa,
    /// Accelerated projected gradients.
    ProjectedGradient,
    /// The alternating direction method of multipliers.
    Admm,
    /// The proximal point method.
    Proximal,
    /// Semismooth Newton on the equations of Alart and Curnier.
    NewtonAlartCurnier,
    /// Semismooth Newton on the bi-potential's natural map.
    NewtonNaturalMap,
}

impl SolverKind {
    /// Every solver.
    pub const ALL: [SolverKind; 10] = [
        SolverKind::Auto,
        SolverKind::GaussSeidel,
        SolverKind::GaussSeidelEnumerative,
        SolverKind::GaussSeidelAlartCurnier,
        SolverKind::Uzawa,
        SolverKind::ProjectedGradient,
        SolverKind::Admm,
        SolverKind::Proximal,
        SolverKind::NewtonAlartCurnier,
        SolverKind::NewtonNaturalMap,
    ];

    /// The name, as in case files and on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            SolverKind::Auto => "auto",
            SolverKind::GaussSeidel => "gauss-seidel",
            SolverKind::GaussSeidelEnumerative => "gauss-seidel-enumerative",
            SolverKind::GaussSeidelAlartCurnier => "gauss-seidel-alart-curnier",
            SolverKind::Uzawa => "uzawa",
            SolverKind::ProjectedGradient => "projected-gradient",
            SolverKind::Admm => "admm",
            SolverKind::Proximal => "proximal",
            SolverKind::NewtonAlartCurnier => "newton-alart-curnier",
            SolverKind::NewtonNaturalMap => "newton-natural-map",
        }
    }

    /// The solver of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}
