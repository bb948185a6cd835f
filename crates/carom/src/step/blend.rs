//! The blend of start and end stresses that closes the energy balance of massless contact nodes.
//!
//! Nodes without mass are in static balance at the end of the step, f₁ + C v̄ = H₁ᵀ r₁, so the work of contact is not exactly
//! that of the conserving force f_a. One scalar α per group of bodies in contact makes up for it: inside, the force is
//! f_a + d_a + α (f_d + d_d), where f_d comes from the difference of the stresses of both ends, and d_a, d_d are rigid force fields
//! that give the resultant and moment of what the boundary lacks back to the mass, so that the momenta are kept too. The
//! reactions of the step are then r̄ = (½ − α) r₀ + (½ + α) r₁, and
//!
//! α = [Σ (f_a + C v̄)_b·d_b − d_a·d_i + D_a] / [Σ (f_d)_i·d_i + d_d·d_i − D_d]
//!
//! with i and b the nodes with and without mass, D_a + α D_d = Σ μ r̄_n |w_t| less the work of obstacles that move, makes the change of kinetic and strain energy
//! what loads do, less what damping and friction take.

use carom_contact::Target;
use carom_fem::{RigidMass, StepForces};
use carom_mesh::{Vector, tensor};

use crate::Model;
use crate::body::fe::equation::{BodyStep, ResidualScratch};

/// Largest |α|. Up to here r̄ is a mean of r₀ and r₁ with weights that are not negative, so that friction never does work.
const LARGEST: f64 = 0.5;

/// The two ends of the balance of a body or of a group: α is their ratio.
#[derive(Debug, Clone, Copy, Default)]
struct Balance {
    missing: f64,
    available: f64,
    /// Energy of the motion of the step, ½ Σ m (d/Δt)² [J].
    motion: f64,
}

/// What is missing below this fraction of the energy of the model, or of that of the motion of the step where the model starts from rest, is
/// round-off and may wait. Where there is neither, nothing can be missing.
const NEGLIGIBLE: f64 = 1e-14;

/// Forces, balances and weights of all bodies.
#[derive(Debug)]
pub(crate) struct Blend<const D: usize> {
    /// f_a + d_a inside.
    pub conserving: Vec<Vector<D>>,
    /// f_d + d_d inside.
    pub difference: Vec<Vector<D>>,
    /// f₁.
    pub end: Vec<Vector<D>>,
    middle: Vec<Vector<D>>,
    arms: Vec<Vector<D>>,
    balances: Vec<Balance>,
    groups: Vec<Balance>,
    leader: Vec<usize>,
    /// α of every body.
    pub weight: Vec<f64>,
}

/// A contact in the eyes of the balance: its bodies, μ, normal reactions at the start and the end of the step, and |w_t|.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rubbing {
    pub group: usize,
    pub source: usize,
    pub target: Target,
    pub friction: f64,
    pub start: f64,
    pub end: f64,
    pub slip: f64,
    /// Work [J] that prescribed motion, as of an obstacle, would do with the reactions of the start and of the end.
    pub driven: [f64; 2],
}

impl Rubbing {
    /// Work [J] that prescribed motion does through the contact.
    pub fn prescribed(&self, weight: f64) -> f64 {
        (0.5 - weight) * self.driven[0] + (0.5 + weight) * self.driven[1]
    }

    /// μ r̄_n |w_t|: what friction takes in the step [J].
    pub fn dissipation(&self, weight: f64) -> f64 {
        self.friction * ((0.5 - weight) * self.start + (0.5 + weight) * self.end) * self.slip
    }
}

impl<const D: usize> Blend<D> {
    pub fn new(model: &Model<D>) -> Self {
        let zeros = vec![Vector::zeros(); model.reference.len()];
        let bodies = model.bodies.len();
        Self {
            conserving: zeros.clone(),
            difference: zeros.clone(),
            end: zeros.clone(),
            middle: zeros.clone(),
            arms: zeros,
            balances: vec![Balance::default(); bodies],
            groups: vec![Balance::default(); bodies],
            leader: (0..bodies).collect(),
            weight: vec![0.0; bodies],
        }
    }

    /// Forces and balance of body `index` at the present guess.
    pub fn measure(
        &mut self,
        model: &Model<D>,
        index: usize,
        step: &BodyStep<'_, D>,
        scratch: &mut ResidualScratch<D>,
    ) {
        let nodes = model.bodies[index].nodes();
        let body = step.body;
        let (conserving, difference, end) = (
            &mut self.conserving[nodes.clone()],
            &mut self.difference[nodes.clone()],
            &mut self.end[nodes.clone()],
        );
        let mut forces = StepForces { conserving, difference, end };
        step.worked.step_forces(step.start, step.displacement, &mut forces);
        let StepForces { conserving, difference, end } = forces;
        let viscous = step.viscous_force(scratch);
        let (middle, arms) = (&mut self.middle[nodes.clone()], &mut self.arms[nodes]);
        for ((m, u), d) in middle.iter_mut().zip(step.start).zip(step.motion) {
            *m = u + d * 0.5;
        }
        let rigid = body.rigid_mass(middle, arms);
        let mut balance = Balance::default();
        // What the forces of the boundary have more than the reactions (½ ∓ α) of start and end: resultants and moments.
        let (mut excess, mut excess_moment) = ([Vector::zeros(); 2], [[0.0; 3]; 2]);
        for (&n, k) in body.massless().iter().zip(body.massless_stiffness()) {
            let n = n as usize;
            // What supports hold is theirs: contact neither moves it nor receives its work.
            let held = body.held();
            let d = held.free_part(n, &step.motion[n]);
            let x1 = body.mesh().nodes()[n] + step.displacement[n] - rigid.centre;
            let (x0, x_mid) = (x1 - step.motion[n], x1 - step.motion[n] * 0.5);
            let balance_at_end = end[n] + viscous[n] + step.steadying_force(n, *k) - step.end_load(n);
            let [p0, p1] = [step.contact_force[n], balance_at_end].map(|p| held.free_part(n, &p));
            let inner = [conserving[n] + viscous[n] - step.mean_load(n), difference[n]]
                .map(|f| held.free_part(n, &f));
            balance.missing += inner[0].dot(&d);
            let outer = [[p0 * 0.5, p1 * 0.5], [-p0, p1]];
            for k in 0..2 {
                excess[k] += inner[k] - outer[k][0] - outer[k][1];
                let moments = [(x_mid, inner[k], 1.0), (x0, outer[k][0], -1.0), (x1, outer[k][1], -1.0)];
                for (x, f, sign) in moments {
                    let moment = tensor::cross(&x, &f);
                    (0..3).for_each(|i| excess_moment[k][i] += sign * moment[i]);
                }
            }
        }
        // A body that cannot turn has no moment to keep.
        let turns = body.turns();
        let accelerations: [_; 2] = std::array::from_fn(|k| {
            rigid.acceleration(&excess[k], if turns { &excess_moment[k] } else { &[0.0; 3] })
        });
        for (n, &mass) in body.nodal_mass().iter().enumerate() {
            let d = step.motion[n];
            let given = accelerations.map(|a| RigidMass::force(&a, mass, &arms[n]));
            conserving[n] += given[0];
            difference[n] += given[1];
            balance.missing -= given[0].dot(&d);
            balance.available += difference[n].dot(&d);
            balance.motion += mass * d.norm_squared();
        }
        balance.motion *= 0.5 / (step.map.dt * step.map.dt);
        // The rows of massless nodes have no part in what is available.
        for n in body.massless().iter().map(|&n| n as usize) {
            balance.available -= difference[n].dot(&body.held().free_part(n, &step.motion[n]));
        }
        self.balances[index] = balance;
    }

    /// α of every group of bodies in contact among `bodies`, which `rubbing` is all of. `excess` is the energy of every body [J] that steps before left over and
    /// `energy` that of the model: where little can be moved, as in nearly rigid flight, it waits for a step where there is more.
    pub fn weigh(&mut self, bodies: &[usize], rubbing: &[Rubbing], excess: &[f64], energy: f64) {
        for &i in bodies {
            (self.leader[i], self.groups[i]) = (i, Balance::default());
        }
        for c in rubbing {
            match c.target {
                Target::Surface(target) if c.start > 0.0 || c.end > 0.0 => {
                    let (a, b) = (self.leader_of(c.source), self.leader_of(target));
                    self.leader[a.max(b)] = a.min(b);
                }
                _ => {}
            }
        }
        for &i in bodies {
            let group = &mut self.groups[leader_of(&self.leader, i)];
            group.missing += self.balances[i].missing + excess[i];
            group.available += self.balances[i].available;
        }
        for c in rubbing {
            let group = &mut self.groups[leader_of(&self.leader, c.source)];
            let [start, end] = c.driven;
            group.missing += c.friction * 0.5 * (c.start + c.end) * c.slip - 0.5 * (start + end);
            group.available += end - start - c.friction * (c.end - c.start) * c.slip;
        }
        let energy = bodies.iter().map(|&i| self.balances[i].motion).sum::<f64>().max(energy);
        for &i in bodies {
            let Balance { missing, available, .. } = self.groups[leader_of(&self.leader, i)];
            let matters = missing.abs() > NEGLIGIBLE * energy && available > 0.0;
            self.weight[i] = if matters { (missing / available).clamp(-LARGEST, LARGEST) } else { 0.0 };
        }
    }

    /// Adds what a step left over to `excess`: `surplus` of every body and what friction took, group by group.
    pub fn carry(&mut self, surplus: impl Iterator<Item = f64>, rubbing: &[Rubbing], excess: &mut [f64]) {
        self.groups.fill(Balance::default());
        for (i, surplus) in surplus.enumerate() {
            self.groups[leader_of(&self.leader, i)].missing += excess[i] + surplus;
        }
        for c in rubbing {
            let weight = self.weight[c.source];
            let group = &mut self.groups[leader_of(&self.leader, c.source)];
            group.missing += c.dissipation(weight) - c.prescribed(weight);
        }
        excess.iter_mut().zip(&self.groups).for_each(|(excess, group)| *excess = group.missing);
    }

    fn leader_of(&self, body: usize) -> usize {
        leader_of(&self.leader, body)
    }

    /// Writes the residual of body `index` without reactions [N] to `out`.
    pub fn residual(
        &self,
        model: &Model<D>,
        index: usize,
        step: &BodyStep<'_, D>,
        scratch: &mut ResidualScratch<D>,
        out: &mut [Vector<D>],
    ) {
        let nodes = model.bodies[index].nodes();
        step.inertia_and_damping(scratch, out);
        let inside = self.conserving[nodes.clone()].iter().zip(&self.difference[nodes.clone()]);
        for (out, (conserving, difference)) in out.iter_mut().zip(inside) {
            *out -= conserving + difference * self.weight[index];
        }
        step.balance_massless(&self.end[nodes], scratch.viscous(), out);
    }

    /// What body `index` received through contact in the step, by the forces last measured [J].
    pub fn exchanged(&self, index: usize) -> f64 {
        let Balance { missing, available, .. } = self.balances[index];
        missing - self.weight[index] * available
    }

    /// Largest |α|.
    pub fn largest_weight(&self) -> f64 {
        self.weight.iter().fold(0.0, |largest: f64, w| largest.max(w.abs()))
    }
}

/// The first body of the group that a body belongs to.
fn leader_of(leaders: &[usize], mut body: usize) -> usize {
    while leaders[body] != body {
        body = leaders[body];
    }
    body
}
