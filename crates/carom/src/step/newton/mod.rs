//! How Newton's iterations go on and end.

pub(crate) mod acceleration;
pub(crate) mod convergence;
