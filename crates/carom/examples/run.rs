//! Runs a scenario without Python, for profiling: `cargo run --release --example run -- scenario.json`.
//!
//! `carom.Scenario.from_toml("case.toml").to_json()` writes such a file.

use std::error::Error;

use carom::{Scenario, Simulation};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which scenario? give the path of a JSON file")?;
    let scenario: Scenario = serde_json::from_str(&std::fs::read_to_string(path)?)?;
    if scenario.dimension == 2 { run::<2>(&scenario) } else { run::<3>(&scenario) }
}

fn run<const D: usize>(scenario: &Scenario) -> Result<(), Box<dyn Error>> {
    let mut simulation = Simulation::<D>::new(scenario)?;
    let start = std::time::Instant::now();
    simulation.advance(f64::INFINITY, || false)?;
    let elapsed = start.elapsed().as_secs_f64();
    println!("{}", serde_json::to_string_pretty(&simulation.summary())?);
    let friction = 100.0 * simulation.friction_time().as_secs_f64() / elapsed;
    println!(
        "{:.4} ms per step, {friction:.2} % in the friction solver",
        1e3 * elapsed / simulation.step() as f64
    );
    Ok(())
}
