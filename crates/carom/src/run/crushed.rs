//! What a step that failed, or bodies inside one another, had to do with: cells that are compressed to a small part of their volume.

use std::fmt;

use carom_mesh::Matrix;
use serde::Serialize;

use crate::{Model, State};

/// √det C of the mean strain of a cell below which it is crushed. Saint-Venant–Kirchhoff bodies soften from 0.58 on in uniaxial compression.
const CRUSHED: f64 = 0.5;

/// The body whose cells are compressed the most, where any are crushed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Crushed {
    /// Its name.
    pub body: String,
    /// Cells of it that are compressed to less than half their volume, or area in plane stress.
    pub cells: usize,
    /// Volume of the worst of them, in parts of that of the reference configuration.
    pub least: f64,
}

/// The same, by the number of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct CrushedCells {
    pub body: usize,
    pub cells: usize,
    pub least: f64,
}

impl CrushedCells {
    /// Looks for crushed cells, in a state, of the bodies that `count`.
    pub fn find<const D: usize>(
        model: &Model<D>,
        state: &State<D>,
        counts: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let bodies = model.bodies.iter().zip(&state.history).enumerate().filter(|(body, _)| counts(*body));
        let crushed = bodies.map(|(body, (b, history))| {
            let cells = b
                .body
                .after(history)
                .grown(b.growth_at(state.time))
                .cell_states(&state.displacement[b.nodes()]);
            let volumes =
                cells.iter().map(|cell| (Matrix::<3>::identity() + cell.strain * 2.0).determinant().sqrt());
            let mut crushed = Self { body, cells: 0, least: f64::INFINITY };
            for volume in volumes.filter(|&volume| volume < CRUSHED) {
                crushed.cells += 1;
                crushed.least = crushed.least.min(volume);
            }
            crushed
        });
        crushed.filter(|crushed| crushed.cells > 0).min_by(|a, b| a.least.total_cmp(&b.least))
    }

    /// The same with the name of the body.
    pub fn of<const D: usize>(self, model: &Model<D>) -> Crushed {
        let Self { body, cells, least } = self;
        Crushed { body: model.bodies[body].name.clone(), cells, least }
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
