//! Bodies so many that their pairs are a rule and no list.

use carom::Simulation;
use serde_json::{Value, json};

use crate::checkpoint::goes_on_identically;
use crate::common::{body, disc, parse, plane, scenario};

/// Discs side by side.
const WIDTH: usize = 8;
/// Of six rows, the last one short of one.
const COUNT: usize = 47;

/// Discs in rows that fall into one another and on a floor: 1,175 pairs, with themselves among them. Rows that never meet are pairs only if
/// `all` are.
fn pile(condition: &str, discretisation: &str, all: bool) -> Value {
    let row = |k: usize| k / WIDTH;
    let name = |k: usize| format!("disc {k}");
    let of = |k: usize| {
        let (across, up) = ((k % WIDTH) as f64 + 0.3 * (row(k) % 2) as f64, row(k) as f64);
        let falls = -0.4 * (1.0 + up) - 0.05 * ((7 * k) % 5) as f64;
        body(&name(k), disc([2.01 * across, 1.005 + 2.005 * up], 1.0, 2), [0.1 * (k % 3) as f64, falls])
    };
    let discs: Vec<Value> = (0..COUNT).map(of).collect();
    let mut case = scenario(0.12, 4e-3, &discs, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["discretisation"] = json!(discretisation);
    case["contact"]["solver"]["kind"] = json!("auto");
    if !all {
        let two = (0..COUNT).flat_map(|a| (a..COUNT).map(move |b| (a, b)));
        let apart = two.filter(|&(a, b)| row(b) >= row(a) + 4);
        let entry = |(a, b)| {
            json!({"between": [name(a), name(b)], "friction": null, "sources": null, "discretisation": null,
                   "enabled": false})
        };
        case["contact"]["pairs"] = apart.map(entry).collect();
    }
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation.finish();
    simulation
}

#[test]
fn a_pile_moves_the_same_to_the_last_bit_whether_its_pairs_are_listed_or_not() {
    for (condition, discretisation) in
        [("midpoint", "node-to-segment"), ("gap", "mortar"), ("massless", "node-to-segment")]
    {
        let [mut ruled, mut listed] = [true, false].map(|all| run(&pile(condition, discretisation, all)));
        let are_many = |run: &Simulation<2>| run.model().assembly.contact.pairs.are_many();
        assert!(are_many(&ruled) && !are_many(&listed), "{condition}");
        assert!(ruled.state().displacement == listed.state().displacement, "{condition}");
        let bits = |rows: Vec<f64>| rows.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert!(bits(ruled.take_history()) == bits(listed.take_history()), "{condition}");
        let [all, few] = [&ruled, &listed].map(|run| run.summary());
        assert_eq!(all.contacts, few.contacts, "{condition}");
        assert!(all.contacts.len() > 15, "{condition}: {} contacts", all.contacts.len());
        // Few pairs are told of whether they touched or not, many only if they did.
        let touched: Vec<_> = few.pairs.into_iter().filter(|pair| pair.ledger.has_touched).collect();
        assert_eq!(all.pairs, touched, "{condition}");
    }
}

#[test]
fn a_run_of_many_bodies_goes_on_identically() {
    goes_on_identically::<2>(&pile("midpoint", "node-to-segment", true), 2);
}
