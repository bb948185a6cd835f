//! The contacts of a step: which take part, their reduced problem, their reactions.

pub(crate) mod active;
pub(crate) mod compliance;
pub(crate) mod coupling;
pub(crate) mod cross_check;
pub(crate) mod delassus;
pub(crate) mod solve;
