//! Growth: a body that is free takes its new size without stress, and force and stiffness are derivatives of the energy of what has grown.

use carom_fem::material::{J2Plasticity, LawSpec};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis};
use carom_mesh::{CellKind, Vector};

use crate::common::{distortion, elastic, grid, shaken, spec};

const GROWTH: f64 = 0.07;

/// Bodies of every hypothesis and formulation in D dimensions that may grow.
fn bodies<const D: usize>() -> Vec<(String, BodySpec, Body<D>)> {
    let metal = J2Plasticity {
        elastic: elastic(),
        yield_stress: 100.0,
        hardening: 50.0,
        saturation_stress: None,
        saturation_rate: 0.0,
    };
    let laws = [
        LawSpec::LinearElastic(elastic()),
        LawSpec::SaintVenantKirchhoff(elastic()),
        LawSpec::NeoHookean(elastic()),
        LawSpec::J2Plasticity(metal),
    ];
    let hypotheses: &[Hypothesis] = match D {
        2 => &[Hypothesis::PlaneStrain, Hypothesis::PlaneStress, Hypothesis::Axisymmetric],
        _ => &[Hypothesis::PlaneStrain],
    };
    let kind = if D == 2 { CellKind::Quad4 } else { CellKind::Hex8 };
    let mut bodies = Vec::new();
    for law in laws {
        for &hypothesis in hypotheses {
            for formulation in [Formulation::Standard, Formulation::MeanDilatation] {
                let spec = BodySpec { hypothesis, formulation, grows: true, ..spec(law.clone()) };
                let mut axis = Vector::zeros();
                axis[0] = 0.3;
                // What cannot be, as a sheet in mean dilatation, is refused.
                if let Ok(body) = Body::new(grid::<D>(kind, 2, |x| distortion(x) + axis), &spec) {
                    bodies.push((format!("{D}D {:?} {hypothesis:?} {formulation:?}", spec.law), spec, body));
                }
            }
        }
    }
    bodies
}

fn dot<const D: usize>(a: &[Vector<D>], b: &[Vector<D>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

fn is_free_of_stress_when_it_has_grown<const D: usize>() -> usize {
    let mut count = 0;
    for (name, spec, body) in bodies::<D>() {
        if D == 2 && spec.hypothesis == Hypothesis::PlaneStrain {
            continue;
        }
        let u: Vec<_> = body.mesh().nodes().iter().map(|x| x * GROWTH).collect();
        let grown = body.after(&[]).grown(GROWTH);
        let mut force = vec![Vector::zeros(); u.len()];
        let energy = grown.internal_force_and_energy(&u, &mut force);
        let largest = force.iter().map(Vector::norm).fold(0.0, f64::max);
        assert!(energy.abs() < 1e-25 * 2700.0 && largest < 1e-11, "{name}: {energy:e} J, {largest:e} N");
        for cell in grown.cell_states(&u) {
            assert!(cell.stress.norm() < 1e-10, "{name}: {}", cell.stress);
            let strain = 0.5 * ((1.0 + GROWTH).powi(2) - 1.0);
            assert!((cell.strain[(0, 0)] - strain).abs() < 1e-14, "{name}: the strain is that of the motion");
        }
        count += 1;
    }
    count
}

#[test]
fn a_body_that_nothing_holds_grows_without_stress() {
    assert_eq!(is_free_of_stress_when_it_has_grown::<2>() + is_free_of_stress_when_it_has_grown::<3>(), 17);
}

/// σ₃₃ = −E γ of a long body that is free in its plane and held along its axis (Timoshenko & Goodier); in the plane it grows by (1 + ν) γ.
#[test]
fn a_slice_of_a_long_body_grows_across_by_what_is_held_along() {
    let law = LawSpec::LinearElastic(elastic());
    let body = Body::<2>::new(grid(CellKind::Quad4, 2, |x| x), &BodySpec { grows: true, ..spec(law) })
        .expect("valid");
    let growth = 1e-3;
    let u: Vec<_> = body.mesh().nodes().iter().map(|x| x * (1.33 * growth)).collect();
    let grown = body.after(&[]).grown(growth);
    let mut force = vec![Vector::zeros(); u.len()];
    let energy = grown.internal_force_and_energy(&u, &mut force);
    assert!(force.iter().all(|f| f.norm() < 1e-12));
    assert!((energy - 0.5 * 2700.0 * growth * growth).abs() < 1e-12 * energy, "{energy:e}");
    for cell in grown.cell_states(&u) {
        // Cauchy's stress is P over the deformed area.
        assert!((cell.stress[(2, 2)] / (-2700.0 * growth) - 1.0).abs() < growth, "{}", cell.stress);
    }
}

/// Force, stiffness and the force of a step against differences of the energy.
fn derives_from_the_energy<const D: usize>() {
    for (name, _, body) in bodies::<D>() {
        let n = body.node_count();
        let (u, d) = (shaken::<D>(n, 0.03, 0.3), shaken::<D>(n, 1.0, 1.7));
        let grown = body.after(&[]).grown(GROWTH);
        let force = |u: &[Vector<D>]| {
            let mut f = vec![Vector::zeros(); u.len()];
            grown.internal_force(u, &mut f);
            f
        };
        let moved = |s: f64| -> Vec<_> { u.iter().zip(&d).map(|(u, d)| u + d * s).collect() };
        let (plus, minus) = (moved(1e-6), moved(-1e-6));
        let numeric = (grown.strain_energy(&plus) - grown.strain_energy(&minus)) / 2e-6;
        let power = dot(&force(&u), &d);
        assert!((numeric - power).abs() < 1e-6 * body.volume() * 2700.0, "{name}: {numeric} {power}");
        let mut product = vec![Vector::zeros(); n];
        grown.stiffness(&u).multiply(&d, &mut product);
        let size = product.iter().map(Vector::norm).fold(0.0, f64::max);
        for ((p, m), k) in force(&plus).iter().zip(force(&minus)).zip(&product) {
            let error = ((p - m) / 2e-6 - k).norm();
            assert!(error < 1e-6 * size, "{name}: {error} of {size}");
        }
        let end = moved(0.02);
        let mut of_step = vec![Vector::zeros(); n];
        grown.conserving_force(&u, &end, &mut of_step);
        let (work, change) = (dot(&of_step, &d) * 0.02, grown.strain_energy(&end) - grown.strain_energy(&u));
        let scale = grown.strain_energy(&end);
        assert!((work - change).abs() < 1e-12 * scale, "{name}: {work} {change}");
    }
}

#[test]
fn forces_and_stiffness_are_derivatives_of_the_energy_of_what_has_grown() {
    derives_from_the_energy::<2>();
    derives_from_the_energy::<3>();
}
