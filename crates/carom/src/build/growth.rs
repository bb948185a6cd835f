use super::signals::signal;
use crate::Signal;
use crate::error::InputError;
use crate::scenario::{AnalysisKind, BodyEntry, Scenario};

/// The least growth: a third of the size.
const LEAST: f64 = -2.0 / 3.0;
/// The largest: three times the size.
const LARGEST: f64 = 2.0;

/// How body number `index` grows.
pub(super) fn growth(
    scenario: &Scenario,
    index: usize,
    entry: &BodyEntry,
) -> Result<Option<Signal>, InputError> {
    let Some(spec) = &entry.growth else { return Ok(None) };
    let key = format!("bodies.{index}.growth");
    let analysis = &scenario.analysis;
    let growth = signal(&key, spec, analysis.span())?;
    for t in analysis.moments() {
        let value = growth.at(t).value;
        if !(LEAST..=LARGEST).contains(&value) {
            let message = format!(
                "{value} at t = {t} s: growth is a linear strain, from -2/3 to 2; for a temperature T give alpha*T"
            );
            return Err(InputError::new(key, message));
        }
    }
    let start = growth.at(0.0).value;
    if analysis.kind == AnalysisKind::Dynamic && analysis.starts_from_nothing() && start != 0.0 {
        let message = format!(
            "{start} at t = 0, where a dynamic analysis starts from none; let it grow from 0, as t*{start} does"
        );
        return Err(InputError::new(key, message));
    }
    Ok(Some(growth))
}
