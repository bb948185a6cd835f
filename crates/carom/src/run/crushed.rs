//! What a step that failed had to do with: cells that are compressed to a small part of their volume.

use std::fmt;

use carom_mesh::Matrix;

use crate::{Model, State};

/// √det C of the mean strain of a cell below which it is crushed. Saint-Venant–Kirchhoff bodies soften from 0.58 on in uniaxial compression.
const CRUSHED: f64 = 0.5;

/// The body whose cells are compressed the most, where any are crushed.
#[derive(Debug, Clone, PartialEq)]
pub struct Crushed {
    /// Its name.
    pub body: String,
    /// Cells of it that are compressed to less than half their volume, or area in plane stress.
    pub cells: usize,
    /// Volume of the worst of them, in parts of that of the reference configuration.
    pub least: f64,
}

impl Crushed {
    /// Looks for crushed cells in a state.
    pub(crate) fn find<const D: usize>(model: &Model<D>, state: &State<D>) -> Option<Self> {
        let crushed = model.bodies.iter().zip(&state.history).map(|(b, history)| {
            let cells = b
                .body
                .after(history)
                .grown(b.growth_at(state.time))
                .cell_states(&state.displacement[b.nodes()]);
            let volumes =
                cells.iter().map(|cell| (Matrix::<3>::identity() + cell.strain * 2.0).determinant().sqrt());
            let mut crushed = Self { body: b.name.clone(), cells: 0, least: f64::INFINITY };
            for volume in volumes.filter(|&volume| volume < CRUSHED) {
                crushed.cells += 1;
                crushed.least = crushed.least.min(volume);
            }
            crushed
        });
        crushed.filter(|crushed| crushed.cells > 0).min_by(|a, b| a.least.total_cmp(&b.least))
    }
}

impl fmt::Display for Crushed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { body, cells, least } = self;
        let plural = if *cells == 1 { "" } else { "s" };
        write!(
            f,
            "{cells} cell{plural} of body {body:?} crushed to less than half, the worst to {least:.2} of what it was"
        )
    }
}
