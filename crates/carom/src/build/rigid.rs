//! Rigid bodies of a scenario.

use carom_fem::{Body, FemError};
use carom_mesh::{Matrix, Mesh};

use super::body::{contact_surface, unstressed};
use super::masses::masses;
use super::mesh::mesh;
use super::roundness::Roundness;
use super::values::number;
use crate::body::rigid::shape::RigidSpec;
use crate::error::InputError;
use crate::scenario::{BodyEntry, BodyMass, Inertia, Scenario};

/// Inertia may be short of what moments of real masses obey by so much of itself: that of a rod about its axis is none.
const ROUND_OFF: f64 = 1e-12;

/// Rigid body number `index`, whose cells make its mass, and what of that is not theirs; `given` is its mesh if that comes from a file.
pub(super) fn rigid_body<const D: usize>(
    scenario: &Scenario,
    index: usize,
    entry: &BodyEntry,
    given: Option<Mesh<D>>,
) -> Result<(Body<D>, RigidSpec<D>), InputError> {
    let key = format!("bodies.{index}");
    if !entry.regions.is_empty() {
        let message = format!("body {:?} is rigid and of no material; leave its regions out", entry.name);
        return Err(InputError::new(format!("{key}.regions"), message));
    }
    let mesh = mesh(&format!("{key}.mesh"), &entry.mesh, given)?;
    if !mesh.ties().is_empty() {
        let message = format!("body {:?} is rigid and cannot be periodic; leave periodic out", entry.name);
        return Err(InputError::mesh(format!("{key}.mesh.periodic"), message));
    }
    let surface = contact_surface(&format!("{key}.contact_sets"), entry, &mesh)?;
    let points = masses(scenario, entry, &mesh)?;
    let round = Roundness::<D>::of(&key, entry)?;
    let made = |density: f64| {
        let spec = unstressed(entry, density, points.clone());
        Body::with_contact_surface(mesh.clone(), surface.clone(), &spec).map_err(|e| match e {
            FemError::MaterialConstant { name, .. } => {
                InputError::new(format!("{key}.{name}"), e.to_string())
            }
            FemError::Hypothesis { .. } => InputError::new(format!("{key}.hypothesis"), e.to_string()),
            _ => InputError::mesh(format!("{key}.mesh"), e.to_string()),
        })
    };
    let body = match (entry.density, entry.mass) {
        (Some(_), Some(_)) => {
            let message = "a rigid body has a density or a mass, not both; leave one out";
            return Err(InputError::new(format!("{key}.mass"), message));
        }
        (Some(density), None) => {
            let body = made(density)?;
            match &round {
                Some(round) => made(density * (round.volume / body.volume()))?,
                None => body,
            }
        }
        (None, Some(BodyMass::Given(mass))) => {
            number(&format!("{key}.mass"), mass, mass > 0.0, "the mass must be greater than 0 kg")?;
            made(mass / made(1.0)?.volume())?
        }
        (None, _) => {
            let message = format!("body {:?} is rigid and has no density; give it, or its mass", entry.name);
            return Err(InputError::new(format!("{key}.density"), message));
        }
    };
    let inertia = match (entry.inertia, &round) {
        (Some(given), _) => Some(inertia::<D>(&format!("{key}.inertia"), given)?),
        (None, Some(round)) => Some(round.inertia(body.total_mass())),
        (None, None) => None,
    };
    Ok((body, RigidSpec { centre: round.map(|round| round.centre_of_mass), inertia }))
}

/// The inertia tensor that is given.
fn inertia<const D: usize>(key: &str, given: Inertia) -> Result<Matrix<3>, InputError> {
    let tensor = match (given, D) {
        (Inertia::InPlane(j), 2) => {
            number(key, j, j > 0.0, "the inertia must be greater than 0 kg m²")?;
            return Ok(Matrix::<3>::from_diagonal_element(j));
        }
        (Inertia::Principal(j), 3) => Matrix::<3>::from_diagonal(&j.into()),
        (Inertia::Tensor(rows), 3) => Matrix::<3>::from_fn(|i, j| rows[i][j]),
        _ => {
            let form = ["a number", "three numbers, or three rows of three"][D - 2];
            return Err(InputError::new(key, format!("an inertia in {D}D is {form}")));
        }
    };
    if tensor != tensor.transpose() {
        return Err(InputError::new(key, "the inertia must be symmetric; Jxy is the same as Jyx"));
    }
    let moments = tensor.symmetric_eigenvalues();
    let most = moments.max();
    // tr J = 2 Σ m r², and about each axis there is less than all of it.
    if !(moments.min() > 0.0 && 2.0 * most <= moments.sum() * (1.0 + ROUND_OFF)) {
        let values: Vec<String> = moments.iter().map(|j| format!("{j:.4e}")).collect();
        let message = format!(
            "principal moments {}: no mass has them; each is greater than 0 and none greater than the sum of the others",
            values.join(", ")
        );
        return Err(InputError::new(key, message));
    }
    Ok(tensor)
}
