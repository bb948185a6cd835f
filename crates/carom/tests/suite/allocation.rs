//! Time steps take no memory from the system once a run is under way, but for the scratch of friction solvers.

use std::alloc::System;
use std::env;
use std::process::Command;

use carom::{Scenario, Simulation};
use serde_json::json;
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

#[global_allocator]
static GLOBAL: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// A disc that slides on a floor under gravity, from a `height` above it.
fn sliding_disc(scheme: &serde_json::Value, condition: &str, height: f64) -> Scenario {
    serde_json::from_value(json!({
        "analysis": {
            "kind": "dynamic", "end_time": 0.4, "time_step": 1e-3, "max_halvings": 8, "gravity": [0.0, -10.0],
            "scheme": scheme, "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 1.0, "history_every": 1.0, "merge_contacts": 1.0},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": [{
            "name": "disc", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0,
            "mass": "consistent", "mesh": {"kind": "disc", "centre": [0.0, 1.0 + height], "radius": 1.0, "divisions": 6}, "velocity": [0.5, 0.0], "spin": 0.0,
        }],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0]}],
        "contact": {
            "condition": condition, "friction": 0.2, "sources": "finer", "targets": "faceted", "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01,
            "solver": {"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}

/// Runs up to `step`; returns the steps in contact, allocations, and the bytes that they took and gave back.
fn count(simulation: &mut Simulation<2>, step: u64) -> (usize, usize, usize, usize) {
    let mut contact_steps = 0;
    let region = Region::new(GLOBAL);
    while simulation.step() < step {
        let friction = simulation.friction_time();
        simulation.advance(f64::INFINITY, || true).expect("runs");
        contact_steps += usize::from(simulation.friction_time() > friction);
    }
    let change = region.change();
    let allocations = change.allocations + change.reallocations;
    (contact_steps, allocations, change.bytes_allocated, change.bytes_deallocated)
}

/// Set in the process that counts: the allocator counts for all of a process, and other tests run beside this one.
const ALONE: &str = "CAROM_TEST_ALONE";

#[test]
fn steps_allocate_nothing_beside_what_a_friction_solver_takes_and_gives_back() {
    if env::var_os(ALONE).is_none() {
        let name = "allocation::steps_allocate_nothing_beside_what_a_friction_solver_takes_and_gives_back";
        let mut alone = Command::new(env::current_exe().expect("this program"));
        let done = alone.args([name, "--exact"]).env(ALONE, "1").output().expect("it starts");
        let said = String::from_utf8_lossy(&done.stdout);
        assert!(done.status.success() && said.contains("1 passed"), "{said}");
        return;
    }
    // Threads that are still starting would allocate in between.
    rayon::broadcast(|_| ());
    let theta = json!({"kind": "theta", "theta": 0.5, "xi": 0.5});
    for (scheme, condition) in [(theta, "gap"), (json!({"kind": "conserving"}), "midpoint")] {
        let fall = sliding_disc(&scheme, condition, 1.0);
        // A thread of the pool that is about to wait may allocate once; a step would in every flight.
        let flights = [(); 3].map(|()| {
            let mut simulation = Simulation::<2>::new(&fall).expect("valid");
            simulation.advance(0.02, || false).expect("runs");
            let (contact_steps, allocations, ..) = count(&mut simulation, 60);
            (contact_steps, allocations)
        });
        assert_eq!(flights.iter().min(), Some(&(0, 0)), "{condition}: in flight");

        let slide = sliding_disc(&scheme, condition, 1e-4);
        let mut simulation = Simulation::<2>::new(&slide).expect("valid");
        // Every contact that there will be has been seen.
        simulation.advance(0.2, || false).expect("runs");
        let (contact_steps, _, taken, given) = count(&mut simulation, 380);
        assert!(contact_steps > 20, "{condition}: {contact_steps} steps in contact");
        assert_eq!(taken, given, "{condition}: memory grows in {contact_steps} steps in contact");
    }
}
