//! Which rigid motion neither supports nor closed contacts resist, of bodies that do not come to rest in a load step.

use carom_fem::rigid_motion;
use carom_mesh::Vector;
use nalgebra::{DMatrix, DVector};

use super::workspace::Workspace;
use crate::contact::stiffened::held_directions;
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::state::State;

/// A rigid motion is free if supports and contacts see no more of it than this, relative to the body.
const FREE: f64 = 1e-6;

/// Forces drive a free motion if more than this share of them does.
const DRIVEN: f64 = 1e-6;

/// The rigid motions of some bodies, one after the other.
struct Motions<'a, const D: usize> {
    bodies: &'a [usize],
    /// The body, by its place in `bodies`, and number of every motion.
    columns: Vec<(usize, usize)>,
    centres: Vec<Vector<D>>,
    size: f64,
}

impl<'a, const D: usize> Motions<'a, D> {
    fn of(bodies: &'a [usize], given: &Given<'_, D>, next: &State<D>, work: &Workspace<D>) -> Self {
        let assembly = given.assembly;
        let place = |n: usize| assembly.reference[n] + next.displacement[n];
        let centre = |nodes: std::ops::Range<usize>| {
            let count = nodes.len() as f64;
            nodes.map(place).sum::<Vector<D>>() / count
        };
        let columns = bodies.iter().enumerate();
        Self {
            bodies,
            columns: columns
                .flat_map(|(k, &i)| work.bodies[i].rigid_motions().into_iter().map(move |m| (k, m)))
                .collect(),
            centres: bodies.iter().map(|&i| centre(assembly.nodes(i))).collect(),
            size: assembly.size,
        }
    }

    /// Σ of these nodal motions, each with its weight, by every rigid motion: what it moves along `direction`.
    fn row(
        &self,
        given: &Given<'_, D>,
        next: &State<D>,
        direction: &Vector<D>,
        stencil: impl Iterator<Item = (usize, f64)>,
    ) -> DVector<f64> {
        let mut row = DVector::zeros(self.columns.len());
        for (node, weight) in stencil {
            let Some(body) = given.assembly.body_of(node) else { continue };
            let Some(place) = self.bodies.iter().position(|&i| i == body) else { continue };
            let arm = given.assembly.reference[node] + next.displacement[node] - self.centres[place];
            for (c, &(_, motion)) in self.columns.iter().enumerate().filter(|(_, (k, _))| *k == place) {
                row[c] += weight * direction.dot(&rigid_motion(motion, &arm, self.size));
            }
        }
        row
    }
}

/// Says which of the `bodies` nothing holds against the forces on it, and how it would move; none if all are held, or nothing drives what is not.
pub(super) fn not_held<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &State<D>,
    work: &Workspace<D>,
) -> Option<StepError> {
    let assembly = given.assembly;
    let motions = Motions::of(bodies, given, next, work);
    let count = motions.columns.len();
    let mut resisted = DMatrix::<f64>::zeros(count, count);
    let mut resist = |row: DVector<f64>| resisted.ger(1.0, &row, &row, 1.0);
    for node in bodies.iter().flat_map(|&i| assembly.nodes(i)) {
        for component in (0..D).filter(|&c| assembly.held(node)[c]) {
            let axis = Vector::from_fn(|i, _| if i == component { 1.0 } else { 0.0 });
            resist(motions.row(given, next, &axis, std::iter::once((node, 1.0))));
        }
    }
    let active = &work.contacts.active;
    let mut forces = work.newton.residual.clone();
    let pressing = active.contacts.iter().zip(&active.reactions).zip(&active.friction);
    let mut touches = vec![false; assembly.body_count()];
    for (((contact, r), mu), before) in pressing.zip(&work.contacts.reduced.guess) {
        contact.add_force(&(r - before), &mut forces);
        let directions = held_directions(r, *mu);
        if directions > 0 {
            contact.stencil().filter_map(|(n, _)| assembly.body_of(n)).for_each(|b| touches[b] = true);
        }
        for axis in 0..directions {
            let direction: Vector<D> = contact.frame.row(axis).transpose();
            resist(motions.row(given, next, &direction, contact.stencil()));
        }
    }
    let eigen = resisted.symmetric_eigen();
    let most = eigen.eigenvalues.max().max(1.0);
    let mut driving = DVector::zeros(count);
    let mut total = 0.0;
    for node in bodies.iter().flat_map(|&i| assembly.nodes(i)) {
        let force = assembly.free_part(node, &forces[node]);
        total += force.norm();
        driving += motions.row(given, next, &force, std::iter::once((node, 1.0)));
    }
    // The part of the forces that moves what is free.
    let mut free = DVector::zeros(count);
    for (k, value) in eigen.eigenvalues.iter().enumerate() {
        if *value <= FREE * FREE * most {
            let mode = eigen.eigenvectors.column(k);
            free += mode * mode.dot(&driving);
        }
    }
    if free.norm() <= DRIVEN * total || total == 0.0 {
        return None;
    }
    let of_body = |place: usize| {
        let own = motions.columns.iter().zip(free.iter()).filter(move |((k, _), _)| *k == place);
        own.map(|((_, motion), x)| (*motion, *x))
    };
    let share = |place: usize| of_body(place).map(|(_, x)| x * x).sum::<f64>();
    let worst = (0..bodies.len()).max_by(|&a, &b| share(a).total_cmp(&share(b)))?;
    let mut along = Vector::<D>::zeros();
    let mut spin = [0.0; 3];
    for (motion, x) in of_body(worst) {
        if motion < D {
            along[motion] = x;
        } else {
            spin[if D == 2 { 2 } else { motion - D }] = x;
        }
    }
    let body = bodies[worst];
    let name = assembly.name(body).to_string();
    Some(StepError::NotHeld { body: name, motion: in_words(&along, &spin, touches[body]) })
}

/// How a rigid motion along and about these axes, of a body that touches others or none, is called.
fn in_words<const D: usize>(along: &Vector<D>, spin: &[f64; 3], touches: bool) -> String {
    let turns = spin.iter().map(|w| w * w).sum::<f64>() > along.norm_squared();
    let (verb, axis) = match (turns, touches) {
        (true, _) => ("turn about", &spin[..]),
        (false, true) => ("slide along", along.as_slice()),
        (false, false) => ("move along", along.as_slice()),
    };
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let main = axis.iter().position(|x| x.abs() > 0.99 * length);
    let name = main.map_or_else(
        || {
            let parts: Vec<String> = axis.iter().map(|x| format!("{:.2}", x / length)).collect();
            format!("({})", parts.join(", "))
        },
        |k| ["x", "y", "z"][k].to_string(),
    );
    format!("{verb} {name}")
}
