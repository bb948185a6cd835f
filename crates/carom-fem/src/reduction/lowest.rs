//! The lowest modes of a body, by Lanczos's iteration of blocks with K⁻¹M, whose vectors are all kept orthogonal (Grimes, Lewis & Simon, SIAM J. Matrix
//! Anal. Appl. 15, 1994, without shifts).

use carom_mesh::{Vector, nodal};
use nalgebra::DMatrix;

use crate::sparse::{Factor, NodalMatrix};
use crate::{FemError, Held};

/// Vectors of a block: so many equal frequencies are found at once.
const BLOCK: usize = 6;

/// Frequencies are found where a block more changes none by more than this part of itself.
const FOUND: f64 = 1e-10;

/// What is left of a vector is round-off where it is less than this part of it.
const NOTHING: f64 = 1e-10;

/// The lowest `count` modes with what is `held` at rest, with a mass of one each; all that there are if these are fewer. The `factor` is that of K.
///
/// # Errors
/// If a mode is not a number.
pub(super) fn lowest_modes<const D: usize>(
    mass: &NodalMatrix<f64>,
    held: &Held,
    factor: &mut Factor<D>,
    count: usize,
) -> Result<Vec<Vec<Vector<D>>>, FemError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let nodes = mass.graph().node_count();
    let mut space = Space { mass, held, vectors: Vec::new(), loads: Vec::new(), projected: Vec::new() };
    let mut block: Vec<Vec<Vector<D>>> = (0..BLOCK).map(|k| start(nodes, k)).collect();
    let mut before: Vec<f64> = Vec::new();
    loop {
        let first = space.vectors.len();
        block.into_iter().for_each(|vector| space.add(vector));
        let is_complete = space.vectors.len() == first;
        block = (first..space.vectors.len()).map(|k| space.flexed(k, factor)).collect();
        let (values, vectors) = space.ritz();
        if values.iter().any(|value| !value.is_finite()) {
            return Err(FemError::NotPositiveDefinite);
        }
        let found = values.len().min(count);
        let is_found = before.len() >= count
            && values.iter().zip(&before).take(count).all(|(now, then)| (now - then).abs() <= FOUND * now);
        if is_complete || is_found {
            return Ok((0..found).map(|k| space.combined(&vectors, k)).collect());
        }
        before = values;
    }
}

/// Vectors of which each has a mass of one and none with another.
struct Space<'a, const D: usize> {
    mass: &'a NodalMatrix<f64>,
    held: &'a Held,
    vectors: Vec<Vec<Vector<D>>>,
    /// M v.
    loads: Vec<Vec<Vector<D>>>,
    /// v_i·M K⁻¹ M v_j, j after j, each with the i ≤ j.
    projected: Vec<Vec<f64>>,
}

impl<const D: usize> Space<'_, D> {
    fn load(&self, vector: &[Vector<D>]) -> Vec<Vector<D>> {
        let mut load = vec![Vector::zeros(); vector.len()];
        self.mass.multiply(vector, &mut load);
        self.held.clear(&mut load);
        load
    }

    /// Adds what is new of a vector, if anything is.
    fn add(&mut self, mut vector: Vec<Vector<D>>) {
        self.held.clear(&mut vector);
        let size = nodal::dot(&vector, &self.load(&vector)).sqrt();
        for _ in 0..2 {
            for (own, load) in self.vectors.iter().zip(&self.loads) {
                let along = nodal::dot(&vector, load);
                nodal::each(&mut vector, [own], |v, [own]| *v -= own * along);
            }
        }
        let load = self.load(&vector);
        let left = nodal::dot(&vector, &load).sqrt();
        if left.is_nan() || left <= NOTHING * size {
            return;
        }
        self.vectors.push(vector.iter().map(|v| v / left).collect());
        self.loads.push(load.iter().map(|v| v / left).collect());
    }

    /// K⁻¹ M v of vector `k`, which is projected on all up to it.
    fn flexed(&mut self, k: usize, factor: &mut Factor<D>) -> Vec<Vector<D>> {
        let mut flexed = self.loads[k].clone();
        factor.solve(&mut flexed);
        self.held.clear(&mut flexed);
        self.projected.push(self.loads[..=k].iter().map(|load| nodal::dot(load, &flexed)).collect());
        flexed
    }

    /// Estimates of 1/ω² [s²], descending, and the coordinates of their modes.
    fn ritz(&self) -> (Vec<f64>, DMatrix<f64>) {
        let size = self.projected.len();
        let eigen = DMatrix::from_fn(size, size, |i, j| self.projected[i.max(j)][i.min(j)]).symmetric_eigen();
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let vectors = DMatrix::from_fn(size, size, |i, k| eigen.eigenvectors[(i, order[k])]);
        (order.iter().map(|&k| eigen.eigenvalues[k]).collect(), vectors)
    }

    fn combined(&self, coordinates: &DMatrix<f64>, k: usize) -> Vec<Vector<D>> {
        let mut sum = vec![Vector::zeros(); self.mass.graph().node_count()];
        for (i, vector) in self.vectors.iter().enumerate() {
            let part = coordinates[(i, k)];
            nodal::each(&mut sum, [vector], |s, [v]| *s += v * part);
        }
        sum
    }
}

/// Start vector number `k`, in which no mode is missing: SplitMix64 (Steele, Lea & Flood 2014).
fn start<const D: usize>(nodes: usize, k: usize) -> Vec<Vector<D>> {
    let number = |n: u64| {
        let mut x = (n + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        x = (x ^ (x >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    (0..nodes).map(|n| Vector::from_fn(|i, _| number(((k * nodes + n) * D + i) as u64))).collect()
}
