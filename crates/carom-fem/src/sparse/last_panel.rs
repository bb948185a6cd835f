//! The inverse between columns of the last panel of a factor, which no others have part in.

use std::ops::Range;

use faer::{MatMut, MatRef};

use super::real::Real;

/// (L⁻ᵀL⁻¹)₁₁ of the last columns, all at once: one large product instead of many substitutions.
#[derive(Debug, Default)]
pub(super) struct LastPanel<T> {
    /// Column by column; empty until it is asked for.
    inverse: Vec<T>,
    columns: Range<usize>,
    /// The columns that responses are asked for.
    asked: Vec<usize>,
}

impl<T: Real> LastPanel<T> {
    /// Memory [bytes].
    pub fn bytes(&self) -> usize {
        size_of_val(&self.inverse[..])
    }

    /// Forgets a factor.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Asks for no columns.
    pub fn ask_for_none(&mut self) {
        self.asked.clear();
    }

    /// Asks for some of the last `columns`, of which `z` has the inverse.
    pub fn ask<'z>(
        &mut self,
        asked: impl Iterator<Item = usize>,
        columns: Range<usize>,
        z: impl FnOnce(Range<usize>) -> MatRef<'z, T>,
    ) where
        T: 'z,
    {
        self.asked.clear();
        self.asked.extend(asked);
        if self.columns != columns {
            let (count, z) = (columns.len(), z(columns.clone()));
            self.columns = columns;
            self.inverse = vec![T::default(); count * count];
            let inverse = MatMut::from_column_major_slice_mut(&mut self.inverse, count, count);
            T::multiply(inverse, z.transpose(), z);
        }
    }

    /// The answer in a column to the one that was asked for as the `number`-th, if any was.
    pub fn answer(&self, number: usize, column: impl Fn() -> usize) -> Option<T> {
        let (first, count) = (self.columns.start, self.columns.len());
        self.asked.get(number).map(|&asked| self.inverse[(asked - first) * count + column() - first])
    }
}
