use carom_contact::Contact;
use carom_mesh::Vector;
use serde::{Deserialize, Serialize};

use crate::StepMap;
use crate::body::ContactWeights;

/// How a contact stands in a step [m].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Opening {
    /// [What of its gap](ContactCondition::start_gap) at the start has a part in the condition.
    pub start_gap: f64,
    /// How much its interference, which gaps are less, grows in the step.
    pub widening: f64,
}

/// Where in time the unilateral condition is written. It decides what impact does to the energy.
///
/// The variants differ only in the configuration where contacts are evaluated, in which of them are active, and in an offset of
/// the normal motion. No solver knows of them. Tangentially the slip is always the relative motion of the step, so that
/// friction dissipates exactly −Σ r_t·Δu_t.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactCondition {
    /// The gap at the end of the step, as in the paper: never penetrates.
    #[default]
    Gap,
    /// The normal relative motion of the step, less the gap that is open at its start: what is closed comes no closer, what closes lands
    /// on its target. The work that normal reactions do on landing is given back, so that they do none.
    Midpoint,
    /// The normal relative velocity at the end of the step, of contacts closed at its start and of those that arrive before the next one could
    /// stop them (Moreau): a plastic impact, or one with restitution.
    Endpoint,
    /// The gap at the end of the step, between nodes without mass that are in static balance there. It never penetrates,
    /// and nothing can bounce (Khenous, Laborde & Renard 2008). One side without mass is enough; pairs that have none are ruled as
    /// `Midpoint` does.
    Massless,
}

/// What the motion of a contact lacks of the variable of an impact of rigid bodies that meet at the velocity `v` [m/s], where their interference
/// grows by `widening` [m], with a coefficient of restitution e (Moreau). With v₊ = a v + b d, that is (v₊ + e v)/b along the normal and v₊/b across
/// it: they part at −e v, and friction acts against the velocity that is left.
pub(crate) fn impact_offset<const D: usize>(
    v: &Vector<D>,
    widening: f64,
    restitution: f64,
    map: &StepMap,
) -> Vector<D> {
    let closing = v[0] - widening / map.dt;
    let mut offset = v * map.velocity_of_velocity;
    offset[0] = closing * (map.velocity_of_velocity + restitution);
    offset /= map.velocity_of_motion;
    offset[0] -= widening;
    offset
}

impl ContactCondition {
    /// The configuration where contacts are evaluated, as a weight between start (0) and end (1) of the step.
    #[must_use]
    pub fn evaluation_weight(self) -> f64 {
        match self {
            ContactCondition::Gap | ContactCondition::Massless => 1.0,
            ContactCondition::Midpoint | ContactCondition::Endpoint => 0.5,
        }
    }

    /// Whether a contact takes part in a step that it starts with this gap [m]. If velocities are ruled, the contact must be closed there,
    /// up to what is as good as `closed` [m], or it is one that `is_stopped` before it arrives.
    #[must_use]
    pub fn is_active(self, start_gap: f64, closed: f64, is_stopped: impl FnOnce() -> bool) -> bool {
        self.rules_the_end() || start_gap <= closed || is_stopped()
    }

    /// The part of the gap at the start [m] that has a part in the condition: what is open there and may be closed, or the penetration, negative,
    /// that the step may keep but not deepen, as `stays` says. What is as good as `closed` [m] is: at rest the gap is nothing but
    /// round-off, and its sign would be left to chance.
    #[must_use]
    pub fn start_gap(self, gap: f64, closed: f64, stays: bool) -> f64 {
        match self {
            ContactCondition::Gap | ContactCondition::Massless if stays => gap.min(0.0),
            ContactCondition::Midpoint if gap > closed => gap,
            _ => 0.0,
        }
    }

    /// Whether contacts that were missed are found by what has gone through its target at the end of the step. With `Endpoint` they are
    /// those that arrive.
    #[must_use]
    pub fn rules_the_end(self) -> bool {
        self != ContactCondition::Endpoint
    }

    /// Whether it is the gap itself that is ruled, and not the motion.
    #[must_use]
    pub fn rules_gaps(self) -> bool {
        matches!(self, ContactCondition::Gap | ContactCondition::Massless)
    }

    /// Whether what normal reactions take on landing is given back; with `Massless` in pairs whose sides have mass.
    #[must_use]
    pub fn restores(self) -> bool {
        matches!(self, ContactCondition::Midpoint | ContactCondition::Massless)
    }

    /// Whether contact nodes carry no mass where bodies can spare it.
    #[must_use]
    pub fn is_massless(self) -> bool {
        self == ContactCondition::Massless
    }

    /// The reaction that the reduced problem solves for, as a fraction of the reaction itself: the rows of massless nodes are
    /// scaled by ξ so that K̄ stays symmetric.
    #[must_use]
    pub fn reaction_weight(self, map: &StepMap) -> f64 {
        if self.is_massless() { map.xi } else { 1.0 }
    }

    /// How much the reactions that the last step and this one ended with count in this one.
    #[must_use]
    pub fn weights_of_ends(self, map: &StepMap) -> ContactWeights {
        let alike = |weights| ContactWeights { normal: weights, across: weights };
        if map.is_static() {
            // Reactions grow with the motion of a load step; where something slides, it does so when friction is at its limit.
            return ContactWeights { normal: [0.5, 0.5], across: [0.0, 1.0] };
        }
        if self.is_massless() { alike([1.0 - map.xi, map.xi]) } else { alike([0.0, 1.0]) }
    }

    /// What the normal motion (H d)_n lacks of the variable w_n of the condition [m].
    ///
    /// A penetration that may be kept is that of a node that came past an edge. In pairs checked from both sides, it is that of a contact that
    /// starts inside its target where another has stood for it. To push it out at once would create energy. `d` is the current motion of
    /// the step and `v` the velocity at its start.
    pub fn normal_offset<const D: usize>(
        self,
        contact: &Contact<D>,
        Opening { start_gap, widening }: Opening,
        map: &StepMap,
        d: impl Fn(usize) -> Vector<D>,
        v: impl Fn(usize) -> Vector<D>,
    ) -> f64 {
        match self {
            ContactCondition::Gap | ContactCondition::Massless => {
                contact.gap - start_gap - contact.relative(d)[0]
            }
            ContactCondition::Midpoint => start_gap - widening,
            // v₊ = a v + b d, so w_n = v₊/b = d + (a/b) v: ½Δt v₊ for θ = ½.
            ContactCondition::Endpoint => {
                let closing = contact.relative(v)[0] - widening / map.dt;
                map.velocity_of_velocity / map.velocity_of_motion * closing - widening
            }
        }
    }
}
