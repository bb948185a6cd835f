//! Reduced bodies of a scenario.

use carom_fem::material::{LawSpec, Viscosity};
use carom_fem::{Body, FemError, Hypothesis};
use carom_mesh::{Mesh, Vector};

use super::body::body;
use crate::body::reduced::part::ReducedPart;
use crate::error::InputError;
use crate::scenario::{AnalysisKind, BodyEntry, Scenario};

/// The most displacements of its surface that a reduced body keeps: with more its matrices, which are full, are larger than sparse ones of the mesh.
const MOST: usize = 3000;

/// Reduced body number `index`; `given` is its mesh if that comes from a file.
pub(super) fn reduced_body<const D: usize>(
    scenario: &Scenario,
    index: usize,
    entry: &BodyEntry,
    given: Option<Mesh<D>>,
) -> Result<(Body<D>, ReducedPart<D>), InputError> {
    let (key, name) = (format!("bodies.{index}"), &entry.name);
    let refused = |at: String, message: String| Err(InputError::new(at, message));
    if scenario.analysis.kind == AnalysisKind::Static {
        let message = format!("body {name:?} is reduced and moves in time alone; choose \"dynamic\"");
        return refused("analysis.kind".to_string(), message);
    }
    let Some(modes) = entry.modes else {
        let message =
            format!("body {name:?} is reduced; say how many modes it has beside those of its surface");
        return refused(format!("{key}.modes"), message);
    };
    if entry.hypothesis == Hypothesis::Axisymmetric {
        let message =
            format!("body {name:?} is reduced and cannot be one of revolution; choose \"plane-strain\"");
        return refused(format!("{key}.hypothesis"), message);
    }
    if entry.growth.is_some() {
        return refused(
            format!("{key}.growth"),
            format!("body {name:?} is reduced and cannot grow; leave it out"),
        );
    }
    if entry.initial_stress.is_some() {
        let message = format!("body {name:?} is reduced and starts without stress; leave it out");
        return refused(format!("{key}.initial_stress"), message);
    }
    let regions = (0..)
        .zip(&entry.regions)
        .map(|(i, region)| (format!("{key}.regions.{i}.material"), &region.material));
    let mut stiffness_damping = None;
    for (at_name, material) in entry.material.iter().map(|of| (format!("{key}.material"), of)).chain(regions)
    {
        let Some(of) = scenario.materials.get(material) else { continue };
        let at = |what: &str| format!("materials.{material}.{what}");
        if matches!(of.law, LawSpec::J2Plasticity(_)) {
            let message = format!("body {name:?} is reduced and cannot flow; choose an elastic law");
            return refused(at_name, message);
        }
        if *stiffness_damping.get_or_insert(of.damping.stiffness) != of.damping.stiffness {
            let message = format!(
                "{}: body {name:?} is reduced and damped mode by mode, by one number; give all of its materials the same",
                of.damping.stiffness
            );
            return refused(at("damping.stiffness"), message);
        }
        if of.viscosity != Viscosity::default() {
            let message = format!("body {name:?} is reduced; damp it by damping.stiffness instead");
            return refused(at("viscosity"), message);
        }
        if of.damping.mass != 0.0 {
            let message = format!(
                "body {name:?} is reduced, and damping of mass would brake its flight; damp it by damping.stiffness"
            );
            return refused(at("damping.mass"), message);
        }
    }
    let body = body(scenario, index, entry, given, None)?;
    if !body.mesh().ties().is_empty() {
        let message = format!("body {name:?} is reduced and cannot be periodic; leave periodic out");
        return Err(InputError::mesh(format!("{key}.mesh.periodic"), message));
    }
    let (nodes, inside) = (body.surface().nodes().len(), body.node_count() - body.surface().nodes().len());
    if D * nodes > MOST {
        let message = format!(
            "body {name:?} keeps {} displacements of its contact surface, more than {MOST}; name the sets of facets that may touch",
            D * nodes
        );
        return refused(format!("{key}.contact_sets"), message);
    }
    if modes > D * inside {
        let message =
            format!("{modes}: body {name:?} has {} displacements inside, and no more modes", D * inside);
        return refused(format!("{key}.modes"), message);
    }
    // A surface holds what hangs together, so that nothing else can be wrong.
    let part = ReducedPart::new(&body, modes, &tracked(scenario, name, &body))
        .map_err(|_| InputError::mesh(format!("{key}.mesh"), FemError::InPieces.to_string()))?;
    Ok((body, part))
}

/// The nodes nearest to the points of a body that are tracked.
fn tracked<const D: usize>(scenario: &Scenario, name: &str, body: &Body<D>) -> Vec<u32> {
    let own = scenario.output.track.iter().filter(|track| track.body == name && track.point.len() == D);
    own.filter_map(|track| {
        let point = Vector::from_column_slice(&track.point);
        let distances = (0..).zip(body.mesh().nodes()).map(|(n, x)| (n, (x - point).norm()));
        distances.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(n, _)| n)
    })
    .collect()
}
