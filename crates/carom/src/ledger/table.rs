use crate::Books;

/// The books over time, a row per body and per pair that has touched.
///
/// A row is: time [s]; entry, the index of the body or, after the bodies, of the pair; and what happened since the start [J]:
/// kinetic, strain, external, viscous, plastic, scheme, contact, friction, normal_contact, prescribed, defect. What does not belong to an entry is NaN.
#[derive(Debug, Default)]
pub struct LedgerTable {
    pub(crate) rows: Vec<f64>,
}

impl LedgerTable {
    /// Numbers in a row.
    pub const WIDTH: usize = 13;

    /// Appends the rows of a moment [s].
    pub(crate) fn record(&mut self, time: f64, books: &Books) {
        let none = f64::NAN;
        for (i, b) in books.bodies.iter().enumerate() {
            self.rows.extend([time, i as f64, b.kinetic, b.strain, b.external]);
            self.rows.extend([b.viscous, b.plastic, b.scheme, b.contact]);
            self.rows.extend([none, none, b.prescribed, b.defect()]);
        }
        for (i, p) in books.pairs.iter().enumerate().filter(|(_, p)| p.has_touched) {
            self.rows.extend([time, (books.bodies.len() + i) as f64]);
            self.rows.extend([none; 7]);
            self.rows.extend([p.friction, p.normal_contact, p.prescribed, none]);
        }
    }

    /// Hands over the rows recorded so far, one after the other.
    pub(crate) fn take(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.rows)
    }
}
