//! What an impact does to two solids: its impulse, restitution, and where the energy of their motion went.

use carom_contact::Solid;
use carom_fem::KineticParts;
use carom_mesh::{Vector, tensor};
use serde::Serialize;

use crate::ledger::BodyLedger;
use crate::step::report::PairImpulse;
use crate::{Model, State};

/// Speeds below this share of those of the two solids are round-off: they have no ratio to another one.
const ROUND_OFF: f64 = 1e-12;

/// How a solid moves as a whole, and the energy in it. Vectors have three components; in the plane the last is zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Whole {
    /// Its centre of mass [m].
    pub centre: [f64; 3],
    /// Velocity of that [m/s].
    pub velocity: [f64; 3],
    /// Mean spin [rad/s].
    pub spin: [f64; 3],
    /// Its kinetic energy [J].
    pub kinetic: KineticParts,
    /// Its strain energy [J].
    pub strain: f64,
    /// What it has dissipated so far by plastic strain, and by damping and viscosity [J].
    pub plastic: f64,
    /// See `plastic`.
    pub viscous: f64,
}

impl Whole {
    /// That of a solid in a state, where the books of bodies are these. An obstacle has a velocity alone.
    pub fn of<const D: usize>(
        model: &Model<D>,
        state: &State<D>,
        books: &[BodyLedger],
        solid: Solid,
    ) -> Self {
        match solid {
            Solid::Obstacle(o) => {
                let v = state.velocity[model.node_count() + o];
                let velocity = std::array::from_fn(|i| if i < D { v[i] } else { 0.0 });
                Self { velocity, ..Self::default() }
            }
            Solid::Body(i) => {
                let b = &model.bodies[i];
                let (u, v) = (&state.displacement[b.nodes()], &state.velocity[b.nodes()]);
                let energies = state.body_energies[i];
                let [centre, velocity, spin] = b.drift(u, v);
                Self {
                    centre,
                    velocity,
                    spin,
                    kinetic: b.momenta(u, v, energies.kinetic).kinetic,
                    strain: energies.strain,
                    plastic: books[i].plastic,
                    viscous: books[i].viscous,
                }
            }
        }
    }

    /// The velocity [m/s] of its point at this `arm` from its centre [m], as if it were rigid.
    fn velocity_at(&self, arm: &Vector<3>) -> Vector<3> {
        Vector::from(self.velocity) + tensor::rotation_velocity(&self.spin, arm)
    }

    /// Where its centre was half of `dt` [s] before [m].
    fn earlier(&self, dt: f64) -> Vector<3> {
        Vector::from(self.centre) - Vector::from(self.velocity) * (0.5 * dt)
    }

    /// Its numbers, one after the other.
    fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let Self { centre, velocity, spin, kinetic, strain, plastic, viscous } = self;
        let KineticParts { translation, rotation, vibration } = kinetic;
        let vectors = centre.iter_mut().chain(velocity).chain(spin);
        vectors.chain([translation, rotation, vibration, strain, plastic, viscous])
    }
}

/// What is known of two solids that touch: how they came, and what they have done to one another since.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Touching {
    /// How the two moved when they met.
    pub before: [Whole; 2],
    /// The impulses so far, of the normal reactions and of friction, on the first of the two [N s].
    impulses: [[f64; 3]; 2],
    /// Where reactions acted in the mean in the middle of the first step, from the centres of both then [m]. What spins turns the places that
    /// touch away from there, and these from the start of a step or its end come or go.
    arms: [[f64; 3]; 2],
    /// The same of the last step, from the origin [m], and how long that was [s].
    place: [f64; 3],
    dt: f64,
    /// How many steps gave an impulse.
    steps: f64,
}

impl Touching {
    /// Of two solids that meet, and moved like this before.
    pub fn meeting(before: [Whole; 2]) -> Self {
        Self { before, ..Self::default() }
    }

    /// Adds the impulse of a step that took `dt` [s]; `centres` says where those of both were in the middle of it [m].
    pub fn go_on(&mut self, given: &PairImpulse, dt: f64, centres: impl FnOnce() -> [[f64; 3]; 2]) {
        let Some(place) = given.place() else { return };
        if self.steps == 0.0 {
            self.arms = centres().map(|centre| std::array::from_fn(|i| place[i] - centre[i]));
        }
        (self.place, self.dt) = (place, dt);
        self.steps += 1.0;
        for (sum, more) in self.impulses.iter_mut().zip([given.normal, given.friction]) {
            sum.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
    }

    /// What it came to, where the two solids, `are_one` if they are a body and itself, move on like this. None without an impulse, as of load
    /// steps.
    pub fn impact(&self, after: &[Whole; 2], are_one: bool) -> Option<Impact> {
        let before = &self.before;
        let [normal, friction] = self.impulses.map(Vector::<3>::from);
        let met = self.arms.map(Vector::<3>::from);
        let place = Vector::<3>::from(self.place);
        let parted = if self.steps == 1.0 { met } else { after.map(|w| place - w.earlier(self.dt)) };
        let impulse = normal.norm();
        let n = normal.try_normalize(0.0)?;
        let velocities = |of: &[Whole; 2], arms: &[Vector<3>; 2]| [0, 1].map(|i| of[i].velocity_at(&arms[i]));
        let (came, left) = (velocities(before, &met), velocities(after, &parted));
        let speed = came.iter().chain(&left).map(Vector::norm).fold(0.0, f64::max);
        let ratio = |after: f64, before: f64| (before > ROUND_OFF * speed).then(|| after / before);
        let [came, left] = [came, left].map(|[first, second]| first - second);
        let approach = -came.dot(&n);
        let along = came + n * approach;
        let sliding = along.norm();
        let back = -left.dot(&along) / sliding;
        let sides = if are_one { 1 } else { 2 };
        let change = |of: fn(&Whole) -> f64| {
            after[..sides].iter().map(of).sum::<f64>() - before[..sides].iter().map(of).sum::<f64>()
        };
        Some(Impact {
            impulse,
            friction_impulse: friction.norm(),
            approach,
            restitution: ratio(left.dot(&n), approach),
            sliding,
            tangential_restitution: ratio(back, sliding),
            translation: change(|w| w.kinetic.translation),
            rotation: change(|w| w.kinetic.rotation),
            vibration: change(|w| w.kinetic.vibration),
            strain: change(|w| w.strain),
            plastic: change(|w| w.plastic),
            viscous: change(|w| w.viscous),
        })
    }

    /// Its numbers, one after the other.
    pub fn numbers_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        let Self { before, impulses, arms, place, dt, steps } = self;
        let vectors = impulses.iter_mut().chain(arms).flatten().chain(place).chain([dt, steps]);
        before.iter_mut().flat_map(Whole::numbers_mut).chain(vectors)
    }
}

/// What two solids did to one another from the onset of a contact to its release. Their motion is that of rigid bodies of the same momenta, at
/// the places where reactions acted at first and at last, in the middle of these steps; n is the direction of the impulse.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Impact {
    /// Of the normal reactions [N s].
    pub impulse: f64,
    /// Of friction [N s].
    pub friction_impulse: f64,
    /// Speed at which the two came together along n [m/s].
    pub approach: f64,
    /// Newton's coefficient: the speed at which they parted, over that at which they met. None where they did not come together.
    pub restitution: Option<f64>,
    /// Speed at which they slid on one another when they met [m/s].
    pub sliding: f64,
    /// The part of this speed with which they slid back: −1 where nothing hindered them, 0 where they stuck. None where they did not slide.
    pub tangential_restitution: Option<f64>,
    /// Change of the kinetic energy of their centres of mass [J].
    pub translation: f64,
    /// Of their turning as rigid bodies [J].
    pub rotation: f64,
    /// Of the rest of their kinetic energy [J].
    pub vibration: f64,
    /// Of their strain energy [J].
    pub strain: f64,
    /// What they dissipated by plastic strain [J].
    pub plastic: f64,
    /// What they dissipated by damping and viscosity [J].
    pub viscous: f64,
}

impl Impact {
    /// Its numbers that are always there, one after the other.
    pub(crate) fn numbers_mut(&mut self) -> [&mut f64; 10] {
        [
            &mut self.impulse,
            &mut self.friction_impulse,
            &mut self.approach,
            &mut self.sliding,
            &mut self.translation,
            &mut self.rotation,
            &mut self.vibration,
            &mut self.strain,
            &mut self.plastic,
            &mut self.viscous,
        ]
    }

    /// The others.
    pub(crate) fn optional_mut(&mut self) -> [&mut Option<f64>; 2] {
        [&mut self.restitution, &mut self.tangential_restitution]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of mass 2 kg and ½ m r² = 0.25 kg m² that comes down obliquely, and leaves with half of the speed and rolling.
    #[test]
    fn a_disc_that_bounces_and_rolls_off_is_said_to() {
        let came = Whole {
            centre: [0.0, 0.5, 0.0],
            velocity: [3.0, -2.0, 0.0],
            kinetic: KineticParts { translation: 13.0, ..KineticParts::default() },
            ..Whole::default()
        };
        let left = Whole {
            velocity: [2.0, 1.0, 0.0],
            spin: [0.0, 0.0, -4.0],
            kinetic: KineticParts { translation: 5.0, rotation: 2.0, vibration: 0.0 },
            ..came
        };
        let given = PairImpulse {
            normal: [0.0, 6.0, 0.0],
            friction: [-2.0, 0.0, 0.0],
            moment: [0.0; 3],
            weight: 6.0,
        };
        let floor = Whole::default();
        let mut touching = Touching::meeting([came, floor]);
        touching.go_on(&given, 0.1, || [came.centre, floor.centre]);
        let impact = touching.impact(&[left, floor], false).expect("has an impulse");
        assert_eq!(
            (impact.impulse, impact.friction_impulse, impact.approach, impact.sliding),
            (6.0, 2.0, 2.0, 3.0)
        );
        assert_eq!((impact.restitution, impact.tangential_restitution), (Some(0.5), Some(-0.0)));
        assert_eq!((impact.translation, impact.rotation, impact.vibration), (-8.0, 2.0, 0.0));
    }

    #[test]
    fn what_did_not_come_together_has_no_coefficient() {
        let given =
            PairImpulse { normal: [0.0, 1.0, 0.0], friction: [0.0; 3], moment: [0.0; 3], weight: 1.0 };
        let mut touching = Touching::meeting([Whole::default(); 2]);
        assert_eq!(touching.impact(&[Whole::default(); 2], false), None);
        touching.go_on(&given, 0.1, || [[0.0; 3]; 2]);
        let impact = touching.impact(&[Whole::default(); 2], false).expect("has an impulse");
        assert_eq!((impact.restitution, impact.tangential_restitution), (None, None));
    }
}
