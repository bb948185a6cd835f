//! The books: every joule once, by bodies, by pairs, by facets.

use crate::common::{body, disc, parse, plane, scenario};
use carom::Simulation;
use serde_json::json;

/// Two discs that hit each other and the floor, spinning, with friction.
fn collision(scheme: &str, condition: &str) -> Simulation<2> {
    let bodies = [
        body("left", disc([1.2, 1.02], 1.0, 4), [2.0, -1.0]),
        body("right", disc([3.3, 1.3], 1.0, 4), [-1.0, -1.5]),
    ];
    let mut case = scenario(0.5, 1e-3, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = if scheme == "theta" {
        json!({"kind": "theta", "theta": 0.6, "xi": 0.55})
    } else {
        json!({"kind": scheme})
    };
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["analysis"]["gravity"] = json!([0.0, -5.0]);
    case["materials"]["elastic"]["damping"] = json!({"mass": 0.02, "stiffness": 1e-5});
    case["bodies"][0]["spin"] = json!(-2.0);
    case["bodies"][0]["thickness"] = json!(0.3);
    case["bodies"][1]["thickness"] = json!(0.3);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["targets"] = json!("smooth");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

const VARIANTS: [(&str, &str); 6] = [
    ("theta", "gap"),
    ("theta", "endpoint"),
    ("theta", "massless"),
    ("conserving", "gap"),
    ("conserving", "midpoint"),
    ("conserving", "massless"),
];

#[test]
fn books_of_bodies_and_pairs_add_up_to_those_of_the_whole() {
    for (scheme, condition) in VARIANTS {
        let simulation = collision(scheme, condition);
        let books = simulation.books();
        let total = &books.total;
        let close = |a: f64, b: f64, what: &str| {
            assert!(
                (a - b).abs() < 1e-12 * total.kinetic.abs(),
                "{scheme} {condition} {what}: {a} against {b}"
            );
        };
        close(books.bodies.iter().map(|b| b.kinetic).sum(), total.kinetic, "kinetic");
        close(books.bodies.iter().map(|b| b.strain).sum(), total.strain, "strain");
        close(books.bodies.iter().map(|b| b.external).sum(), total.external, "external");
        close(books.bodies.iter().map(|b| b.viscous).sum(), total.viscous, "viscous");
        close(books.bodies.iter().map(|b| b.scheme).sum(), total.scheme, "scheme");
        close(books.pairs.values().map(|p| p.friction).sum(), total.friction, "friction");
        close(books.pairs.values().map(|p| p.normal_contact).sum(), total.normal_contact, "normal contact");
        assert_eq!(books.pairs.values().filter(|p| p.has_touched).count(), 3, "{scheme} {condition}");
        let mut touched = books.pairs.values().filter(|p| p.has_touched);
        assert!(touched.all(|p| p.friction > 0.0), "{scheme} {condition}");
    }
}

#[test]
fn what_bodies_receive_through_contact_is_what_pairs_do_not_keep() {
    for (scheme, condition) in VARIANTS {
        let simulation = collision(scheme, condition);
        let books = simulation.books();
        let received: f64 = books.bodies.iter().map(|b| b.contact).sum();
        let kept: f64 = books.pairs.values().map(|p| p.friction + p.normal_contact + p.settling).sum();
        let scale = books.total.kinetic.abs();
        assert!((received + kept).abs() < 1e-9 * scale, "{scheme} {condition}: {received} and {kept}");
    }
}

#[test]
fn books_of_every_body_close_under_the_conserving_scheme() {
    for condition in ["gap", "midpoint", "massless"] {
        let simulation = collision("conserving", condition);
        let books = simulation.books();
        for ledger in &books.bodies {
            let defect = ledger.defect();
            assert!(ledger.contact.abs() > 1e-2, "the body was hit");
            assert!(defect.abs() < 1e-9 * books.total.kinetic.abs(), "{condition}: {defect:.2e} J");
        }
        assert!(books.total.defect().abs() < 1e-9 * books.total.kinetic.abs(), "{condition}");
    }
}

#[test]
fn friction_energy_of_the_facets_sums_to_that_of_the_ledger() {
    for (scheme, condition) in VARIANTS {
        let simulation = collision(scheme, condition);
        let fields = simulation.surface_fields();
        let energy: f64 = fields.friction_energy.iter().zip(&fields.area).map(|(e, a)| e * a).sum();
        let friction = simulation.books().total.friction;
        assert!((energy - friction).abs() < 1e-12 * friction, "{scheme} {condition}: {energy} of {friction}");
        let perimeter: f64 = fields.area.iter().sum::<f64>() / 0.3;
        assert!((perimeter - 4.0 * std::f64::consts::PI).abs() < 0.1, "two circles");
        assert!(fields.friction_energy.iter().all(|e| *e >= -1e-12), "{scheme} {condition}");
    }
}

/// Symptom guarded against: a linear bar that bounced under `theta` with massless contact lost three quarters of its energy to no term at all.
/// What steadies massless nodes takes it, and says so.
#[test]
fn massless_contact_under_theta_closes_the_books_of_linear_bodies() {
    for (weight, scale, damping) in [(0.5, 1.0, 0.0), (0.5, 10.0, 0.0), (0.7, 1.0, 0.0), (0.5, 1.0, 1e-5)] {
        let mesh =
            json!({"kind": "rectangle", "corner": [0.0, 0.1], "size": [0.1, 1.0], "divisions": [1, 40]});
        let mut bar = body("bar", mesh, [0.0, 0.0]);
        bar["contact_sets"] = json!(["bottom"]);
        let mut case = scenario(1.0, 1e-3, &[bar], &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
        case["analysis"]["gravity"] = json!([0.0, -9.81 * scale]);
        case["analysis"]["scheme"] = json!({"kind": "theta", "theta": weight, "xi": weight});
        case["analysis"]["newton"]["tolerance"] = json!(1e-12);
        case["materials"]["elastic"] = json!({
            "kind": "linear-elastic", "young": 1e6, "poisson": 0.0, "density": 1000.0,
            "damping": {"mass": 0.0, "stiffness": damping},
        });
        case["contact"]["condition"] = json!("massless");
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
        simulation.advance(f64::INFINITY, || false).expect("converges");
        let summary = simulation.summary();
        let fallen = 100.0 * 9.81 * scale * 0.1;
        let what = format!("ξ = {weight}, {scale} g, damping {damping}");
        assert!(summary.contacts.len() > 1, "{what}: it bounces");
        assert!(summary.energy.terms.scheme > 1e-2 * fallen, "{what}: {}", summary.energy.terms.scheme);
        assert!(summary.energy.max_defect < 1e-10 * fallen, "{what}: {:e}", summary.energy.max_defect);
    }
}

/// Symptom guarded against: terms of a body that were taken off instead of added, and a defect of bodies that was always zero, went unnoticed.
#[test]
fn books_of_a_body_that_flows_and_is_driven_close_term_by_term() {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [3.0, 6.0], "divisions": [3, 6]});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(4.0, 0.05, &[body("bar", mesh, [0.0, 0.0])], &[floor]);
    case["materials"]["elastic"] = json!({
        "kind": "j2-plasticity", "young": 117.0, "poisson": 0.35, "density": 8.93,
        "yield_stress": 0.4, "hardening": 0.1,
    });
    case["motions"] = json!([{"kind": "prescribed", "body": "bar", "on": "top", "y": "-0.05*t"}]);
    case["output"] = json!({"fields_every": 4.0, "history_every": 0.5, "merge_contacts": 0.5});
    case["contact"]["friction"] = json!(0.2);
    for (scheme, closes) in
        [(json!({"kind": "conserving"}), true), (json!({"kind": "theta", "theta": 0.5, "xi": 0.5}), false)]
    {
        case["analysis"]["scheme"] = scheme;
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
        simulation.advance(f64::INFINITY, || false).expect("converges");
        let books = simulation.books();
        let pair = books.pairs.values().next().expect("the bar touches");
        let bar = &books.bodies[0];
        assert!(bar.plastic > 0.01 && bar.prescribed > 0.01, "{bar:?}");
        let gained = bar.kinetic + bar.strain + bar.viscous + bar.plastic + bar.scheme;
        let left = gained - bar.external - bar.prescribed - bar.contact;
        let scale = bar.prescribed;
        assert!((bar.defect() - left).abs() < 1e-14 * scale, "{bar:?}");
        assert_eq!(left.abs() < 1e-9 * scale, closes, "{left:e} of {scale:e}: {bar:?}");
        assert!((books.total.plastic - bar.plastic).abs() < 1e-14 * scale);
        assert!((books.total.prescribed - bar.prescribed - pair.prescribed).abs() < 1e-14 * scale);
    }
}
