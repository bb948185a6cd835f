//! The Chebyshev semi-iteration: its terms, and how nodes share them.

use carom_mesh::parallel::each_chunk;
use pulp::{Arch, Simd, WithSimd};

use super::control::CONTROL;
use super::moved::Moved;
use super::rows::{ELSEWHERE, Split};
use super::scaled::{Columns, Scaled};
use crate::ranks::Ranks;

/// The vectors of the semi-iteration: the right-hand side, the solution, and the one before it.
#[derive(Debug)]
pub(super) struct Vectors<const D: usize, const C: usize> {
    pub b: Vec<Columns<D, C>>,
    pub x: Vec<Columns<D, C>>,
    pub before: Vec<Columns<D, C>>,
}

impl<const D: usize, const C: usize> Vectors<D, C> {
    pub fn zeros(nodes: usize) -> Self {
        let zeros = || vec![[[0.0; C]; D]; nodes];
        Self { b: zeros(), x: zeros(), before: zeros() }
    }

    /// Makes them zero at some places.
    pub fn clear(&mut self, places: impl Iterator<Item = usize>) {
        for place in places {
            for values in [&mut self.b, &mut self.x, &mut self.before] {
                values[place] = [[0.0; C]; D];
            }
        }
    }
}

/// A term of the semi-iteration: what it makes of `x` and the vector before that.
#[derive(Debug)]
struct Term<'a, const D: usize, const C: usize> {
    matrix: &'a Scaled<D>,
    /// ω and α.
    factors: [f32; 2],
    b: &'a [Columns<D, C>],
    x: &'a [Columns<D, C>],
}

impl<const D: usize, const C: usize> Clone for Term<'_, D, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const D: usize, const C: usize> Copy for Term<'_, D, C> {}

impl<const D: usize, const C: usize> Term<'_, D, C> {
    #[inline(always)]
    fn apply(&self, node: usize, before: &mut Columns<D, C>) {
        self.apply_product(node, &self.matrix.row_times(node, self.x), before);
    }

    /// The same where the row of S x is known.
    #[inline(always)]
    fn apply_product(&self, node: usize, product: &Columns<D, C>, before: &mut Columns<D, C>) {
        let [omega, alpha] = self.factors;
        let (b, x) = (&self.b[node], &self.x[node]);
        for i in 0..D {
            for c in 0..C {
                let change = x[i][c] - before[i][c] + alpha * (b[i][c] - product[i][c]);
                before[i][c] += omega * change;
            }
        }
    }

    fn apply_to_all(self, before: &mut [Columns<D, C>]) {
        if let Some(rows) = self.matrix.rows() {
            let Split { whole, split } = rows.all();
            return self.apply_shared(rows.ranks(), whole, split, before);
        }
        each_chunk(before, |first, before| Arch::new().dispatch(Chunk { term: self, first, before }));
    }

    /// Where it makes nothing else move than so many rings of this.
    fn apply_within(self, moved: &Moved, ring: usize, before: &mut [Columns<D, C>]) {
        // In the order of the matrix more nodes cost less, and threads share them.
        if 2 * moved.region().up_to(ring).len() > self.matrix.graph().node_count() {
            return self.apply_to_all(before);
        }
        let (whole, split) = moved.up_to(ring);
        match self.matrix.rows() {
            Some(rows) => self.apply_shared(rows.ranks(), whole, split, before),
            None => Arch::new().dispatch(Scattered { term: self, places: whole, before }),
        }
    }

    /// Where other ranks have parts of the rows that are split. Beside their message the memory that this takes anew is nothing.
    fn apply_shared(self, ranks: &dyn Ranks, whole: &[u32], split: &[u32], before: &mut [Columns<D, C>]) {
        let mut products = vec![[[0.0; C]; D]; split.len()];
        Arch::new().dispatch(Products { term: self, places: split, products: &mut products });
        if !split.is_empty() {
            ranks.sum_single(products.as_flattened_mut().as_flattened_mut());
        }
        Arch::new().dispatch(Scattered { term: self, places: whole, before });
        for (&place, product) in split.iter().zip(&products).filter(|&(&place, _)| place != ELSEWHERE) {
            self.apply_product(place as usize, product, &mut before[place as usize]);
        }
    }
}

/// The rows of S x at some places, or [`ELSEWHERE`].
struct Products<'a, const D: usize, const C: usize> {
    term: Term<'a, D, C>,
    places: &'a [u32],
    products: &'a mut [Columns<D, C>],
}

impl<const D: usize, const C: usize> WithSimd for Products<'_, D, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        let Self { term, places, products } = self;
        for (&place, product) in places.iter().zip(products) {
            if place != ELSEWHERE {
                *product = term.matrix.row_times(place as usize, term.x);
            }
        }
    }
}

/// A term for consecutive nodes.
struct Chunk<'a, const D: usize, const C: usize> {
    term: Term<'a, D, C>,
    first: usize,
    before: &'a mut [Columns<D, C>],
}

/// A term at some places.
struct Scattered<'a, const D: usize, const C: usize> {
    term: Term<'a, D, C>,
    places: &'a [u32],
    before: &'a mut [Columns<D, C>],
}

impl<const D: usize, const C: usize> WithSimd for Chunk<'_, D, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        for (node, before) in (self.first..).zip(self.before) {
            self.term.apply(node, before);
        }
    }
}

impl<const D: usize, const C: usize> WithSimd for Scattered<'_, D, C> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _simd: S) {
        for &place in self.places {
            self.term.apply(place as usize, &mut self.before[place as usize]);
        }
    }
}

/// 1/α and ω of as many terms as it takes for spectra between these positive bounds; None if they are more than `most`.
pub(super) fn terms([least, largest]: [f64; 2], most: usize) -> Option<(f64, Vec<f32>)> {
    let (middle, radius) = (0.5 * (largest + least), 0.5 * (largest - least));
    let mu = radius / middle;
    // What n terms leave is 1/Tₙ(1/μ) at most.
    let (mut omega, mut weights) = (1.0, Vec::new());
    let (mut before, mut chebyshev) = (1.0, 1.0 / mu);
    while weights.len() < most {
        weights.push(omega as f32);
        if 1.0 / chebyshev <= CONTROL.left {
            return Some((middle, weights));
        }
        (before, chebyshev) = (chebyshev, 2.0 / mu * chebyshev - before);
        let share = if weights.len() == 1 { 0.5 } else { 0.25 * omega };
        omega = 1.0 / (1.0 - share * mu * mu);
    }
    None
}

/// The semi-iteration for `vectors.b`, from nothing.
pub(super) fn solve<const D: usize, const C: usize>(
    matrix: &Scaled<D>,
    weights: &[f32],
    alpha: f32,
    vectors: &mut Vectors<D, C>,
) {
    let Vectors { b, x, before } = vectors;
    for ((x, before), b) in x.iter_mut().zip(&mut *before).zip(&*b) {
        *before = [[0.0; C]; D];
        *x = b.map(|row| row.map(|b| alpha * b));
    }
    for &omega in &weights[1..] {
        Term { matrix, factors: [omega, alpha], b, x }.apply_to_all(before);
        std::mem::swap(x, before);
    }
}

/// [`solve`] for a right-hand side that is zero outside the middle of what is `moved`, with vectors that are zero outside
/// of it: each term takes in one more ring.
pub(super) fn solve_within<const D: usize, const C: usize>(
    matrix: &Scaled<D>,
    weights: &[f32],
    alpha: f32,
    vectors: &mut Vectors<D, C>,
    moved: &Moved,
) {
    let Vectors { b, x, before } = vectors;
    for place in moved.here(0) {
        x[place] = b[place].map(|row| row.map(|b| alpha * b));
    }
    for (ring, &omega) in weights.iter().enumerate().skip(1) {
        let term = Term { matrix, factors: [omega, alpha], b, x };
        term.apply_within(moved, ring, before);
        std::mem::swap(x, before);
    }
}
