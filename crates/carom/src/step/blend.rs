//! The blend of start and end stresses that closes the energy balance of massless contact nodes.
//!
//! Nodes without mass are in static balance at the end of the step, f₁ + C v̄ = H₁ᵀ r₁. So the work of contact is not exactly that
//! of the conserving force f_a.
//!
//! One scalar α per group of bodies in contact makes up for it. Inside, the force is f_a + d_a + α (f_d + d_d), where f_d comes
//! from the difference of the stresses of both ends. d_a and d_d are rigid force fields. They give the resultant and moment of what
//! the boundary lacks back to the mass, so the momenta are kept too. The reactions of the step are then r̄ = (½ − α) r₀ + (½ + α)
//! r₁, and
//!
//! α = [Σ (f_a + C v̄)_b·d_b − d_a·d_i + D_a] / [Σ (f_d)_i·d_i + d_d·d_i − D_d]
//!
//! with i and b the nodes with and without mass. A body that has its mass where it touches adds the work of r₀ and r₁ on it: see
//! [`crate::contact::on_masses`]. D_a + α D_d = Σ μ r̄_n |w_t| less the work of obstacles that move. The change of kinetic
//! and strain energy is then the work of the loads, less what damping and friction take.
//!
//! α is so small that no r̄_n pulls, and friction never does work: it may be −½ to ½ always, and more where r₀ and r₁ are nearly equal or r̄ is
//! mostly that of the end which presses more.

use carom_contact::{Pair, Target};

use crate::body::Balance;
use crate::contact::contact_work::ContactWork;
use crate::model::forest::Forest;

/// Largest |α|. Up to ½ stresses are those of a time within the step. Measured on 40 random scenes: with ½ the books of five stay open for
/// some steps, and one of them fails; with 2 all complete.
const LARGEST: f64 = 2.0;

/// Up to this |α| stresses are those of a time within the step. Where what it moves is not clear of round-off, below this fraction of the energy, it has no
/// more, and is zero where that would not do: a blend of round-off makes more of it in every step, and moves nothing that is missing.
const WITHIN: f64 = 0.5;
const CLEAR: f64 = 1e-9;

/// What is missing below this fraction of the energy of the model is round-off and may wait. Where the model starts from rest, it is the
/// energy of the motion of the step. Where there is neither, nothing can be missing.
const NEGLIGIBLE: f64 = 1e-14;

/// Balances and weights of all bodies.
#[derive(Debug)]
pub(crate) struct Blend {
    pub balances: Vec<Balance>,
    groups: Vec<Balance>,
    /// The least and the largest α of every group.
    ranges: Vec<[f64; 2]>,
    forest: Forest,
    /// α of every body.
    pub weight: Vec<f64>,
    /// The energy of the vibration of every body at the end of the step [J], where it is asked for.
    pub vibration: Vec<f64>,
    /// The same of every group.
    pub vibration_of_group: Vec<f64>,
    /// What every body took on of its vibration in the last step, as a share of it.
    pub share: Vec<f64>,
}

impl Blend {
    /// Of so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self {
            balances: vec![Balance::default(); bodies],
            groups: vec![Balance::default(); bodies],
            ranges: vec![[-LARGEST, LARGEST]; bodies],
            forest: Forest::new(bodies),
            weight: vec![0.0; bodies],
            vibration: vec![0.0; bodies],
            vibration_of_group: vec![0.0; bodies],
            share: vec![0.0; bodies],
        }
    }

    /// α of every group of bodies in contact among `bodies`, which `contacts` are all of. `energy_debt` is the energy of every body [J] that steps
    /// before left over and `energy` that of the model. Where little can be moved, as in nearly rigid flight, it waits for a step where there is
    /// more.
    pub fn weigh(&mut self, bodies: &[usize], contacts: &[ContactWork], energy_debt: &[f64], energy: f64) {
        for &i in bodies {
            self.forest.part(i);
            self.groups[i] = Balance::default();
            self.ranges[i] = [-LARGEST, LARGEST];
        }
        for c in contacts {
            match c.target {
                Target::Surface(target) if c.start > 0.0 || c.end > 0.0 => {
                    self.forest.join(c.source, target);
                }
                _ => {}
            }
        }
        for &i in bodies {
            let group = &mut self.groups[self.forest.root_of(i)];
            group.missing += self.balances[i].missing + energy_debt[i];
            group.available += self.balances[i].available;
        }
        for c in contacts {
            let leader = self.forest.root_of(c.source);
            narrow(&mut self.ranges[leader], c);
            let group = &mut self.groups[leader];
            let [start, end] = c.driven;
            group.missing += c.friction * 0.5 * (c.start + c.end) * c.slip - 0.5 * (start + end);
            group.available += end - start - c.friction * (c.end - c.start) * c.slip;
        }
        let energy = bodies.iter().map(|&i| self.balances[i].motion).sum::<f64>().max(energy);
        for &i in bodies {
            let leader = self.forest.root_of(i);
            let (Balance { missing, available, .. }, [least, largest]) =
                (self.groups[leader], self.ranges[leader]);
            let matters = missing.abs() > NEGLIGIBLE * energy;
            self.weight[i] = if matters && available.abs() > CLEAR * energy {
                (missing / available).clamp(least, largest)
            } else if matters && missing.abs() <= WITHIN * available {
                missing / available
            } else {
                0.0
            };
        }
    }

    /// Takes what iterations with `other` have come to for a body.
    pub fn take(&mut self, body: usize, other: &Self) {
        self.balances[body] = other.balances[body];
        self.weight[body] = other.weight[body];
        self.forest.take(body, &other.forest);
    }

    /// Takes note that a body rests: it is a group of its own, and nothing of it is blended.
    pub fn rest(&mut self, body: usize) {
        self.forest.part(body);
        self.weight[body] = 0.0;
        self.balances[body] = Balance::default();
    }

    /// What nodes without mass give way to of loads that set in [J].
    pub fn onset(&self) -> f64 {
        self.balances.iter().map(|balance| balance.onset).sum()
    }

    /// Keeps the weights of `bodies`, as far as they are those of stresses of a time within the step. What they leave over waits, or vibration has it.
    pub fn keep(&mut self, bodies: &[usize]) {
        bodies.iter().for_each(|&i| self.weight[i] = self.weight[i].clamp(-WITHIN, WITHIN));
    }

    /// Adds what a step left over to `energy_debt`: `surplus` of every body and what friction took, group by group. `booked` is what contacts
    /// of pairs with mass, which are not blended, took [J].
    pub fn carry(
        &mut self,
        surplus: impl Iterator<Item = f64>,
        contacts: &[ContactWork],
        booked: &[(Pair, f64)],
        energy_debt: &mut [f64],
    ) {
        for (pair, _) in booked {
            if let Target::Surface(target) = pair.target {
                self.forest.join(pair.source, target);
            }
        }
        self.groups.fill(Balance::default());
        for (i, surplus) in surplus.enumerate() {
            self.groups[self.forest.root_of(i)].missing += energy_debt[i] + surplus;
        }
        for c in contacts {
            let weight = self.weight[c.source];
            let group = &mut self.groups[self.forest.root_of(c.source)];
            group.missing += c.dissipation(weight) - c.prescribed(weight);
        }
        for (pair, taken) in booked {
            self.groups[self.forest.root_of(pair.source)].missing += taken;
        }
        energy_debt
            .iter_mut()
            .zip(&self.groups)
            .for_each(|(energy_debt, group)| *energy_debt = group.missing);
    }

    /// The first body of the group that a body belongs to.
    pub fn leader_of(&self, body: usize) -> usize {
        self.forest.root_of(body)
    }

    /// Largest |α|.
    pub fn largest_weight(&self) -> f64 {
        self.weight.iter().fold(0.0, |largest: f64, w| largest.max(w.abs()))
    }
}

/// Narrows a range of α to where the mean reaction of a contact, r̄ = ½ (r₀ + r₁) + α (r₁ − r₀), does not pull.
fn narrow([least, largest]: &mut [f64; 2], contact: &ContactWork) {
    let (sum, change) = (contact.start + contact.end, contact.end - contact.start);
    if change > 0.0 {
        *least = least.max(-0.5 * sum / change);
    } else if change < 0.0 {
        *largest = largest.min(-0.5 * sum / change);
    }
}
