//! What of a body resists velocities: damping and viscosity.

use carom_mesh::{Matrix, Vector};

use super::Body;
use crate::composition::for_each_piece_of;
use crate::elements::{Past, elements};
use crate::material::Mat3;
use crate::ranks::Summed;
use crate::sparse::NodalMatrix;
use crate::{BodySpec, FemError};

impl<const D: usize> Body<D> {
    /// Σ β K₀ over the materials of the body, which is like `spec` [N s/m]; none where no β is more than zero.
    pub(super) fn stiffness_of_damping(
        &self,
        spec: &BodySpec,
    ) -> Result<Option<NodalMatrix<Matrix<D>>>, FemError> {
        let unstressed = BodySpec { initial_stress: Mat3::zeros(), ..spec.clone() };
        let rest = vec![Vector::zeros(); self.node_count()];
        let mut sum: Option<NodalMatrix<Matrix<D>>> = None;
        for (index, of) in spec.by_material().iter().enumerate() {
            let factor = of.damping.stiffness;
            if factor == 0.0 {
                continue;
            }
            let mut k = self.no_stiffness();
            for_each_piece_of(index, &self.mesh, self.depth, &unstressed, |cells, spec| {
                elements(spec, cells, self.mass.shared_graph())?.add_stiffness(&rest, Past::none(), &mut k);
                Ok(())
            })?;
            k.values.iter_mut().for_each(|block| *block *= factor);
            match &mut sum {
                None => sum = Some(k),
                Some(sum) => sum.values.iter_mut().zip(&k.values).for_each(|(sum, k)| *sum += k),
            }
        }
        Ok(sum)
    }

    /// Σ β K₀ over its materials [N s/m], if there is any: what resists velocities in the frame of the body.
    #[must_use]
    pub fn damping_stiffness(&self) -> Option<&NodalMatrix<Matrix<D>>> {
        self.damping_stiffness.as_ref()
    }

    /// The viscous force C v [N], written to `f`; `frame` is the rotation of the body and `scratch` as long as `v`.
    pub fn damping_force(
        &self,
        frame: &Matrix<D>,
        v: &[Vector<D>],
        f: &mut [Vector<D>],
        scratch: &mut [Vector<D>],
    ) {
        match &self.damping_stiffness {
            Some(k0) => {
                for (s, v) in scratch.iter_mut().zip(v) {
                    *s = frame.tr_mul(v);
                }
                k0.multiply(scratch, f);
                f.iter_mut().for_each(|f| *f = frame * *f);
            }
            None => f.fill(Vector::zeros()),
        }
        if self.damping.mass > 0.0 {
            self.mass.multiply(v, scratch);
            for (f, mv) in f.iter_mut().zip(scratch.iter()) {
                *f += mv * self.damping.mass;
            }
        }
        if self.damping.mass > 0.0 || self.damping_stiffness.is_some() {
            self.ranks.sum_up(f);
        }
    }

    /// Whether anything resists velocities: damping or viscosity.
    #[must_use]
    pub fn is_damped(&self) -> bool {
        self.damping.mass != 0.0 || self.damping_stiffness.is_some() || self.is_viscous
    }

    /// Adds the force [N] of the material's viscosity in a step from `u0` to `u1` in `dt` [s] to `f`: its work is what the step
    /// dissipates.
    pub fn add_viscous_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], dt: f64, f: &mut [Vector<D>]) {
        if self.ranks.is_none() {
            return self.dashpots.iter().for_each(|d| d.add_force(u0, u1, dt, f));
        }
        if !self.is_viscous {
            return;
        }
        let mut own = vec![Vector::zeros(); f.len()];
        self.dashpots.iter().for_each(|d| d.add_force(u0, u1, dt, &mut own));
        self.ranks.sum_up(&mut own);
        f.iter_mut().zip(&own).for_each(|(f, own)| *f += own);
    }

    /// The derivative of the viscous force by the velocities [N s/m] at `u`, if there is any viscosity.
    #[must_use]
    pub fn viscosity(&self, u: &[Vector<D>]) -> Option<NodalMatrix<Matrix<D>>> {
        if self.dashpots.is_empty() {
            return None;
        }
        let mut c = self.no_stiffness();
        self.dashpots.iter().for_each(|d| d.add_damping(u, &mut c));
        Some(c)
    }
}
