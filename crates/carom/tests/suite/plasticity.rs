//! Metal that flows: an impact on a rigid plane keeps the books with the plastic work in them.

use carom::{Simulation, Summary};
use serde_json::{Value, json};

use crate::common::{body, parse, plane, scenario};

/// A copper bar, 3 × 6 mm, that hits a plane at `speed` [m/s]; units of mm, µs and mg give stresses in GPa.
fn bar(speed: f64, divisions: [usize; 2]) -> Value {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [3.0, 6.0], "divisions": divisions});
    let mut case =
        scenario(4.0, 0.05, &[body("bar", mesh, [0.0, -speed])], &[plane("wall", [0.0, 0.0], [0.0, 1.0])]);
    case["materials"]["elastic"] = json!({
        "kind": "j2-plasticity", "young": 117.0, "poisson": 0.35, "density": 8.93,
        "yield_stress": 0.4, "hardening": 0.1,
    });
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"] = json!({"tolerance": 1e-11, "max_iterations": 80});
    case["output"] = json!({"fields_every": 4.0, "history_every": 0.5, "merge_contacts": 0.5});
    case["contact"]["condition"] = json!("midpoint");
    case
}

fn run(case: &Value) -> (Simulation<2>, Summary) {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let summary = simulation.summary();
    (simulation, summary)
}

#[test]
fn plastic_work_and_friction_are_all_that_is_lost_in_an_impact() {
    for formulation in ["standard", "mean-dilatation"] {
        let mut case = bar(0.227, [6, 12]);
        case["bodies"][0]["formulation"] = json!(formulation);
        case["contact"]["friction"] = json!(0.2);
        let (simulation, summary) = run(&case);
        let energy = summary.energy;
        assert!(energy.plastic > 0.2 * energy.initial, "{formulation}: {energy:?}");
        assert!(energy.friction > 0.0);
        assert!(energy.max_defect < 1e-9 * energy.initial, "{formulation}: defect {:e}", energy.max_defect);
        let strains: Vec<f64> = simulation.fields().cells.iter().map(|c| c.plastic_strain).collect();
        assert!(strains.iter().all(|&a| a >= 0.0) && strains.iter().any(|&a| a > 0.1), "{strains:?}");
    }
}

/// The plastic work of the ledger is that of the strains that are left, Σ V (σ₀ α + ½ H α²) where cells have one value of α.
#[test]
fn plastic_work_is_that_of_the_plastic_strains() {
    let mut case = bar(0.227, [6, 12]);
    case["bodies"][0]["mesh"]["cell"] = json!("tri3");
    let (simulation, summary) = run(&case);
    let volume = 3.0 * 6.0 / 144.0;
    let work = |a: f64| volume * (0.4 * a + 0.05 * a * a);
    let total: f64 = simulation.fields().cells.iter().map(|c| work(c.plastic_strain)).sum();
    assert!((total / summary.energy.plastic - 1.0).abs() < 1e-12, "{total} {}", summary.energy.plastic);
}

#[test]
fn an_impact_that_does_not_yield_loses_nothing() {
    let (_, summary) = run(&bar(0.002, [4, 8]));
    let energy = summary.energy;
    assert_eq!(energy.plastic, 0.0);
    assert!(energy.max_drift < 1e-10 * energy.initial, "drift {:e}", energy.max_drift);
}

/// The defect of the paper's scheme is the error of the mean stress, which vanishes with the step.
#[test]
fn the_paper_s_scheme_converges_to_the_same_plastic_work() {
    let mut case = bar(0.227, [4, 8]);
    let energy = |case: &Value| run(case).1.energy;
    let paper_s = |case: &mut Value| {
        case["analysis"]["scheme"] = json!({"kind": "theta", "theta": 0.5, "xi": 0.5});
    };
    case["analysis"]["time_step"] = json!(0.0125);
    let conserving = energy(&case);
    paper_s(&mut case);
    let fine = energy(&case);
    case["analysis"]["time_step"] = json!(0.05);
    let coarse = energy(&case);
    assert!(
        (fine.plastic / conserving.plastic - 1.0).abs() < 2e-3,
        "{} {}",
        fine.plastic,
        conserving.plastic
    );
    assert!(fine.max_defect < 0.25 * coarse.max_defect, "{:e} {:e}", fine.max_defect, coarse.max_defect);
}

#[test]
fn what_cannot_flow_is_refused() {
    let refusal = |case: &Value| Simulation::<2>::new(&parse(case)).err().expect("refused").to_string();
    let mut case = bar(0.2, [4, 8]);
    case["contact"]["condition"] = json!("massless");
    assert!(refusal(&case).contains("massless"), "{}", refusal(&case));
    let mut case = bar(0.2, [4, 8]);
    case["bodies"][0]["hypothesis"] = json!("plane-stress");
    assert!(refusal(&case).contains("j2-plasticity has no plane-stress"), "{}", refusal(&case));
}
