//! Bodies whose cells processes share out, as an engine in Rust has it.

use std::sync::Arc;

use crate::common::{body, disc, parse, scenario};
use carom::{Engine, Inputs, Simulation};
use carom_fem::Share;

/// Refuses to share bodies, or leaves them whole to every process.
#[derive(Debug)]
struct Choosy {
    refuses: bool,
}

impl Engine for Choosy {
    fn share(
        &self,
        _: &str,
        _: usize,
        _: &[f64],
        blocks: &[(usize, &[u32])],
    ) -> Result<Option<Share>, String> {
        assert!(!blocks.is_empty());
        if self.refuses { Err("no rank has room for it".to_string()) } else { Ok(None) }
    }
}

fn shared(refuses: bool) -> Result<Simulation<2>, carom::InputError> {
    let case = scenario(0.01, 1e-3, &[body("a", disc([0.0, 0.0], 1.0, 2), [1.0, 0.0])], &[]);
    let engine: Arc<dyn Engine> = Arc::new(Choosy { refuses });
    Simulation::with_inputs(&parse(&case), Inputs { engine: Some(engine), ..Inputs::default() })
}

#[test]
fn a_body_that_is_not_shared_is_whole_and_one_that_cannot_be_is_named() {
    let mut whole = shared(false).unwrap_or_else(|e| panic!("{e}"));
    whole.advance(f64::INFINITY, || false).expect("flies");
    assert!(whole.summary().energy.max_defect < 1e-12);
    let Err(error) = shared(true) else { panic!("shared") };
    let message = error.to_string();
    assert!(message.contains("\"a\" cannot be shared among processes: no rank has room for it"), "{message}");
    assert!(message.contains("cannot be shared among processes: "), "{message}");
}
