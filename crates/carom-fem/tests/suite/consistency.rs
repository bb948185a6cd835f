//! Force and stiffness are derivatives of the energy, and the force of a step does its work, for every cell, hypothesis and
//! formulation.

use carom_fem::material::{LawSpec, Mat3};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, StepForces};
use carom_mesh::{CellKind, Matrix, Vector, tensor};

use crate::common::{PLANE, SPATIAL, distortion, elastic, grid, shaken, spec};

/// Away from the axis of a body of revolution.
const RADIUS: f64 = 0.3;

/// Every formulation, without an initial stress and with one, of every law, hypothesis and cell.
fn bodies<const D: usize>(cells: &[CellKind]) -> Vec<(String, BodySpec, Body<D>)> {
    let mut bodies = Vec::new();
    let laws = [LawSpec::SaintVenantKirchhoff, LawSpec::NeoHookean, LawSpec::LinearElastic];
    let hypotheses: &[Hypothesis] = match D {
        2 => &[Hypothesis::PlaneStrain, Hypothesis::PlaneStress, Hypothesis::Axisymmetric],
        _ => &[Hypothesis::PlaneStrain],
    };
    let stress = Mat3::new(90.0, 30.0, 0.0, 30.0, -60.0, 0.0, 0.0, 0.0, 40.0);
    for &kind in cells {
        for law in laws {
            for &hypothesis in hypotheses {
                for formulation in [Formulation::Standard, Formulation::MeanDilatation] {
                    for initial_stress in [Mat3::zeros(), stress] {
                        let spec =
                            BodySpec { hypothesis, formulation, initial_stress, ..spec(law(elastic())) };
                        let name = format!(
                            "{kind:?} {:?} {hypothesis:?} {formulation:?} {initial_stress}",
                            spec.law
                        );
                        bodies.extend(body(kind, &spec).map(|body| (name, spec, body)));
                    }
                }
            }
        }
    }
    bodies
}

/// None of what cannot be.
fn body<const D: usize>(kind: CellKind, spec: &BodySpec) -> Option<Body<D>> {
    let mut axis = Vector::zeros();
    axis[0] = RADIUS;
    let divisions = if kind.is_quadratic() { 1 } else { 2 };
    let mesh = grid::<D>(kind, divisions, |x| distortion(x) + axis);
    let is_sheet = spec.hypothesis == Hypothesis::PlaneStress;
    let locks = matches!(kind, CellKind::Quad4 | CellKind::Hex8);
    let dilates = spec.formulation == Formulation::MeanDilatation;
    let suits = !dilates || locks && !is_sheet && !matches!(spec.law, LawSpec::LinearElastic(_));
    let is_stressed = is_sheet && spec.initial_stress != Mat3::zeros();
    match Body::new(mesh, spec) {
        Ok(body) => {
            assert!(suits && !is_stressed);
            Some(body)
        }
        Err(e) => {
            let e = e.to_string();
            assert!(
                !suits && e.contains("mean-dilatation") || is_stressed && e.contains("initial stress"),
                "{e}"
            );
            None
        }
    }
}

fn dot<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn moved<const D: usize>(u: &[Vector<D>], s: f64, d: &[Vector<D>]) -> Vec<Vector<D>> {
    u.iter().zip(d).map(|(u, d)| u + d * s).collect()
}

fn force<const D: usize>(body: &Body<D>, u: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut f = vec![Vector::zeros(); u.len()];
    body.internal_force(u, &mut f);
    f
}

fn derivatives<const D: usize>(cells: &[CellKind]) {
    for (name, _, body) in bodies::<D>(cells) {
        let n = body.node_count();
        let (u, d) = (shaken::<D>(n, 0.04, 0.3), shaken::<D>(n, 1.0, 1.7));
        let h = 1e-6;
        let (plus, minus) = (moved(&u, h, &d), moved(&u, -h, &d));
        let numeric = (body.strain_energy(&plus) - body.strain_energy(&minus)) / (2.0 * h);
        let power = dot(&force(&body, &u), &d);
        assert!((numeric - power).abs() < 1e-6 * body.volume() * 2700.0, "{name}: {numeric} {power}");
        let mut product = vec![Vector::zeros(); n];
        let stiffness = body.stiffness(&u);
        stiffness.multiply(&d, &mut product);
        let size = product.iter().map(Vector::norm).fold(0.0, f64::max);
        for (n, (p, m)) in force(&body, &plus).iter().zip(force(&body, &minus)).enumerate() {
            let error = ((p - m) / (2.0 * h) - product[n]).norm();
            assert!(error < 1e-7 * size, "{name}, node {n}: {error} of {size}");
        }
        let e = shaken::<D>(n, 1.0, 4.1);
        let mut other = vec![Vector::zeros(); n];
        stiffness.multiply(&e, &mut other);
        let asymmetry = dot(&product, &e) - dot(&other, &d);
        assert!(asymmetry.abs() < 1e-11 * size * n as f64, "{name}: K is not symmetric");
    }
}

#[test]
fn force_and_stiffness_are_derivatives_of_the_energy() {
    derivatives::<2>(&PLANE);
    derivatives::<3>(&SPATIAL);
}

fn works<const D: usize>(cells: &[CellKind]) {
    for (name, spec, body) in bodies::<D>(cells) {
        let n = body.node_count();
        let u0 = shaken::<D>(n, 0.03, 0.3);
        for size in [0.05, 1e-4] {
            let d = shaken::<D>(n, size, 1.7);
            let u1 = moved(&u0, 1.0, &d);
            let mut f = vec![Vector::zeros(); n];
            body.conserving_force(&u0, &u1, &mut f);
            let change = body.strain_energy(&u1) - body.strain_energy(&u0);
            let scale = body.volume() * 2700.0;
            assert!((dot(&f, &d) - change).abs() < 1e-14 * scale, "{name}: {} {change}", dot(&f, &d));
            let zeros = vec![Vector::zeros(); n];
            let (mut conserving, mut difference, mut end) = (zeros.clone(), zeros.clone(), zeros);
            let mut forces =
                StepForces { conserving: &mut conserving, difference: &mut difference, end: &mut end };
            let energy = body.after(&[]).step_forces_and_energy(&u0, &u1, &mut forces);
            assert!((energy - body.strain_energy(&u1)).abs() < 1e-14 * scale, "{name}");
            let of_both = [forces.conserving.to_vec(), forces.difference.to_vec(), forces.end.to_vec()];
            body.step_forces(&u0, &u1, &mut forces);
            assert_eq!(of_both, [&*forces.conserving, &*forces.difference, &*forces.end], "{name}");
            let inner = force(&body, &u1);
            for k in 0..n {
                assert!((conserving[k] - f[k]).norm() < 1e-12 * scale, "{name}");
                assert!((end[k] - inner[k]).norm() < 1e-12 * scale, "{name}");
            }
            // Neither a resultant nor, at the middle of the step, a moment.
            let turns = spec.hypothesis != Hypothesis::Axisymmetric && body.turns();
            for f in [&f, &difference] {
                assert!(body.resultant(f.iter().sum()).norm() < 1e-12 * scale, "{name}");
                let mut moment = Vector::<3>::zeros();
                for ((f, x), (a, b)) in f.iter().zip(body.mesh().nodes()).zip(u0.iter().zip(&u1)) {
                    moment += Vector::<3>::from(tensor::cross(&(x + (a + b) * 0.5), f));
                }
                assert!(!turns || moment.norm() < 1e-12 * scale, "{name}: {moment}");
            }
        }
    }
}

#[test]
fn the_conserving_force_does_the_work_of_the_step_and_keeps_the_momenta() {
    works::<2>(&PLANE);
    works::<3>(&SPATIAL);
}

fn rigid<const D: usize>(cells: &[CellKind]) {
    let turn: Matrix<D> = tensor::rotation(if D == 2 { &[0.0, 0.0, 1.1] } else { &[0.4, -0.3, 1.1] });
    for (name, spec, body) in bodies::<D>(cells) {
        let mut drift = Vector::<D>::zeros();
        drift[1] = 0.7;
        let turns = body.turns();
        let q = if turns { turn } else { Matrix::identity() };
        assert_eq!(turns, spec.hypothesis != Hypothesis::Axisymmetric && !name.contains("Linear"), "{name}");
        let u: Vec<Vector<D>> = body.mesh().nodes().iter().map(|x| q * x - x + drift).collect();
        let rest = vec![Vector::zeros(); u.len()];
        let is_stressed = spec.initial_stress != Mat3::zeros();
        assert_eq!(is_stressed, body.strain_energy(&rest) > 0.0, "{name}");
        let gained = body.strain_energy(&u) - body.strain_energy(&rest);
        assert!(gained.abs() < 1e-15 * 2700.0 * body.volume(), "{name}: {gained}");
        // An initial stress turns with the body.
        for (turned, f) in force(&body, &u).iter().zip(force(&body, &rest)) {
            assert!((turned - q * f).norm() < 1e-11, "{name}");
            assert!(is_stressed || f.norm() < 1e-11, "{name}");
        }
    }
}

#[test]
fn a_rigid_motion_changes_no_energy_and_turns_forces() {
    rigid::<2>(&PLANE);
    rigid::<3>(&SPATIAL);
}
