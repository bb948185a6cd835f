use std::marker::PhantomData;

use carom_mesh::parallel::{has_threads, share};
use carom_mesh::{Matrix, Vector};
use pulp::{Arch, Simd, WithSimd};

use super::kinematics::Kinematics;
use super::staging::{Local, Staging};
use crate::material::{Batch, LANES, MAX_POINTS, PlasticState, Tangent};
use crate::quadrature::Integrand;
use crate::shape_table::{Cells, ShapeTable};
use crate::sparse::{NodalMatrix, NodeGraph};
use crate::{FemError, Growth};

/// Packs whose matrices a thread makes at a time, and so many times as many are made before they are added up.
const PACKS: usize = 4;
const GROUPS: usize = 8;

/// Cells with `N` nodes and their quadrature points, whatever their law: [`LANES`] cells side by side in a pack.
///
/// Point `q` of the cell in lane `l` of a pack is number `q * LANES + l` of its batch. The last pack is filled up with copies of the
/// last cell, which take no part in sums.
#[derive(Debug)]
pub(crate) struct Grid<const D: usize, const S: usize, const N: usize, K> {
    cells: usize,
    points_per_cell: usize,
    /// The nodes of the cells of every pack, lane by lane.
    nodes: Vec<[[u32; LANES]; N]>,
    /// The gradients g_a of [`Kinematics`] [1/m], pack by pack and point by point.
    gradients: Vec<[[[f64; LANES]; S]; N]>,
    /// Reference volumes of the points [m³], pack by pack and point by point.
    weights: Vec<[f64; LANES]>,
    /// Where the N × N node pairs of each cell stand in a matrix over the graph of the body.
    entries: Vec<[[u32; N]; N]>,
    /// None for few cells.
    staging: Option<Staging<D, N>>,
    arch: Arch,
    kinematics: PhantomData<K>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> Grid<D, S, N, K> {
    /// Zero forces at the nodes of a pack.
    pub const NOWHERE: Local<D, N> = [[[0.0; LANES]; D]; N];

    /// # Errors
    /// If a cell is inverted or degenerate.
    pub fn new(cells: &Cells<'_, D>, graph: &NodeGraph) -> Result<Self, FemError> {
        let table = ShapeTable::<D, N>::new(cells, Integrand::Gradients)?;
        let cells: Vec<[u32; N]> =
            cells.block.cells().map(|nodes| std::array::from_fn(|a| nodes[a])).collect();
        let entries = cells
            .iter()
            .map(|c| std::array::from_fn(|a| std::array::from_fn(|b| graph.entry(c[a], c[b]) as u32)))
            .collect();
        let (count, points_per_cell) = (cells.len(), table.points_per_cell);
        debug_assert!(points_per_cell <= MAX_POINTS);
        let packs = count.div_ceil(LANES);
        let cell = |pack: usize, lane: usize| (pack * LANES + lane).min(count - 1);
        let points = packs * points_per_cell;
        let (mut gradients, mut weights) = (Vec::with_capacity(points), Vec::with_capacity(points));
        for pack in 0..packs {
            for point in 0..points_per_cell {
                let at: [usize; LANES] =
                    std::array::from_fn(|lane| cell(pack, lane) * points_per_cell + point);
                let mut of_point = [[[0.0; LANES]; S]; N];
                for (lane, &q) in at.iter().enumerate() {
                    for (a, gradient) in of_point.iter_mut().enumerate() {
                        let g = K::gradient(&table.gradients[q][a], table.hoop(q, a));
                        (0..S).for_each(|j| gradient[j][lane] = g[j]);
                    }
                }
                gradients.push(of_point);
                weights.push(at.map(|q| table.weights[q]));
            }
        }
        let nodes: Vec<[[u32; LANES]; N]> = (0..packs)
            .map(|pack| std::array::from_fn(|a| std::array::from_fn(|lane| cells[cell(pack, lane)][a])))
            .collect();
        Ok(Self {
            cells: count,
            points_per_cell,
            staging: Staging::new(graph.node_count(), count, &nodes),
            nodes,
            gradients,
            weights,
            entries,
            arch: Arch::new(),
            kinematics: PhantomData,
        })
    }

    /// Number of packs.
    pub fn packs(&self) -> usize {
        self.nodes.len()
    }

    /// Number of points of a pack.
    #[inline]
    pub fn batch(&self) -> usize {
        self.points_per_cell * LANES
    }

    /// Number of quadrature points of all packs.
    pub fn point_count(&self) -> usize {
        self.packs() * self.batch()
    }

    /// The cells of a pack, lane by lane.
    #[inline]
    pub fn cells(&self, pack: usize) -> std::ops::Range<usize> {
        pack * LANES..((pack + 1) * LANES).min(self.cells)
    }

    /// The points of the cell in a lane, within its batch.
    #[inline]
    pub fn points(&self, lane: usize) -> impl Iterator<Item = usize> + Clone + use<D, S, N, K> {
        (0..self.points_per_cell).map(move |q| q * LANES + lane)
    }

    /// Reference volumes [m³] of the points of a pack.
    #[inline]
    pub fn weights(&self, pack: usize) -> &[f64] {
        let first = pack * self.points_per_cell;
        self.weights[first..first + self.points_per_cell].as_flattened()
    }

    /// The part of `history` that the points of a pack have, if they have one.
    #[inline]
    pub fn part<'h>(&self, pack: usize, history: &'h [PlasticState]) -> &'h [PlasticState] {
        history.get(pack * self.batch()..(pack + 1) * self.batch()).unwrap_or_default()
    }

    /// The part of `history` that the points of a pack have, if they have one.
    pub fn part_mut<'h>(&self, pack: usize, history: &'h mut [PlasticState]) -> &'h mut [PlasticState] {
        history.get_mut(pack * self.batch()..(pack + 1) * self.batch()).unwrap_or_default()
    }

    /// Sum over the points of the cells of a pack, without the copies that fill it up.
    #[inline]
    pub fn sum(&self, pack: usize, of_point: impl Fn(usize) -> f64) -> f64 {
        let mut of_lanes = [0.0; LANES];
        for q in 0..self.points_per_cell {
            for (lane, sum) in of_lanes.iter_mut().enumerate() {
                *sum += of_point(q * LANES + lane);
            }
        }
        of_lanes[..self.cells(pack).len()].iter().sum()
    }

    /// Mean equivalent plastic strain of the cell in a lane.
    pub fn plastic_strain(&self, pack: usize, lane: usize, history: &[PlasticState]) -> f64 {
        let (weights, states) = (self.weights(pack), self.part(pack, history));
        if states.is_empty() {
            return 0.0;
        }
        let sum: f64 = self.points(lane).map(|q| weights[q] * states[q].equivalent_strain).sum();
        sum / self.points(lane).map(|q| weights[q]).sum::<f64>()
    }

    /// Writes F at the points of a pack to `f`.
    #[inline]
    pub fn deform(&self, pack: usize, u: &[Vector<D>], f: &mut Batch<S>) {
        self.arch.dispatch(Deform { grid: self, pack, u, f });
    }

    /// Writes the elastic part of F at the points of a pack to `f`.
    #[inline]
    pub fn deform_elastically(&self, pack: usize, u: &[Vector<D>], growth: Growth, f: &mut Batch<S>) {
        self.deform(pack, u, f);
        growth.take_out_of(f);
    }

    /// Adds the nodal forces of the `stresses` at the points of a pack to `f`; those of its cells go to `local`.
    #[inline]
    fn add_forces(&self, pack: usize, stresses: &Batch<S>, local: &mut Local<D, N>, f: &mut [Vector<D>]) {
        self.local_forces(pack, stresses, local);
        let lanes = self.cells(pack).len();
        for (nodes, force) in self.nodes[pack].iter().zip(&*local) {
            for (lane, &node) in nodes.iter().enumerate().take(lanes) {
                let f = &mut f[node as usize];
                (0..D).for_each(|i| f[i] += force[i][lane]);
            }
        }
    }

    /// Adds the nodal forces of the stresses that `stress` writes, pack by pack, to `forces`; returns the sum of what it returns.
    /// Every thread that takes part has a `scratch` of its own.
    #[inline]
    pub fn assemble<W, const M: usize>(
        &self,
        mut forces: [&mut [Vector<D>]; M],
        scratch: impl Fn() -> W + Sync,
        stress: impl Fn(usize, &mut W, &mut [Batch<S>; M]) -> f64 + Sync,
    ) -> f64 {
        let batches = || [const { Batch::zeros() }; M];
        if let Some(staging) = self.staging.as_ref().filter(|_| has_threads()) {
            let assembled = staging.assemble(
                &mut forces,
                || (scratch(), batches()),
                |pack, (work, stresses), local| {
                    let sum = stress(pack, work, stresses);
                    stresses.iter().zip(local).for_each(|(p, local)| self.local_forces(pack, p, local));
                    sum
                },
            );
            if let Some(sum) = assembled {
                return sum;
            }
        }
        let (mut work, mut stresses, mut local) = (scratch(), batches(), Self::NOWHERE);
        let mut sum = 0.0;
        for pack in 0..self.packs() {
            sum += stress(pack, &mut work, &mut stresses);
            for (stresses, force) in stresses.iter().zip(&mut forces) {
                self.add_forces(pack, stresses, &mut local, force);
            }
        }
        sum
    }

    /// As [`Self::assemble`], for the stresses of a step between the displacements `ends`, of which `stress` gets the elastic part of F at both ends.
    #[inline]
    pub fn assemble_step<const M: usize>(
        &self,
        ends: [&[Vector<D>]; 2],
        growth: Growth,
        forces: [&mut [Vector<D>]; M],
        stress: impl Fn(usize, [&Batch<S>; 2], &mut [Batch<S>; M]) -> f64 + Sync,
    ) -> f64 {
        let scratch = || (Batch::zeros(), Batch::zeros());
        self.assemble(forces, scratch, |pack, (f0, f1), stresses| {
            self.deform_elastically(pack, ends[0], growth, f0);
            self.deform_elastically(pack, ends[1], growth, f1);
            stress(pack, [f0, f1], stresses)
        })
    }

    /// Writes the nodal forces of the `stresses` at the points of a pack to `local`.
    #[inline]
    pub fn local_forces(&self, pack: usize, stresses: &Batch<S>, local: &mut Local<D, N>) {
        self.arch.dispatch(Forces { grid: self, pack, stresses, local });
    }

    /// Room for the tangents of a pack.
    pub fn tangents(&self) -> Vec<Tangent<S>> {
        vec![[[[[0.0; S]; S]; S]; S]; self.batch()]
    }

    /// Writes the stiffness of the cells of a pack, one per lane, for `tangents` at all of its points.
    pub fn write_stiffness(&self, pack: usize, tangents: &[Tangent<S>], locals: &mut [[[Matrix<D>; N]; N]]) {
        for (lane, local) in locals.iter_mut().enumerate() {
            *local = self.local_stiffness(pack, lane, self.points(lane).map(|q| &tangents[q]));
        }
    }

    fn local_stiffness<'t>(
        &self,
        pack: usize,
        lane: usize,
        tangents: impl Iterator<Item = &'t Tangent<S>>,
    ) -> [[Matrix<D>; N]; N] {
        let mut local = [[Matrix::zeros(); N]; N];
        let first = pack * self.points_per_cell;
        for (point, tangent) in (first..).zip(tangents) {
            let (gradients, weight) = (&self.gradients[point], self.weights[point][lane]);
            let g: [Vector<S>; N] = std::array::from_fn(|a| Vector::from_fn(|j, _| gradients[a][j][lane]));
            for a in 0..N {
                let stresses = K::stress_of_displacement(tangent, &g[a], weight);
                for b in 0..N {
                    K::add_forces(&mut local[a][b], &stresses, &g[b]);
                }
            }
        }
        local
    }

    /// Adds the matrices of all cells to `k`, in their order: `of_pack` writes those of the cells of a pack, with `scratch`. Threads share what it does.
    pub fn assemble_matrix<W>(
        &self,
        k: &mut NodalMatrix<Matrix<D>>,
        scratch: impl Fn() -> W + Sync,
        of_pack: impl Fn(usize, &mut W, &mut [[[Matrix<D>; N]; N]]) + Sync,
    ) {
        // Of few cells threads have no part in forces either.
        let is_shared = has_threads() && self.staging.is_some();
        let at_once = if is_shared { PACKS * GROUPS } else { 1 };
        let mut locals = vec![[[Matrix::zeros(); N]; N]; at_once * LANES];
        let mut own = scratch();
        let make = |work: &mut W, first: usize, locals: &mut [[[Matrix<D>; N]; N]]| {
            for (pack, locals) in (first..self.packs()).zip(locals.chunks_mut(LANES)) {
                of_pack(pack, work, &mut locals[..self.cells(pack).len()]);
            }
        };
        for first in (0..self.packs()).step_by(at_once) {
            if is_shared {
                share(&mut locals, PACKS * LANES, &|of_locals, locals| {
                    make(&mut scratch(), first + of_locals / LANES, locals);
                });
            } else {
                make(&mut own, first, &mut locals);
            }
            let cells = first * LANES..self.cells.min((first + at_once) * LANES);
            for (entries, local) in self.entries[cells].iter().zip(&locals) {
                for (&entry, block) in entries.as_flattened().iter().zip(local.as_flattened()) {
                    k.values[entry as usize] += block;
                }
            }
        }
    }
}

/// Part `chunk` of the lanes as a SIMD register.
#[inline(always)]
fn load<V: Simd>(lanes: &[f64; LANES], chunk: usize) -> V::f64s {
    V::as_simd_f64s(lanes).0[chunk]
}

/// See [`Grid::deform`].
struct Deform<'a, const D: usize, const S: usize, const N: usize, K> {
    grid: &'a Grid<D, S, N, K>,
    pack: usize,
    u: &'a [Vector<D>],
    f: &'a mut Batch<S>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> WithSimd
    for Deform<'_, D, S, N, K>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { grid, pack, u, f } = self;
        let (zero, one) = (simd.splat_f64s(0.0), simd.splat_f64s(1.0));
        let first = pack * grid.points_per_cell;
        let gradients = &grid.gradients[first..first + grid.points_per_cell];
        for chunk in 0..LANES / V::F64_LANES {
            let mut local = [[zero; D]; N];
            for (nodes, local) in grid.nodes[pack].iter().zip(&mut local) {
                let mut lanes = [[0.0; LANES]; D];
                for (lane, &node) in nodes[chunk * V::F64_LANES..].iter().enumerate().take(V::F64_LANES) {
                    let u = &u[node as usize];
                    for i in 0..D {
                        lanes[i][lane] = u[i];
                    }
                }
                for i in 0..D {
                    local[i] = load::<V>(&lanes[i], 0);
                }
            }
            for (q, gradients) in gradients.iter().enumerate() {
                let mut sum = [[zero; S]; S];
                for (i, row) in sum.iter_mut().enumerate() {
                    row[i] = one;
                }
                for (u, gradient) in local.iter().zip(gradients) {
                    let mut g = [zero; S];
                    for j in 0..S {
                        g[j] = load::<V>(&gradient[j], chunk);
                    }
                    K::add_displacement(simd, &mut sum, u, &g);
                }
                for i in 0..S {
                    for j in 0..S {
                        let lanes = &mut f.components[i][j][q * LANES..(q + 1) * LANES];
                        V::as_mut_simd_f64s(lanes).0[chunk] = sum[i][j];
                    }
                }
            }
        }
    }
}

/// See [`Grid::local_forces`].
struct Forces<'a, const D: usize, const S: usize, const N: usize, K> {
    grid: &'a Grid<D, S, N, K>,
    pack: usize,
    stresses: &'a Batch<S>,
    local: &'a mut Local<D, N>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> WithSimd
    for Forces<'_, D, S, N, K>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { grid, pack, stresses, local } = self;
        let zero = simd.splat_f64s(0.0);
        let points = pack * grid.points_per_cell..(pack + 1) * grid.points_per_cell;
        let (gradients, weights) = (&grid.gradients[points.clone()], &grid.weights[points]);
        for chunk in 0..LANES / V::F64_LANES {
            let mut sum = [[zero; D]; N];
            for (q, (gradients, weight)) in gradients.iter().zip(weights).enumerate() {
                let weight = load::<V>(weight, chunk);
                let mut p = [[zero; S]; S];
                for i in 0..S {
                    for j in 0..S {
                        let lanes = &stresses.components[i][j][q * LANES..(q + 1) * LANES];
                        p[i][j] = simd.mul_f64s(V::as_simd_f64s(lanes).0[chunk], weight);
                    }
                }
                for (sum, gradient) in sum.iter_mut().zip(gradients) {
                    let mut g = [zero; S];
                    for j in 0..S {
                        g[j] = load::<V>(&gradient[j], chunk);
                    }
                    K::add_force(simd, sum, &p, &g);
                }
            }
            for (local, sum) in local.iter_mut().zip(&sum) {
                for i in 0..D {
                    V::as_mut_simd_f64s(&mut local[i]).0[chunk] = sum[i];
                }
            }
        }
    }
}
