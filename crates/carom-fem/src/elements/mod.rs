//! What cells store, how they resist and what they weigh.

mod block;
mod choice;
mod dashpots;
mod dilatation;
mod grid;
mod kinematics;
mod mass;
mod mean_dilatation;
mod staging;

use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};

use crate::Growth;
use crate::material::{Mat3, PlasticState};
use crate::sparse::NodalMatrix;

pub use choice::{dashpots, elements};
pub use dashpots::Dashpots;
pub use mass::{add_mass, add_scaled_diagonal_mass};

/// Mean state of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellState {
    /// Cauchy stress [Pa].
    pub stress: Mat3,
    /// Green–Lagrange strain ½(FᵀF − 1) of the motion of the nodes; a sheet without stress across it has none there either.
    pub strain: Mat3,
    /// Stored energy per reference volume [J/m³].
    pub energy_density: f64,
    /// Equivalent plastic strain; zero in what is elastic.
    pub plastic_strain: f64,
}

impl CellState {
    /// Nothing yet to be a mean of.
    pub(crate) fn empty(plastic_strain: f64) -> Self {
        Self { stress: Mat3::zeros(), strain: Mat3::zeros(), energy_density: 0.0, plastic_strain }
    }

    /// How many numbers it is.
    pub(crate) const NUMBERS: usize = 20;

    /// All of it, in a row.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> {
        let tensors = self.stress.iter().chain(self.strain.iter()).copied();
        tensors.chain([self.energy_density, self.plastic_strain]).collect::<Vec<_>>().into_iter()
    }

    /// What these [numbers](Self::numbers) say.
    pub(crate) fn of_numbers(row: &[f64]) -> Self {
        let tensor = |first: usize| Mat3::from_column_slice(&row[first..first + 9]);
        Self { stress: tensor(0), strain: tensor(9), energy_density: row[18], plastic_strain: row[19] }
    }
}

/// The forces of a step from u₀ to u₁ that a blend of its start and end stresses is made of [N], one vector per node; F̄ = ½(F₀ + F₁).
#[derive(Debug)]
pub struct StepForces<'a, const D: usize> {
    /// The conserving force ∫ F̄ S̄ ∇N dV: its work is the change of the stored energy.
    pub conserving: &'a mut [Vector<D>],
    /// ∫ F̄ (S₁ − S₀) ∇N dV.
    pub difference: &'a mut [Vector<D>],
    /// The internal force ∫ F₁ S₁ ∇N dV at the end.
    pub end: &'a mut [Vector<D>],
}

impl<const D: usize> StepForces<'_, D> {
    /// Those of the conserving stress, of the difference and of the end.
    pub(crate) fn each(&mut self) -> [&mut [Vector<D>]; 3] {
        [self.conserving, self.difference, self.end]
    }
}

/// What the quadrature points of a block are under beside the motion.
#[derive(Debug, Clone, Copy)]
pub struct Past<'a> {
    /// What they remember at the start of the step; empty if they are elastic or virgin.
    pub history: &'a [PlasticState],
    /// How they have grown.
    pub growth: Growth,
}

impl Past<'_> {
    /// Nothing.
    pub fn none() -> Self {
        Self { history: &[], growth: Growth::default() }
    }
}

/// The elements of one block of cells. Chosen once per block; what is inside runs without dispatch.
///
/// `u` and `f` hold one vector per node of the body. Energies, forces and stiffnesses are those that the law gives for the elastic part of the
/// deformation, per volume as it has grown.
pub trait Elements<const D: usize>: Send + Sync + Debug {
    /// Number of quadrature points of all cells.
    fn point_count(&self) -> usize;
    /// Stored energy ∫ψ dV [J], and plastic work since the start of the step.
    fn energy(&self, u: &[Vector<D>], past: Past<'_>) -> f64;
    /// Adds the internal force ∂E/∂u = ∫ P·∇N dV [N] to `f`.
    fn add_internal_force(&self, u: &[Vector<D>], past: Past<'_>, f: &mut [Vector<D>]);
    /// Adds the internal force to `f` and returns the stored energy, in one pass where that is cheaper.
    fn add_internal_force_of_energy(&self, u: &[Vector<D>], past: Past<'_>, f: &mut [Vector<D>]) -> f64 {
        self.add_internal_force(u, past, f);
        self.energy(u, past)
    }
    /// Adds the force [N] of a step from `u0` to `u1` whose work is the change of the stored energy, f·(u₁ − u₀) = ΔE, to `f`.
    fn add_conserving_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], past: Past<'_>, f: &mut [Vector<D>]);
    /// Adds the forces of a step from `u0` to `u1`; returns the stored energy at its end, or zero where it is not asked for.
    fn add_step_forces(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        past: Past<'_>,
        f: &mut StepForces<'_, D>,
        with_energy: bool,
    ) -> f64;
    /// Adds the stiffness ∂²E/∂u² [N/m] to `k`.
    fn add_stiffness(&self, u: &[Vector<D>], past: Past<'_>, k: &mut NodalMatrix<Matrix<D>>);
    /// Appends the mean state of every cell.
    fn cell_states(&self, u: &[Vector<D>], past: Past<'_>, out: &mut Vec<CellState>);
    /// Replaces what the points remember by what they will at the end of a step to `u`; returns the plastic work of the step [J].
    fn update(&self, u: &[Vector<D>], growth: Growth, history: &mut [PlasticState]) -> f64;
}

/// Evaluates an expression in which `$n` is the number of nodes of cells of a kind, as a constant; `$d` is the dimension of the mesh.
///
/// A mesh refuses cells of another dimension than its own. Code for them is not compiled: it was half of what elements are.
macro_rules! with_node_count {
    ($d:ident, $kind:expr, $n:ident => $body:expr) => {
        match $d {
            2 => with_node_count!(2, $kind, $n => $body),
            _ => match $kind {
                CellKind::Tet4 => with_node_count!(@ 4, $n, $body),
                CellKind::Wedge6 => with_node_count!(@ 6, $n, $body),
                CellKind::Hex8 => with_node_count!(@ 8, $n, $body),
                CellKind::Tet10 => with_node_count!(@ 10, $n, $body),
                CellKind::Wedge15 => with_node_count!(@ 15, $n, $body),
                CellKind::Hex20 => with_node_count!(@ 20, $n, $body),
                CellKind::Hex27 => with_node_count!(@ 27, $n, $body),
                other => unreachable!("a mesh of space has no cells {other:?}"),
            },
        }
    };
    (2, $kind:expr, $n:ident => $body:expr) => {
        match $kind {
            CellKind::Tri3 => with_node_count!(@ 3, $n, $body),
            CellKind::Quad4 => with_node_count!(@ 4, $n, $body),
            CellKind::Tri6 => with_node_count!(@ 6, $n, $body),
            CellKind::Quad8 => with_node_count!(@ 8, $n, $body),
            CellKind::Quad9 => with_node_count!(@ 9, $n, $body),
            other => unreachable!("a mesh of the plane has no cells {other:?}"),
        }
    };
    (@ $count:literal, $n:ident, $body:expr) => {{
        const $n: usize = $count;
        $body
    }};
}
pub(crate) use with_node_count;
