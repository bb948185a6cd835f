//! Friction laws: how the coefficient of a contact depends on the way it slides.
//!
//! Coulomb's law with a constant μ is what the solvers solve. A law beyond it is a fixed point around that: μ is what the law says of the
//! motion that the contact problem has with this μ.

use std::fmt::Debug;
use std::sync::Arc;

/// How a contact slides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Speed [m/s].
    pub speed: f64,
    /// How far it has slid since the start, whichever way; in a step as far as in its middle [m].
    pub distance: f64,
    /// Normal reaction per area of the reference configuration [Pa].
    pub pressure: f64,
    /// The [state variable](FrictionLaw::evolved) of the contact.
    pub state: f64,
}

/// A law of friction.
pub trait FrictionLaw: Debug + Send + Sync {
    /// μ of a contact that slides like this; at no speed, μ up to which one at rest holds, unless that [jumps](Self::holding).
    fn coefficient(&self, sliding: &Sliding) -> f64;

    /// μ up to which a contact holds that sticks, where it jumps to [`Self::coefficient`] as soon as the contact slides.
    fn holding(&self) -> Option<f64> {
        None
    }

    /// μ along and across the direction of friction, where they differ; [`Self::coefficient`] is the larger one.
    fn by_direction(&self, _sliding: &Sliding) -> Option<[f64; 2]> {
        None
    }

    /// Whether the speed says anything. Load steps have none.
    fn depends_on_speed(&self) -> bool {
        true
    }

    /// Whether the pressure says anything.
    fn depends_on_pressure(&self) -> bool {
        false
    }

    /// The state variable of a contact that is new.
    fn initial_state(&self) -> f64 {
        0.0
    }

    /// The state variable after `dt` [s] at this speed of slip [m/s].
    fn evolved(&self, state: f64, _speed: f64, _dt: f64) -> f64 {
        state
    }

    /// μ up to which a contact holds that has never slid.
    fn at_rest(&self) -> f64 {
        self.holding().unwrap_or_else(|| {
            self.coefficient(&Sliding { state: self.initial_state(), ..Sliding::default() })
        })
    }
}

/// What takes μ from its static to its kinetic value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Weakening {
    /// Sliding itself: what sticks holds up to μ_s, what slides has μ_k until it sticks again.
    AtOnce,
    /// Speed: (μ_s − μ_k) exp(−v/v_s) is left at the speed v [Stribeck 1902; Bo & Pavelescu 1982]. The number is v_s [m/s].
    OverSpeed(f64),
    /// Distance: the difference falls linearly to zero over the critical distance D_c of slip [Ida 1972; Andrews 1976]. The number
    /// is D_c [m].
    OverDistance(f64),
}

/// Static and kinetic friction, and what is viscous in it: μ = μ_k + what is left of μ_s − μ_k + c v.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticKinetic {
    /// μ_s.
    pub static_coefficient: f64,
    /// μ_k.
    pub kinetic: f64,
    /// What takes the one to the other.
    pub weakening: Weakening,
    /// c [s/m].
    pub viscous: f64,
}

impl FrictionLaw for StaticKinetic {
    fn coefficient(&self, sliding: &Sliding) -> f64 {
        let left = match self.weakening {
            Weakening::AtOnce => 0.0,
            Weakening::OverSpeed(speed) => (-sliding.speed / speed).exp(),
            Weakening::OverDistance(distance) => (1.0 - sliding.distance / distance).max(0.0),
        };
        self.kinetic + (self.static_coefficient - self.kinetic) * left + self.viscous * sliding.speed
    }

    fn holding(&self) -> Option<f64> {
        let jumps = self.weakening == Weakening::AtOnce && self.static_coefficient != self.kinetic;
        jumps.then_some(self.static_coefficient)
    }

    fn depends_on_speed(&self) -> bool {
        matches!(self.weakening, Weakening::OverSpeed(_)) || self.viscous != 0.0
    }
}

/// Friction of which each of two directions has its own law. None of these jumps, and none has a state variable.
#[derive(Debug, Clone)]
pub struct Directional {
    /// The laws along and across.
    pub laws: [Arc<dyn FrictionLaw>; 2],
}

impl FrictionLaw for Directional {
    fn coefficient(&self, sliding: &Sliding) -> f64 {
        // What is no number is no coefficient, whichever of both it is.
        let [along, across] = self.laws.each_ref().map(|law| law.coefficient(sliding));
        if across.is_nan() { across } else { along.max(across) }
    }

    fn by_direction(&self, sliding: &Sliding) -> Option<[f64; 2]> {
        Some(self.laws.each_ref().map(|law| law.coefficient(sliding)))
    }

    fn depends_on_speed(&self) -> bool {
        self.laws.iter().any(|law| law.depends_on_speed())
    }

    fn depends_on_pressure(&self) -> bool {
        self.laws.iter().any(|law| law.depends_on_pressure())
    }
}

/// Rate and state friction: μ = μ₀ + a ln(1 + v/v*) + b ln(1 + θ v*/D_c), whose state variable θ [s] is the age of the contact, θ' = 1 − v θ/D_c
/// [Dieterich 1979; Ruina 1983], with the cut-off by 1 that leaves a strength at rest, which grows with the logarithm of time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RateAndState {
    /// μ₀.
    pub reference: f64,
    /// a.
    pub direct: f64,
    /// b.
    pub evolution: f64,
    /// v* [m/s].
    pub speed: f64,
    /// D_c [m].
    pub distance: f64,
    /// θ of a new contact [s].
    pub age: f64,
}

impl FrictionLaw for RateAndState {
    fn coefficient(&self, sliding: &Sliding) -> f64 {
        let (speed, age) = (sliding.speed / self.speed, sliding.state * self.speed / self.distance);
        self.reference + self.direct * speed.ln_1p() + self.evolution * age.ln_1p()
    }

    fn initial_state(&self) -> f64 {
        self.age
    }

    /// Exactly, as the speed is constant.
    fn evolved(&self, state: f64, speed: f64, dt: f64) -> f64 {
        let slip = speed * dt / self.distance;
        // (1 − exp(−x))/x, which is 1 at rest.
        let part = if slip > 0.0 { -(-slip).exp_m1() / slip } else { 1.0 };
        state * (-slip).exp() + dt * part
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(weakening: Weakening, viscous: f64) -> StaticKinetic {
        StaticKinetic { static_coefficient: 0.5, kinetic: 0.2, weakening, viscous }
    }

    #[test]
    fn coefficients_go_from_static_to_kinetic() {
        let sliding = |speed, distance| Sliding { speed, distance, ..Sliding::default() };
        let at_once = law(Weakening::AtOnce, 0.0);
        assert_eq!((at_once.at_rest(), at_once.coefficient(&sliding(0.0, 0.0))), (0.5, 0.2));
        assert!(!at_once.depends_on_speed());
        let stribeck = law(Weakening::OverSpeed(0.1), 2.0);
        assert_eq!((stribeck.at_rest(), stribeck.holding()), (0.5, None));
        let expected = 0.2 + 0.3 * (-2.0_f64).exp() + 2.0 * 0.2;
        assert!((stribeck.coefficient(&sliding(0.2, 9.0)) - expected).abs() < 1e-15);
        let weakening = law(Weakening::OverDistance(2e-3), 0.0);
        assert_eq!(weakening.coefficient(&sliding(7.0, 0.0)), 0.5);
        assert!((weakening.coefficient(&sliding(7.0, 1e-3)) - 0.35).abs() < 1e-15);
        assert_eq!(weakening.coefficient(&sliding(7.0, 3e-3)), 0.2);
        assert!(!weakening.depends_on_speed() && stribeck.depends_on_speed());
    }

    #[test]
    fn a_contact_ages_at_rest_and_forgets_over_a_distance() {
        let law = RateAndState {
            reference: 0.6,
            direct: 0.01,
            evolution: 0.015,
            speed: 1e-3,
            distance: 1e-4,
            age: 2.0,
        };
        assert_eq!(law.evolved(2.0, 0.0, 3.0), 5.0);
        // In two parts or at once.
        let (at_once, half) = (law.evolved(2.0, 3e-4, 1.0), law.evolved(2.0, 3e-4, 0.5));
        assert!((law.evolved(half, 3e-4, 0.5) - at_once).abs() < 1e-15);
        // Sliding for long leaves D_c/v.
        assert!((law.evolved(2.0, 1e-2, 10.0) - 1e-2).abs() < 1e-15);
        let steady =
            |speed: f64| law.coefficient(&Sliding { speed, state: 1e-4 / speed, ..Sliding::default() });
        let expected = 0.6 + 0.01 * 3.0_f64.ln() + 0.015 * 1.5_f64.ln();
        assert!((steady(2e-3) - expected).abs() < 1e-15);
        assert!((law.at_rest() - (0.6 + 0.015 * 21.0_f64.ln())).abs() < 1e-15);
    }

    #[test]
    fn each_direction_has_its_law_and_the_larger_coefficient_is_told() {
        let laws: [Arc<dyn FrictionLaw>; 2] =
            [Arc::new(law(Weakening::OverDistance(1.0), 0.0)), Arc::new(law(Weakening::OverSpeed(0.1), 1.0))];
        let both = Directional { laws };
        let sliding = Sliding { speed: 2.0, distance: 0.5, ..Sliding::default() };
        assert_eq!(both.by_direction(&sliding), Some([0.35, 0.2 + 0.3 * (-20.0_f64).exp() + 2.0]));
        assert_eq!(both.coefficient(&sliding), 0.2 + 0.3 * (-20.0_f64).exp() + 2.0);
        assert!(both.depends_on_speed() && !both.depends_on_pressure());
        assert_eq!((both.at_rest(), both.holding()), (0.5, None));
    }

    #[test]
    fn static_friction_that_is_kinetic_does_not_jump() {
        let same = StaticKinetic { static_coefficient: 0.2, ..law(Weakening::AtOnce, 0.1) };
        assert_eq!((same.holding(), same.at_rest()), (None, 0.2));
        assert!(same.depends_on_speed());
    }
}
