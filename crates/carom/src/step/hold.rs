//! Which rigid motion neither supports nor closed contacts resist, of bodies that do not come to rest in a load step.

use carom_contact::Contact;
use carom_fem::rigid_motion;
use carom_mesh::{Vector, nodal};
use nalgebra::{DMatrix, DVector};

use super::free_motion::FreeMotion;
use super::iterating::Iterating;
use super::newton::left_alone::{leave_out, normalise};
use crate::contact::stiffened::held_directions;
use crate::error::StepError;
use crate::model::given::Given;

/// A rigid motion is free if supports and contacts see no more of it than this, relative to the body.
const FREE: f64 = 1e-6;

/// Forces drive a free motion if more than this share of them does.
const DRIVEN: f64 = 1e-6;

/// A contact catches what closes it at more than this rate, relative to that of the body.
const CAUGHT: f64 = 1e-3;

/// A free motion may stay undone where less than this share of what presses drives it: between curved sides whose facets do not match there is
/// a moment of that kind. Measured: 1.2e-6 of press fits with 32 facets in 48.
const NEARLY_AT_REST: f64 = 1e-5;

/// A correction is a free motion if all but this share of it is.
const ALIKE: f64 = 1e-2;

/// A rigid motion is next to free if supports and contacts see no more of it than this. What is left alone is decided by what drives it; of the turn of press
/// fits contacts see 7.5e-6 with 32 facets in 48, and with 16 in 24 so much that with 5e-5 iterations did not end.
const NEARLY_FREE: f64 = 1e-2;

/// The rigid motions of some bodies, one after the other.
struct Motions<'a, const D: usize> {
    bodies: &'a [usize],
    /// The body, by its place in `bodies`, and number of every motion.
    columns: Vec<(usize, usize)>,
    centres: Vec<Vector<D>>,
    size: f64,
}

impl<'a, const D: usize> Motions<'a, D> {
    fn of(bodies: &'a [usize], given: &Given<'_, D>, reached: &[Vector<D>], work: &Iterating<D>) -> Self {
        let assembly = given.assembly;
        let place = |n: usize| assembly.reference[n] + reached[n];
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
        reached: &[Vector<D>],
        direction: &Vector<D>,
        stencil: impl Iterator<Item = (usize, f64)>,
    ) -> DVector<f64> {
        let mut row = DVector::zeros(self.columns.len());
        for (node, weight) in stencil {
            let Some(body) = given.assembly.body_of(node) else { continue };
            let Some(place) = self.bodies.iter().position(|&i| i == body) else { continue };
            let arm = given.assembly.reference[node] + reached[node] - self.centres[place];
            for (c, &(_, motion)) in self.columns.iter().enumerate().filter(|(_, (k, _))| *k == place) {
                row[c] += weight * direction.dot(&rigid_motion(motion, &arm, self.size));
            }
        }
        row
    }

    /// A motion of all nodes that is made of so much of every rigid motion.
    fn field(&self, shares: &DVector<f64>, given: &Given<'_, D>, reached: &[Vector<D>]) -> Vec<Vector<D>> {
        let assembly = given.assembly;
        let mut field = vec![Vector::zeros(); assembly.node_count()];
        for (&(place, motion), share) in self.columns.iter().zip(shares.iter()) {
            for node in assembly.nodes(self.bodies[place]) {
                let arm = assembly.reference[node] + reached[node] - self.centres[place];
                field[node] += rigid_motion(motion, &arm, self.size) * *share;
            }
        }
        field
    }
}

/// What supports, springs, and contacts that hold so many directions of their frames, see of rigid motions: Σ of the squares, a quadratic form.
fn resisted<'a, const D: usize>(
    motions: &Motions<'_, D>,
    holding: impl Iterator<Item = (&'a Contact<D>, usize)>,
    given: &Given<'_, D>,
    reached: &[Vector<D>],
) -> DMatrix<f64> {
    let assembly = given.assembly;
    let count = motions.columns.len();
    let mut resisted = DMatrix::<f64>::zeros(count, count);
    let mut resist = |row: DVector<f64>| resisted.ger(1.0, &row, &row, 1.0);
    for node in motions.bodies.iter().flat_map(|&i| assembly.nodes(i)) {
        for component in (0..D).filter(|&c| assembly.held(node)[c]) {
            let axis = Vector::from_fn(|i, _| if i == component { 1.0 } else { 0.0 });
            resist(motions.row(given, reached, &axis, std::iter::once((node, 1.0))));
        }
    }
    for (contact, directions) in holding {
        for axis in 0..directions {
            let direction: Vector<D> = contact.frame.row(axis).transpose();
            resist(motions.row(given, reached, &direction, contact.stencil()));
        }
    }
    for spring in &assembly.springs {
        for direction in spring.held_directions(reached) {
            let stencil = spring.stencil.iter().map(|&(n, weight)| (n as usize, weight));
            resist(motions.row(given, reached, &direction, stencil));
        }
    }
    resisted
}

/// The motions of which `resisted` sees no more than a share `seen`, each as its share of every rigid motion of a body.
fn free(resisted: DMatrix<f64>, seen: f64) -> Vec<DVector<f64>> {
    let eigen = resisted.symmetric_eigen();
    let most = eigen.eigenvalues.max().max(1.0);
    let is_free = |value: &f64| *value <= seen * seen * most;
    let free = eigen.eigenvalues.iter().enumerate().filter(|(_, value)| is_free(value));
    free.map(|(k, _)| eigen.eigenvectors.column(k).into_owned()).collect()
}

/// The rigid motions of some bodies that neither supports nor closed contacts resist, and what the forces on them do there.
struct FreeMotions<'a, const D: usize> {
    motions: Motions<'a, D>,
    /// Each as its share of every rigid motion of a body.
    modes: Vec<DVector<f64>>,
    /// The part of the forces [N] that moves what is free, by the rigid motions of every body.
    driving: DVector<f64>,
    /// Σ|f| of what is out of balance, and Σ|r| of what presses [N].
    unbalanced: f64,
    pressing: f64,
    touches: Vec<bool>,
}

impl<'a, const D: usize> FreeMotions<'a, D> {
    /// Those of `bodies` at the present guess of which supports and contacts see no more than a share `seen`.
    fn of(
        bodies: &'a [usize],
        seen: f64,
        given: &Given<'_, D>,
        reached: &[Vector<D>],
        work: &Iterating<D>,
    ) -> Self {
        let assembly = given.assembly;
        let motions = Motions::of(bodies, given, reached, work);
        let count = motions.columns.len();
        let active = &work.contacts.active;
        let mut forces = work.newton.residual.clone();
        let pressing = active.contacts.iter().zip(&active.reactions).zip(&active.friction);
        let mut touches = vec![false; assembly.body_count()];
        let mut holding = Vec::with_capacity(active.contacts.len());
        for (((contact, r), mu), before) in pressing.zip(&work.contacts.reduced.guess) {
            contact.add_force(&(r - before), &mut forces);
            let directions = held_directions(r, *mu);
            if directions > 0 {
                contact.stencil().filter_map(|(n, _)| assembly.body_of(n)).for_each(|b| touches[b] = true);
            }
            holding.push((contact, directions));
        }
        let modes = free(resisted(&motions, holding.into_iter(), given, reached), seen);
        let mut all = DVector::zeros(count);
        let mut unbalanced = 0.0;
        for node in bodies.iter().flat_map(|&i| assembly.nodes(i)) {
            let force = assembly.free_part(node, &forces[node]);
            unbalanced += force.norm();
            all += motions.row(given, reached, &force, std::iter::once((node, 1.0)));
        }
        Self {
            driving: modes.iter().fold(DVector::zeros(count), |sum, mode| sum + mode * mode.dot(&all)),
            pressing: active.reactions.iter().map(Vector::norm).sum(),
            motions,
            modes,
            unbalanced,
            touches,
        }
    }

    /// Whether forces drive what is free.
    fn is_driven(&self) -> bool {
        self.unbalanced > 0.0 && self.driving.norm() > DRIVEN * self.unbalanced
    }

    /// Whether contacts that are open now close where forces drive what is free: it falls on what will hold it.
    fn is_caught(&self, given: &Given<'_, D>, reached: &[Vector<D>], work: &Iterating<D>) -> bool {
        let least = CAUGHT * self.driving.norm();
        work.contacts.active.contacts.iter().any(|contact| {
            let normal: Vector<D> = contact.frame.row(0).transpose();
            self.motions.row(given, reached, &normal, contact.stencil()).dot(&self.driving) < -least
        })
    }

    /// Whether they drive it by so little of what presses that it may be left where it is.
    fn is_nearly_at_rest(&self) -> bool {
        !self.modes.is_empty() && self.driving.norm() <= NEARLY_AT_REST * self.pressing
    }

    /// What is driven most; none if nothing is.
    fn driven(&self) -> Option<FreeMotion> {
        let of_body = |place: usize| {
            let own = self.motions.columns.iter().zip(self.driving.iter());
            own.filter(move |((k, _), _)| *k == place).map(|((_, motion), x)| (*motion, *x))
        };
        let share = |place: usize| of_body(place).map(|(_, x)| x * x).sum::<f64>();
        let bodies = self.motions.bodies;
        let worst = (0..bodies.len()).max_by(|&a, &b| share(a).total_cmp(&share(b)))?;
        let (mut along, mut spin) = ([0.0; 3], [0.0; 3]);
        for (motion, x) in of_body(worst) {
            match (motion < D, D) {
                (true, _) => along[motion] = x,
                (false, 2) => spin[2] = x,
                (false, _) => spin[motion - D] = x,
            }
        }
        let body = bodies[worst];
        let driving = self.driving.norm() / self.pressing;
        let found = FreeMotion { body, along, spin, touches: self.touches[body], driving };
        self.is_driven().then_some(found)
    }

    /// Whether a motion of all nodes is one of these.
    fn has(&self, motion: &[Vector<D>], given: &Given<'_, D>, reached: &[Vector<D>]) -> bool {
        let mut rest = motion.to_vec();
        let mut known: Vec<Vec<Vector<D>>> = Vec::with_capacity(self.modes.len());
        for mode in &self.modes {
            let mut field = self.motions.field(mode, given, reached);
            known.iter().for_each(|other| leave_out(other, &mut field));
            normalise(&mut field);
            leave_out(&field, &mut rest);
            known.push(field);
        }
        nodal::dot(&rest, &rest) <= ALIKE * ALIKE * nodal::dot(motion, motion)
    }
}

/// The rigid motions of a `body` alone, where the model is in the state `next`, that neither supports nor these contacts resist: an entry per node of
/// the body. The contacts hold so many directions of their frames.
pub(super) fn neutral<'a, const D: usize>(
    body: usize,
    holding: impl Iterator<Item = (&'a Contact<D>, usize)>,
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &Iterating<D>,
) -> Vec<Vec<Vector<D>>> {
    let bodies = [body];
    let motions = Motions::of(&bodies, given, reached, work);
    let modes = free(resisted(&motions, holding, given, reached), NEARLY_FREE);
    let nodes = given.assembly.nodes(body);
    modes.iter().map(|mode| motions.field(mode, given, reached)[nodes.clone()].to_vec()).collect()
}

/// The share of a motion of a `body`, squared, that is no rigid one.
pub(super) fn elastic_share<const D: usize>(
    body: usize,
    motion: &[Vector<D>],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &Iterating<D>,
) -> f64 {
    let bodies = [body];
    let motions = Motions::of(&bodies, given, reached, work);
    let nodes = given.assembly.nodes(body);
    let (mut rest, mut known) = (motion.to_vec(), Vec::<Vec<Vector<D>>>::new());
    for k in 0..motions.columns.len() {
        let unit = DVector::from_fn(motions.columns.len(), |i, _| if i == k { 1.0 } else { 0.0 });
        let mut field = motions.field(&unit, given, reached)[nodes.clone()].to_vec();
        known.iter().for_each(|other| leave_out(other, &mut field));
        normalise(&mut field);
        leave_out(&field, &mut rest);
        known.push(field);
    }
    nodal::dot(&rest, &rest) / nodal::dot(motion, motion)
}

/// The last correction of `bodies`, of unit length, if it is a motion that next to nothing resists and next to nothing drives.
pub(super) fn left_alone<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &Iterating<D>,
) -> Option<Vec<Vector<D>>> {
    let free = FreeMotions::of(bodies, NEARLY_FREE, given, reached, work);
    let mut motion = vec![Vector::zeros(); given.assembly.node_count()];
    for nodes in bodies.iter().map(|&i| given.assembly.nodes(i)) {
        motion[nodes.clone()].copy_from_slice(&work.newton.correction[nodes]);
    }
    if !free.is_nearly_at_rest() || !free.has(&motion, given, reached) {
        return None;
    }
    normalise(&mut motion);
    Some(motion)
}

/// What drives the motion that `bodies` were left alone in.
///
/// # Errors
/// If it is more than next to nothing.
pub(super) fn driven_least<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &Iterating<D>,
) -> Result<Option<FreeMotion>, StepError> {
    let free = FreeMotions::of(bodies, NEARLY_FREE, given, reached, work);
    let driven = free.driven();
    match driven {
        Some(found) if !free.is_nearly_at_rest() => Err(as_error(&found, given)),
        _ => Ok(driven),
    }
}

/// Says which of the `bodies` nothing holds against the forces on it, and how it would move; none if all are held, or nothing drives what is not. Beside
/// that, whether it falls on a contact that was found.
pub(super) fn not_held<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &Iterating<D>,
) -> Option<(StepError, bool)> {
    let free = FreeMotions::of(bodies, FREE, given, reached, work);
    let driven = free.driven()?;
    Some((as_error(&driven, given), free.is_caught(given, reached, work)))
}

fn as_error<const D: usize>(found: &FreeMotion, given: &Given<'_, D>) -> StepError {
    let body = given.assembly.name(found.body).to_string();
    StepError::NotHeld { body, motion: found.in_words::<D>() }
}
