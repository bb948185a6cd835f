//! Friction laws: how the coefficient of a contact depends on the way it slides.
//!
//! Coulomb's law with a constant μ is what the solvers solve. A law beyond it is a fixed point around that: μ is what the law says of the
//! motion that the contact problem has with this μ.

use std::fmt::Debug;

/// How a contact slides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Speed [m/s].
    pub speed: f64,
    /// How far it has slid since the start, whichever way; in a step as far as in its middle [m].
    pub distance: f64,
}

/// A law of friction.
pub trait FrictionLaw: Debug + Send + Sync {
    /// μ of a contact that slides like this; at no speed, μ up to which one at rest holds, unless that [jumps](Self::holding).
    fn coefficient(&self, sliding: &Sliding) -> f64;

    /// μ up to which a contact holds that sticks, where it jumps to [`Self::coefficient`] as soon as the contact slides.
    fn holding(&self) -> Option<f64> {
        None
    }

    /// Whether the speed says anything. Load steps have none.
    fn depends_on_speed(&self) -> bool {
        true
    }

    /// μ up to which a contact holds that has never slid.
    fn at_rest(&self) -> f64 {
        self.holding().unwrap_or_else(|| self.coefficient(&Sliding::default()))
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

#[cfg(test)]
mod tests {
    use super::*;

    fn law(weakening: Weakening, viscous: f64) -> StaticKinetic {
        StaticKinetic { static_coefficient: 0.5, kinetic: 0.2, weakening, viscous }
    }

    #[test]
    fn coefficients_go_from_static_to_kinetic() {
        let sliding = |speed, distance| Sliding { speed, distance };
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
    fn static_friction_that_is_kinetic_does_not_jump() {
        let same = StaticKinetic { static_coefficient: 0.2, ..law(Weakening::AtOnce, 0.1) };
        assert_eq!((same.holding(), same.at_rest()), (None, 0.2));
        assert!(same.depends_on_speed());
    }
}
