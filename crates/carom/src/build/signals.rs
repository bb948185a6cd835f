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

/// A displacement below this at the start, relative to the model, is round-off [1].
const AT_START: f64 = 1e-12;

/// The displacement over time under `key`, which starts from zero at the time `since` [s] in a model of this `size` [m].
pub(super) fn starting_from_none(
    key: &str,
    spec: &SignalSpec,
    span: [f64; 2],
    since: f64,
    size: f64,
) -> Result<Signal, InputError> {
    let signal = signal(key, spec, span)?;
    let start = signal.at(since);
    if start.value.abs() > AT_START * size {
        let message = if since == 0.0 {
            format!(
                "the displacement at t = 0 is {} m, where the run starts from none; let it grow from 0, as t*{0} does",
                start.value
            )
        } else {
            format!(
                "the displacement at t = {since} s is {} m, where it counts from none: it is the displacement since then; let it \
                 grow from 0, as (t - {since})*{0} does",
                start.value
            )
        };
        return Err(InputError::new(key, message));
    }
    if !start.rate.is_finite() {
        let message = format!("the velocity at t = {since} is {} m/s: it must be finite", start.rate);
        return Err(InputError::new(key, message));
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
