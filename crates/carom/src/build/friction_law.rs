//! Friction out of a scenario: a coefficient that is constant, or a law.

use std::sync::Arc;

use carom_friction::{Directional, FrictionLaw, Sliding};

use super::cohesion::first_cohesion;
use super::values::number;
use crate::Formula;
use crate::error::InputError;
use crate::model::Model;
use crate::model::assembly::Assembly;
use crate::model::bearing::Bearing;
use crate::model::cohesion::Strength;
use crate::model::friction_laws::{FrictionLaws, MAX_FRICTION};
use crate::scenario::{
    ContactSpec, FrictionSpec, OrthotropicSpec, RateAndStateSpec, Scenario, StaticKineticSpec,
};

const RANGE: &str = "friction must be between 0 and 1000";

/// A formula of speed, distance and pressure.
#[derive(Debug)]
struct FormulaLaw(Formula<3>);

impl FrictionLaw for FormulaLaw {
    fn coefficient(&self, sliding: &Sliding) -> f64 {
        self.0.at([sliding.speed, sliding.distance, sliding.pressure])
    }

    fn depends_on_speed(&self) -> bool {
        self.0.uses(0)
    }

    fn depends_on_pressure(&self) -> bool {
        self.0.uses(2)
    }
}

/// Refuses coefficients that are negative, or so large that round-off of μ|w_t| would hide the normal motion.
fn in_range(key: &str, value: f64) -> Result<f64, InputError> {
    number(key, value, (0.0..=MAX_FRICTION).contains(&value), RANGE)?;
    Ok(value)
}

/// Both coefficients of contacts that have never slid, which are in range.
pub(super) fn by_direction(key: &str, spec: &OrthotropicSpec) -> Result<[f64; 2], InputError> {
    let mut both = [0.0; 2];
    for (found, (name, friction)) in both.iter_mut().zip([("along", &spec.along), ("across", &spec.across)]) {
        let key = format!("{key}.{name}");
        let law = law(&key, friction)?;
        let has_memory = matches!(**friction, FrictionSpec::RateAndState(_) | FrictionSpec::Orthotropic(_));
        if has_memory || law.is_some_and(|law| law.holding().is_some()) {
            let message = "each direction has a coefficient, a formula, or static and kinetic friction that falls over a speed or a distance";
            return Err(InputError::new(key, message));
        }
        *found = at_rest(&key, friction)?;
        number(&key, *found, *found > 0.0, "must be greater than 0")?;
    }
    Ok(both)
}

/// The coefficient of contacts that have never slid.
pub(super) fn at_rest(key: &str, friction: &FrictionSpec) -> Result<f64, InputError> {
    match law(key, friction)? {
        Some(law) => in_range(key, law.at_rest()),
        None => match friction {
            FrictionSpec::Coefficient(value) => in_range(key, *value),
            FrictionSpec::Orthotropic(spec) => {
                by_direction(key, spec).map(|[along, across]| along.max(across))
            }
            _ => Ok(0.0),
        },
    }
}

/// The law, if the coefficient is not constant.
fn law(key: &str, friction: &FrictionSpec) -> Result<Option<Arc<dyn FrictionLaw>>, InputError> {
    Ok(Some(match friction {
        FrictionSpec::Orthotropic(spec) if friction.is_law() => {
            by_direction(key, spec)?;
            let own = |name: &str, friction: &FrictionSpec| -> Result<Arc<dyn FrictionLaw>, InputError> {
                let law = law(&format!("{key}.{name}"), friction)?;
                let constant = StaticKineticSpec::constant(at_rest(key, friction)?).law();
                Ok(law.unwrap_or_else(|| Arc::new(constant)))
            };
            Arc::new(Directional { laws: [own("along", &spec.along)?, own("across", &spec.across)?] })
        }
        FrictionSpec::Coefficient(_) | FrictionSpec::Orthotropic(_) => return Ok(None),
        FrictionSpec::Formula(spec) => {
            let formula = Formula::new(&spec.formula, ["v", "s", "p"]);
            let formula = formula.map_err(|e| InputError::new(format!("{key}.formula"), e.to_string()))?;
            Arc::new(FormulaLaw(formula))
        }
        FrictionSpec::RateAndState(spec) => {
            check_rate_and_state(key, spec)?;
            Arc::new(spec.law())
        }
        FrictionSpec::StaticKinetic(spec) => {
            check(key, spec)?;
            Arc::new(spec.law())
        }
    }))
}

fn check_rate_and_state(key: &str, spec: &RateAndStateSpec) -> Result<(), InputError> {
    in_range(&format!("{key}.reference"), spec.reference)?;
    for (name, value) in [("direct", spec.direct), ("evolution", spec.evolution)] {
        number(&format!("{key}.{name}"), value, value >= 0.0, "must not be negative")?;
    }
    for (name, value) in [("speed", spec.speed), ("distance", spec.distance)] {
        number(&format!("{key}.{name}"), value, value > 0.0, "must be greater than 0")?;
    }
    let age = spec.law().age;
    number(&format!("{key}.age"), age, age >= 0.0, "must not be negative")
}

fn check(key: &str, spec: &StaticKineticSpec) -> Result<(), InputError> {
    in_range(&format!("{key}.kinetic"), spec.kinetic)?;
    if let Some(value) = spec.static_coefficient {
        in_range(&format!("{key}.static"), value)?;
    }
    let jumps = spec.speed.is_none() && spec.distance.is_none();
    if let Some(value) = spec.static_coefficient.filter(|&value| jumps && value < spec.kinetic) {
        let message = format!(
            "{value}: is less than kinetic = {}: what sticks would slide and be held at once; give at least as much, or a speed or a distance over which friction grows",
            spec.kinetic
        );
        return Err(InputError::new(format!("{key}.static"), message));
    }
    if spec.speed.is_some() && spec.distance.is_some() {
        let message = "static friction falls over a speed or over a distance; leave one out, or write a formula of v and s";
        return Err(InputError::new(format!("{key}.distance"), message));
    }
    for (name, value) in [("speed", spec.speed), ("distance", spec.distance)] {
        let Some(value) = value else { continue };
        let key = format!("{key}.{name}");
        number(&key, value, value > 0.0, "must be greater than 0")?;
        if spec.static_coefficient.is_none() {
            return Err(InputError::new(
                key,
                "there is no static friction that could fall; give it by static",
            ));
        }
    }
    number(&format!("{key}.viscous"), spec.viscous, spec.viscous >= 0.0, "must not be negative")
}

/// The laws of all pairs.
///
/// # Errors
/// If one is none, or the kind of analysis leaves it without meaning.
pub(crate) fn friction_laws<const D: usize>(
    spec: &ContactSpec,
    is_static: bool,
    assembly: &Assembly<D>,
) -> Result<FrictionLaws, InputError> {
    let allowed = |key: &str, friction: &FrictionSpec| {
        let law = law(key, friction)?;
        let Some(found) = &law else { return Ok(None) };
        if is_static && found.depends_on_speed() {
            let message = "a static analysis has no speed of slip for friction to depend on; give a law of the distance, a coefficient, \
                           or choose a dynamic analysis";
            return Err(InputError::new(key, message));
        }
        Ok(law)
    };
    let mut laws =
        FrictionLaws { default: allowed("contact.friction", &spec.friction)?, ..FrictionLaws::default() };
    for (k, entry) in spec.pairs.iter().enumerate() {
        let (Some(friction), Some(between)) = (&entry.friction, assembly.between(&entry.between)) else {
            continue;
        };
        laws.own.insert(between, allowed(&format!("contact.pairs.{k}.friction"), friction)?);
    }
    Ok(laws)
}

/// The areas by which laws have their pressure, and cohesion its force; none where nothing asks for them.
///
/// # Errors
/// If one does, and a body has no pressure at its nodes.
pub(super) fn bearing<const D: usize>(scenario: &Scenario, model: &Model<D>) -> Result<Bearing, InputError> {
    let by_stress = model.assembly.cohesions.all().any(|c| matches!(c.strength, Strength::Stress(_)));
    let by_pressure = model.assembly.friction_laws.depend_on_pressure();
    if !by_pressure && !by_stress {
        return Ok(Bearing::default());
    }
    for (b, entry) in model.bodies.iter().zip(&scenario.bodies) {
        let quadratic = b.body.surface().facets().iter().any(|facet| facet.kind.is_quadratic());
        let why = if entry.round {
            "is round and has no area of contact; leave \"round\" out"
        } else if quadratic {
            "has cells of second order, whose nodes have no pressure of their own; take cells of first order"
        } else {
            continue;
        };
        let (key, message) = if by_pressure {
            let message =
                format!("friction that depends on the pressure: body {:?} {why}, or leave p out", b.name);
            (first_law(&scenario.contact), message)
        } else {
            let message =
                format!("cohesion as a stress: body {:?} {why}, or give the force of a contact", b.name);
            (first_cohesion(&scenario.contact), message)
        };
        return Err(InputError::new(key.unwrap_or_default(), message));
    }
    Ok(Bearing::of(model.bodies.iter().map(|b| &**b)))
}

/// The first law of a contact that is not a coefficient, by its key.
pub(crate) fn first_law(spec: &ContactSpec) -> Option<String> {
    first(spec, FrictionSpec::is_law)
}

/// The first friction that depends on the direction, by its key.
pub(crate) fn first_orthotropic(spec: &ContactSpec) -> Option<String> {
    first(spec, |friction| matches!(friction, FrictionSpec::Orthotropic(_)))
}

/// The key of the first friction of which this is true.
fn first(spec: &ContactSpec, is_it: impl Fn(&FrictionSpec) -> bool) -> Option<String> {
    if is_it(&spec.friction) {
        return Some("contact.friction".to_string());
    }
    let found = spec.pairs.iter().position(|entry| entry.friction.as_ref().is_some_and(&is_it));
    found.map(|k| format!("contact.pairs.{k}.friction"))
}
