//! Time per step of two discs of 2,084 unknowns with a floor bounce and a disc–disc impact in 600 steps of 1 ms, on one thread: the
//! problem that other codes were measured on. criterion reports elements (steps) per second; the median is printed per step.

mod common;

use std::time::{Duration, Instant};

use carom::Simulation;
use common::{STEPS, scenario};
use criterion::{Criterion, Throughput};

fn main() {
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    for (condition, friction) in [("gap", 0.0), ("gap", 0.2), ("midpoint", 0.2)] {
        let scenario = scenario(friction, condition, "gauss-seidel");
        let mut times: Vec<Duration> = Vec::new();
        let mut group = criterion.benchmark_group("cylinders, 2084 dofs");
        group.throughput(Throughput::Elements(STEPS));
        group.bench_function(format!("{condition}, friction {friction}"), |bencher| {
            bencher.iter_custom(|runs| {
                let mut total = Duration::ZERO;
                for _ in 0..runs {
                    let mut simulation = Simulation::<2>::new(&scenario).expect("valid");
                    let start = Instant::now();
                    simulation.advance(f64::INFINITY, || false).expect("runs");
                    times.push(start.elapsed());
                    total += start.elapsed();
                    assert_eq!(simulation.step(), STEPS);
                }
                total
            });
        });
        group.finish();
        times.sort_unstable();
        let median = times[times.len() / 2].as_secs_f64() / STEPS as f64;
        println!(
            "{condition}, friction {friction}: median {:.3} ms per step of {} runs",
            1e3 * median,
            times.len()
        );
    }
    criterion.final_summary();
}
