use carom_contact::{Pair, Proximity, Target};
use carom_fem::{Body, OfMaterial, Reduction};
use serde::Serialize;

use crate::body::fe::part::ModelBody;
use crate::ledger::ByPair;
use crate::model::assembly::{Assembly, NamedPair};
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
    /// The pairs that may touch; of more than a thousand those that are near one another.
    pub pairs: Vec<PairDescription>,
}

/// A body as it would run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodyDescription {
    /// Name.
    pub name: String,
    /// Whether it is rigid.
    pub is_rigid: bool,
    /// Whether its nodes that may touch have no mass.
    pub is_massless: bool,
    /// What these had of its mass, which is inside now [kg].
    pub moved_mass: f64,
    /// The vibrations of a reduced body.
    pub vibrations: Option<Vibrations>,
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
    /// Speed of pressure waves [m/s], where it is lowest; none of a rigid body.
    pub wave_speed: Option<f64>,
    /// What it has of each of its materials; none of a rigid body.
    pub materials: Vec<MaterialDescription>,
    /// Length of the diagonal of the bounding box [m].
    pub diameter: f64,
    /// Shortest edge [m].
    pub smallest_edge: f64,
    /// Time of a pressure wave through the shortest edge of a material, the least [s]; none of a rigid body.
    pub suggested_time_step: Option<f64>,
}

/// What a body has of a material: of that of the rest, then of those of its regions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaterialDescription {
    /// Cells.
    pub cells: usize,
    /// Volume [m³].
    pub volume: f64,
    /// Mass [kg].
    pub mass: f64,
    /// Speed of pressure waves [m/s].
    pub wave_speed: f64,
}

/// In how many shapes a reduced body vibrates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Vibrations {
    /// Their number.
    pub count: usize,
    /// The lowest of their frequencies [rad/s].
    pub lowest: f64,
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
                is_massless: !b.body.massless().is_empty(),
                moved_mass: b.body.massless_mass().iter().sum(),
                vibrations: b.reduced.as_ref().map(|reduced| vibrations(&reduced.reduction)),
                dofs: b.dofs(),
                mass: b.body.total_mass(),
                volume: b.body.volume(),
                wave_speed,
                materials: materials(b),
                diameter: b.body.mesh().diameter(),
                smallest_edge,
                suggested_time_step: wave_speed.map(|_| shortest_wave(&b.body)),
            }
        })
        .collect();
    let pairs = describe_pairs(model, state);
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

fn materials<const D: usize>(body: &ModelBody<D>) -> Vec<MaterialDescription> {
    let of = |of: &OfMaterial| MaterialDescription {
        cells: of.cells,
        volume: of.volume,
        mass: of.mass,
        wave_speed: of.wave_speed,
    };
    if body.is_rigid() || body.is_foreign() {
        Vec::new()
    } else {
        body.body.materials().iter().map(of).collect()
    }
}

/// Time that a pressure wave needs through the smallest edge of a body [s], material by material.
fn shortest_wave<const D: usize>(body: &Body<D>) -> f64 {
    body.materials().iter().map(|of| of.smallest_edge / of.wave_speed).fold(f64::INFINITY, f64::min)
}

fn vibrations<const D: usize>(reduction: &Reduction<D>) -> Vibrations {
    let lowest = reduction.stiffness().first().map_or(0.0, |stiffness| stiffness.sqrt());
    Vibrations { count: reduction.count(), lowest }
}

/// The pairs that may touch, in their order: of many those that are no farther apart than the smaller of the two is large.
fn describe_pairs<const D: usize>(model: &Model<D>, state: &State<D>) -> Vec<PairDescription> {
    let Model { assembly, .. } = model;
    let at = |n: u32| assembly.reference[n as usize] + state.displacement[n as usize];
    let Assembly { contact, .. } = assembly;
    let mut closest: ByPair<Option<Proximity<D>>> = ByPair::default();
    let extents = contact.extents(&at);
    let mut pairs = Vec::new();
    contact.within(assembly.size, &extents, &mut pairs);
    let is_of_two = |pair: &Pair| pair.target != Target::Surface(pair.source);
    for pair in pairs.into_iter().map(|p| contact.pairs.get(p)).filter(is_of_two) {
        let is_far = |gap: f64| contact.pairs.are_many() && gap > assembly.pair_size(&pair);
        if is_far(contact.at_least(&pair, &extents, &at)) {
            continue;
        }
        let near = contact.proximity(&pair, &at);
        if let Some(near) = near.filter(|near| !is_far(near.gap)) {
            let known = closest.or_default(pair.between());
            *known = Some(known.filter(|known| known.gap <= near.gap).unwrap_or(near));
        }
    }
    let known = closest.iter().filter_map(|(between, closest)| Some((between, (*closest)?)));
    known
        .map(|(between, Proximity { gap, at })| {
            let NamedPair { between, friction } = assembly.named_pair(between);
            PairDescription { between, friction, initial_gap: gap, at: at.iter().copied().collect() }
        })
        .collect()
}
