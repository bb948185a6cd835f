use std::collections::BTreeSet;

use carom_fem::material::{LawSpec, Mat3, Viscosity};
use carom_fem::{Body, BodySpec, FemError, Formulation, MassKind, PointMass, RayleighDamping, Share};
use carom_mesh::sets::facet_key;
use carom_mesh::{Mesh, Surface};

use super::inputs::Engine;
use super::masses::masses;
use super::mesh::mesh;
use super::regions::{material, regions};
use super::spare_mass::spares_mass;
use super::values::number;
use crate::error::InputError;
use crate::scenario::{AnalysisKind, BodyEntry, BodyMass, InitialStress, Scenario};

/// Body number `index`; `given` is its mesh if that comes from a file.
pub(super) fn body<const D: usize>(
    scenario: &Scenario,
    index: usize,
    entry: &BodyEntry,
    given: Option<Mesh<D>>,
    engine: Option<&dyn Engine>,
) -> Result<Body<D>, InputError> {
    let key = format!("bodies.{index}");
    let material =
        material(scenario, &format!("{key}.material"), entry.material.as_deref().unwrap_or_default())?;
    let mesh = mesh(&format!("{key}.mesh"), &entry.mesh, given)?;
    let regions = regions(scenario, &key, entry, &mesh)?;
    let surface = contact_surface(&format!("{key}.contact_sets"), entry, &mesh)?;
    let mut laws = std::iter::once(&material.law).chain(regions.iter().map(|region| &region.law));
    let flows = laws.any(|law| matches!(law, LawSpec::J2Plasticity(_)));
    // What metal remembers, and sides that are tied, are not shared: all processes have the whole body.
    let share = match engine {
        Some(engine) if !flows && mesh.ties().is_empty() => share(engine, &key, entry, &mesh)?,
        _ => None,
    };
    let massless_contact = !flows && spares_mass(scenario, entry, &mesh, &surface);
    let mut spec = BodySpec {
        law: material.law.clone(),
        density: material.density,
        damping: material.damping,
        viscosity: material.viscosity,
        regions,
        mass: mass_kind(&key, entry)?,
        hypothesis: entry.hypothesis,
        formulation: entry.formulation,
        thickness: entry.thickness,
        initial_stress: initial_stress::<D>(&format!("{key}.initial_stress"), entry.initial_stress)?,
        grows: entry.growth.is_some(),
        points: masses(scenario, entry, &mesh)?,
        massless_contact,
        share,
    };
    let names = entry.material.iter().chain(entry.regions.iter().map(|region| &region.material));
    for (of, name) in spec.by_material().iter().zip(names) {
        of.check::<D>().map_err(|e| refused(&key, name, &e))?;
    }
    let name = entry.material.as_deref().unwrap_or_default();
    if spec.massless_contact {
        match Body::with_contact_surface(mesh.clone(), surface.clone(), &spec) {
            // One cell across it has none to spare.
            Err(FemError::NoMassInside { .. }) => spec.massless_contact = false,
            Ok(made) if scenario.analysis.kind == AnalysisKind::Static => return Ok(made.without_inertia()),
            made => return made.map_err(|e| refused(&key, name, &e)),
        }
    }
    Body::with_contact_surface(mesh, surface, &spec).map_err(|e| refused(&key, name, &e))
}

/// This process's share of the body under `key`, if it is shared.
fn share<const D: usize>(
    engine: &dyn Engine,
    key: &str,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
) -> Result<Option<Share>, InputError> {
    let blocks: Vec<(usize, &[u32])> =
        mesh.blocks().iter().map(|b| (b.kind.node_count(), &b.connectivity[..])).collect();
    engine.share(&entry.name, D, bytemuck::cast_slice(mesh.nodes()), &blocks).map_err(|why| {
        let message =
            format!("body {:?} cannot be shared among processes: {why}; run without --engine", entry.name);
        InputError::new(key.to_string(), message)
    })
}

/// What is wrong with the body under `key`, or with its `material`.
fn refused(key: &str, material: &str, e: &FemError) -> InputError {
    match e {
        FemError::MaterialConstant { name: "thickness", .. } => {
            InputError::new(format!("{key}.thickness"), e.to_string())
        }
        FemError::MaterialConstant { name, .. } => {
            InputError::new(format!("materials.{material}.{name}"), e.to_string())
        }
        FemError::Mixed { .. } => InputError::new(format!("{key}.regions"), e.to_string()),
        FemError::Hypothesis { .. } | FemError::PlaneStress { .. } => {
            InputError::new(format!("{key}.hypothesis"), e.to_string())
        }
        FemError::InitialStress { .. } => InputError::new(format!("{key}.initial_stress"), e.to_string()),
        FemError::Formulation { .. } => InputError::new(format!("{key}.formulation"), e.to_string()),
        _ => InputError::mesh(format!("{key}.mesh"), e.to_string()),
    }
}

/// How the mass of a deformable body is shared.
fn mass_kind(key: &str, entry: &BodyEntry) -> Result<MassKind, InputError> {
    match entry.mass {
        None => Ok(MassKind::default()),
        Some(BodyMass::Shared(kind)) => Ok(kind),
        Some(BodyMass::Given(mass)) => {
            let message =
                format!("{mass}: a mass is given of a rigid body; choose \"consistent\" or \"lumped\"");
            Err(InputError::new(format!("{key}.mass"), message))
        }
    }
}

/// The stress [Pa] under `key` in the case file; zero if there is none.
fn initial_stress<const D: usize>(key: &str, given: Option<InitialStress>) -> Result<Mat3, InputError> {
    let Some(InitialStress { xx, yy, zz, xy, yz, xz }) = given else { return Ok(Mat3::zeros()) };
    let across = [("yz", yz), ("xz", xz)];
    for (name, value) in across {
        let remedy = "a body of the plane has no shear across it; give 0";
        number(&format!("{key}.{name}"), value, D == 3 || value == 0.0, remedy)?;
    }
    Ok(Mat3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
}

/// What a body is made of whose cells carry mass and no stress: a rigid one, or that of another code.
pub(super) fn unstressed(entry: &BodyEntry, density: f64, points: Vec<PointMass>) -> BodySpec {
    BodySpec {
        law: LawSpec::Unstressed,
        density,
        damping: RayleighDamping::default(),
        viscosity: Viscosity::default(),
        regions: Vec::new(),
        mass: MassKind::Consistent,
        hypothesis: entry.hypothesis,
        formulation: Formulation::default(),
        thickness: entry.thickness,
        initial_stress: Mat3::zeros(),
        grows: false,
        points,
        massless_contact: false,
        share: None,
    }
}

/// The boundary of a body, or the sets of it that may touch others.
pub(super) fn contact_surface<const D: usize>(
    key: &str,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
) -> Result<Surface, InputError> {
    let whole = Surface::of(mesh);
    let Some(names) = &entry.contact_sets else { return Ok(whole) };
    if names.is_empty() {
        return Err(InputError::new(key, "name one set at least, or disable the pairs of the body"));
    }
    let mut chosen = BTreeSet::new();
    for name in names {
        let part = mesh.surface_of(name, &whole).ok_or_else(|| {
            let known = mesh.sets().facet_names();
            InputError::new(key, format!("{name:?}: the mesh has no such set of facets; known are {known:?}"))
        })?;
        chosen.extend(part.facets().iter().map(|f| facet_key(&f.nodes)));
    }
    let part = whole.part(|f| chosen.contains(&facet_key(&f.nodes)));
    if part.facets().is_empty() {
        return Err(InputError::new(key, format!("{names:?}: no facet of these sets is on the boundary")));
    }
    Ok(part)
}
