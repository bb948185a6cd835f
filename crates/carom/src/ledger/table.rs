use carom_contact::Pairs;

use super::{Books, TERMS};

/// The books over time, a row per body and per pair that has touched.
///
/// A row is time [s], entry, what happened since the start [J] by `TERMS`, and the defect [J]. The entry is the index of the body or, after
/// the bodies, the place of the two solids among all that may touch. What does not belong to an entry is NaN.
#[derive(Debug, Default)]
pub struct LedgerTable {
    pub(crate) rows: Vec<f64>,
}

impl LedgerTable {
    /// Numbers in a row.
    pub const WIDTH: usize = TERMS.len() + 3;

    /// Appends the rows of a moment [s]; the books are of solids that touch as `pairs` say.
    pub(crate) fn record(&mut self, time: f64, books: &Books, pairs: &Pairs) {
        let bodies = books.bodies.iter().map(|b| (b.columns(), b.defect()));
        for (i, (terms, defect)) in bodies.enumerate() {
            self.row(time, i, terms, defect);
        }
        for (between, p) in books.pairs.iter().filter(|(_, p)| p.has_touched) {
            self.row(time, books.bodies.len() + pairs.place(between), p.columns(), f64::NAN);
        }
    }

    fn row(&mut self, time: f64, entry: usize, terms: [f64; TERMS.len()], defect: f64) {
        self.rows.extend([time, entry as f64]);
        self.rows.extend(terms);
        self.rows.push(defect);
    }

    /// Hands over the rows recorded so far, one after the other.
    pub(crate) fn take(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.rows)
    }
}
