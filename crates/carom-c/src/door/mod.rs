//! The functions and types of `carom.h`, in its order.

pub mod books;
pub mod contact;
pub mod friction;
pub mod messages;
pub mod results;
pub mod setup;

pub use crate::compliance::carom_solver;
pub use crate::status::carom_status;
