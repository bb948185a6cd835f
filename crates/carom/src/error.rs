use carom_fem::FemError;
use carom_friction::SolveReport;
use thiserror::Error;

/// A scenario that cannot be run, found before anything is computed.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{message}")]
pub struct InputError {
    /// Where in the scenario, as a dotted path such as `bodies.1.mesh.radius`.
    pub key: String,
    /// What is wrong and what to do.
    pub message: String,
    /// Whether it is the mesh that is wrong.
    pub is_mesh: bool,
}

impl InputError {
    /// An error at `key`.
    pub fn new(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { key: key.into(), message: message.into(), is_mesh: false }
    }

    /// An error of the mesh at `key`.
    pub fn mesh(key: impl Into<String>, message: impl Into<String>) -> Self {
        Self { is_mesh: true, ..Self::new(key, message) }
    }
}

/// Why a step has no result. The state it started from is intact.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum StepError {
    /// The iterations on the equations of motion did not converge.
    #[error(
        "Newton's iterations stopped after {iterations} with a last correction of {correction:.3e} m (wanted {wanted:.3e} m)"
    )]
    Newton {
        /// Iterations made.
        iterations: usize,
        /// Largest displacement in the last correction [m].
        correction: f64,
        /// What would have been small enough [m].
        wanted: f64,
    },
    /// Iterations went further away than the step could have gone.
    #[error(
        "Newton's iterations went astray: correction {iterations} is {correction:.3e} m, where the step set out with {reach:.3e} m"
    )]
    Astray {
        /// Iterations made.
        iterations: usize,
        /// Largest displacement in the last correction [m].
        correction: f64,
        /// The larger of the first correction and of the motion in the step [m].
        reach: f64,
    },
    /// Load steps led further away than there is anything to hold on to.
    #[error(
        "a body moves by {motion:.3e} m, and the largest is {size:.3e} m large: the loads outgrow what bears them, or the \
         step is too long for them"
    )]
    Runaway {
        /// Largest motion of a node in the step [m].
        motion: f64,
        /// Diameter of the largest body [m].
        size: f64,
    },
    /// The friction solver did not reach its tolerance.
    #[error("the contact problem of {contacts} contacts ended as {} after {} iterations at a residual of {:.3e}", report.status.name(), report.iterations, report.measure.natural_residual)]
    Friction {
        /// Number of contacts.
        contacts: usize,
        /// What the solver said.
        report: Box<SolveReport>,
    },
    /// A friction law gave what is no coefficient.
    #[error(
        "the friction law gives {coefficient} at a slip speed of {speed:.3e} m/s after {distance:.3e} m of slip: it must be between 0 and 1000"
    )]
    FrictionLaw {
        /// What it gave.
        coefficient: f64,
        /// Slip speed [m/s].
        speed: f64,
        /// Distance of slip [m].
        distance: f64,
    },
    /// No friction coefficient was found that is what its law says of the motion that it leads to.
    #[error(
        "the friction law has no fixed point in this step: the last coefficient is {off:.3e} away from what the law says of the \
         motion that it leads to; take a shorter time step, or let friction fall less steeply"
    )]
    FrictionUnsettled {
        /// How far the last coefficient was from the law.
        off: f64,
    },
    /// A node went through its target outside of the contact search.
    #[error("a node came into contact outside of a search margin of {margin:.3e} m")]
    MissedContact {
        /// The margin [m].
        margin: f64,
    },
    /// On its way through the step something went through something else.
    #[error(
        "{first:?} and {second:?} go through one another within the step, and no contact was found: take a shorter time step"
    )]
    PassedThrough {
        /// One of them.
        first: String,
        /// The other, or the same body.
        second: String,
    },
    /// What the massless nodes took from the balance of energy could not be given back.
    #[error(
        "contact of massless nodes leaves {missing:.3e} J unaccounted for, where {allowed:.3e} J are allowed: shorten the time \
         step, or choose the contact condition gap or midpoint"
    )]
    Unbalanced {
        /// What the step left over [J].
        missing: f64,
        /// What a step may [J].
        allowed: f64,
    },
    /// In a static analysis nothing keeps a body where it is.
    #[error(
        "body {body:?} is not held: it is free to {motion}, and the forces on it drive it there; support it, start it in \
         contact with what holds it, or give friction"
    )]
    NotHeld {
        /// The body.
        body: String,
        /// What nothing resists, in words.
        motion: String,
    },
    /// In a static analysis nothing near the last state resists: its tangent is indefinite however much holds its motion back.
    #[error(
        "no state near the last one is in stable equilibrium: body {body:?} buckles, snaps through or is pulled apart{motion}; drive it \
         by a displacement in place of a load, or let it move on by analysis.stabilisation = \"dynamic\""
    )]
    Unstable {
        /// The body.
        body: String,
        /// Where it gives way and in which direction, in words, if that is known.
        motion: String,
    },
    /// In a static analysis bodies press one another out of the way, and their contact problem has no solution that was found. Whether they are unstable is
    /// not known.
    #[error(
        "no equilibrium near the last state was found: body {body:?} and what it touches may be about to buckle or to snap through (their contact \
         problem is indefinite, and no solution was found); let them move on by analysis.stabilisation = \"dynamic\""
    )]
    Indefinite {
        /// The body.
        body: String,
    },
    /// Where there is no equilibrium nearby, and inertia took the body to no other either.
    #[error(
        "no state near the last one is in stable equilibrium, and with inertia, as analysis.stabilisation says, body {body:?} comes to rest in \
         none{motion}: lower the load, drive it by a displacement in its place, or choose a dynamic analysis"
    )]
    Restless {
        /// The body.
        body: String,
        /// See [`Self::Unstable`].
        motion: String,
    },
    /// Something was not a finite number.
    #[error("the {0} is not finite")]
    NotFinite(&'static str),
    /// The iteration matrix could not be factorised.
    #[error(transparent)]
    Matrix(#[from] FemError),
}

impl StepError {
    /// Whether what failed was a factor that the memory does not suffice for.
    pub(crate) fn is_of_memory(&self) -> bool {
        matches!(self, Self::Matrix(FemError::Memory { .. }))
    }
}
