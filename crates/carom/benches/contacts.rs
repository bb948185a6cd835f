//! Thousands of contacts of one body: a flat block that lands on a rough floor and bounces.
//!
//! `cargo bench -p carom --bench contacts -- [CELLS...]` takes blocks with so many cells along either side of their base, 10, 20, 40 and
//! 70 by default, and prints medians per step with all nodes of the base in contact and in the flight that follows, where the
//! block vibrates.

use std::time::Instant;

use carom::{Scenario, Simulation};
use serde_json::json;

/// Cells from base to top.
const LAYERS: usize = 8;
/// Steps: longer than the contact lasts, two ways of a wave through the block.
const STEPS: usize = 40;

fn scenario(cells: usize) -> Scenario {
    let h = 1.0 / cells as f64;
    // A step in which a wave crosses a cell; it falls a thousandth of a cell in it.
    let dt = h / 63.0;
    let speed = 1e-3 * h / dt;
    serde_json::from_value(json!({
        "dimension": 3,
        "analysis": {
            "kind": "dynamic", "end_time": STEPS as f64 * dt, "time_step": dt, "max_halvings": 8, "gravity": null,
            "scheme": {"kind": "conserving"}, "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 1e3, "history_every": 1e3, "merge_contacts": 1e3},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": [{
            "name": "block", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": {
                "kind": "box", "corner": [0.0, 0.0, 1.5 * speed * dt], "size": [1.0, 1.0, LAYERS as f64 * h],
                "divisions": [cells, cells, LAYERS], "cell": "hex8",
            },
            "velocity": [0.3 * speed, 0.0, -speed], "spin": [0.0, 0.0, 0.0],
        }],
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}],
        "contact": {
            "condition": "midpoint", "friction": 0.2, "sources": "finer", "targets": "faceted", "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01,
            "solver": {"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// A line of /proc/self/status in MiB; not a number where there is no such file.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kib.map_or(f64::NAN, |kib| kib / 1024.0)
}

fn measure(cells: usize) {
    let mut simulation = Simulation::<3>::new(&scenario(cells)).expect("valid");
    let all = (cells + 1) * (cells + 1);
    let (mut flight, mut contact, mut first) = (Vec::new(), Vec::new(), 0.0_f64);
    let (mut iterations, mut friction) = ([0, 0], 0.0);
    while simulation.step() < simulation.steps() {
        let (start, before, made) =
            (Instant::now(), simulation.friction_time(), simulation.newton_iterations());
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let seconds = start.elapsed().as_secs_f64();
        let made = simulation.newton_iterations() - made;
        match simulation.progress().contacts {
            0 if contact.is_empty() => {}
            0 => {
                flight.push(seconds);
                iterations[0] += made;
            }
            // The first of these steps makes the table of compliances.
            _ if first == 0.0 => first = seconds,
            n if n >= all / 2 => {
                contact.push(seconds);
                iterations[1] += made;
                friction += (simulation.friction_time() - before).as_secs_f64();
            }
            _ => {}
        }
    }
    let summary = simulation.summary();
    let mean = |sum: u64, of: usize| sum as f64 / of as f64;
    println!(
        "{:>8} {all:>9} {first:>9.2} {:>10.1} {:>6.1} {:>10.1} {:>6.1} {:>6.2} {:>9.1} {:>9.0} {:>9.0} {:>10.1e}",
        summary.dofs,
        1e3 * median(contact.clone()),
        mean(iterations[1], contact.len()),
        1e3 * median(flight.clone()),
        mean(iterations[0], flight.len()),
        median(contact.clone()) / median(flight),
        100.0 * friction / contact.iter().sum::<f64>(),
        memory("VmHWM"),
        memory("VmRSS"),
        summary.energy.max_defect / summary.energy.initial,
    );
}

fn main() {
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|a| a.parse().ok()).collect();
    println!(
        "{:>8} {:>9} {:>9} {:>10} {:>6} {:>10} {:>6} {:>6} {:>9} {:>9} {:>9} {:>10}",
        "dofs",
        "contacts",
        "first s",
        "contact ms",
        "it",
        "flight ms",
        "it",
        "ratio",
        "friction%",
        "peak MiB",
        "MiB",
        "defect/E0"
    );
    for cells in if sizes.is_empty() { vec![10, 20, 40, 70] } else { sizes } {
        measure(cells);
    }
}
