//! Threads that share a body.

use carom_fem::material::LawSpec;
use carom_fem::{Body, StepForces};
use carom_mesh::{CellKind, Vector};
use rayon::prelude::*;

use crate::common::{elastic, grid, spec};

/// More than one may evaluate its forces at a time, also as tasks of the threads that share each evaluation: whoever waits for the
/// others may be given such a task.
#[test]
fn many_evaluate_the_forces_of_one_body_at_once() {
    let law = LawSpec::SaintVenantKirchhoff(elastic());
    let body = Body::new(grid(CellKind::Quad4, 100, |x: Vector<2>| x), &spec(law)).expect("valid");
    let forces = |k: usize| {
        let u = |x: &Vector<2>| Vector::<2>::new(x[1] * x[1], (3.0 * x[0]).sin()) * 0.01 * k as f64;
        let u: Vec<_> = body.mesh().nodes().iter().map(u).collect();
        let still = vec![Vector::zeros(); u.len()];
        let [mut force, mut conserving, mut difference, mut end] = [(); 4].map(|()| still.clone());
        body.internal_force(&u, &mut force);
        let mut forces =
            StepForces { conserving: &mut conserving, difference: &mut difference, end: &mut end };
        let energy = body.after(&[]).step_forces_and_energy(&still, &u, &mut forces);
        (energy, [force, conserving, difference, end])
    };
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let alone: Vec<_> = pool(1).install(|| (0..400).map(forces).collect());
    let together: Vec<_> = pool(3).install(|| (0..400).into_par_iter().with_max_len(1).map(forces).collect());
    assert_eq!(alone, together);
    let [force, conserving, difference, end] = &alone[1].1;
    assert!(force.iter().any(|f| f.norm() > 0.0));
    // All of the same size: none is left out, or written in the place of another.
    let apart =
        |a: &[Vector<2>], b: &[Vector<2>]| a.iter().zip(b).any(|(a, b)| (a - b).norm() > 1e-3 * a.norm());
    assert!(apart(conserving, difference) && apart(conserving, end) && apart(difference, end));
    assert_eq!(force, end);
}
