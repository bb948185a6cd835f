use serde::Serialize;

use crate::{Model, State};

/// What would run: the answer of `carom check`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Description {
    /// Title of the case.
    pub title: String,
    /// Unknown displacements.
    pub dofs: usize,
    /// Nominal steps.
    pub steps: u64,
    /// Initial energy [J].
    pub energy: f64,
    /// Time that a pressure wave needs through the smallest edge of all bodies [s]; none where all are rigid.
    pub suggested_time_step: Option<f64>,
    /// The bodies.
    pub bodies: Vec<BodyDescription>,
    /// The pairs that may touch.
    pub pairs: Vec<PairDescription>,
}

/// A body as it would run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyDescription {
    /// Name.
    pub name: String,
    /// Whether it is rigid.
    pub is_rigid: bool,
    /// Nodes.
    pub nodes: usize,
    /// Cells.
    pub cells: usize,
    /// Unknown displacements.
    pub dofs: usize,
    /// Mass [kg].
    pub mass: f64,
    /// Volume [m³].
    pub volume: f64,
    /// Speed of pressure waves [m/s]; none of a rigid body.
    pub wave_speed: Option<f64>,
    /// Length of the diagonal of the bounding box [m].
    pub diameter: f64,
    /// Shortest edge [m].
    pub smallest_edge: f64,
    /// Time of a pressure wave through it [s]; none of a rigid body.
    pub suggested_time_step: Option<f64>,
}

/// A pair before anything has moved.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairDescription {
    /// The two names.
    pub between: [String; 2],
    /// Friction coefficient.
    pub friction: f64,
    /// Smallest distance [m].
    pub initial_gap: f64,
    /// Where it is [m].
    pub at: Vec<f64>,
}

/// Describes a model and its initial state.
pub(crate) fn describe<const D: usize>(
    title: &str,
    model: &Model<D>,
    state: &State<D>,
    steps: u64,
) -> Description {
    let bodies: Vec<BodyDescription> = model
        .bodies
        .iter()
        .map(|b| {
            let (wave_speed, smallest_edge) = (b.wave_speed(), b.body.mesh().smallest_edge());
            BodyDescription {
                name: b.name.clone(),
                nodes: b.body.node_count(),
                cells: b.body.mesh().cell_count(),
                is_rigid: b.is_rigid(),
                dofs: b.dofs(),
                mass: b.body.total_mass(),
                volume: b.body.volume(),
                wave_speed,
                diameter: b.body.mesh().diameter(),
                smallest_edge,
                suggested_time_step: wave_speed.map(|speed| smallest_edge / speed),
            }
        })
        .collect();
    let at = |n: u32| model.assembly.reference[n as usize] + state.displacement[n as usize];
    let mut pairs: Vec<PairDescription> = Vec::new();
    for (k, pair) in model.assembly.named_pairs.iter().enumerate().filter(|(_, pair)| !pair.is_of_one_body())
    {
        let closest = model
            .assembly
            .contact
            .pairs
            .iter()
            .filter(|p| p.named_pair == k)
            .filter_map(|p| model.assembly.contact.proximity(p, &at))
            .min_by(|a, b| a.gap.total_cmp(&b.gap));
        if let Some(closest) = closest {
            pairs.push(PairDescription {
                between: pair.between.clone(),
                friction: pair.friction,
                initial_gap: closest.gap,
                at: closest.at.iter().copied().collect(),
            });
        }
    }
    Description {
        title: title.to_string(),
        dofs: model.dofs(),
        steps,
        energy: state.energies.total(),
        suggested_time_step: bodies.iter().filter_map(|b| b.suggested_time_step).reduce(f64::min),
        bodies,
        pairs,
    }
}
