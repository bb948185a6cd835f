//! A bridge between two states of equilibrium, where a load step finds none near the last one: bodies snap through, or lose their hold and find
//! another. They move on with inertia and the paper's scheme at its most damped, θ = ξ = 1, under the loads of the end of the load step, in steps that
//! grow, until they come to rest. What that dissipates is in the ledger's `scheme`.
//!
//! Where a body gives way symmetry may keep it from doing so: nothing drives it out of a path that is unstable. It is given a push along the motion by
//! which it gives way, and what that brings is in the ledger's `external`.

use carom_mesh::parallel::among_threads;
use carom_mesh::{Vector, nodal};

use super::stepper::Stepper;
use crate::State;
use crate::body::Interval;
use crate::step::giving_way::GivingWay;
use crate::step::report::StepReport;
use crate::step::step_over;
use crate::step::workspace::Workspace;

/// Load steps are halved so often before there is a bridge.
pub(super) const AFTER: u32 = 4;

/// The length of the first step, of the longest and of the shortest, in times of a wave through the largest body.
const LENGTHS: [f64; 3] = [0.1, 1e4, 1e-5];

/// Steps of a bridge. One in steps of the longest length never takes so many.
const STEPS: usize = 400;

/// A step with no more iterations than this was easy, and the next is twice as long.
const EASY: usize = 12;

/// Bodies may be at rest where their kinetic energy is below this share of the strain energy.
const SLOW: f64 = 1e-6;

/// The kinetic energy of a push, in terms of the strain energy: far above round-off, and small beside what giving way sets free.
const PUSH: f64 = 1e-8;

/// So many steps lie between two attempts to find the equilibrium.
const ATTEMPTS: usize = 4;

/// A push that no step has taken up yet.
struct Push<const D: usize> {
    body: usize,
    /// What it brings [J].
    energy: f64,
    /// The velocities of the body before [m/s].
    before: Vec<Vector<D>>,
}

impl<const D: usize> Stepper<'_, D> {
    /// Takes the state to the equilibrium under the loads at time `end` [s], wherever that is, and returns whether there is one. If not, the state
    /// is where the bridge ended; `observe` was told of all its steps.
    pub(super) fn bridge(
        &mut self,
        end: f64,
        observe: &mut impl FnMut([&State<D>; 2], &StepReport, &Workspace<D>),
    ) -> bool {
        let mut push = self.push();
        let leads_there = self.cross_all(end, &mut push, observe);
        if let Some(Push { body, before, .. }) = push {
            let nodes = self.model.assembly.nodes(body);
            self.state.velocity[nodes].copy_from_slice(&before);
            self.state.refresh(&self.model.assembly, &self.work.iterating.bodies);
        }
        leads_there
    }

    /// The steps of a bridge.
    fn cross_all(
        &mut self,
        end: f64,
        push: &mut Option<Push<D>>,
        observe: &mut impl FnMut([&State<D>; 2], &StepReport, &Workspace<D>),
    ) -> bool {
        let waves = self.model.bodies.iter().filter_map(|b| Some(b.body.mesh().diameter() / b.wave_speed()?));
        let time = waves.fold(0.0, f64::max);
        let mut dt = LENGTHS[0] * time;
        let mut since = 0;
        for _ in 0..STEPS {
            let interval = self.method.bridge([self.state.time, end], dt);
            let Some(report) = self.cross(&interval, push, observe) else {
                dt /= 4.0;
                if dt < LENGTHS[2] * time {
                    return false;
                }
                continue;
            };
            since += 1;
            let energies = self.state.energies;
            if energies.kinetic <= SLOW * energies.strain && since >= ATTEMPTS {
                since = 0;
                if self.cross(&self.method.interval(end, 0.0), push, observe).is_some() {
                    return true;
                }
            }
            if report.newton_iterations <= EASY {
                dt = (2.0 * dt).min(LENGTHS[1] * time);
            }
        }
        false
    }

    /// Pushes the body that is about to give way, if one is.
    fn push(&mut self) -> Option<Push<D>> {
        let Self { model, state, work, .. } = self;
        let GivingWay { body, motion } = work.iterating.newton.giving_way.take()?;
        let nodes = model.assembly.nodes(body);
        let kinetic = state.body_energies[body].kinetic;
        let before = state.velocity[nodes.clone()].to_vec();
        let mass = |own: u32| work.iterating.bodies[body].mass_of(own);
        let of_unit_speed =
            0.5 * (0..).zip(&motion).map(|(own, x)| mass(own) * x.norm_squared()).sum::<f64>();
        let speed = (PUSH * state.energies.strain / of_unit_speed).sqrt();
        nodal::each(&mut state.velocity[nodes], [&motion], |v, [x]| *v = x * speed);
        state.refresh(&model.assembly, &work.iterating.bodies);
        Some(Push { body, energy: state.body_energies[body].kinetic - kinetic, before })
    }

    /// One step of a bridge, if it succeeds. What a `push` has brought belongs to the first one.
    fn cross(
        &mut self,
        interval: &Interval,
        push: &mut Option<Push<D>>,
        observe: &mut impl FnMut([&State<D>; 2], &StepReport, &Workspace<D>),
    ) -> Option<StepReport> {
        let Self { model, method, state, spare, work, .. } = self;
        let made = among_threads(model.node_count(), || {
            step_over(&model.assembly, method, interval, state, spare, work)
        });
        let Ok(mut report) = made else {
            self.failed += 1;
            return None;
        };
        if let Some(Push { body, energy, .. }) = push.take() {
            report.ledger.external += energy;
            work.body_ledgers[body].external += energy;
        }
        std::mem::swap(*state, *spare);
        observe([spare, state], &report, work);
        Some(report)
    }
}
