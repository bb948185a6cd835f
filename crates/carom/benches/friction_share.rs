//! How much of a step the friction solver takes: the two discs of the other benchmark with the default solver and with
//! Gauss–Seidel. A share is that of the contact steps, those that posed a contact problem, and that of the whole run; printed is
//! its median over the runs.

mod common;

use std::time::{Duration, Instant};

use carom::Simulation;
use carom_friction::SolverKind;
use common::{STEPS, scenario};

/// Runs after a warm-up.
const RUNS: usize = 3;

/// Time of steps, and of the friction solver in them.
#[derive(Default)]
struct Times {
    steps: u32,
    total: Duration,
    friction: Duration,
}

impl Times {
    fn add(&mut self, total: Duration, friction: Duration) {
        self.steps += 1;
        self.total += total;
        self.friction += friction;
    }

    fn percent(&self) -> f64 {
        100.0 * self.friction.as_secs_f64() / self.total.as_secs_f64()
    }

    fn per_step(&self) -> f64 {
        1e3 * self.total.as_secs_f64() / f64::from(self.steps)
    }
}

/// The contact steps of a run, and all its steps.
fn run(condition: &str, solver: SolverKind) -> [Times; 2] {
    let mut simulation = Simulation::<2>::new(&scenario(0.2, condition, solver.name())).expect("valid");
    let [mut contact, mut all] = <[Times; 2]>::default();
    while simulation.step() < STEPS {
        let (start, friction) = (Instant::now(), simulation.friction_time());
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let (total, friction) = (start.elapsed(), simulation.friction_time() - friction);
        all.add(total, friction);
        if !friction.is_zero() {
            contact.add(total, friction);
        }
    }
    [contact, all]
}

fn median(runs: &[[Times; 2]], which: usize, of: impl Fn(&Times) -> f64) -> f64 {
    let mut values: Vec<f64> = runs.iter().map(|times| of(&times[which])).collect();
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

fn main() {
    let mut solvers = vec![SolverKind::default(), SolverKind::GaussSeidel];
    solvers.dedup();
    println!(
        "| condition | solver | contact steps | ms per contact step | friction solver there | in the run |"
    );
    println!("|---|---|---|---|---|---|");
    for condition in ["gap", "midpoint"] {
        for &solver in &solvers {
            run(condition, solver);
            let runs: Vec<[Times; 2]> = (0..RUNS).map(|_| run(condition, solver)).collect();
            println!(
                "| `{condition}` | `{}` | {} of {} | {:.3} | {:.2} % | {:.2} % |",
                solver.name(),
                runs[0][0].steps,
                runs[0][1].steps,
                median(&runs, 0, Times::per_step),
                median(&runs, 0, Times::percent),
                median(&runs, 1, Times::percent),
            );
        }
    }
}
