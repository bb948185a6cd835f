//! Contact in the steps of others: what a step does about contacts, for bodies that carom does not know.
//!
//! Somebody else's time loop knows its bodies: where their nodes are, and the K̄ that corrects a guess of the motion d = u₊ − u. All else is what
//! carom's own step does, by the same functions: [search](contact::PlantedContact::search), which contacts take part and where they are
//! [evaluated](contact::PlantedContact::evaluate), the [solution](contact::PlantedContact::solve) of their problem for a W that the caller condenses, whether one was
//! [missed](contact::PlantedContact::missed), and what is kept and booked when the step is [accepted](contact::PlantedContact::accept).

pub(crate) mod build;
pub(crate) mod contact;
pub(crate) mod mass;
mod numbering;
pub(crate) mod run;
