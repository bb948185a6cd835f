//! A run that starts from bodies that are not where they are drawn.

use carom_contact::{Penetration, Solid};
use carom_mesh::{Vector, nodal};

use crate::Simulation;
use crate::build::cohesion::bond;
use crate::build::values::place;
use crate::error::InputError;

impl<const D: usize> Simulation<D> {
    /// Starts from these displacements [m], one per node, and the velocities of the scenario. Elastic bodies are under the stress of them. What is
    /// prescribed counts from there.
    ///
    /// # Errors
    /// If a displacement breaks what binds its node, energies are not finite, or bodies are in one another; the simulation is then of no use.
    ///
    /// # Panics
    /// If steps were made already or the number of nodes is not that of the model.
    pub fn set_initial_displacement(&mut self, displacement: &[Vector<D>]) -> Result<(), InputError> {
        assert_eq!(self.step(), 0, "initial displacements belong before the first step");
        let (stage, state) = (&self.stages[self.current], &mut self.state);
        let model = &stage.model;
        state.displacement[..model.node_count()].copy_from_slice(displacement);
        for (i, b) in model.bodies.iter().enumerate() {
            let u = &displacement[b.nodes()];
            let key = format!("bodies.{i}");
            let ties = b.body.mesh().ties();
            if let Some(tie) = ties.iter().find(|tie| u[tie.image as usize] != u[tie.master as usize]) {
                let message = format!(
                    "nodes {} and {} of {:?} move as one, as its sides are periodic; give both the same displacement",
                    tie.master, tie.image, b.name
                );
                return Err(InputError::new(key, message));
            }
            let bound =
                b.supports.bound(&b.body).find(|dof| u[dof.node as usize][dof.component as usize] != 0.0);
            if let Some(dof) = bound {
                let message = format!(
                    "node {} of {:?} is on the axis, which it cannot leave; let its radial displacement be 0",
                    dof.node, b.name
                );
                return Err(InputError::new(key, message));
            }
        }
        model.take_over(state);
        stage.set_in_motion(state);
        state.refresh(&model.assembly, &self.work.iterating.bodies);
        bond(&model.assembly, state);
        if !nodal::is_finite(displacement) || !state.is_finite(&model.assembly) {
            let message = "the energy of the initial displacements is not finite; check their unit, metres";
            return Err(InputError::new("bodies", message));
        }
        self.refuse_overlaps()?;
        self.restart();
        Ok(())
    }

    /// Refuses bodies that are in one another, in obstacles or in themselves by more than a run may have them.
    fn refuse_overlaps(&self) -> Result<(), InputError> {
        let stage = self.stage();
        let assembly = &stage.model.assembly;
        let at = |n: u32| assembly.reference[n as usize] + self.state.displacement[n as usize];
        let counts = |between: [Solid; 2]| assembly.must_not_overlap(between);
        let mut refused = None;
        let found = |Penetration { depth, cell, arcs, between, at }: Penetration<D>| {
            let depth = depth - assembly.clearance(between, self.state.time);
            if depth > stage.method.allowed_penetration(cell, arcs, 0.0) && refused.is_none() {
                let [a, b] = between.map(|solid| assembly.solid_name(solid));
                let message = format!(
                    "{a:?} and {b:?} overlap by {depth:.3e} m where the initial displacements put them, near {}; move one of them",
                    place(&at)
                );
                refused = Some(InputError::new("bodies", message));
            }
        };
        assembly.boundaries.clone().measure(&assembly.contact.obstacles, counts, &at, found);
        refused.map_or(Ok(()), Err)
    }
}
