//! Frictional impact of deformable bodies by the bi-potential method and a first-order time scheme.
//!
//! Continuum (`carom-fem`), touch (`carom-contact`) and friction (`carom-friction`) do not know one another; they meet in
//! [`step`]. A [`Scenario`] is plain data, and from it a [`Model`] is built once. A step maps one [`State`] to the next.
//! The [`Workspace`] may be dropped at any moment. The [`Simulation`] walks through time and keeps the books.
//!
//! ```text
//! State ─ scheme ─► StepMap ─ predict ─► detect ─► candidates
//!     ┌──────────────────────── until converged ─────────────────────────┐
//!     │ linearise: K̄, residual ─► condense: W, q ─► friction: r ─► correct │
//!     └──────────────────────────────────────────────────────────────────┘
//! commit ─► State + StepReport (iterations, certificate, ledger terms)
//! ```
//!
//! Source of the method: B. Magnain, Z.-Q. Feng, J.-M. Cros, *Modélisation des problèmes d'impact avec dissipation d'énergie par
//! frottement*, C. R. Mécanique 333 (2005) 419–424. Its equations are cited as (1)–(4).

mod archive;
mod body;
mod build;
mod checkpoint;
mod contact;
mod error;
mod ledger;
mod model;
mod planted;
mod run;
mod scenario;
mod scheme;
mod signal;
mod step;

pub use archive::{Archive, Checkpoint, CheckpointError};
pub use body::fe::load::{DeadLoad, FollowerPressure, Load};
pub use body::fe::part::ModelBody;
pub use body::fe::supports::Motion;
pub use body::foreign::ForeignBody;
pub use body::foreign::code::{Blocks, ForeignCode};
pub use body::foreign::law::ForeignLaw;
pub use body::reduced::vibrations::VibrationEnergies;
pub use body::{Balance, Body, BodyEnd, BodyState, ContactWeights, Forecast, Guess, Interval, Jolt, Tangent};
pub use build::{Engine, Inputs, Laws, Meshes, Surfaces, build};
pub use contact::PosedProblem;
pub use contact::cross_check::{CrossCheck, CrossCheckSummary};
pub use error::{InputError, StepError};
pub use ledger::table::LedgerTable;
pub use ledger::{BodyLedger, Books, Energies, Ledger, PairLedger};
pub use model::Model;
pub use model::assembly::{Assembly, Member, NamedPair};
pub use model::bearing::Bearing;
pub use model::cohesion::{Cohesion, Cohesions, Strength};
pub use model::condition::ContactCondition;
pub use model::friction_laws::FrictionLaws;
pub use model::interference::{Interference, Overlap};
pub use model::method::{Method, NewtonRule};
pub use model::obstacle_motion::ObstacleMotion;
pub use model::orthotropy::{Grain, Orthotropies, Orthotropy};
pub use model::sliding::SlidingRecord;
pub use model::springs::{ForceLaw, Spring};
pub use model::state::{Reaction, State};
pub use planted::build::{Outline, PlantedSpec};
pub use planted::contact::{PlantedContact, PlantedStep};
pub use planted::mass::ForeignMass;
pub use planted::run::{ForeignPart, ForeignRun, ForeignSpec};
pub use run::crushed::Crushed;
pub use run::describe::{BodyDescription, Description, MaterialDescription, PairDescription, Vibrations};
pub use run::error::RunError;
pub use run::events::ContactEvent;
pub use run::impact::Impact;
pub use run::nominal_step::NominalStep;
pub use run::simulation::{Fields, Outcome, Progress, Simulation, StepPair};
pub use run::summary::Summary;
pub use run::surface_fields::SurfaceFields;
pub use scenario::{FrictionFormulaSpec, FrictionSpec, RateAndStateSpec, Scenario, StaticKineticSpec};
pub use scheme::{Scheme, StepMap, StressRule};
pub use signal::{Dual, Expression, ExpressionError, Formula, Signal, SignalError, SignalSpec, Table};
pub use step::report::{PairReport, StepReport};
pub use step::step;
pub use step::workspace::Workspace;
