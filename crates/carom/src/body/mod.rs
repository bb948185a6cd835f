//! Bodies in a step.

pub(crate) mod fe;
