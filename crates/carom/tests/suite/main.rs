//! The tests of whole steps and runs, in one program: the core is generic, and every program that uses it compiles it anew.

mod checkpoint;
mod common;
mod conservation;
mod contact_patch;
mod contact_problems;
mod contact_search;
mod curved_obstacles;
mod driven_bodies;
mod edges;
mod hypotheses;
mod incline;
mod invariance;
mod large_bodies;
mod ledger;
mod load_steps;
mod materials;
mod mortar;
mod moving_obstacles;
mod oscillator;
mod periodic;
mod plasticity;
mod self_contact;
mod space;
mod sphere_impact;
mod step_control;
mod threads;
