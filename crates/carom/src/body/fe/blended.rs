//! The forces whose blend closes the energy balance of nodes without mass: see [`crate::step::blend`].

use carom_fem::{RigidMass, StepForces};
use carom_mesh::{Vector, tensor};

use super::equation::{Equation, ResidualScratch, steadied};
use crate::body::{Balance, Outlook};

/// The forces of a step that is blended, node by node [N]; empty until one is.
#[derive(Debug, Default)]
pub(crate) struct BlendedForces<const D: usize> {
    /// f_a + d_a inside.
    conserving: Vec<Vector<D>>,
    /// f_d + d_d inside.
    difference: Vec<Vector<D>>,
    /// f₁.
    pub end: Vec<Vector<D>>,
    middle: Vec<Vector<D>>,
    from_centre: Vec<Vector<D>>,
    arms: Vec<Vector<D>>,
}

impl<const D: usize> BlendedForces<D> {
    /// Forces and balance at a guess. Where nothing will press on the boundary, what is open there will be gone at the next guess: the balance is that of it,
    /// up to what is small of second order, and α is found one iteration earlier.
    pub fn measure(
        &mut self,
        equation: &Equation<'_, D>,
        outlook: Outlook,
        scratch: &mut ResidualScratch<D>,
    ) -> Balance {
        let mut forces = self.step_forces(equation.motion.len());
        equation.with_history.step_forces(equation.start, equation.displacement, &mut forces);
        if outlook == Outlook::First {
            equation.viscous_force(scratch);
            return Balance::default();
        }
        self.balance(equation, outlook, scratch)
    }

    /// The balance at the end of a step, and the strain energy there [J].
    pub fn close(&mut self, equation: &Equation<'_, D>, scratch: &mut ResidualScratch<D>) -> (Balance, f64) {
        let mut forces = self.step_forces(equation.motion.len());
        let energy =
            equation.with_history.step_forces_and_energy(equation.start, equation.displacement, &mut forces);
        (self.balance(equation, Outlook::Pressed, scratch), energy)
    }

    /// The forces inside, to be written, of a body with so many nodes.
    fn step_forces(&mut self, nodes: usize) -> StepForces<'_, D> {
        let Self { conserving, difference, end, middle, from_centre, arms } = self;
        for forces in [&mut *conserving, &mut *difference, &mut *end, middle, from_centre, arms] {
            forces.resize(nodes, Vector::zeros());
        }
        StepForces { conserving, difference, end }
    }

    /// The balance of the forces inside, which get the rigid force fields that go with them.
    fn balance(
        &mut self,
        equation: &Equation<'_, D>,
        outlook: Outlook,
        scratch: &mut ResidualScratch<D>,
    ) -> Balance {
        let body = equation.body;
        let Self { conserving, difference, end, middle, from_centre, arms } = self;
        let viscous = equation.viscous_force(scratch);
        for ((m, u), d) in middle.iter_mut().zip(equation.start).zip(equation.motion) {
            *m = u + d * 0.5;
        }
        let rigid = body.rigid_mass(middle, from_centre, arms);
        let mut balance = Balance::default();
        // What the forces of the boundary have more than the reactions (½ ∓ α) of start and end: resultants and moments.
        let (mut excess, mut excess_moment) = ([Vector::zeros(); 2], [[0.0; 3]; 2]);
        for (n, resistance) in steadied(body, equation.map) {
            // What supports hold is theirs: contact neither moves it nor receives its work.
            let held = body.held();
            let d = held.free_part(n, &equation.motion[n]);
            let x1 = body.mesh().nodes()[n] + equation.displacement[n] - rigid.centre;
            let (x0, x_mid) = (x1 - equation.motion[n], x1 - equation.motion[n] * 0.5);
            let balance_at_end =
                end[n] + viscous[n] + equation.steadying_force(n, resistance) - equation.end_load(n);
            balance.onset += equation.set_in(n, &viscous[n]).dot(&d).abs();
            let [p0, p1] = [equation.contact_force[n], balance_at_end].map(|p| held.free_part(n, &p));
            let inner = [conserving[n] + viscous[n] - equation.mean_load(n), difference[n]]
                .map(|f| held.free_part(n, &f));
            balance.missing += inner[0].dot(&d);
            if outlook == Outlook::Free {
                let open = p1.dot(&d);
                balance.missing -= 0.5 * open;
                balance.available += open;
            }
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
            let d = equation.motion[n];
            let given = accelerations.map(|a| RigidMass::force(&a, mass, &arms[n]));
            conserving[n] += given[0];
            difference[n] += given[1];
            balance.missing -= given[0].dot(&d);
            balance.available += difference[n].dot(&d);
            balance.motion += mass * d.norm_squared();
        }
        balance.motion *= 0.5 / (equation.map.dt * equation.map.dt);
        // The rows of massless nodes have no part in what is available.
        for n in body.massless().iter().map(|&n| n as usize) {
            balance.available -= difference[n].dot(&body.held().free_part(n, &equation.motion[n]));
        }
        balance
    }

    /// Writes the residual without reactions [N], with the weight α of the blend, to `out`.
    pub fn residual(
        &self,
        equation: &Equation<'_, D>,
        weight: f64,
        scratch: &mut ResidualScratch<D>,
        out: &mut [Vector<D>],
    ) {
        equation.inertia_and_damping(scratch, out);
        let inside = self.conserving.iter().zip(&self.difference);
        for (out, (conserving, difference)) in out.iter_mut().zip(inside) {
            *out -= conserving + difference * weight;
        }
        equation.balance_massless(&self.end, scratch.viscous(), out);
    }
}
