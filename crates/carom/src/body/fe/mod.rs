//! A body of finite elements.

pub(crate) mod drive;
pub(crate) mod equation;
pub(crate) mod operator;
