//! Rigid motions, and whether supports leave a body any.

use std::ops::Range;

use carom_mesh::{Vector, tensor};
use nalgebra::DMatrix;

use crate::Body;

/// Rigid motions that move what is held by less than this, relative to the body, are free.
const FREE: f64 = 1e-6;

/// The velocity of a point at `arm` [m] from the centre in rigid motion number `k`: of unit speed along an axis if k < D; if not, about z in the
/// plane or about axis k − D in space, at unit speed in the distance `size` [m].
#[must_use]
pub fn rigid_motion<const D: usize>(k: usize, arm: &Vector<D>, size: f64) -> Vector<D> {
    if k < D {
        return Vector::from_fn(|i, _| if i == k { 1.0 } else { 0.0 });
    }
    let axis = if D == 2 { 2 } else { k - D };
    let spin: [f64; 3] = std::array::from_fn(|i| if i == axis { 1.0 / size } else { 0.0 });
    tensor::rotation_velocity(&spin, arm)
}

impl<const D: usize> Body<D> {
    /// The numbers of its rigid motions, as [`rigid_motion`] has them. A body that repeats itself cannot turn, and one of revolution moves along its
    /// axis only.
    #[must_use]
    pub fn rigid_motions(&self) -> Range<usize> {
        let turns = if self.mesh().ties().is_empty() { D * (D - 1) / 2 } else { 0 };
        if self.is_axisymmetric() { 1..D } else { 0..D + turns }
    }

    /// Whether what is held leaves the body a rigid motion.
    #[must_use]
    pub fn is_loose(&self) -> bool {
        let motions = self.rigid_motions();
        let centre = self.mean(self.mesh().nodes());
        let size = self.mesh().diameter();
        let mut gram = DMatrix::<f64>::zeros(motions.len(), motions.len());
        for dof in self.held().dofs() {
            let arm = self.mesh().nodes()[dof.node as usize] - centre;
            let at: Vec<f64> =
                motions.clone().map(|k| rigid_motion(k, &arm, size)[dof.component as usize]).collect();
            for i in 0..at.len() {
                for j in 0..at.len() {
                    gram[(i, j)] += at[i] * at[j];
                }
            }
        }
        let held = gram.symmetric_eigenvalues().min();
        held <= FREE * FREE * self.held().dofs().len().max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{ElasticConstants, LawSpec, Viscosity};
    use crate::{BodySpec, Formulation, HeldDof, Hypothesis, MassKind, RayleighDamping};
    use carom_mesh::generate;

    fn cube(held: &[(u32, u8)]) -> bool {
        let spec = BodySpec {
            law: LawSpec::NeoHookean(ElasticConstants { young: 1.0, poisson: 0.3 }),
            density: 1.0,
            damping: RayleighDamping::default(),
            viscosity: Viscosity::default(),
            regions: Vec::new(),
            mass: MassKind::Consistent,
            thickness: 1.0,
            hypothesis: Hypothesis::PlaneStrain,
            formulation: Formulation::Standard,
            initial_stress: crate::material::Mat3::zeros(),
            grows: false,
            points: Vec::new(),
            massless_contact: false,
            share: None,
        };
        let mesh = generate::grid([0.0; 3], [1.0; 3], [1, 1, 1]).expect("valid");
        let mut body = Body::new(mesh, &spec).expect("valid");
        body.hold(held.iter().map(|&(node, component)| HeldDof { node, component }));
        body.is_loose()
    }

    /// Three nodes held in 3, 2 and 1 components hold a solid; less does not, nor do 6 components along one line.
    #[test]
    fn six_supports_in_the_right_places_hold_a_solid() {
        let three_two_one = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
        assert!(!cube(&three_two_one));
        for left_out in 0..6 {
            let mut five = three_two_one.to_vec();
            five.remove(left_out);
            assert!(cube(&five), "{left_out}");
        }
        assert!(cube(&[(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2)]), "a hinge");
        assert!(cube(&[]));
    }
}
