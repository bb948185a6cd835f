use std::ops::Range;

use faer::linalg::triangular_solve::solve_upper_triangular_in_place;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::{MatMut, MatRef, Par};
use pulp::{Arch, Simd, WithSimd};

/// Rows of a panel are padded with zeros to a multiple of this, so that SIMD loops have no remainder.
const PADDING: usize = 4;
/// Columns taken together, so that what is loaded once serves them all.
const COLUMNS: usize = 4;
/// Columns from which a panel is inverted in blocks, by faer: the large ones of bodies in space.
const BLOCKED: usize = 96;

/// Forward and backward substitution with a supernodal Cholesky factor, for one right-hand side.
///
/// For every supernode with diagonal block L₁₁ and rows L₂₁ below, the panel Z = [L₁₁⁻¹; L₂₁L₁₁⁻¹] is kept. The forward step is
/// then [y₁; t] = Z x₁, x₂ ← x₂ − t, and the backward step x₁ = Zᵀ[y₁; −x₂]: one product each way, without divisions or
/// dependent loops. A factor is made once and solved with thousands of times, so the set-up does not count, and small
/// panels, where a general library spends most of its time on dispatch, are what 2D bodies consist of.
#[derive(Debug, Default)]
pub(super) struct Substitution {
    panels: Vec<Panel>,
    /// The panel of every column.
    panel_of: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
    gathered: Vec<f64>,
}

/// The supernode of columns `start..start + columns`; its rows below are `rows[first_row..first_row + below]`.
#[derive(Debug, Clone, Copy)]
struct Panel {
    start: usize,
    columns: usize,
    below: usize,
    first_row: usize,
    first_value: usize,
    padded: usize,
}

impl Substitution {
    /// Takes over the values of a factor.
    pub fn load(&mut self, factor: &SupernodalLltRef<'_, usize, f64>) {
        self.panels.clear();
        self.panel_of.clear();
        self.rows.clear();
        self.values.clear();
        let mut largest = 0;
        for s in 0..factor.symbolic().n_supernodes() {
            let supernode = factor.supernode(s);
            let (l, pattern) = (supernode.val(), supernode.pattern());
            let (columns, below) = (l.ncols(), pattern.len());
            let padded = (columns + below).next_multiple_of(PADDING);
            let panel = Panel {
                start: supernode.start(),
                columns,
                below,
                first_row: self.rows.len(),
                first_value: self.values.len(),
                padded,
            };
            self.rows.extend(pattern.iter().map(|&r| r as u32));
            self.values.resize(panel.first_value + padded * columns, 0.0);
            let z = &mut self.values[panel.first_value..];
            invert(l, z, padded, columns + below);
            largest = largest.max(padded);
            self.panel_of.resize(panel.start + columns, self.panels.len() as u32);
            self.panels.push(panel);
        }
        self.gathered.resize(largest, 0.0);
    }

    /// Overwrites `x`, in the order of elimination, with L⁻¹ x.
    pub fn forward(&mut self, x: &mut [f64]) {
        let panels = 0..self.panels.len();
        Arch::new().dispatch(Forward { substitution: self, panels, x });
    }

    /// Overwrites `x`, in the order of elimination, with L⁻ᵀ x.
    pub fn backward(&mut self, x: &mut [f64]) {
        let panels = (0..self.panels.len()).rev();
        Arch::new().dispatch(Backward { substitution: self, panels, x });
    }

    /// [`Self::forward`] where `x` is zero outside of a [`Self::reach`], and stays so.
    pub fn forward_within(&mut self, reach: &[u32], x: &mut [f64]) {
        let panels = reach.iter().map(|&p| p as usize);
        Arch::new().dispatch(Forward { substitution: self, panels, x });
    }

    /// [`Self::backward`], only for the columns of a [`Self::reach`].
    pub fn backward_within(&mut self, reach: &[u32], x: &mut [f64]) {
        let panels = reach.iter().rev().map(|&p| p as usize);
        Arch::new().dispatch(Backward { substitution: self, panels, x });
    }

    /// Writes the panels of `columns` and of all that are eliminated after them and depend on them to `reach`, ascending: what a
    /// right-hand side in these columns touches, and what the solution there depends on (Gilbert 1994).
    pub fn reach(&self, columns: impl Iterator<Item = usize>, reach: &mut Vec<u32>) {
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
                let parent = self.panel_of[self.rows[panel.first_row] as usize];
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
    if columns > BLOCKED {
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

struct Forward<'a, I> {
    substitution: &'a mut Substitution,
    panels: I,
    x: &'a mut [f64],
}

impl<I: Iterator<Item = usize>> WithSimd for Forward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered, .. }, panels: order, x } = self;
        for p in order {
            let p = &panels[p];
            let z = &values[p.first_value..p.first_value + p.padded * p.columns];
            let t = &mut gathered[..p.padded];
            product(simd, z, &x[p.start..p.start + p.columns], t);
            // Panels are small: a call to copy or fill would cost more than it does.
            for (x, t) in x[p.start..p.start + p.columns].iter_mut().zip(&*t) {
                *x = *t;
            }
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&t[p.columns..]) {
                x[row as usize] -= t;
            }
        }
    }
}

struct Backward<'a, I> {
    substitution: &'a mut Substitution,
    panels: I,
    x: &'a mut [f64],
}

impl<I: Iterator<Item = usize>> WithSimd for Backward<'_, I> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered, .. }, panels: order, x } = self;
        for p in order {
            let p = &panels[p];
            let z = &values[p.first_value..p.first_value + p.padded * p.columns];
            let t = &mut gathered[..p.padded];
            for (t, x) in t.iter_mut().zip(&x[p.start..p.start + p.columns]) {
                *t = *x;
            }
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&mut t[p.columns..]) {
                *t = -x[row as usize];
            }
            for t in &mut t[p.columns + p.below..] {
                *t = 0.0;
            }
            transposed_product(simd, z, t, &mut x[p.start..p.start + p.columns]);
        }
    }
}

/// `t` = Z `x`, with Z stored column by column.
#[inline(always)]
fn product<S: Simd>(simd: S, z: &[f64], x: &[f64], t: &mut [f64]) {
    let rows = t.len();
    let mut columns = z.chunks_exact(COLUMNS * rows);
    let mut factors = x.chunks_exact(COLUMNS);
    let (t_simd, t_tail) = S::as_mut_simd_f64s(t);
    for t in &mut *t_simd {
        *t = simd.splat_f64s(0.0);
    }
    for t in &mut *t_tail {
        *t = 0.0;
    }
    for (z, x) in columns.by_ref().zip(factors.by_ref()) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| S::as_simd_f64s(&z[k * rows..(k + 1) * rows]));
        let [xa, xb, xc, xd] = [x[0], x[1], x[2], x[3]].map(|x| simd.splat_f64s(x));
        for ((((t, a), b), c), d) in t_simd.iter_mut().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
            let ab = simd.mul_add_e_f64s(*a, xa, simd.mul_add_e_f64s(*b, xb, *t));
            *t = simd.mul_add_e_f64s(*c, xc, simd.mul_add_e_f64s(*d, xd, ab));
        }
        for ((((t, a), b), c), d) in t_tail.iter_mut().zip(a.1).zip(b.1).zip(c.1).zip(d.1) {
            *t += a * x[0] + b * x[1] + c * x[2] + d * x[3];
        }
    }
    for (z, &x) in columns.remainder().chunks_exact(rows).zip(factors.remainder()) {
        let (z_simd, z_tail) = S::as_simd_f64s(z);
        let x_simd = simd.splat_f64s(x);
        for (t, z) in t_simd.iter_mut().zip(z_simd) {
            *t = simd.mul_add_e_f64s(*z, x_simd, *t);
        }
        for (t, z) in t_tail.iter_mut().zip(z_tail) {
            *t += z * x;
        }
    }
}

/// `x` = Zᵀ `t`, with Z stored column by column.
#[inline(always)]
fn transposed_product<S: Simd>(simd: S, z: &[f64], t: &[f64], x: &mut [f64]) {
    let rows = t.len();
    let (t_simd, t_tail) = S::as_simd_f64s(t);
    let mut columns = z.chunks_exact(COLUMNS * rows);
    let mut results = x.chunks_exact_mut(COLUMNS);
    for (z, x) in columns.by_ref().zip(results.by_ref()) {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| S::as_simd_f64s(&z[k * rows..(k + 1) * rows]));
        let zero = simd.splat_f64s(0.0);
        let (mut sa, mut sb, mut sc, mut sd) = (zero, zero, zero, zero);
        for ((((t, a), b), c), d) in t_simd.iter().zip(a.0).zip(b.0).zip(c.0).zip(d.0) {
            sa = simd.mul_add_e_f64s(*a, *t, sa);
            sb = simd.mul_add_e_f64s(*b, *t, sb);
            sc = simd.mul_add_e_f64s(*c, *t, sc);
            sd = simd.mul_add_e_f64s(*d, *t, sd);
        }
        let tail = |z: &[f64]| -> f64 { z.iter().zip(t_tail).map(|(z, t)| z * t).sum() };
        x[0] = simd.reduce_sum_f64s(sa) + tail(a.1);
        x[1] = simd.reduce_sum_f64s(sb) + tail(b.1);
        x[2] = simd.reduce_sum_f64s(sc) + tail(c.1);
        x[3] = simd.reduce_sum_f64s(sd) + tail(d.1);
    }
    for (z, x) in columns.remainder().chunks_exact(rows).zip(results.into_remainder()) {
        let (z_simd, z_tail) = S::as_simd_f64s(z);
        let mut sum = simd.splat_f64s(0.0);
        for (t, z) in t_simd.iter().zip(z_simd) {
            sum = simd.mul_add_e_f64s(*z, *t, sum);
        }
        *x = simd.reduce_sum_f64s(sum) + z_tail.iter().zip(t_tail).map(|(z, t)| z * t).sum::<f64>();
    }
}
