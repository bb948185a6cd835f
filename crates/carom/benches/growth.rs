//! How time and memory grow with the size of a body: discs and balls that fall on a floor, one process per size.
//!
//! `cargo bench -p carom --bench growth -- [LARGEST_2D [LARGEST_3D]]` takes sizes up to these numbers of unknowns. Printed are medians per
//! step in flight and in contact after the first contacts, and the memory of the process, at its peak and while steps are made, over
//! that of model and inverse, which is a factor of the smallest bodies only; at the end the exponents of a power law through all sizes.

use std::process::Command;
use std::time::Instant;

use carom::{Scenario, Simulation};
use serde_json::json;

/// Steps: of flight, then of contact.
const STEPS: [u64; 2] = [8, 24];

fn scenario(dimension: usize, divisions: usize) -> Scenario {
    let axis = |x: f64, y: f64| if dimension == 2 { vec![x, y] } else { vec![x, 0.0, y] };
    let kind = if dimension == 2 { "disc" } else { "ball" };
    let h = 1.0 / divisions as f64;
    // A step in which a wave crosses a cell; the body moves a hundredth of a cell in it.
    let dt = h / 63.0;
    let speed = 0.01 * h / dt;
    let steps = STEPS[0] + STEPS[1];
    let mut mesh = json!({"kind": kind, "centre": axis(0.0, 1.0 + (STEPS[0] as f64 - 0.5) * speed * dt), "radius": 1.0,
        "divisions": divisions});
    if dimension == 3 {
        mesh["cell"] = json!("hex8");
    }
    serde_json::from_value(json!({
        "dimension": dimension,
        "analysis": {
            "kind": "dynamic", "end_time": steps as f64 * dt, "time_step": dt, "max_halvings": 8, "gravity": null,
            "scheme": {"kind": "conserving"}, "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 1e3, "history_every": 1e3, "merge_contacts": 1e3},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": [{
            "name": "body", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": mesh, "velocity": axis(0.0, -speed), "spin": if dimension == 2 { json!(0.0) } else { json!([0.0, 0.0, 0.0]) },
        }],
        "obstacles": [{"name": "floor", "kind": "plane", "point": axis(0.0, 0.0), "normal": axis(0.0, 1.0)}],
        "contact": {
            "condition": "midpoint", "friction": 0.2, "sources": "finer", "targets": "faceted", "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01,
            "solver": {"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}

/// A line of /proc/self/status in MiB; not a number where there is no such file.
fn memory(name: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with(name));
    let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<f64>().ok());
    kib.map_or(f64::NAN, |kib| kib / 1024.0)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Runs one size and prints its numbers, as [`sizes`] reads them.
fn measure<const D: usize>(divisions: usize) {
    let scenario = scenario(D, divisions);
    let before = memory("VmRSS");
    let start = Instant::now();
    let mut simulation = Simulation::<D>::new(&scenario).expect("valid");
    let built = start.elapsed().as_secs_f64();
    let mesh = memory("VmRSS") - before;
    let (mut flight, mut contact, mut first) = (Vec::new(), Vec::new(), 0.0_f64);
    while simulation.step() < simulation.steps() {
        let (start, friction) = (Instant::now(), simulation.friction_time());
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let seconds = start.elapsed().as_secs_f64();
        match simulation.step() {
            1 => first = seconds,
            step if step > STEPS[0] + 4 && simulation.friction_time() > friction => contact.push(seconds),
            step if step <= STEPS[0] && simulation.friction_time() == friction => flight.push(seconds),
            _ => {}
        }
    }
    let summary = simulation.summary();
    println!(
        "{} {built} {first} {} {} {} {} {} {mesh} {}",
        summary.dofs,
        median(flight),
        median(contact),
        memory("VmHWM"),
        memory("VmRSS"),
        simulation.factor_bytes() as f64 / 1048576.0,
        summary.newton_iterations as f64 / simulation.steps() as f64,
    );
}

/// The numbers of every size up to `largest` unknowns.
fn sizes(dimension: usize, largest: f64, divisions: &[usize]) -> Vec<Vec<f64>> {
    println!(
        "\n{dimension}D {:>8} {:>8} {:>8} {:>10} {:>10} {:>9} {:>9} {:>9} {:>9} {:>6} {:>6}",
        "dofs",
        "build s",
        "first s",
        "flight ms",
        "contact ms",
        "peak MiB",
        "MiB",
        "factor",
        "model",
        "ratio",
        "it"
    );
    let mut rows = Vec::new();
    for divisions in divisions {
        let program = std::env::current_exe().expect("this program");
        let output = Command::new(program)
            .args(["measure", &dimension.to_string(), &divisions.to_string()])
            .output()
            .expect("starts");
        let text = String::from_utf8_lossy(&output.stdout);
        let row: Vec<f64> = text.split_whitespace().filter_map(|x| x.parse().ok()).collect();
        if row.len() < 10 {
            println!("   {divisions} divisions: {}", String::from_utf8_lossy(&output.stderr));
            break;
        }
        let [dofs, built, first, flight, contact, peak, now, factor, mesh, iterations] =
            [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].map(|k| row[k]);
        println!(
            "   {dofs:>8} {built:>8.2} {first:>8.2} {:>10.2} {:>10.2} {peak:>9.0} {now:>9.0} {factor:>9.0} {mesh:>9.0} {:>6.2} {iterations:>6.2}",
            1e3 * flight,
            1e3 * contact,
            now / (factor + mesh),
        );
        rows.push(row);
        if dofs > largest {
            break;
        }
    }
    rows
}

/// The exponent of a power law through column `y` over the unknowns, by least squares of logarithms.
fn exponent(rows: &[Vec<f64>], y: usize) -> f64 {
    let points: Vec<(f64, f64)> =
        rows.iter().map(|r| (r[0].ln(), r[y].ln())).filter(|p| p.1.is_finite()).collect();
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let (mut xy, mut xx) = (0.0, 0.0);
    for (x, y) in points {
        xy += (x - mx) * (y - my);
        xx += (x - mx) * (x - mx);
    }
    xy / xx
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    if let [command, dimension, divisions] = &arguments[..] {
        if command == "measure" {
            let divisions = divisions.parse().expect("a number");
            return if dimension == "2" { measure::<2>(divisions) } else { measure::<3>(divisions) };
        }
    }
    let largest = |k: usize, default: f64| arguments.get(k).and_then(|a| a.parse().ok()).unwrap_or(default);
    for (dimension, largest, divisions) in [
        (2, largest(0, 1e5), &[10, 20, 40, 80, 160, 240][..]),
        (3, largest(1, 5e4), &[6, 8, 12, 16, 20, 26][..]),
    ] {
        let rows = sizes(dimension, largest, divisions);
        println!(
            "   time per step ~ N^{:.2} in flight, N^{:.2} in contact; memory ~ N^{:.2}",
            exponent(&rows, 3),
            exponent(&rows, 4),
            exponent(&rows, 6)
        );
    }
}
