//! Bodies of others in steps of carom.

use carom_contact::ContactModel;
use carom_mesh::compiled;
use carom_mesh::{Surface, Vector};
use serde::Deserialize;

use super::build::{Outline, PlantedSpec, assembled, diameter, method, touching};
use crate::body::Body;
use crate::body::foreign::ForeignBody;
use crate::body::foreign::law::ForeignLaw;
use crate::build::Surfaces;
use crate::build::foreign::not_definite;
use crate::contact::PosedProblem;
use crate::error::{InputError, StepError};
use crate::model::assembly::{Assembly, Member};
use crate::model::method::{Method, NewtonRule};
use crate::model::state::State;
use crate::scheme::Scheme;
use crate::step::report::StepReport;
use crate::step::step;
use crate::step::workspace::Workspace;

/// A body of somebody else's: its nodes, its boundary and its law.
pub struct ForeignPart<const D: usize> {
    /// Name and boundary, by its own nodes.
    pub outline: Outline,
    /// Nodes without deformation [m].
    pub points: Vec<Vector<D>>,
    /// Its mass and its law.
    pub law: ForeignLaw<D>,
}

/// What is said beside the bodies.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct ForeignSpec {
    /// Obstacles and contact.
    #[serde(flatten)]
    pub planted: PlantedSpec,
    /// Time scheme.
    pub scheme: Scheme,
    /// Largest correction of the iterations, relative to the largest motion in the step.
    pub newton_tolerance: f64,
    /// Iterations after which a step fails.
    pub newton_iterations: usize,
}

/// Bodies of others on their way through time, in contact with one another and with obstacles.
pub struct ForeignRun<const D: usize> {
    assembly: Assembly<D>,
    method: Method<D>,
    state: State<D>,
    next: State<D>,
    work: Workspace<D>,
}

type Build<const D: usize> =
    fn(&ForeignSpec, Vec<ForeignPart<D>>, Surfaces<D>) -> Result<ForeignRun<D>, InputError>;

impl<const D: usize> ForeignRun<D> {
    /// The bodies at the start.
    ///
    /// # Errors
    /// If facets make no surface, a mass is not positive definite, or a value is out of range.
    pub fn build(
        spec: &ForeignSpec,
        parts: Vec<ForeignPart<D>>,
        surfaces: Surfaces<D>,
    ) -> Result<Self, InputError> {
        compiled!(D, ForeignRun::of as Build)(spec, parts, surfaces)
    }

    fn of(spec: &ForeignSpec, parts: Vec<ForeignPart<D>>, surfaces: Surfaces<D>) -> Result<Self, InputError> {
        let mut method = method(&spec.planted)?;
        method.scheme = spec.scheme;
        method.newton =
            NewtonRule { tolerance: spec.newton_tolerance, max_iterations: spec.newton_iterations };
        let (mut members, mut sides, mut model) = (Vec::new(), Vec::new(), ContactModel::default());
        let (mut bodies, mut velocities, mut first): (Vec<Box<dyn Body<D>>>, _, _) =
            (Vec::new(), Vec::new(), 0);
        for ForeignPart { outline, points, law } in parts {
            let key = format!("surfaces.{}.facets", outline.name);
            let own = Surface::from_facets(&points, &outline.facets)
                .map_err(|e| InputError::mesh(key, e.to_string()))?;
            let (surface, mut side) = touching(&outline, &spec.planted.contact, &own, first, &points)?;
            model.surfaces.push(surface);
            side.side.mass = law.total_mass();
            sides.push(side);
            let body = ForeignBody::new(points.clone(), &law, Vector::zeros()).map_err(|_| {
                InputError::new(format!("bodies.{}.mass", outline.name), not_definite(&outline.name))
            })?;
            first += points.len();
            velocities.extend(law.velocity);
            members.push(Member {
                name: outline.name,
                diameter: diameter(&points),
                reference: points,
                boundary: if own.is_closed() { own } else { Surface::default() },
                held: law.held,
                is_massless: false,
                turns: true,
                axis: Vec::new(),
                stepped: Vec::new(),
            });
            bodies.push(Box::new(body));
        }
        let assembly = assembled(&spec.planted, members, &sides, model, surfaces)?;
        let state = State::initial(&assembly, &bodies, velocities);
        if !state.is_finite(&assembly) {
            let message = "the initial energy is not finite; check velocities, energy and force at rest";
            return Err(InputError::new("bodies", message));
        }
        let work = Workspace::with_bodies(&assembly, bodies);
        Ok(Self { next: state.clone(), assembly, method, state, work })
    }

    /// Takes the bodies one step of length `dt` [s] further.
    ///
    /// # Errors
    /// See [`step`]; the state is what it was.
    pub fn step(&mut self, dt: f64) -> Result<StepReport, StepError> {
        let Self { assembly, method, state, next, work } = self;
        let report = step(assembly, method, state, next, dt, work)?;
        std::mem::swap(state, next);
        Ok(report)
    }

    /// Where the bodies are.
    #[must_use]
    pub fn state(&self) -> &State<D> {
        &self.state
    }

    /// The bodies in their places, and what may touch what.
    #[must_use]
    pub fn assembly(&self) -> &Assembly<D> {
        &self.assembly
    }

    /// Scratch of the last step.
    #[must_use]
    pub fn workspace(&self) -> &Workspace<D> {
        &self.work
    }

    /// The contact problem that was posed last.
    #[must_use]
    pub fn posed_problem(&self) -> Option<PosedProblem<'_, D>> {
        self.work.posed_problem()
    }
}
