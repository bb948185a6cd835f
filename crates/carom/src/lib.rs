//! Frictional impact of deformable bodies by the bi-potential method and a first-order time scheme.
//!
//! Continuum (`carom-fem`), touch (`carom-contact`) and friction (`carom-friction`) do not know one another; they meet in
//! [`step`]. A [`Scenario`] is plain data; from it a [`Model`] is built once; a step maps one [`State`] to the next; the
//! [`Workspace`] may be dropped at any moment; the [`Simulation`] walks through time and keeps the books.
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
//! frottement*, C. R. Mécanique 333 (2005) 419–424; its equations are cited as (1)–(4).

mod acceleration;
mod blend;
mod body_step;
mod books;
mod build;
mod checkpoint;
mod compliance;
mod condense;
mod condition;
mod convergence;
mod coupling;
mod cross_check;
mod crushed;
mod describe;
mod drive;
mod error;
mod events;
mod history;
mod ledger;
mod ledger_table;
mod linearise;
mod load;
mod mesh_spec;
mod model;
mod motion;
mod nominal_step;
mod react;
mod scenario;
mod scheme;
mod search;
mod signal;
mod simulation;
mod state;
mod step;
mod step_control;
mod summary;
mod surface_fields;
mod totals;
mod tracked;
mod workspace;

pub use build::{Meshes, build};
pub use checkpoint::{Checkpoint, CheckpointError};
pub use condition::ContactCondition;
pub use cross_check::{CrossCheck, CrossCheckSummary};
pub use crushed::Crushed;
pub use describe::{BodyDescription, Description, PairDescription};
pub use error::{InputError, RunError, StepError};
pub use events::ContactEvent;
pub use ledger::{BodyLedger, Books, Energies, Ledger, PairLedger};
pub use ledger_table::LedgerTable;
pub use load::{DeadLoad, FollowerPressure, Load};
pub use model::{Group, Method, Model, ModelBody, NewtonRule};
pub use motion::{Motion, ObstacleMotion};
pub use nominal_step::NominalStep;
pub use scenario::Scenario;
pub use scheme::{Scheme, StepMap, StressRule};
pub use signal::{Dual, Expression, ExpressionError, Signal, SignalError, SignalSpec, Table};
pub use simulation::{Fields, Outcome, Progress, Simulation, StepPair};
pub use state::{Reaction, State};
pub use step::step;
pub use summary::Summary;
pub use surface_fields::SurfaceFields;
pub use workspace::{GroupReport, PosedProblem, StepReport, Workspace};
