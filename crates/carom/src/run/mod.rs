//! Through time: nominal steps, the books, and what is told of them.

pub(crate) mod account;
mod bridge;
pub(crate) mod control;
pub(crate) mod crushed;
pub(crate) mod describe;
mod displaced;
pub(crate) mod error;
pub(crate) mod events;
pub(crate) mod history;
pub(crate) mod impact;
mod inside;
pub(crate) mod nominal_step;
pub(crate) mod simulation;
pub(crate) mod stage;
pub(crate) mod stepper;
pub(crate) mod summary;
pub(crate) mod surface_fields;
pub(crate) mod time_grid;
pub(crate) mod totals;
pub(crate) mod tracked;
