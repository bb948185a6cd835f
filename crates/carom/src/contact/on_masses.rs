//! What contact with nodes without mass does to a body that has its mass where it touches.
//!
//! A node without mass is in static balance under the reaction r₁ at the end of the step. Its body moves under stresses of the whole step,
//! and so its share of the contact is the mean r̄ = (1 − ξ) r₀ + ξ r₁ + α (r₁ − r₀), with r₀ at the start and α of the
//! blend. A body with mass, a rigid one say, takes this r̄ itself. In a blended step it takes the moments of r₀ where the
//! step starts and of r₁ where it ends, as the other side does: its own arms are those half way, and a couple makes up for the difference.

use carom_mesh::{Matrix, Vector, tensor};

use super::active::ActiveSet;
use crate::body::{Balance, Masses};
use crate::model::given::Given;

/// The forces of such contacts on the nodes of bodies with mass [N], which are of no use elsewhere.
#[derive(Debug, Default)]
pub(crate) struct OnMasses<const D: usize> {
    /// Hᵀr₀ and Hᵀr₁.
    start: Vec<Vector<D>>,
    end: Vec<Vector<D>>,
    /// Couples: those without α, and those that go with it.
    couples: [Vec<Vector<D>>; 2],
    /// The mass of every node of a body [kg].
    masses: Vec<f64>,
    /// By body, how many times ξ r₁ it feels.
    felt: Vec<f64>,
    /// Whether such contacts act on a body, and whether a body with mass is asked for.
    acts_on: Vec<bool>,
    is_asked: Vec<bool>,
}

/// In W no body feels less than this of ξ r₁: with 0 it would be singular.
const LEAST_FELT: f64 = 0.25;

impl<const D: usize> OnMasses<D> {
    /// Takes the reactions that the step starts with.
    pub fn begin(&mut self, given: &Given<'_, D>) {
        let (assembly, state) = (given.assembly, given.state);
        for flags in [&mut self.acts_on, &mut self.is_asked] {
            flags.clear();
            flags.resize(assembly.body_count(), false);
        }
        self.felt.clear();
        self.felt.resize(assembly.body_count(), 1.0);
        if !assembly.is_mixed() || !given.method.condition.is_massless() {
            return;
        }
        let [a, b] = &mut self.couples;
        for forces in [&mut self.start, &mut self.end, a, b] {
            forces.clear();
            forces.resize(assembly.node_count(), Vector::zeros());
        }
        for reaction in &state.reactions {
            if given.condition_of(reaction.pair).is_massless() {
                let force = reaction.contact.frame.tr_mul(&reaction.force);
                for (node, weight) in reaction.contact.stencil() {
                    if let Some(body) = with_mass(given, node) {
                        self.start[node] += force * weight;
                        self.acts_on[body] = true;
                    }
                }
            }
        }
    }

    /// Takes the reactions known so far of the contacts of `bodies`, as they were evaluated last.
    pub fn take(&mut self, bodies: &[usize], given: &Given<'_, D>, active: &ActiveSet<D>) {
        let assembly = given.assembly;
        if !assembly.is_mixed() || !given.method.condition.is_massless() {
            return;
        }
        let asked = || bodies.iter().copied().filter(|&i| !assembly.is_massless(i));
        for i in asked() {
            self.end[assembly.nodes(i)].fill(Vector::zeros());
            self.is_asked[i] = true;
        }
        for (k, contact) in active.contacts.iter().enumerate() {
            if !active.conditions[k].is_massless() {
                continue;
            }
            let force = contact.frame.tr_mul(&(active.reactions[k] / active.weights[k]));
            for (node, weight) in contact.stencil() {
                if let Some(body) = with_mass(given, node).filter(|&body| self.is_asked[body]) {
                    self.end[node] += force * weight;
                    self.acts_on[body] = true;
                }
            }
        }
        asked().for_each(|i| self.is_asked[i] = false);
    }

    /// Adds what these mean for the balance of energy of a blended step, whose motion is guessed to be `motion` [m], to `balances`.
    pub fn weigh(
        &mut self,
        bodies: &[usize],
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        masses: &(impl Masses<D> + ?Sized),
        balances: &mut [Balance],
    ) {
        for &i in bodies {
            if self.acts_on[i] {
                self.turn(i, given, motion, masses);
                self.balance(i, given, motion, &mut balances[i]);
            }
        }
    }

    /// Makes the couples of body `i`, of forces that turn it as a whole.
    fn turn(
        &mut self,
        i: usize,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        masses: &(impl Masses<D> + ?Sized),
    ) {
        let nodes = given.assembly.nodes(i);
        if !given.assembly.turns(i) {
            return;
        }
        // A rigid body works it out.
        self.masses.clear();
        self.masses.extend((0..nodes.len()).map(|own| masses.mass_of(i, own as u32)));
        let xi = given.interval.map.xi;
        let mut moments = [Vector::<3>::zeros(); 2];
        let (mut total, mut centre) = (0.0, Vector::<D>::zeros());
        let middle = |n: usize| given.position(n as u32) + motion[n] * 0.5;
        for n in nodes.clone() {
            let (p0, p1, d) = (&self.start[n], &self.end[n], &motion[n]);
            // The arm of r₀ is d/2 behind that half way, the arm of r₁ as much ahead.
            let without = tensor::cross(d, &((p1 * xi - p0 * (1.0 - xi)) * 0.5));
            let with = tensor::cross(d, &((p0 + p1) * 0.5));
            moments[0] += Vector::from(without);
            moments[1] += Vector::from(with);
            let mass = self.masses[n - nodes.start];
            total += mass;
            centre += middle(n) * mass;
        }
        centre /= total;
        let mut inertia = Matrix::<3>::zeros();
        let lifted = |v: Vector<D>| Vector::<3>::from_fn(|k, _| if k < D { v[k] } else { 0.0 });
        for n in nodes.clone() {
            let (arm, mass) = (lifted(middle(n) - centre), self.masses[n - nodes.start]);
            inertia += (Matrix::identity() * arm.norm_squared() - arm * arm.transpose()) * mass;
        }
        let inverse = tensor::inverse(&inertia).0;
        for (couple, moment) in self.couples.iter_mut().zip(moments) {
            let spin: [f64; 3] = (inverse * moment).into();
            // What has no extent cannot turn.
            let spin = if spin.iter().all(|s| s.is_finite()) { spin } else { [0.0; 3] };
            for n in nodes.clone() {
                let mass = self.masses[n - nodes.start];
                couple[n] = tensor::rotation_velocity(&spin, &(middle(n) - centre)) * mass;
            }
        }
    }

    /// Adds the work that body `i` receives to its balance.
    fn balance(&self, i: usize, given: &Given<'_, D>, motion: &[Vector<D>], balance: &mut Balance) {
        let xi = given.interval.map.xi;
        let [without, with] = &self.couples;
        for n in given.assembly.nodes(i) {
            let d = given.assembly.free_part(n, &motion[n]);
            let (p0, p1) = (&self.start[n], &self.end[n]);
            balance.missing += (p0 * (1.0 - xi) + p1 * xi + without[n]).dot(&d);
            balance.available -= (p1 - p0 + with[n]).dot(&d);
        }
    }

    /// Adds to the `residual` [N] of `bodies` what acts on them beside ξ r₁, which their contacts add as others do theirs, and takes note of what they
    /// [feel](Self::felt); `weights` are α of all bodies.
    pub fn add_known(
        &mut self,
        bodies: &[usize],
        given: &Given<'_, D>,
        weights: &[f64],
        residual: &mut [Vector<D>],
    ) {
        let xi = given.interval.map.xi;
        for &i in bodies.iter().filter(|&&i| self.acts_on[i]) {
            for n in given.assembly.nodes(i) {
                residual[n] += self.start[n] * (1.0 - xi);
            }
        }
        for &i in bodies {
            let alpha = if self.acts_on[i] && given.interval.is_blended { weights[i] } else { 0.0 };
            self.felt[i] = (1.0 + alpha / xi).max(LEAST_FELT);
        }
        self.add_blended(bodies, given, weights, residual);
    }

    /// How many times ξ r₁ body `i` feels of a reaction r₁ in this iteration. Without it a change of r₁ would be half or twice what it takes, and
    /// iterations would go round: two boxes at rest on one another, one of them with mass, did.
    pub fn felt(&self, i: usize) -> f64 {
        self.felt[i]
    }

    /// Adds to `forces` [N] on `bodies` what they have more than (1 − ξ) r₀ + ξ r₁ in a blended step.
    pub fn add_blended(
        &self,
        bodies: &[usize],
        given: &Given<'_, D>,
        weights: &[f64],
        forces: &mut [Vector<D>],
    ) {
        if !given.interval.is_blended {
            return;
        }
        let [without, with] = &self.couples;
        for &i in bodies.iter().filter(|&&i| self.acts_on[i]) {
            for n in given.assembly.nodes(i) {
                forces[n] += without[n] + (self.end[n] - self.start[n] + with[n]) * weights[i];
            }
        }
    }
}

/// The body of a node, if it has mass where it touches.
fn with_mass<const D: usize>(given: &Given<'_, D>, node: usize) -> Option<usize> {
    given.assembly.body_of(node).filter(|&body| !given.assembly.is_massless(body))
}
