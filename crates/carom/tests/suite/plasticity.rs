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
    simulate(case)
}

fn simulate<const D: usize>(case: &Value) -> (Simulation<D>, Summary) {
    let mut simulation = Simulation::<D>::new(&parse(case)).expect("valid");
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
        assert!(energy.terms.plastic > 0.2 * energy.initial, "{formulation}: {energy:?}");
        assert!(energy.terms.friction > 0.0);
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
    assert!(
        (total / summary.energy.terms.plastic - 1.0).abs() < 1e-12,
        "{total} {}",
        summary.energy.terms.plastic
    );
}

#[test]
fn an_impact_that_does_not_yield_loses_nothing() {
    let (_, summary) = run(&bar(0.002, [4, 8]));
    let energy = summary.energy;
    assert_eq!(energy.terms.plastic, 0.0);
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
        (fine.terms.plastic / conserving.terms.plastic - 1.0).abs() < 2e-3,
        "{} {}",
        fine.terms.plastic,
        conserving.terms.plastic
    );
    assert!(fine.max_defect < 0.25 * coarse.max_defect, "{:e} {:e}", fine.max_defect, coarse.max_defect);
}

/// How much shorter a bar is [mm], from the mean motion of its top, with the foot on the plane.
fn shortening<const D: usize>(simulation: &Simulation<D>) -> f64 {
    let nodes = simulation.model().assembly.reference.iter().zip(&simulation.state().displacement);
    let (count, sum) = nodes
        .filter(|(x, _)| x[D - 1] > 6.0 - 1e-9)
        .fold((0.0, 0.0), |(count, sum), (_, u)| (count + 1.0, sum - u[D - 1]));
    sum / count
}

/// Taylor's anvil test in small, in space and as a body of revolution: hexahedra keep the books of the flow as well, and shorten and
/// take up as much, per volume, as the section does.
#[test]
fn round_bar_in_space_is_shortened_as_its_section_is() {
    let mut section = bar(0.227, [3, 6]);
    section["bodies"][0]["hypothesis"] = json!("axisymmetric");
    section["bodies"][0]["formulation"] = json!("mean-dilatation");
    section["contact"]["condition"] = json!("gap");
    section["analysis"]["time_step"] = json!(0.1);
    section["analysis"]["newton"]["tolerance"] = json!(1e-9);
    let mut space = section.clone();
    space["dimension"] = json!(3);
    space["bodies"][0]["spin"] = json!([0.0, 0.0, 0.0]);
    space["bodies"][0]["hypothesis"] = json!("plane-strain");
    space["bodies"][0]["velocity"] = json!([0.0, 0.0, -0.227]);
    space["bodies"][0]["mesh"] = json!({
        "kind": "cylinder", "base": [0.0, 0.0, 0.0], "axis": [0.0, 0.0, 1.0], "radius": 3.0, "height": 6.0,
        "divisions": 3, "rings": 1, "layers": 6,
    });
    space["obstacles"][0]["point"] = json!([0.0, 0.0, 0.0]);
    space["obstacles"][0]["normal"] = json!([0.0, 0.0, 1.0]);
    let (flat, flat_summary) = simulate::<2>(&section);
    let (solid, solid_summary) = simulate::<3>(&space);
    for energy in [flat_summary.energy, solid_summary.energy] {
        assert!(
            energy.max_defect < 1e-9 * energy.initial,
            "defect {:e} of {}",
            energy.max_defect,
            energy.initial
        );
        assert!(energy.terms.plastic > 0.3 * energy.initial, "{energy:?}");
    }
    let shares = [flat_summary.energy, solid_summary.energy].map(|e| e.terms.plastic / e.initial);
    assert!((shares[1] / shares[0] - 1.0).abs() < 0.01, "{shares:?}");
    let (flat, solid) = (shortening(&flat), shortening(&solid));
    assert!((solid / flat - 1.0).abs() < 0.01, "{solid} {flat}");
}

/// A round bar drawn to 1.5 times its length: τ = σ_y(α), α = ln λ − τ/E, and it bears A₀ τ/λ. It hardens by more than it bears, so that it does
/// not neck.
#[test]
fn round_bar_in_tension_bears_what_its_hardening_says() {
    for formulation in ["standard", "mean-dilatation"] {
        let mesh =
            json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 2.0], "divisions": [2, 3]});
        let mut case = scenario(1.0, 0.05, &[body("bar", mesh, [0.0, 0.0])], &[]);
        case["analysis"] = json!({
            "kind": "static", "end_time": 1.0, "time_step": 0.05, "max_halvings": 8, "gravity": null,
            "newton": {"tolerance": 1e-11, "max_iterations": 50},
        });
        case["bodies"][0]["hypothesis"] = json!("axisymmetric");
        case["bodies"][0]["formulation"] = json!(formulation);
        case["materials"] = bar(0.0, [1, 1])["materials"].clone();
        case["materials"]["elastic"]["hardening"] = json!(2.0);
        case["output"] = json!({"fields_every": 1.0, "history_every": 1.0, "merge_contacts": 0.0});
        case["motions"] = json!([
            {"kind": "fixed", "body": "bar", "on": "bottom", "components": ["y"]},
            {"kind": "prescribed", "body": "bar", "on": "top", "y": "t"},
        ]);
        let (simulation, summary) = run(&case);
        let alpha = (1.5_f64.ln() - 0.4 / 117.0) / (1.0 + 2.0 / 117.0);
        let force = std::f64::consts::PI * (0.4 + 2.0 * alpha) / 1.5;
        let state = simulation.state();
        let top = simulation
            .model()
            .assembly
            .reference
            .iter()
            .zip(&state.internal_force)
            .filter(|(x, _)| x[1] > 1.99);
        let borne: f64 = top.map(|(_, f)| f[1]).sum();
        assert!((borne / force - 1.0).abs() < 1e-8, "{formulation}: {borne} {force}");
        let work = 2.0 * std::f64::consts::PI * (0.4 * alpha + alpha * alpha);
        assert!(
            (summary.energy.terms.plastic / work - 1.0).abs() < 1e-8,
            "{formulation}: {:?}",
            summary.energy
        );
    }
}

#[test]
fn what_cannot_flow_is_refused() {
    let refusal = |case: &Value| Simulation::<2>::new(&parse(case)).err().expect("refused").to_string();
    let mut case = bar(0.2, [4, 8]);
    case["bodies"][0]["hypothesis"] = json!("plane-stress");
    assert!(refusal(&case).contains("j2-plasticity has no plane-stress"), "{}", refusal(&case));
}
