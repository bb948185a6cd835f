//! Initial stress: what it has stored comes out as it is released, and damping does not see it.

use carom_fem::material::{ElasticConstants, LawSpec, Mat3};
use carom_fem::{Body, BodySpec, RayleighDamping};
use carom_mesh::{CellKind, Matrix, Vector};

use crate::common::{elastic, grid, spec};

const STRESS: f64 = 27.0;

fn pulled(law: LawSpec) -> BodySpec {
    let mut initial_stress = Mat3::zeros();
    initial_stress[(0, 0)] = STRESS;
    BodySpec { initial_stress, ..spec(law) }
}

fn force_and_energy<const D: usize>(body: &Body<D>, u: &[Vector<D>]) -> (Vec<Vector<D>>, f64) {
    let mut force = vec![Vector::zeros(); u.len()];
    let energy = body.after(&[]).internal_force_and_energy(u, &mut force);
    (force, energy)
}

/// A bar pulled by S₁₁ = E·E₁₁ has E₂₂ = E₃₃ = −ν E₁₁ (Saint-Venant–Kirchhoff): where these strains are taken back it is free of stress, and so
/// of energy. As it is drawn it has stored S₁₁²/2E, and pulls with S₁₁.
#[test]
fn a_bar_that_is_let_go_gives_back_what_its_initial_stress_has_stored() {
    let ElasticConstants { young, poisson } = elastic();
    let body =
        Body::<3>::new(grid(CellKind::Hex8, 2, |x| x), &pulled(LawSpec::SaintVenantKirchhoff(elastic())))
            .expect("valid");
    let strain = -STRESS / young;
    let stretch = |strain: f64| (1.0 + 2.0 * strain).sqrt() - 1.0;
    let change = Vector::<3>::new(stretch(strain), stretch(-poisson * strain), stretch(-poisson * strain));
    let free: Vec<_> = body.mesh().nodes().iter().map(|x| x.component_mul(&change)).collect();
    let (force, energy) = force_and_energy(&body, &free);
    assert!(force.iter().all(|f| f.norm() < 1e-13 * STRESS));
    assert!(energy.abs() < 1e-15 * young, "{energy:e}");
    let (force, energy) = force_and_energy(&body, &vec![Vector::zeros(); free.len()]);
    let stored = STRESS * STRESS / (2.0 * young);
    assert!((energy - stored).abs() < 1e-14 * stored, "{energy} {stored}");
    let pull: f64 =
        force.iter().zip(body.mesh().nodes()).filter(|(_, x)| x[0] > 0.5).map(|(f, _)| f[0]).sum();
    // The middle nodes of two cells see nothing of a uniform stress.
    assert!((pull - STRESS).abs() < 1e-13 * STRESS, "{pull}");
    let state = body.after(&[]).cell_states(&vec![Vector::zeros(); free.len()]);
    assert!(state.iter().all(|cell| (cell.stress[(0, 0)] - STRESS).abs() < 1e-13 * STRESS));
}

/// A slow turn of a body under stress is no strain: Rayleigh's damping takes nothing from it.
#[test]
fn damping_by_stiffness_takes_nothing_from_the_turn_of_a_body_under_initial_stress() {
    let damping = RayleighDamping { mass: 0.0, stiffness: 1e-3 };
    let spec = BodySpec { damping, ..pulled(LawSpec::NeoHookean(elastic())) };
    let body = Body::<2>::new(grid(CellKind::Quad4, 2, |x| x), &spec).expect("valid");
    let spin: Vec<_> = body.mesh().nodes().iter().map(|x| Vector::<2>::new(-x[1], x[0])).collect();
    let (mut force, mut scratch) = (spin.clone(), spin.clone());
    body.damping_force(&Matrix::identity(), &spin, &mut force, &mut scratch);
    assert!(force.iter().all(|f| f.norm() < 1e-13 * 2.7), "{force:?}");
}
