use std::fmt::Debug;

use carom_mesh::{CellBlock, CellKind, Matrix, Mesh, Vector};

use crate::FemError;
use crate::material::{Mat3, PointLaw};
use crate::quadrature::Integrand;
use crate::shape_table::ShapeTable;
use crate::sparse::{NodalMatrix, NodeGraph};

/// Mean state of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellState {
    /// Cauchy stress [Pa].
    pub stress: Mat3,
    /// Stored energy per reference volume [J/m³].
    pub energy_density: f64,
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
    pub(crate) fn fill_with_zeros(&mut self) {
        [&mut *self.conserving, &mut *self.difference, &mut *self.end]
            .into_iter()
            .for_each(|f| f.fill(Vector::zeros()));
    }
}

/// The elements of one block of cells. Chosen once per block; what is inside runs without dispatch.
///
/// `u` and `f` hold one vector per node of the body.
pub trait Elements<const D: usize>: Send + Sync + Debug {
    /// Stored energy ∫ψ dV [J].
    fn energy(&self, u: &[Vector<D>]) -> f64;
    /// Adds the internal force ∂E/∂u = ∫ P·∇N dV [N] to `f`.
    fn add_internal_force(&self, u: &[Vector<D>], f: &mut [Vector<D>]);
    /// Adds the force [N] of a step from `u0` to `u1` whose work is the change of the stored energy, f·(u₁ − u₀) = ΔE, to `f`.
    fn add_conserving_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut [Vector<D>]);
    /// Adds the forces of a step from `u0` to `u1`.
    fn add_step_forces(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut StepForces<'_, D>);
    /// Adds the stiffness ∂²E/∂u² [N/m] to `k`.
    fn add_stiffness(&self, u: &[Vector<D>], k: &mut NodalMatrix<Matrix<D>>);
    /// Appends the mean state of every cell.
    fn cell_states(&self, u: &[Vector<D>], out: &mut Vec<CellState>);
}

/// Elements with `N` nodes that follow the law `L`.
#[derive(Debug)]
struct Block<const D: usize, const N: usize, L> {
    law: L,
    cells: Vec<[u32; N]>,
    table: ShapeTable<D, N>,
    /// Where the N × N node pairs of each cell stand in a matrix over the graph of the body.
    entries: Vec<[[u32; N]; N]>,
}

/// The elements of `block`, whose cells are numbered from `first_cell` in `mesh`; weights carry the thickness [m].
///
/// # Errors
/// If a cell is inverted or degenerate.
pub fn elements<const D: usize, L: PointLaw<D> + Clone + 'static>(
    law: &L,
    mesh: &Mesh<D>,
    block: &CellBlock,
    first_cell: usize,
    thickness: f64,
    graph: &NodeGraph,
) -> Result<Box<dyn Elements<D>>, FemError> {
    Ok(match block.kind {
        CellKind::Line2 => Box::new(Block::<D, 2, L>::new(law, mesh, block, first_cell, thickness, graph)?),
        CellKind::Tri3 => Box::new(Block::<D, 3, L>::new(law, mesh, block, first_cell, thickness, graph)?),
        CellKind::Quad4 | CellKind::Tet4 => {
            Box::new(Block::<D, 4, L>::new(law, mesh, block, first_cell, thickness, graph)?)
        }
        CellKind::Hex8 => Box::new(Block::<D, 8, L>::new(law, mesh, block, first_cell, thickness, graph)?),
    })
}

impl<const D: usize, const N: usize, L: PointLaw<D> + Clone> Block<D, N, L> {
    fn new(
        law: &L,
        mesh: &Mesh<D>,
        block: &CellBlock,
        first_cell: usize,
        thickness: f64,
        graph: &NodeGraph,
    ) -> Result<Self, FemError> {
        let mut table = ShapeTable::new(mesh, block, first_cell, Integrand::Gradients)?;
        table.weights.iter_mut().for_each(|w| *w *= thickness);
        let cells: Vec<[u32; N]> = block.cells().map(|nodes| std::array::from_fn(|a| nodes[a])).collect();
        let entries = cells
            .iter()
            .map(|c| std::array::from_fn(|a| std::array::from_fn(|b| graph.entry(c[a], c[b]) as u32)))
            .collect();
        Ok(Self { law: law.clone(), cells, table, entries })
    }

    #[inline]
    fn gather(u: &[Vector<D>], nodes: &[u32; N]) -> [Vector<D>; N] {
        std::array::from_fn(|a| u[nodes[a] as usize])
    }

    /// F = I + Σ u_a ⊗ ∇N_a.
    #[inline]
    fn deformation_gradient(u: &[Vector<D>; N], gradients: &[Vector<D>; N]) -> Matrix<D> {
        let mut f = Matrix::identity();
        for a in 0..N {
            f += u[a] * gradients[a].transpose();
        }
        f
    }

    /// Gradients and weights at the quadrature points of a cell.
    #[inline]
    fn points(&self, cell: usize) -> impl Iterator<Item = (&[Vector<D>; N], f64)> {
        let range = cell * self.table.points_per_cell..(cell + 1) * self.table.points_per_cell;
        self.table.gradients[range.clone()].iter().zip(self.table.weights[range].iter().copied())
    }
}

impl<const D: usize, const N: usize, L: PointLaw<D> + Clone> Elements<D> for Block<D, N, L> {
    fn energy(&self, u: &[Vector<D>]) -> f64 {
        let mut energy = 0.0;
        for (cell, nodes) in self.cells.iter().enumerate() {
            let u = Self::gather(u, nodes);
            for (gradients, weight) in self.points(cell) {
                energy += weight * self.law.energy(&Self::deformation_gradient(&u, gradients));
            }
        }
        energy
    }

    fn add_internal_force(&self, u: &[Vector<D>], f: &mut [Vector<D>]) {
        for (cell, nodes) in self.cells.iter().enumerate() {
            let u = Self::gather(u, nodes);
            let mut local = [Vector::<D>::zeros(); N];
            for (gradients, weight) in self.points(cell) {
                let stress = self.law.stress(&Self::deformation_gradient(&u, gradients)) * weight;
                for a in 0..N {
                    local[a] += stress * gradients[a];
                }
            }
            for a in 0..N {
                f[nodes[a] as usize] += local[a];
            }
        }
    }

    fn add_conserving_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut [Vector<D>]) {
        for (cell, nodes) in self.cells.iter().enumerate() {
            let (u0, u1) = (Self::gather(u0, nodes), Self::gather(u1, nodes));
            let mut local = [Vector::<D>::zeros(); N];
            for (gradients, weight) in self.points(cell) {
                let f0 = Self::deformation_gradient(&u0, gradients);
                let f1 = Self::deformation_gradient(&u1, gradients);
                let stress = self.law.discrete_stress(&f0, &f1) * weight;
                for a in 0..N {
                    local[a] += stress * gradients[a];
                }
            }
            for a in 0..N {
                f[nodes[a] as usize] += local[a];
            }
        }
    }

    fn add_step_forces(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut StepForces<'_, D>) {
        for (cell, nodes) in self.cells.iter().enumerate() {
            let (u0, u1) = (Self::gather(u0, nodes), Self::gather(u1, nodes));
            let mut local = [[Vector::<D>::zeros(); 3]; N];
            for (gradients, weight) in self.points(cell) {
                let f0 = Self::deformation_gradient(&u0, gradients);
                let f1 = Self::deformation_gradient(&u1, gradients);
                let stresses = self.law.step_stresses(&f0, &f1);
                for a in 0..N {
                    let gradient = gradients[a] * weight;
                    for (local, stress) in local[a].iter_mut().zip(&stresses) {
                        *local += stress * gradient;
                    }
                }
            }
            for (&node, local) in nodes.iter().zip(&local) {
                f.conserving[node as usize] += local[0];
                f.difference[node as usize] += local[1];
                f.end[node as usize] += local[2];
            }
        }
    }

    fn add_stiffness(&self, u: &[Vector<D>], k: &mut NodalMatrix<Matrix<D>>) {
        for (cell, nodes) in self.cells.iter().enumerate() {
            let u = Self::gather(u, nodes);
            let mut local = [[Matrix::<D>::zeros(); N]; N];
            for (gradients, weight) in self.points(cell) {
                let (_, tangent) = self.law.stress_and_tangent(&Self::deformation_gradient(&u, gradients));
                for a in 0..N {
                    // half[i][k][L] = ∇N_a[J] A[i][J][k][L] w
                    let mut half = [[[0.0; D]; D]; D];
                    for i in 0..D {
                        for j in 0..D {
                            let g = gradients[a][j] * weight;
                            for k in 0..D {
                                for l in 0..D {
                                    half[i][k][l] += g * tangent[i][j][k][l];
                                }
                            }
                        }
                    }
                    for b in 0..N {
                        for i in 0..D {
                            for k in 0..D {
                                for l in 0..D {
                                    local[a][b][(i, k)] += half[i][k][l] * gradients[b][l];
                                }
                            }
                        }
                    }
                }
            }
            for a in 0..N {
                for b in 0..N {
                    k.values[self.entries[cell][a][b] as usize] += local[a][b];
                }
            }
        }
    }

    fn cell_states(&self, u: &[Vector<D>], out: &mut Vec<CellState>) {
        for (cell, nodes) in self.cells.iter().enumerate() {
            let u = Self::gather(u, nodes);
            let mut mean = CellState { stress: Mat3::zeros(), energy_density: 0.0 };
            let mut volume = 0.0;
            for (gradients, weight) in self.points(cell) {
                let f = Self::deformation_gradient(&u, gradients);
                mean.stress += self.law.cauchy_stress(&f) * weight;
                mean.energy_density += self.law.energy(&f) * weight;
                volume += weight;
            }
            mean.stress /= volume;
            mean.energy_density /= volume;
            out.push(mean);
        }
    }
}

/// Adds the consistent mass ∫ρ N_a N_b dV [kg] of `block` to `m`.
///
/// # Errors
/// If a cell is inverted or degenerate.
pub fn add_mass<const D: usize>(
    mesh: &Mesh<D>,
    block: &CellBlock,
    first_cell: usize,
    areal_density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    match block.kind {
        CellKind::Line2 => add_mass_of::<D, 2>(mesh, block, first_cell, areal_density, m),
        CellKind::Tri3 => add_mass_of::<D, 3>(mesh, block, first_cell, areal_density, m),
        CellKind::Quad4 | CellKind::Tet4 => add_mass_of::<D, 4>(mesh, block, first_cell, areal_density, m),
        CellKind::Hex8 => add_mass_of::<D, 8>(mesh, block, first_cell, areal_density, m),
    }
}

fn add_mass_of<const D: usize, const N: usize>(
    mesh: &Mesh<D>,
    block: &CellBlock,
    first_cell: usize,
    areal_density: f64,
    m: &mut NodalMatrix<f64>,
) -> Result<(), FemError> {
    let table = ShapeTable::<D, N>::new(mesh, block, first_cell, Integrand::Values)?;
    for (cell, nodes) in block.cells().enumerate() {
        for (p, values) in table.values.iter().enumerate() {
            let weight = areal_density * table.weights[cell * table.points_per_cell + p];
            for a in 0..N {
                for b in 0..N {
                    let entry = m.graph().entry(nodes[a], nodes[b]);
                    m.values[entry] += weight * values[a] * values[b];
                }
            }
        }
    }
    Ok(())
}
