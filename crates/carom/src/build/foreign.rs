//! Bodies of other codes in a scenario.

use carom_fem::Body;
use carom_mesh::{Mesh, Vector};

use super::body::{contact_surface, unstressed};
use super::mesh::mesh;
use crate::body::fe::part::ModelBody;
use crate::body::foreign::ForeignBody;
use crate::body::foreign::law::ForeignLaw;
use crate::error::InputError;
use crate::scenario::{AnalysisKind, BodyEntry, Scenario};

/// Body number `index`, of which the mesh and the law are `given` by another code. Its cells are of no material: they are what is drawn of it.
pub(super) fn foreign_body<const D: usize>(
    scenario: &Scenario,
    index: usize,
    entry: &BodyEntry,
    given: (Option<Mesh<D>>, Option<ForeignLaw<D>>),
) -> Result<(Body<D>, ForeignLaw<D>), InputError> {
    let key = format!("bodies.{index}");
    let name = &entry.name;
    let refuse = |key: String, message: String| Err(InputError::new(key, message));
    let (cells, Some(law)) = given else {
        let message = format!(
            "body {name:?} is of another code, and no file holds its law; put its carom.ForeignBody among the bodies of a Scenario in Python"
        );
        return refuse(key, message);
    };
    if scenario.analysis.kind == AnalysisKind::Static {
        let message =
            format!("body {name:?} is of another code, which takes no load steps; make the analysis dynamic");
        return refuse("analysis.kind".into(), message);
    }
    if let Some(k) = scenario.masses.iter().position(|mass| &mass.body == name) {
        let message = format!("body {name:?} is of another code, which has all of its mass; add it there");
        return refuse(format!("masses.{k}.body"), message);
    }
    let mesh = mesh(&format!("{key}.mesh"), &entry.mesh, cells)?;
    let count = mesh.nodes().len();
    let answers = law.velocity.len() == count && (law.held.is_empty() || law.held.len() == count);
    if !answers || law.mass.iter().any(|&(a, b, _)| a.max(b) as usize >= count) {
        let message = format!("the mass of body {name:?} is not that of the {count} nodes of its cells");
        return refuse(format!("{key}.mass"), message);
    }
    let surface = contact_surface(&format!("{key}.contact_sets"), entry, &mesh)?;
    let made = |density: f64| {
        let spec = unstressed(entry, density, Vec::new());
        let made = Body::with_contact_surface(mesh.clone(), surface.clone(), &spec);
        made.map_err(|e| InputError::mesh(format!("{key}.mesh"), e.to_string()))
    };
    let total = law.total_mass();
    let is_heavy = total > 0.0;
    if !is_heavy || ForeignBody::new(mesh.nodes().to_vec(), &law, Vector::zeros()).is_err() {
        return refuse(format!("{key}.mass"), not_definite(name));
    }
    Ok((made(total / made(1.0)?.volume())?, law))
}

/// What is wrong with a mass that is not positive definite.
pub(crate) fn not_definite(name: &str) -> String {
    format!("the mass of body {name:?} is not positive definite; give every node a mass")
}

/// Refuses what is to hold, load or pull a body of another code from outside.
pub(super) fn refuse_foreign<const D: usize>(key: &str, body: &ModelBody<D>) -> Result<(), InputError> {
    if !body.is_foreign() {
        return Ok(());
    }
    let message = format!(
        "body {:?} is of another code: gravity and contacts are all that acts on it here; hold it by its fixed, and load it by its energy",
        body.name
    );
    Err(InputError::new(key, message))
}
