//! Temporary.
#[path = "suite/common/mod.rs"]
mod common;
mod checkpoint {
    use crate::common::parse;
    use carom::{Checkpoint, Simulation};
    use serde_json::Value;
    /// A simulation in the state of a checkpoint.
    fn restored<const D: usize>(case: &Value, checkpoint: &Checkpoint) -> Simulation<D> {
        let mut simulation = Simulation::new(&parse(case)).expect("valid");
        simulation.restore(checkpoint).expect("a checkpoint of this case");
        simulation
    }

    fn bits(values: &[f64]) -> Vec<u64> {
        values.iter().map(|x| x.to_bits()).collect()
    }

    /// Bit by bit: NaN, where there is nothing, is the same as NaN.
    fn assert_same(a: &Checkpoint, b: &Checkpoint) {
        assert_eq!(a.integers, b.integers);
        assert!(a.numbers.keys().eq(b.numbers.keys()));
        for (name, values) in &a.numbers {
            assert!(bits(values) == bits(&b.numbers[name]), "{name}");
        }
    }

    /// Stops at several moments, goes on from each, and compares with the run that did not; at every stop the state made of the checkpoint
    /// has the same checkpoint.
    pub fn goes_on_identically<const D: usize>(case: &Value, stops: usize) -> Simulation<D> {
        let mut whole = Simulation::<D>::new(&parse(case)).expect("valid");
        let mut checkpoints = Vec::new();
        for k in 1..=stops {
            let until = whole.steps() * k as u64 / (stops + 1) as u64;
            while whole.step() < until {
                whole.advance(f64::INFINITY, || true).expect("runs");
            }
            checkpoints.push(whole.checkpoint().expect("finite"));
        }
        whole.advance(f64::INFINITY, || false).expect("runs");
        whole.finish();
        let (history, ledger) = (bits(&whole.take_history()), bits(&whole.take_ledger()));
        for checkpoint in &checkpoints {
            let mut resumed = restored::<D>(case, checkpoint);
            assert_same(&resumed.checkpoint().expect("finite"), checkpoint);
            resumed.advance(f64::INFINITY, || false).expect("runs");
            resumed.finish();
            let from = format!("from step {}", checkpoint.integers["run/step"][0]);
            assert_eq!(resumed.summary(), whole.summary(), "{from}");
            assert!(bits(&resumed.take_history()) == history, "{from}");
            assert!(bits(&resumed.take_ledger()) == ledger, "{from}");
            assert!(resumed.state() == whole.state(), "{from}");
        }
        whole
    }
}
#[path = "suite/resting.rs"]
mod resting;
