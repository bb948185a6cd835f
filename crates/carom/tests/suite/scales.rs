//! Tolerances know their scale: scenes without energy, without motion and without change, in any units and of any size.
//!
//! Every tolerance is relative to something, and each of these scenes makes one of those things nothing: at rest there is no motion, at the
//! first step from rest no energy, in a load step in which nothing changes neither.

use crate::common::{body, parse, scenario};
use carom::Simulation;
use serde_json::{Value, json};

/// How many units of length, time and mass a metre, a second and a kilogram are.
#[derive(Debug, Clone, Copy)]
struct Units {
    length: f64,
    time: f64,
    mass: f64,
}

impl Units {
    const SI: Self = Self { length: 1.0, time: 1.0, mass: 1.0 };

    fn pressure(self) -> f64 {
        self.mass / (self.length * self.time * self.time)
    }
    fn acceleration(self) -> f64 {
        self.length / (self.time * self.time)
    }
    fn energy(self) -> f64 {
        self.mass * self.length * self.length / (self.time * self.time)
    }
    fn force(self) -> f64 {
        self.mass * self.acceleration()
    }
}

/// mm–t–s, cm–g–s, µm–kg–µs (where a second is a million), and scenes of 10⁻⁹ and 10⁹ units of length.
const OTHERS: [Units; 5] = [
    Units { length: 1e3, time: 1.0, mass: 1e-3 },
    Units { length: 1e2, time: 1.0, mass: 1e3 },
    Units { length: 1e6, time: 1e6, mass: 1.0 },
    Units { length: 1e-9, time: 1.0, mass: 1.0 },
    Units { length: 1e9, time: 1.0, mass: 1.0 },
];

#[derive(Debug, Clone, Copy, PartialEq)]
enum Scene {
    /// On a floor, and nothing acts: there is no energy, ever.
    Nothing,
    /// On a floor under its weight, which sets in at once.
    Resting,
    /// Let go above a floor: no energy at first.
    LetGo,
    /// On a wall that sets out at t = 0.
    Pushed,
    /// A stiff block in long steps, whose energy is nothing beside what the floor bears.
    Stiff,
    /// A load that is there from the first load step on and does not change.
    Loaded,
    /// A support that goes nowhere.
    Held,
}

const DYNAMIC: [Scene; 5] = [Scene::Nothing, Scene::Resting, Scene::LetGo, Scene::Pushed, Scene::Stiff];

/// The scene in some `units`; `method` is a scheme and a contact condition.
fn case(scene: Scene, [scheme, condition]: [&str; 2], units: Units) -> Value {
    let length = |x: f64| x * units.length;
    let above = if scene == Scene::LetGo { 0.003 } else { 0.0 };
    let mesh = json!({
        "kind": "rectangle", "corner": [0.0, length(above)], "size": [length(1.0), length(0.8)], "divisions": [4, 4],
    });
    let mut block = body("block", mesh, [0.0, 0.0]);
    block["thickness"] = json!(length(1.0));
    let mut floor = json!({"name": "floor", "kind": "plane", "point": [0.0, 0.0], "normal": [0.0, 1.0], "velocity": [0.0, 0.0]});
    if scene == Scene::Pushed {
        floor["velocity"] = json!([0.0, 0.1 * units.length / units.time]);
    }
    let step = units.time * if scene == Scene::Stiff { 1e-2 } else { 1e-3 };
    let mut case = scenario(40.0 * step, step, &[block], &[floor]);
    case["analysis"]["scheme"] = match scheme {
        "theta" if scene == Scene::Stiff => json!({"kind": "theta", "theta": 1.0, "xi": 1.0}),
        "theta" => json!({"kind": "theta", "theta": 0.5, "xi": 0.5}),
        _ => json!({"kind": scheme}),
    };
    let young = if scene == Scene::Stiff { 2e10 } else { 1e7 };
    case["materials"]["elastic"] = json!({
        "kind": "saint-venant-kirchhoff", "young": young * units.pressure(), "poisson": 0.3,
        "density": 1000.0 * units.mass / units.length.powi(3),
    });
    case["analysis"]["gravity"] = match scene {
        Scene::Nothing | Scene::Pushed | Scene::Loaded | Scene::Held => Value::Null,
        _ => json!([0.0, -10.0 * units.acceleration()]),
    };
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"]["kind"] = json!("auto");
    case["output"]["history_every"] = json!(step);
    case["output"]["merge_contacts"] = Value::Null;
    if scheme == "static" {
        case["analysis"]["kind"] = json!("static");
        case["analysis"]["scheme"].take();
        case["analysis"].as_object_mut().expect("a table").remove("scheme");
        case["obstacles"] = json!([]);
        case["motions"] = json!([{"kind": "fixed", "body": "block", "on": "bottom"}]);
        if scene == Scene::Loaded {
            let traction = [2e5 * units.pressure(), -3e5 * units.pressure()];
            case["loads"] = json!([{"kind": "traction", "body": "block", "on": "top", "traction": traction}]);
        }
    }
    case
}

/// What happened, without units: energies, reactions and positions of every row, and the steps that failed.
fn outcome(scene: Scene, method: [&str; 2], units: Units) -> Vec<f64> {
    let case = case(scene, method, units);
    let what = format!("{scene:?}, {method:?}, {units:?}");
    let mut simulation = Simulation::<2>::new(&parse(&case)).unwrap_or_else(|e| panic!("{what}: {e}"));
    simulation.advance(f64::INFINITY, || false).unwrap_or_else(|e| panic!("{what}: {e}"));
    let summary = simulation.summary();
    let certificate = summary.certificate;
    assert!(certificate.max_joule <= certificate.tolerance_joule, "{what}: {certificate:?}");
    // One joule is 10⁻⁴ of what the weight of the block is worth over its height; a newton and a millimetre are as small.
    let scales = |column: &str| match column {
        "kinetic" | "strain" | "total" | "friction" | "normal_contact" | "external" | "prescribed"
        | "scheme" => Some(units.energy()),
        "block.x" | "block.y" => Some(1e-3 * units.length),
        "normal_force" => Some(units.force()),
        "retried_steps" => Some(1.0),
        _ => None,
    };
    let scales: Vec<Option<f64>> = simulation.history_columns().iter().map(|c| scales(c)).collect();
    let rows = simulation.take_history();
    rows.iter().zip(scales.iter().cycle()).filter_map(|(x, scale)| scale.map(|s| x / s)).collect()
}

fn assert_alike(scene: Scene, method: [&str; 2]) {
    let here = outcome(scene, method, Units::SI);
    for units in OTHERS {
        let there = outcome(scene, method, units);
        assert_eq!(here.len(), there.len());
        let largest = here.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
        let apart = here.iter().zip(&there).fold(0.0, |d: f64, (a, b)| d.max((a - b).abs()));
        assert!(apart < 1e-9 * largest, "{scene:?}, {method:?}, {units:?}: {apart:e} of {largest}");
    }
}

#[test]
fn units_and_size_do_not_matter_where_there_is_no_motion_or_no_energy() {
    for method in [["conserving", "midpoint"], ["conserving", "gap"], ["theta", "gap"], ["theta", "endpoint"]]
    {
        // Nothing takes the vibrations of stiff bodies out of steps that are far too long for them but θ = 1 and a rule on the gap itself.
        let scenes = DYNAMIC.into_iter().filter(|&scene| scene != Scene::Stiff || method == ["theta", "gap"]);
        scenes.for_each(|scene| assert_alike(scene, method));
    }
}

/// Symptom guarded against: a body at rest, or let go, with massless contact "leaves 1.1e-20 J unaccounted for, where 0 J are allowed".
#[test]
fn massless_contact_starts_from_rest_in_any_units() {
    for method in [["conserving", "massless"], ["theta", "massless"]] {
        [Scene::Nothing, Scene::Resting, Scene::LetGo]
            .into_iter()
            .for_each(|scene| assert_alike(scene, method));
    }
}

/// Symptom guarded against: a load step in which nothing changes was measured by a motion that is not there, and took all its iterations.
#[test]
fn a_load_step_in_which_nothing_changes_is_done_at_once() {
    for scene in [Scene::Loaded, Scene::Held] {
        assert_alike(scene, ["static", "gap"]);
        let case = case(scene, ["static", "gap"], Units::SI);
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
        simulation.advance(2.5e-3, || false).expect("converges");
        let before = simulation.newton_iterations();
        simulation.advance(f64::INFINITY, || false).expect("converges");
        let steps = simulation.steps() - 3;
        assert_eq!(simulation.newton_iterations() - before, steps, "{scene:?}: one iteration a step");
    }
}

/// Symptom guarded against: a stiff stack at rest was not certified, as its certificate was measured by next to no energy.
#[test]
fn the_certificate_of_stiff_bodies_at_rest_is_measured_by_what_they_bear() {
    let case = case(Scene::Stiff, ["theta", "gap"], Units::SI);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    let summary = simulation.summary();
    let reference = summary.certificate.reference_joule;
    // The floor takes m g over the ½ or 1 g Δt² that the block would fall in a step.
    let weight_times_fall = 800.0 * 10.0 * 10.0 * 1e-2_f64.powi(2);
    assert!(reference > 0.4 * weight_times_fall && reference < 4.0 * weight_times_fall, "{reference}");
    assert!(reference > 10.0 * summary.energy.last, "{reference} against {}", summary.energy.last);
}
