//! Substitution for many right-hand sides side by side: what is loaded of a factor serves all of them.

use std::ops::Range;

use faer::{MatMut, MatRef};

use super::real::Real;
use super::row::{ABREAST, Row};
use super::substitution::{Panel, Substitution};

impl<T: Real> Substitution<T> {
    /// The part of Z of the last panel that belongs to these last columns.
    pub fn end_of_last_panel(&self, columns: Range<usize>) -> MatRef<'_, T> {
        let z = panel(&self.panels[self.panels.len() - 1], &self.values);
        let (first, count) = (z.ncols() - columns.len(), columns.len());
        z.submatrix(first, first, count, count)
    }

    /// [`Self::forward`] where the right-hand sides are zero outside of a [`Self::reach`], and stay so.
    pub fn forward_abreast(&mut self, reach: &[u32], x: &mut [Row<T>]) {
        self.gathered_abreast.resize(self.gathered.len(), [T::default(); ABREAST]);
        let Self { panels, rows, values, gathered_abreast, .. } = self;
        let mut largest = [0.0_f64; ABREAST];
        for &p in reach {
            let p = &panels[p as usize];
            let (own, t) = (p.start..p.start + p.columns, &mut gathered_abreast[..p.columns + p.below]);
            T::multiply(matrix_mut(t), panel(p, values), matrix(&x[own.clone()]));
            clear_negligible(t, &mut largest);
            x[own].copy_from_slice(&t[..p.columns]);
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&t[p.columns..]) {
                x[row as usize].iter_mut().zip(t).for_each(|(x, t)| *x -= *t);
            }
        }
    }

    /// [`Self::backward`], only for the columns of a [`Self::reach`].
    pub fn backward_abreast(&mut self, reach: &[u32], x: &mut [Row<T>]) {
        self.gathered_abreast.resize(self.gathered.len(), [T::default(); ABREAST]);
        let Self { panels, rows, values, gathered_abreast, .. } = self;
        for &p in reach.iter().rev() {
            let p = &panels[p as usize];
            let (own, t) = (p.start..p.start + p.columns, &mut gathered_abreast[..p.columns + p.below]);
            t[..p.columns].copy_from_slice(&x[own.clone()]);
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&mut t[p.columns..]) {
                *t = x[row as usize].map(|x| -x);
            }
            T::multiply(matrix_mut(&mut x[own]), panel(p, values).transpose(), matrix(t));
        }
    }
}

/// Clears what is negligible next to the `largest` number of the same right-hand side so far.
fn clear_negligible<T: Real>(rows: &mut [Row<T>], largest: &mut [f64; ABREAST]) {
    for row in rows {
        for (x, largest) in row.iter_mut().zip(&mut *largest) {
            let size = x.to_f64().abs();
            *largest = largest.max(size);
            if size < T::NEGLIGIBLE * *largest {
                *x = T::default();
            }
        }
    }
}

/// Z of a panel.
fn panel<'v, T: Real>(p: &Panel, values: &'v [T]) -> MatRef<'v, T> {
    let z = &values[p.first_value..p.first_value + p.padded * p.columns];
    MatRef::from_column_major_slice_with_stride(z, p.columns + p.below, p.columns, p.padded)
}

fn matrix<T: Real>(rows: &[Row<T>]) -> MatRef<'_, T> {
    MatRef::from_row_major_slice(rows.as_flattened(), rows.len(), ABREAST)
}

fn matrix_mut<T: Real>(rows: &mut [Row<T>]) -> MatMut<'_, T> {
    let count = rows.len();
    MatMut::from_row_major_slice_mut(rows.as_flattened_mut(), count, ABREAST)
}
