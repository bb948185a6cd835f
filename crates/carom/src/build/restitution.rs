//! Impacts of rigid bodies.

use carom_contact::Solid;

use super::values::number;
use crate::ContactCondition;
use crate::error::InputError;
use crate::ledger::ByPair;
use crate::model::Model;
use crate::model::restitution::Restitutions;
use crate::scenario::{AnalysisKind, Scenario};

/// The model with the coefficients of restitution of its pairs of what is rigid: 0 where nothing is said.
pub(super) fn restitution<const D: usize>(
    scenario: &Scenario,
    model: Model<D>,
) -> Result<Model<D>, InputError> {
    let default = scenario.contact.restitution;
    if let Some(e) = default {
        check(scenario, "contact.restitution", e)?;
    }
    let deforms: Vec<bool> = model.bodies.iter().map(|b| !b.is_rigid()).collect();
    let mut own = ByPair::default();
    for (k, entry) in scenario.contact.pairs.iter().enumerate() {
        let (Some(e), Some(between)) = (entry.restitution, model.assembly.between(&entry.between)) else {
            continue;
        };
        let key = format!("contact.pairs.{k}.restitution");
        check(scenario, &key, e)?;
        let soft = between.iter().find(|solid| matches!(solid, Solid::Body(i) if deforms[*i]));
        if let Some(&soft) = soft {
            let message = format!(
                "{:?} deforms, and its impacts follow from that; a restitution is of two that are rigid; leave it out",
                model.assembly.solid_name(soft)
            );
            return Err(InputError::new(key, message));
        }
        own.insert(between, e);
    }
    let rules = scenario.contact.condition == ContactCondition::Endpoint;
    let default = rules.then(|| default.unwrap_or(0.0));
    Ok(model.with_restitutions(Restitutions { default, own, deforms }))
}

/// Refuses coefficients out of range, and where velocities are not ruled.
fn check(scenario: &Scenario, key: &str, e: f64) -> Result<(), InputError> {
    number(key, e, (0.0..=1.0).contains(&e), "a restitution is between 0 and 1")?;
    if scenario.analysis.kind == AnalysisKind::Dynamic
        && scenario.contact.condition != ContactCondition::Endpoint
    {
        let message = "a restitution rules the velocity at the end of an impact; write condition = \"endpoint\", or leave it out";
        return Err(InputError::new(key, message));
    }
    Ok(())
}
