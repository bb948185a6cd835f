//! How far a step is from the least that it could cost: one evaluation of the residual forces and one forward-backward solve per body.
//!
//! Two scenes of 2,084 unknowns: the window of 600 steps that other codes were measured on, and the 15 s of the paper's two cylinders. Printed
//! are medians of interleaved runs: the time per step, of free steps and of steps in contact, the iterations, and the distance to the limit.

mod common;

use std::time::Instant;

use carom::{Scenario, Simulation};
use carom_fem::Body;
use carom_fem::sparse::{Factor, Precision};
use carom_mesh::{Matrix, Vector};
use common::{Scene, paper_scene, scene};

/// Runs of every case, interleaved.
const RUNS: usize = 3;
/// Repetitions of a kernel.
const REPEATS: usize = 400;

#[derive(Default, Clone, Copy)]
struct Steps {
    count: usize,
    seconds: f64,
    iterations: usize,
}

impl Steps {
    fn add(&mut self, seconds: f64, iterations: usize) {
        self.count += 1;
        self.seconds += seconds;
        self.iterations += iterations;
    }

    fn milliseconds(&self) -> f64 {
        1e3 * self.seconds / self.count.max(1) as f64
    }

    fn mean_iterations(&self) -> f64 {
        self.iterations as f64 / self.count.max(1) as f64
    }
}

/// A run: its free steps, its steps in contact, the share of search and friction, factorisations and the drift or defect.
struct Run {
    free: Steps,
    contact: Steps,
    total: f64,
    friction: f64,
    factorisations: u64,
}

fn run(scenario: &Scenario) -> Run {
    let mut simulation = Simulation::<2>::new(scenario).expect("valid");
    let (mut free, mut contact) = (Steps::default(), Steps::default());
    let start = Instant::now();
    while simulation.step() < simulation.steps() {
        let (before, friction) = (Instant::now(), simulation.friction_time());
        let iterations = simulation.newton_iterations();
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let seconds = before.elapsed().as_secs_f64();
        let made = (simulation.newton_iterations() - iterations) as usize;
        let touched = simulation.friction_time() > friction;
        (if touched { &mut contact } else { &mut free }).add(seconds, made);
    }
    Run {
        free,
        contact,
        total: start.elapsed().as_secs_f64(),
        friction: simulation.friction_time().as_secs_f64(),
        factorisations: simulation.summary().factorisations,
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Milliseconds of one evaluation of the forces of a body, and of one solve.
fn kernels(body: &Body<2>, dt: f64, conserving: bool) -> (f64, f64) {
    let n = body.node_count();
    let u0: Vec<Vector<2>> =
        body.mesh().nodes().iter().map(|x| Vector::<2>::new(1e-3 * x[1].sin(), 1e-3 * x[0].cos())).collect();
    let u1: Vec<Vector<2>> = u0.iter().map(|u| u * 1.1).collect();
    let mut f = vec![Vector::zeros(); n];
    let force = median((0..REPEATS).map(|_| {
        let start = Instant::now();
        if conserving {
            body.conserving_force(&u0, &u1, &mut f);
        } else {
            body.internal_force(&u1, &mut f);
        }
        1e3 * start.elapsed().as_secs_f64()
    }));
    let stiffness = body.stiffness(&vec![Vector::zeros(); n]);
    let mass = body.mass();
    let mut factor = Factor::new(body.graph(), &[], &[]).expect("structure");
    factor
        .factorize(Precision::Single, |e| {
            stiffness.values[e] * 0.5 + Matrix::<2>::from_diagonal_element(2.0 / (dt * dt) * mass.values[e])
        })
        .expect("positive definite");
    let solve = median((0..REPEATS).map(|_| {
        let start = Instant::now();
        factor.solve(&mut f);
        1e3 * start.elapsed().as_secs_f64()
    }));
    (force, solve)
}

fn main() {
    let methods =
        [("theta", "gap"), ("conserving", "gap"), ("conserving", "midpoint"), ("conserving", "massless")];
    let scenes: Vec<Scene> = methods
        .into_iter()
        .flat_map(|(scheme, condition)| [0.0, 0.2].map(|mu| (scheme, condition, mu)))
        .flat_map(|(scheme, condition, mu)| {
            [scene(scheme, condition, mu), paper_scene(scheme, condition, mu)]
        })
        .collect();
    let mut runs: Vec<Vec<Run>> = scenes.iter().map(|_| Vec::new()).collect();
    for _ in 0..RUNS {
        for (scene, runs) in scenes.iter().zip(&mut runs) {
            runs.push(run(&scene.scenario));
        }
    }
    println!(
        "{:<36}{:>9}{:>9}{:>9}{:>7}{:>7}{:>7}{:>9}{:>9}",
        "ms per step", "mean", "free", "contact", "it", "it c.", "fact.", "kernels", "distance"
    );
    for (scene, runs) in scenes.iter().zip(&runs) {
        let simulation = Simulation::<2>::new(&scene.scenario).expect("valid");
        let kernels: Vec<(f64, f64)> = simulation
            .model()
            .bodies
            .iter()
            .map(|b| kernels(&b.body, scene.scenario.analysis.time_step, scene.scheme == "conserving"))
            .collect();
        let least: f64 = kernels.iter().map(|(force, solve)| force + solve).sum();
        let steps = (runs[0].free.count + runs[0].contact.count) as f64;
        let mean = median(runs.iter().map(|r| 1e3 * r.total / steps));
        println!(
            "{:<36}{:>9.3}{:>9.3}{:>9.3}{:>7.2}{:>7.2}{:>7}{:>9.4}{:>9.2}   forces {:.1} µs, solves {:.1} µs, friction {:.1} %",
            scene.name,
            mean,
            median(runs.iter().map(|r| r.free.milliseconds())),
            median(runs.iter().map(|r| r.contact.milliseconds())),
            runs[0].free.mean_iterations(),
            runs[0].contact.mean_iterations(),
            runs[0].factorisations,
            least,
            mean / least,
            1e3 * kernels.iter().map(|k| k.0).sum::<f64>(),
            1e3 * kernels.iter().map(|k| k.1).sum::<f64>(),
            1e2 * median(runs.iter().map(|r| r.friction / r.total)),
        );
    }
}
