//! Functions of time out of a scenario.

use crate::error::InputError;
use crate::{Signal, SignalSpec};

/// At how many moments of a run a function of time is checked before it starts.
const SAMPLES: usize = 1000;

/// The function of time under `key`, finite wherever it is checked from `start` to `end` [s].
pub(super) fn signal(key: &str, spec: &SignalSpec, [start, end]: [f64; 2]) -> Result<Signal, InputError> {
    let signal = Signal::new(spec).map_err(|e| InputError::new(key, e.to_string()))?;
    for k in 0..=SAMPLES {
        let t = start + (end - start) * k as f64 / SAMPLES as f64;
        let value = signal.at(t).value;
        if !value.is_finite() {
            return Err(InputError::new(
                key,
                format!("its value at t = {t} s is {value}: it must be finite"),
            ));
        }
    }
    Ok(signal)
}

/// A vector of functions of time.
pub(super) fn signals<const D: usize>(
    key: &str,
    specs: &[SignalSpec],
    span: [f64; 2],
) -> Result<[Signal; D], InputError> {
    if specs.len() != D {
        return Err(InputError::new(key, format!("must have {D} components, not {}", specs.len())));
    }
    let mut signals = std::array::from_fn(|_| Signal::Constant(0.0));
    for (i, (signal_i, spec)) in signals.iter_mut().zip(specs).enumerate() {
        *signal_i = signal(&format!("{key}.{i}"), spec, span)?;
    }
    Ok(signals)
}
