//! The motion that the tangent of a body resists least: the lowest eigenvector of K x = λ M x, by inverse iteration.

use carom_fem::Body;
use carom_mesh::{Vector, nodal};

use super::iteration_matrix::{IterationMatrix, sign};
use crate::body::SoftestMotion;

/// The first share of the inertia that an indefinite tangent is tried with, by how much it grows, and the largest.
const HELD_BACK: [f64; 3] = [1e-3, 4.0, 1e4];

/// Solves at most.
const SOLVES: usize = 60;

/// The eigenvalue is known when a solve changes it by less than this.
const KNOWN: f64 = 1e-6;

/// Where it is as much above what holds the body back, in terms of that, it is known by less than a hundredth: it is not zero.
const POSITIVE: f64 = 1.5;

/// The least share of the inertia with which `is_made`, the tangent, has an inverse.
pub(super) fn held_back(mut is_made: impl FnMut(f64) -> bool) -> Option<f64> {
    let [first, growth, largest] = HELD_BACK;
    let mut share = 0.0;
    while !is_made(share) {
        share = f64::max(share * growth, first);
        if share > largest {
            return None;
        }
    }
    Some(share)
}

/// Makes the largest component of a motion one.
fn normalise<const D: usize>(x: &mut [Vector<D>]) {
    let components = x.iter().flat_map(|x| x.iter().copied());
    let largest = components.fold(0.0_f64, |a, b| if b.abs() > a.abs() { b } else { a });
    if largest != 0.0 {
        x.iter_mut().for_each(|x| *x /= largest);
    }
}

/// Motions of unit length in the mass of the body, each beside M times it.
type Known<const D: usize> = Vec<(Vec<Vector<D>>, Vec<Vector<D>>)>;

/// Leaves what is `known` out of a motion.
fn leave_out<const D: usize>(known: &Known<D>, x: &mut [Vector<D>]) {
    for (field, weighed) in known {
        let part = nodal::dot(weighed, x);
        x.iter_mut().zip(field).for_each(|(x, f)| *x -= f * part);
    }
}

/// The softest motion of a body whose K̄ is its tangent, held back by this share of the inertia of its lowest motion, but for `neutral` ones.
pub(super) fn find<const D: usize>(
    matrix: &mut IterationMatrix<D>,
    body: &Body<D>,
    held_back: f64,
    neutral: &[Vec<Vector<D>>],
) -> SoftestMotion<D> {
    let weigh = |x: &[Vector<D>]| {
        let mut weighed = vec![Vector::zeros(); x.len()];
        body.multiply_mass(x, &mut weighed);
        weighed
    };
    let mut known: Known<D> = Vec::with_capacity(neutral.len());
    for motion in neutral {
        let mut field = motion.clone();
        leave_out(&known, &mut field);
        let mut weighed = weigh(&field);
        let length = nodal::dot(&field, &weighed).sqrt();
        if length > 0.0 {
            field.iter_mut().chain(&mut weighed).for_each(|x| *x /= length);
            known.push((field, weighed));
        }
    }
    let own = matrix.inertia(held_back, 1.0);
    let mut x: Vec<_> = (0..body.node_count()).map(|n| Vector::from_fn(|i, _| sign(n * D + i))).collect();
    let mut y = vec![Vector::zeros(); x.len()];
    let (mut eigenvalue, mut mass) = (f64::INFINITY, 0.0);
    for _ in 0..SOLVES {
        let weighed = weigh(&x);
        matrix.begin(&weighed);
        matrix.end(&mut y);
        leave_out(&known, &mut y);
        let before = eigenvalue;
        eigenvalue = nodal::dot(&y, &weighed) / nodal::dot(&y, &weigh(&y));
        std::mem::swap(&mut x, &mut y);
        normalise(&mut x);
        mass = nodal::dot(&x, &weigh(&x));
        let known = if eigenvalue > (1.0 + POSITIVE) * own && own > 0.0 { 0.01 } else { KNOWN };
        if (eigenvalue - before).abs() <= known * eigenvalue {
            break;
        }
    }
    let inertia = matrix.lowest_inertia * mass;
    SoftestMotion { field: x, stiffness: (eigenvalue - own) * mass, inertia }
}
