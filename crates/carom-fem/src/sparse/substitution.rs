use std::ops::Range;

use carom_mesh::parallel::{has_threads, share};
use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::{MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};

use super::control::CONTROL;
use super::real::Real;
use super::row::Row;

/// Columns taken together, so that what is loaded once serves them all.
const COLUMNS: usize = 4;

/// Forward and backward substitution with some of the supernodes of a Cholesky factor, for one right-hand side.
///
/// Its vectors hold a value for each of its own columns, in the order of elimination. Behind them is one for every row below these that
/// belongs to columns of others. To these, forward substitution adds what the other columns must take over; backward substitution
/// expects their solution there.
///
/// For every supernode with diagonal block L₁₁ and rows L₂₁ below, the panel Z = [L₁₁⁻¹; L₂₁L₁₁⁻¹] is kept. The forward step is
/// then [y₁; t] = Z x₁, x₂ ← x₂ − t, and the backward step x₁ = Zᵀ[y₁; −x₂]: one product each way, without divisions or
/// dependent loops. A factor is made once and solved with thousands of times, so the set-up does not count. 2D bodies consist
/// of small panels, on which a general library spends most of its time on dispatch.
#[derive(Debug, Default)]
pub(super) struct Substitution<T> {
    pub(super) panels: Vec<Panel>,
    /// The large ones among them.
    large: Vec<u32>,
    /// The panel of every column of its own.
    panel_of: Vec<u32>,
    pub(super) rows: Vec<u32>,
    pub(super) values: Vec<T>,
    /// Of a panel what is added up, or taken apart.
    pub(super) gathered: Vec<T>,
    /// The same for right-hand sides side by side; empty until there are any.
    pub(super) gathered_abreast: Vec<Row<T>>,
    /// A panel on its way to `values`.
    inverted: Vec<f64>,
}

/// The supernode of columns `start..start + columns`; its rows below are `rows[first_row..first_row + below]`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Panel {
    pub start: usize,
    pub columns: usize,
    pub below: usize,
    pub first_row: usize,
    pub first_value: usize,
    /// Numbers from column to column.
    pub padded: usize,
}

impl<T: Real> Substitution<T> {
    /// Takes over the values of some supernodes of a factor; `place_of` says where the value of a column of the factor stands in the vectors.
    pub fn load(
        &mut self,
        factor: &SupernodalLltRef<'_, usize, f64>,
        supernodes: impl Iterator<Item = usize> + Clone,
        mut place_of: impl FnMut(usize) -> u32,
    ) {
        *self = Self::default();
        let mut largest = 0;
        let size = |s: usize| {
            let supernode = factor.supernode(s);
            let (columns, below) = (supernode.val().ncols(), supernode.pattern().len());
            (columns + below).next_multiple_of(T::PADDING) * columns
        };
        self.values.reserve_exact(supernodes.clone().map(size).sum());
        for s in supernodes {
            let supernode = factor.supernode(s);
            let (l, pattern) = (supernode.val(), supernode.pattern());
            let (columns, below) = (l.ncols(), pattern.len());
            let padded = (columns + below).next_multiple_of(T::PADDING);
            let panel = Panel {
                start: place_of(supernode.start()) as usize,
                columns,
                below,
                first_row: self.rows.len(),
                first_value: self.values.len(),
                padded,
            };
            self.rows.extend(pattern.iter().map(|&row| place_of(row)));
            self.inverted.clear();
            self.inverted.resize(padded * columns, 0.0);
            invert(l, &mut self.inverted, padded, columns + below);
            for (column, z) in self.inverted.chunks_exact(padded).enumerate() {
                let least = T::NEGLIGIBLE * z[column].abs();
                self.values.extend(z.iter().map(|&z| T::of(if z.abs() < least { 0.0 } else { z })));
            }
            largest = largest.max(padded);
            self.panel_of.resize(panel.start + columns, self.panels.len() as u32);
            if padded * columns >= CONTROL.large_panel {
                self.large.push(self.panels.len() as u32);
            }
            self.panels.push(panel);
        }
        self.gathered.resize(largest, T::default());
        self.inverted = Vec::new();
    }

    /// Memory [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
            + size_of_val(&self.rows[..])
            + size_of_val(&self.panels[..])
            + size_of_val(&self.panel_of[..])
    }

    /// Overwrites `x` with L⁻¹ x.
    pub fn forward(&mut self, x: &mut [T]) {
        let mut next = 0;
        if has_threads() {
            for large in 0..self.large.len() {
                let p = self.large[large] as usize;
                Arch::new().dispatch(Forward { substitution: self, panels: next..p, x });
                self.forward_large(p, x);
                next = p + 1;
            }
        }
        let panels = next..self.panels.len();
        Arch::new().dispatch(Forward { substitution: self, panels, x });
    }

    /// Overwrites `x` with L⁻ᵀ x.
    pub fn backward(&mut self, x: &mut [T]) {
        let mut end = self.panels.len();
        if has_threads() {
            for large in (0..self.large.len()).rev() {
                let p = self.large[large] as usize;
                Arch::new().dispatch(Backward { substitution: self, panels: (p + 1..end).rev(), x });
                self.backward_large(p, x);
                end = p;
            }
        }
        Arch::new().dispatch(Backward { substitution: self, panels: (0..end).rev(), x });
    }

    /// The forward step of one panel, its rows shared by threads.
    fn forward_large(&mut self, p: usize, x: &mut [T]) {
        let Self { panels, rows, values, gathered, .. } = self;
        let p = &panels[p];
        let z = &values[p.first_value..p.first_value + p.padded * p.columns];
        let t = &mut gathered[..p.padded];
        let own = &x[p.start..p.start + p.columns];
        let part = p.padded.div_ceil(rayon::current_num_threads()).next_multiple_of(T::PADDING);
        share(t, part, &|first, t| {
            Arch::new().dispatch(Product { z, rows: p.padded, first, x: own, t });
        });
        subtract(p, rows, t, x);
    }

    /// The backward step of one panel, its columns shared by threads.
    fn backward_large(&mut self, p: usize, x: &mut [T]) {
        let Self { panels, rows, values, gathered, .. } = self;
        let p = &panels[p];
        let z = &values[p.first_value..p.first_value + p.padded * p.columns];
        let t = &mut gathered[..p.padded];
        gather(p, rows, x, t);
        let part = p.columns.div_ceil(rayon::current_num_threads()).next_multiple_of(COLUMNS);
        share(&mut x[p.start..p.start + p.columns], part, &|first, x| {
            let z = &z[first * p.padded..];
            Arch::new().dispatch(TransposedProduct { z: &z[..x.len() * p.padded], t, x });
        });
    }

    /// [`Self::forward`] where `x` is zero outside of a [`Self::reach`], and stays so.
    pub fn forward_within(&mut self, reach: &[u32], x: &mut [T]) {
        let panels = reach.iter().map(|&p| p as usize);
        Arch::new().dispatch(Forward { substitution: self, panels, x });
    }

    /// [`Self::backward`], only for the columns of a [`Self::reach`].
    pub fn backward_within(&mut self, reach: &[u32], x: &mut [T]) {
        let panels = reach.iter().rev().map(|&p| p as usize);
        Arch::new().dispatch(Backward { substitution: self, panels, x });
    }

    /// Writes the panels of `columns` and of all that are eliminated after them and depend on them to `reach`, ascending. These are
    /// what a right-hand side in these columns touches, and what the solution there depends on (Gilbert 1994). Calls `leave` with
    /// the rows of others by which the ways go on there.
    pub fn reach(
        &self,
        columns: impl Iterator<Item = usize>,
        reach: &mut Vec<u32>,
        mut leave: impl FnMut(usize),
    ) {
        reach.clear();
        reach.extend(columns.map(|column| self.panel_of[column]));
        reach.sort_unstable();
        reach.dedup();
        // Parents stand behind their children: each is looked at once, when all that lead to it are known.
        let mut next = 0;
        while next < reach.len() {
            let panel = &self.panels[reach[next] as usize];
            next += 1;
            if panel.below > 0 {
                let row = self.rows[panel.first_row] as usize;
                let Some(&parent) = self.panel_of.get(row) else {
                    leave(row);
                    continue;
                };
                if let Err(place) = reach[next..].binary_search(&parent) {
                    reach.insert(next + place, parent);
                }
            }
        }
    }

    /// The columns of the panels of a [`Self::reach`].
    pub fn columns_within<'a>(&'a self, reach: &'a [u32]) -> impl Iterator<Item = Range<usize>> + 'a {
        reach.iter().map(|&p| {
            let panel = &self.panels[p as usize];
            panel.start..panel.start + panel.columns
        })
    }
}

/// Solves Z L₁₁ = [I; L₂₁] for the panel `z` of so many `rows`, which is zero, `padded` numbers from column to column.
fn invert(l: MatRef<'_, f64>, z: &mut [f64], padded: usize, rows: usize) {
    let columns = l.ncols();
    if columns > CONTROL.blocked {
        for j in 0..columns {
            z[j * padded + j] = 1.0;
            (columns..rows).for_each(|i| z[j * padded + i] = l[(i, j)]);
        }
        let z = MatMut::from_column_major_slice_with_stride_mut(z, rows, columns, padded);
        let l11 = l.subrows(0, columns);
        solve_upper_triangular_in_place(l11.transpose(), z.transpose_mut(), Par::Seq);
        return;
    }
    // Column by column from the last.
    for j in (0..columns).rev() {
        let (z_j, later) = z[j * padded..].split_at_mut(padded);
        for k in j + 1..columns {
            let factor = l[(k, j)];
            let z_k = &later[(k - j - 1) * padded..][..rows];
            z_j[k..rows].iter_mut().zip(&z_k[k..]).for_each(|(known, z)| *known += z * factor);
        }
        for (i, z) in z_j.iter_mut().enumerate().take(rows).skip(j) {
            let right = if i >= columns {
                l[(i, j)]
            } else if i == j {
                1.0
            } else {
                0.0
            };
            *z = (right - *z) / l[(j, j)];
        }
    }
}

struct Forward<'a, T, I> {
    substitution: &'a mut Substitution<T>,
    panels: I,
    x: &'a mut [T],
}

impl<T: Real, I: Iterator<Item = usize>> WithSimd for Forward<'_, T, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered, .. }, panels: order, x } =
            self;
        for p in order {
            let p = &panels[p];
            let z = &values[p.first_value..p.first_value + p.padded * p.columns];
            let t = &mut gathered[..p.padded];
            product(simd, z, p.padded, 0, &x[p.start..p.start + p.columns], t);
            subtract(p, rows, t, x);
        }
    }
}

struct Backward<'a, T, I> {
    substitution: &'a mut Substitution<T>,
    panels: I,
    x: &'a mut [T],
}

impl<T: Real, I: Iterator<Item = usize>> WithSimd for Backward<'_, T, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered, .. }, panels: order, x } =
            self;
        for p in order {
            let p = &panels[p];
            let z = &values[p.first_value..p.first_value + p.padded * p.columns];
            let t = &mut gathered[..p.padded];
            gather(p, rows, x, t);
            transposed_product(simd, z, t, &mut x[p.start..p.start + p.columns]);
        }
    }
}

/// Takes the product `t` of a panel over into `x`. Panels are small: a call to copy or fill would cost more than it does.
#[inline(always)]
fn subtract<T: Real>(p: &Panel, rows: &[u32], t: &[T], x: &mut [T]) {
    for (x, t) in x[p.start..p.start + p.columns].iter_mut().zip(t) {
        *x = *t;
    }
    for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&t[p.columns..]) {
        x[row as usize] -= *t;
    }
}

/// Writes [x₁; −x₂] of a panel to `t`.
#[inline(always)]
fn gather<T: Real>(p: &Panel, rows: &[u32], x: &[T], t: &mut [T]) {
    for (t, x) in t.iter_mut().zip(&x[p.start..p.start + p.columns]) {
        *t = *x;
    }
    for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&mut t[p.columns..]) {
        *t = -x[row as usize];
    }
    for t in &mut t[p.columns + p.below..] {
        *t = T::default();
    }
}

/// A part of the rows of a forward step: see [`product`].
struct Product<'a, T> {
    z: &'a [T],
    rows: usize,
    first: usize,
    x: &'a [T],
    t: &'a mut [T],
}

impl<T: Real> WithSimd for Product<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        product(simd, self.z, self.rows, self.first, self.x, self.t);
    }
}

/// A part of the columns of a backward step: see [`transposed_product`].
struct TransposedProduct<'a, T> {
    z: &'a [T],
    t: &'a [T],
    x: &'a mut [T],
}

impl<T: Real> WithSimd for TransposedProduct<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        transposed_product(simd, self.z, self.t, self.x);
    }
}

/// Some of the `rows` of a column of Z. No array of closures makes these: it is not always inlined, and then nothing is in registers.
#[inline(always)]
fn part<T: Real, S: Simd>(z: &[T], rows: usize, column: usize, own: Range<usize>) -> (&[T::Lanes<S>], &[T]) {
    T::lanes::<S>(&z[column * rows + own.start..column * rows + own.end])
}

/// `t` = Z `x` in the rows from `first` on, with Z stored column by column of so many `rows`.
#[inline(always)]
fn product<T: Real, S: Simd>(simd: S, z: &[T], rows: usize, first: usize, x: &[T], t: &mut [T]) {
    let own = first..first + t.len();
    let mut columns = z.chunks_exact(COLUMNS * rows);
    let mut factors = x.chunks_exact(COLUMNS);
    let (t_simd, t_tail) = T::lanes_mut::<S>(t);
    for t in &mut *t_simd {
        *t = T::splat(simd, T::default());
    }
    for t in &mut *t_tail {
        *t = T::default();
    }
    for (z, x) in columns.by_ref().zip(factors.by_ref()) {
        let (a, b) = (part::<T, S>(z, rows, 0, own.clone()), part::<T, S>(z, rows, 1, own.clone()));
        let (c, d) = (part::<T, S>(z, rows, 2, own.clone()), part::<T, S>(z, rows, 3, own.clone()));
        let (xa, xb) = (T::splat(simd, x[0]), T::splat(simd, x[1]));
        let (xc, xd) = (T::splat(simd, x[2]), T::splat(simd, x[3]));
        for ((((t, a), b), c), d) in t_simd.iter_mut().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
            let ab = T::mul_add(simd, *a, xa, T::mul_add(simd, *b, xb, *t));
            *t = T::mul_add(simd, *c, xc, T::mul_add(simd, *d, xd, ab));
        }
        for ((((t, a), b), c), d) in t_tail.iter_mut().zip(a.1).zip(b.1).zip(c.1).zip(d.1) {
            *t += *a * x[0];
            *t += *b * x[1];
            *t += *c * x[2];
            *t += *d * x[3];
        }
    }
    for (z, &x) in columns.remainder().chunks_exact(rows).zip(factors.remainder()) {
        let (z_simd, z_tail) = T::lanes::<S>(&z[own.clone()]);
        let x_simd = T::splat(simd, x);
        for (t, z) in t_simd.iter_mut().zip(z_simd) {
            *t = T::mul_add(simd, *z, x_simd, *t);
        }
        for (t, z) in t_tail.iter_mut().zip(z_tail) {
            *t += *z * x;
        }
    }
}

/// `x` = Zᵀ `t`, with Z stored column by column.
#[inline(always)]
fn transposed_product<T: Real, S: Simd>(simd: S, z: &[T], t: &[T], x: &mut [T]) {
    let rows = t.len();
    let (t_simd, t_tail) = T::lanes::<S>(t);
    let mut columns = z.chunks_exact(COLUMNS * rows);
    let mut results = x.chunks_exact_mut(COLUMNS);
    for (z, x) in columns.by_ref().zip(results.by_ref()) {
        let (a, b) = (part::<T, S>(z, rows, 0, 0..rows), part::<T, S>(z, rows, 1, 0..rows));
        let (c, d) = (part::<T, S>(z, rows, 2, 0..rows), part::<T, S>(z, rows, 3, 0..rows));
        let zero = T::splat(simd, T::default());
        let (mut sa, mut sb, mut sc, mut sd) = (zero, zero, zero, zero);
        for ((((t, a), b), c), d) in t_simd.iter().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
            sa = T::mul_add(simd, *a, *t, sa);
            sb = T::mul_add(simd, *b, *t, sb);
            sc = T::mul_add(simd, *c, *t, sc);
            sd = T::mul_add(simd, *d, *t, sd);
        }
        for (x, (sum, tail)) in x.iter_mut().zip([(sa, a.1), (sb, b.1), (sc, c.1), (sd, d.1)]) {
            *x = T::sum(simd, sum);
            for (z, t) in tail.iter().zip(t_tail) {
                *x += *z * *t;
            }
        }
    }
    for (z, x) in columns.remainder().chunks_exact(rows).zip(results.into_remainder()) {
        let (z_simd, z_tail) = T::lanes::<S>(z);
        let mut sum = T::splat(simd, T::default());
        for (t, z) in t_simd.iter().zip(z_simd) {
            sum = T::mul_add(simd, *z, *t, sum);
        }
        *x = T::sum(simd, sum);
        z_tail.iter().zip(t_tail).for_each(|(z, t)| *x += *z * *t);
    }
}
