//! Functions of time: what drives loads, supports and obstacles.

mod dual;
mod expression;
mod formula;
mod function;
mod parser;
mod table;

use serde::{Deserialize, Serialize};
use thiserror::Error;

pub use dual::Dual;
pub use expression::{Expression, Formula};
pub use parser::ExpressionError;
pub use table::Table;

/// A function of time as the case file gives it: a number, a formula of `t`, or a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SignalSpec {
    /// The same value at all times.
    Constant(f64),
    /// A formula: see [`Expression`].
    Expression(String),
    /// Values between which it is linear: see [`Table`].
    Table {
        /// Times [s], ascending.
        time: Vec<f64>,
        /// The value at each.
        value: Vec<f64>,
    },
}

/// Why there is no such function of time.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum SignalError {
    /// A constant that is not a finite number.
    #[error("{0}: must be a finite number")]
    NotFinite(f64),
    /// A text that is no formula.
    #[error("{0}")]
    Expression(#[from] ExpressionError),
    /// A table whose times and values do not make a function.
    #[error("{0}")]
    Table(String),
}

/// A function of time with its rate of change.
#[derive(Debug, Clone, PartialEq)]
pub enum Signal {
    /// The same value at all times.
    Constant(f64),
    /// A formula.
    Expression(Expression),
    /// Values between which it is linear.
    Table(Table),
}

impl Signal {
    /// The function that a case file describes.
    ///
    /// # Errors
    /// If it is none.
    pub fn new(spec: &SignalSpec) -> Result<Self, SignalError> {
        match spec {
            SignalSpec::Constant(value) if value.is_finite() => Ok(Self::Constant(*value)),
            SignalSpec::Constant(value) => Err(SignalError::NotFinite(*value)),
            SignalSpec::Expression(text) => Ok(Self::Expression(Expression::new(text)?)),
            SignalSpec::Table { time, value } => {
                Table::new(time, value).map(Self::Table).map_err(SignalError::Table)
            }
        }
    }

    /// Value and rate at time `t` [s]; where the rate jumps, that from `t` on.
    #[must_use]
    pub fn at(&self, t: f64) -> Dual {
        match self {
            Self::Constant(value) => Dual::constant(*value),
            Self::Expression(expression) => expression.at(t),
            Self::Table(table) => table.at(t),
        }
    }

    /// Whether it has the same value at two times [s], and no rate at either.
    #[must_use]
    pub fn stands_still(&self, times: [f64; 2]) -> bool {
        let [a, b] = times.map(|t| self.at(t));
        a.value == b.value && a.rate == 0.0 && b.rate == 0.0
    }

    /// Whether it is the constant 0.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Constant(0.0))
    }
}
