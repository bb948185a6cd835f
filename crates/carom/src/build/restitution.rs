//! Impacts of rigid bodies.

use std::collections::BTreeSet;

use super::values::number;
use crate::ContactCondition;
use crate::error::InputError;
use crate::model::Model;
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
    let soft: BTreeSet<&str> =
        model.bodies.iter().filter(|b| !b.is_rigid()).map(|b| b.name.as_str()).collect();
    let mut restitutions = Vec::new();
    for named in &model.assembly.named_pairs {
        let own =
            scenario.contact.entry_of(&named.between).and_then(|(k, entry)| Some((k, entry.restitution?)));
        let soft = named.between.iter().find(|name| soft.contains(name.as_str()));
        if let Some((k, e)) = own {
            let key = format!("contact.pairs.{k}.restitution");
            check(scenario, &key, e)?;
            if let Some(soft) = soft {
                let message = format!(
                    "{:?} deforms, and its impacts follow from that; a restitution is of two that are rigid; leave it out",
                    soft
                );
                return Err(InputError::new(key, message));
            }
        }
        let rules = scenario.contact.condition == ContactCondition::Endpoint && soft.is_none();
        restitutions.push(rules.then(|| own.map(|(_, e)| e).or(default).unwrap_or(0.0)));
    }
    Ok(model.with_restitutions(restitutions))
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
