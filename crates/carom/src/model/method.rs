use carom_friction::{FrictionSolver, StoppingRule};

use crate::body::Interval;
use crate::model::condition::ContactCondition;
use crate::scheme::Scheme;

/// When Newton's iterations stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonRule {
    /// Largest correction of a displacement, relative to the largest motion of a node in the step. In a static analysis it is relative
    /// to the largest displacement since the start, if that is more.
    pub tolerance: f64,
    /// Iterations after which the step fails.
    pub max_iterations: usize,
}

/// How a model is taken through time.
pub struct Method<const D: usize> {
    /// Time scheme.
    pub scheme: Scheme,
    /// Contact condition.
    pub condition: ContactCondition,
    /// Solver of the reduced contact problem.
    pub solver: Box<dyn FrictionSolver<D>>,
    /// When that solver stops.
    pub stopping: StoppingRule,
    /// Whether a second solver solves the problem of every step again (see [`crate::CrossCheck`]).
    pub cross_check: bool,
    /// When Newton's iterations stop.
    pub newton: NewtonRule,
    /// How often a step that fails is halved.
    pub max_halvings: u32,
    /// Whether load steps that find no equilibrium near the last one move on to another with inertia.
    pub bridges: bool,
    /// The bi-potential gap of a step that a certified run may have, relative to the largest energy of the run. If that is more, it is
    /// relative to the largest work of the reactions of a step over the motion that they prevent.
    pub certificate_tolerance: f64,
    /// How deep solids may be in one another in a completed run, relative to the diameter of the smaller facet that is there; beside what the
    /// condition lets them by its nature.
    pub penetration_tolerance: f64,
}

impl<const D: usize> Method<D> {
    /// The step of length `dt` [s] that starts at time `start` [s].
    #[must_use]
    pub fn interval(&self, start: f64, dt: f64) -> Interval {
        self.interval_by(self.scheme, [start, start + dt], dt)
    }

    /// A step of a bridge between two states of equilibrium: loads come from where they are at the first of these `times` [s] to where they are at
    /// the second, and the bodies move there for `dt` [s], as damped as the paper's scheme can make them.
    pub(crate) fn bridge(&self, times: [f64; 2], dt: f64) -> Interval {
        self.interval_by(Scheme::Theta { theta: 1.0, xi: 1.0 }, times, dt)
    }

    fn interval_by(&self, scheme: Scheme, [start, end]: [f64; 2], dt: f64) -> Interval {
        let map = scheme.step_map(dt);
        Interval {
            map,
            start,
            end,
            whole: dt,
            is_load_step: self.scheme == Scheme::Static,
            approximates: self.approximates(),
            is_blended: self.is_blended(),
        }
    }

    /// How deep solids may be in one another [m] where the smaller facet has the diameter `cell` [m]. Nodes of one side go behind the
    /// facets of the other by the `arcs` [m] that these stand for. Where velocities are ruled, what starts too near to be stopped is
    /// `let_in` [m]. More than half a cell is a way through.
    pub(crate) fn allowed_penetration(&self, cell: f64, arcs: f64, let_in: f64) -> f64 {
        let let_in = if self.condition.rules_the_end() { 0.0 } else { let_in.min(0.5 * cell) };
        self.penetration_tolerance * cell + arcs + let_in
    }

    /// Whether inverses need not be exact. They are in a static analysis, where no mass keeps K̄ well-conditioned, and with massless contact whose balance of
    /// energy sees the last correction itself and not its square. What corrections leave of it blended steps make good.
    fn approximates(&self) -> bool {
        self.scheme != Scheme::Static && (!self.condition.is_massless() || self.is_blended())
    }

    /// Whether what normal reactions take on landing is given back, in pairs that rule the motion. Without inertia nothing lands.
    pub(crate) fn restores(&self) -> bool {
        self.scheme != Scheme::Static && self.condition.restores()
    }

    /// Whether there are velocities that closed contacts turn round in every step: where there is inertia.
    pub(crate) fn settles(&self) -> bool {
        self.scheme != Scheme::Static
    }

    /// Whether the balance of massless contact nodes is closed by a blend of start and end stresses.
    pub(crate) fn is_blended(&self) -> bool {
        self.scheme == Scheme::Conserving && self.condition.is_massless()
    }
}
