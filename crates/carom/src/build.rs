//! From a scenario to a model, a method and the state at t = 0. Everything that can be wrong is found here.

use carom_contact::{ContactModel, ContactSurface, Obstacle, Pair, Target};
use carom_fem::{Body, BodySpec, FemError};
use carom_friction::{Criterion, StoppingRule};
use carom_mesh::{Facet, Mesh, MeshError, Surface, Vector, generate, tensor};

use crate::error::InputError;
use crate::model::{Group, Method, Model, ModelBody, NewtonRule};
use crate::scenario::{
    BodyEntry, MeshSpec, ObstacleShape, PairEntry, PlaneCell, Scenario, Side, Sources, Targets,
};
use crate::{Scheme, State};

/// Overlaps at the start deeper than this, relative to the smallest edge, are an error.
const TOUCHING: f64 = 1e-9;

/// The largest friction coefficient.
const MAX_FRICTION: f64 = 1e3;

/// Builds what a scenario in the plane describes.
///
/// # Errors
/// If a value is out of range, a mesh has an inverted cell, or bodies overlap or are outside their obstacles at the start.
pub fn build(scenario: &Scenario) -> Result<(Model<2>, Method<2>, State<2>), InputError> {
    let method = method(scenario)?;
    let mut bodies: Vec<ModelBody<2>> = Vec::new();
    for (i, entry) in scenario.bodies.iter().enumerate() {
        let first_node = bodies.last().map_or(0, |b| b.nodes().end);
        bodies.push(ModelBody { name: entry.name.clone(), body: body(scenario, i, entry)?, first_node });
    }
    if bodies.is_empty() {
        return Err(InputError::new("bodies", "there is no body; add one [[bodies]] table at least"));
    }
    let (contact, groups) = contact(scenario, &bodies)?;
    let gravity = match &scenario.analysis.gravity {
        Some(g) => vector("analysis.gravity", g)?,
        None => Vector::zeros(),
    };
    let velocities = scenario
        .obstacles
        .iter()
        .enumerate()
        .map(|(i, o)| vector(&format!("obstacles.{i}.velocity"), &o.velocity))
        .collect::<Result<_, _>>()?;
    let model = Model::new(bodies, contact, groups, gravity).with_obstacle_velocities(velocities);
    check_overlaps(scenario, &model)?;
    let velocity = initial_velocity(scenario, &model)?;
    let state = State::initial(&model, velocity);
    if !state.is_finite() {
        return Err(InputError::new(
            "bodies",
            "the initial energy is not finite; check velocities and material constants",
        ));
    }
    Ok((model, method, state))
}

/// Checks that a number is finite and satisfies `valid`.
fn number(key: &str, value: f64, valid: bool, remedy: &str) -> Result<(), InputError> {
    if valid && value.is_finite() { Ok(()) } else { Err(InputError::new(key, format!("{value}: {remedy}"))) }
}

fn vector<const D: usize>(key: &str, values: &[f64]) -> Result<Vector<D>, InputError> {
    if values.len() != D {
        return Err(InputError::new(key, format!("{values:?} must have {D} components")));
    }
    if !values.iter().all(|v| v.is_finite()) {
        return Err(InputError::new(key, format!("{values:?} must be finite numbers")));
    }
    Ok(Vector::from_column_slice(values))
}

fn method(scenario: &Scenario) -> Result<Method<2>, InputError> {
    let analysis = &scenario.analysis;
    let (dt, end) = (analysis.time_step, analysis.end_time);
    number("analysis.time_step", dt, dt > 0.0, "the time step must be greater than 0 s")?;
    number("analysis.end_time", end, end >= dt, "the end time must be at least one time step")?;
    match analysis.scheme {
        Scheme::Theta { theta, xi } => {
            let key = "analysis.scheme.theta";
            number(key, theta, theta > 0.0 && theta <= 1.0, "theta must be greater than 0 and at most 1")?;
            number("analysis.scheme.xi", xi, (0.0..=1.0).contains(&xi), "xi must be between 0 and 1")?;
        }
        Scheme::Conserving => {}
    }
    let newton = analysis.newton;
    let key = "analysis.newton.tolerance";
    number(key, newton.tolerance, newton.tolerance > 0.0, "the tolerance must be greater than 0")?;
    let solver = scenario.contact.solver;
    let key = "contact.solver.tolerance";
    number(key, solver.tolerance, solver.tolerance > 0.0, "the tolerance must be greater than 0")?;
    let (key, tolerance) = ("contact.certificate_tolerance", scenario.contact.certificate_tolerance);
    number(key, tolerance, tolerance > 0.0, "the tolerance must be greater than 0")?;
    for (key, count) in [
        ("analysis.newton.max_iterations", newton.max_iterations),
        ("contact.solver.max_iterations", solver.max_iterations),
    ] {
        number(key, count as f64, count > 0, "at least 1 iteration is needed")?;
    }
    let key = "analysis.max_halvings";
    number(
        key,
        f64::from(analysis.max_halvings),
        analysis.max_halvings <= 30,
        "at most 30 halvings make sense",
    )?;
    Ok(Method {
        scheme: analysis.scheme,
        condition: scenario.contact.condition,
        solver: solver.kind.solver(),
        stopping: StoppingRule {
            tolerance: solver.tolerance,
            criterion: Criterion::Natural,
            max_iterations: solver.max_iterations,
            time_limit: None,
        },
        cross_check: solver.cross_check,
        newton: NewtonRule { tolerance: newton.tolerance, max_iterations: newton.max_iterations },
        max_halvings: analysis.max_halvings,
        certificate_tolerance: scenario.contact.certificate_tolerance,
    })
}

fn body(scenario: &Scenario, index: usize, entry: &BodyEntry) -> Result<Body<2>, InputError> {
    let key = format!("bodies.{index}");
    let material = scenario.materials.get(&entry.material).ok_or_else(|| {
        let known: Vec<&str> = scenario.materials.keys().map(String::as_str).collect();
        let message = format!("there is no material {:?}; known are {known:?}", entry.material);
        InputError::new(format!("{key}.material"), message)
    })?;
    let mesh = mesh(&entry.mesh).map_err(|e| match e {
        MeshError::Generator { parameter, .. } => {
            InputError::mesh(format!("{key}.mesh.{parameter}"), e.to_string())
        }
        _ => InputError::mesh(format!("{key}.mesh"), e.to_string()),
    })?;
    let spec = BodySpec {
        law: material.law.clone(),
        density: material.density,
        damping: material.damping,
        mass: entry.mass,
        thickness: entry.thickness,
        massless_contact: scenario.contact.condition.is_massless() && may_touch(scenario, &entry.name),
    };
    let surface = contact_surface(&format!("{key}.contact_sides"), entry, &mesh)?;
    Body::with_contact_surface(mesh, surface, &spec).map_err(|e| match e {
        FemError::MaterialConstant { name: "thickness", .. } => {
            InputError::new(format!("{key}.thickness"), e.to_string())
        }
        FemError::MaterialConstant { name, .. } => {
            InputError::new(format!("materials.{}.{name}", entry.material), e.to_string())
        }
        _ => InputError::mesh(format!("{key}.mesh"), e.to_string()),
    })
}

/// Whether anything is there that a body may touch.
fn may_touch(scenario: &Scenario, name: &str) -> bool {
    let enabled = |other: &str| {
        let between = |p: &&PairEntry| {
            let [a, b] = &p.between;
            (a == name && b == other) || (a == other && b == name)
        };
        scenario.contact.pairs.iter().find(between).is_none_or(|p| p.enabled)
    };
    let others = scenario.bodies.iter().map(|b| b.name.as_str()).filter(|&other| other != name);
    others.chain(scenario.obstacles.iter().map(|o| o.name.as_str())).any(enabled)
}

/// The boundary of a body, or the sides of it that may touch others.
fn contact_surface(key: &str, entry: &BodyEntry, mesh: &Mesh<2>) -> Result<Surface, InputError> {
    let whole = Surface::of(mesh);
    let Some(sides) = &entry.contact_sides else { return Ok(whole) };
    let MeshSpec::Rectangle { corner, size, .. } = &entry.mesh else {
        return Err(InputError::new(key, "only a rectangle has named sides; leave this out"));
    };
    if sides.is_empty() {
        return Err(InputError::new(key, "name one side at least, or disable the pairs of the body"));
    }
    let on = |side: &Side, x: &Vector<2>| {
        let (axis, at) = match side {
            Side::Left => (0, corner[0]),
            Side::Right => (0, corner[0] + size[0]),
            Side::Bottom => (1, corner[1]),
            Side::Top => (1, corner[1] + size[1]),
        };
        (x[axis] - at).abs() <= 1e-9 * size[axis]
    };
    Ok(whole.part(|f| sides.iter().any(|side| f.nodes.iter().all(|&n| on(side, &mesh.nodes()[n as usize])))))
}

fn mesh(spec: &MeshSpec) -> Result<Mesh<2>, MeshError> {
    let (mesh, cell) = match *spec {
        MeshSpec::Disc { centre, radius, divisions, rings, cell } => {
            (generate::Disc { centre, radius, divisions, rings }.quadrilaterals()?, cell)
        }
        MeshSpec::Rectangle { corner, size, divisions, cell, periodic } => {
            let mesh = generate::grid(corner, size, divisions)?;
            (if periodic { generate::tie_sides(mesh, 0)? } else { mesh }, cell)
        }
    };
    match cell {
        PlaneCell::Quad4 => Ok(mesh),
        PlaneCell::Tri3 => generate::triangulate(&mesh),
    }
}

/// Refuses friction coefficients that are negative, or so large that round-off of μ|w_t| would hide the normal motion.
fn check_friction(key: &str, friction: f64) -> Result<(), InputError> {
    number(key, friction, (0.0..=MAX_FRICTION).contains(&friction), "friction must be between 0 and 1000")
}

/// Every pair of a body with another body or an obstacle, less the exceptions of the scenario.
fn contact(
    scenario: &Scenario,
    bodies: &[ModelBody<2>],
) -> Result<(ContactModel<2>, Vec<Group>), InputError> {
    let mut model = ContactModel::default();
    for b in bodies {
        let surface = ContactSurface::new(b.body.surface(), b.first_node as u32);
        let reference = |n: u32| b.body.mesh().nodes()[n as usize - b.first_node];
        model.surfaces.push(match scenario.contact.targets {
            Targets::Smooth => surface.smoothed(&reference),
            Targets::Faceted => surface,
        });
    }
    for (i, entry) in scenario.obstacles.iter().enumerate() {
        let key = format!("obstacles.{i}");
        match &entry.shape {
            ObstacleShape::Plane { point, normal } => {
                let normal: Vector<2> = vector(&format!("{key}.normal"), normal)?;
                let length = normal.norm();
                let remedy = "the normal must not be zero and points to the free side";
                number(&format!("{key}.normal"), length, length > 0.0, remedy)?;
                let point = vector(&format!("{key}.point"), point)?;
                // The model gives obstacles their numbers.
                model.obstacles.push(Obstacle::plane(point, normal / length, u32::MAX));
            }
        }
    }
    let default = scenario.contact.friction;
    check_friction("contact.friction", default)?;
    let mut groups = Vec::new();
    let names: Vec<&str> = bodies.iter().map(|b| b.name.as_str()).collect();
    let obstacle_names: Vec<&str> = scenario.obstacles.iter().map(|o| o.name.as_str()).collect();
    for (a, &first) in names.iter().enumerate() {
        let others = names.iter().enumerate().skip(a + 1).map(|(b, &name)| (Target::Surface(b), name));
        let obstacles = obstacle_names.iter().enumerate().map(|(o, &name)| (Target::Obstacle(o), name));
        for (target, second) in others.chain(obstacles) {
            let found = scenario.contact.pairs.iter().enumerate().find(|(_, p)| {
                let [x, y] = &p.between;
                (x == first && y == second) || (x == second && y == first)
            });
            let (mut friction, mut sources, mut swapped) = (default, scenario.contact.sources, false);
            if let Some((k, entry)) = found {
                if !entry.enabled {
                    continue;
                }
                friction = entry.friction.unwrap_or(friction);
                sources = entry.sources.unwrap_or(sources);
                // An order is only meant where the entry says which side is the source.
                swapped = entry.sources.is_some() && entry.between[0] == second;
                check_friction(&format!("contact.pairs.{k}.friction"), friction)?;
            }
            let group = groups.len();
            groups.push(Group { between: [first.to_string(), second.to_string()], friction });
            let forward = Pair { source: a, target, friction, group };
            match target {
                Target::Obstacle(_) => model.pairs.push(forward),
                Target::Surface(b) => {
                    let backward = Pair { source: b, target: Target::Surface(a), ..forward };
                    match (sources, swapped) {
                        (Sources::Finer, _) if is_finer(&bodies[b], &bodies[a]) => model.pairs.push(backward),
                        (Sources::Finer, _) => model.pairs.push(forward),
                        (Sources::Both, _) => model.pairs.extend([forward, backward]),
                        (Sources::First, false) | (Sources::Second, true) => model.pairs.push(forward),
                        (Sources::First, true) | (Sources::Second, false) => model.pairs.push(backward),
                    }
                }
            }
        }
    }
    Ok((model, groups))
}

/// Whether the facets of `a` are on average clearly shorter than those of `b`.
fn is_finer(a: &ModelBody<2>, b: &ModelBody<2>) -> bool {
    let mean_edge = |body: &ModelBody<2>| {
        let (nodes, facets) = (body.body.mesh().nodes(), body.body.surface().facets());
        let edge = |f: &Facet| (nodes[f.nodes[1] as usize] - nodes[f.nodes[0] as usize]).norm();
        facets.iter().map(edge).sum::<f64>() / facets.len() as f64
    };
    mean_edge(a) < 0.99 * mean_edge(b)
}

/// Refuses bodies that overlap one another or an obstacle before anything has moved.
fn check_overlaps(scenario: &Scenario, model: &Model<2>) -> Result<(), InputError> {
    let at = |n: u32| model.reference[n as usize];
    for pair in &model.contact.pairs {
        // Both directions are checked, whichever the contact condition uses.
        let mut directions = vec![*pair];
        if let Target::Surface(b) = pair.target {
            directions.push(Pair { source: b, target: Target::Surface(pair.source), ..*pair });
        }
        for direction in directions {
            let points = sample(&model.bodies[direction.source]);
            let Some(closest) = model.contact.closest(points, direction.target, &at) else {
                continue;
            };
            let source = &model.bodies[direction.source];
            if closest.gap >= -TOUCHING * source.body.mesh().smallest_edge() {
                continue;
            }
            let [a, b] = &model.groups[pair.group].between;
            let place = format!("({:.6}, {:.6})", closest.at[0], closest.at[1]);
            let index = direction.source;
            return Err(match direction.target {
                Target::Surface(_) => InputError::new(
                    format!("bodies.{index}.mesh"),
                    format!(
                        "bodies {a:?} and {b:?} overlap at the start: {:?} at {place} is {:.6} m inside; \
                         move one of them",
                        source.name, -closest.gap
                    ),
                ),
                Target::Obstacle(o) => {
                    let plane = &model.contact.obstacles[o];
                    let outside = source.nodes().all(|n| plane.gap(&model.reference[n], &at).0 < 0.0);
                    let fact = if outside { "lies outside, behind" } else { "overlaps" };
                    InputError::new(
                        format!("bodies.{index}.mesh"),
                        format!(
                            "body {a:?} {fact} obstacle {b:?} at the start: its node at {place} is {:.6} m behind it; \
                             move the body or turn the normal of obstacles.{} ({:?})",
                            -closest.gap, o, scenario.obstacles[o].name
                        ),
                    )
                }
            });
        }
    }
    Ok(())
}

/// Nodes, centres of facets and centres of cells of a body: bars of equal height pushed into one another have all nodes on
/// sides of the other, and identical bodies in the same place their facets too.
fn sample(body: &ModelBody<2>) -> impl Iterator<Item = Vector<2>> {
    let mesh = body.body.mesh();
    let centre = |nodes: &[u32]| {
        nodes.iter().map(|&n| mesh.nodes()[n as usize]).sum::<Vector<2>>() / nodes.len() as f64
    };
    let surface = body.body.surface();
    let nodes = surface.nodes().iter().map(|&n| mesh.nodes()[n as usize]);
    let facets = surface.facets().iter().map(move |f| centre(&f.nodes));
    let cells = mesh.blocks().iter().flat_map(move |b| b.cells().map(centre));
    nodes.chain(facets).chain(cells)
}

/// Translation and spin about the centre of mass of every body.
fn initial_velocity(scenario: &Scenario, model: &Model<2>) -> Result<Vec<Vector<2>>, InputError> {
    let mut velocity = Vec::with_capacity(model.node_count());
    for (i, (entry, b)) in scenario.bodies.iter().zip(&model.bodies).enumerate() {
        let drift: Vector<2> = vector(&format!("bodies.{i}.velocity"), &entry.velocity)?;
        let key = format!("bodies.{i}.spin");
        number(&key, entry.spin, true, "the spin must be a finite number")?;
        let free = b.body.mesh().ties().is_empty();
        number(&key, entry.spin, free || entry.spin == 0.0, "a periodic body cannot spin; give 0")?;
        let nodes = b.body.mesh().nodes();
        let centre = b.body.mean(nodes);
        velocity.extend(
            nodes.iter().map(|x| drift + tensor::rotation_velocity(&[0.0, 0.0, entry.spin], &(x - centre))),
        );
    }
    Ok(velocity)
}
