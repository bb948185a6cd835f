//! What every law must satisfy. A new law is proved by its line in `laws`.

use proptest::prelude::*;

use super::{ElasticConstants, LinearElastic, Mat3, Material, NeoHookean, SaintVenantKirchhoff};

fn laws() -> Vec<Box<dyn Material>> {
    let constants = ElasticConstants { young: 2700.0, poisson: 0.33 };
    vec![
        Box::new(SaintVenantKirchhoff::new(&constants).expect("valid")),
        Box::new(LinearElastic::new(&constants).expect("valid")),
        Box::new(NeoHookean::new(&constants).expect("valid")),
    ]
}

/// Natural size of stresses in the laws above [Pa].
const SCALE: f64 = 2700.0;

fn deformation() -> impl Strategy<Value = Mat3> {
    proptest::array::uniform9(-0.2..0.2).prop_map(|e| Mat3::identity() + Mat3::from_row_slice(&e))
}

fn rotation(axis_angle: [f64; 3]) -> Mat3 {
    nalgebra::Rotation3::from_scaled_axis(nalgebra::Vector3::from(axis_angle)).into_inner()
}

proptest! {
    #[test]
    fn stress_is_the_derivative_of_energy(f in deformation()) {
        let h = 1e-5;
        for law in laws() {
            let stress = law.stress(&f);
            for i in 0..3 {
                for j in 0..3 {
                    let (mut p, mut m) = (f, f);
                    p[(i, j)] += h;
                    m[(i, j)] -= h;
                    let numeric = (law.energy(&p) - law.energy(&m)) / (2.0 * h);
                    prop_assert!((stress[(i, j)] - numeric).abs() < 1e-6 * SCALE, "{law:?}");
                }
            }
        }
    }

    #[test]
    fn tangent_is_the_derivative_of_stress(f in deformation()) {
        let h = 1e-5;
        for law in laws() {
            let (stress, tangent) = law.stress_and_tangent(&f);
            prop_assert!((stress - law.stress(&f)).norm() < 1e-12 * SCALE);
            for k in 0..3 {
                for l in 0..3 {
                    let (mut p, mut m) = (f, f);
                    p[(k, l)] += h;
                    m[(k, l)] -= h;
                    let numeric = (law.stress(&p) - law.stress(&m)) / (2.0 * h);
                    for i in 0..3 {
                        for j in 0..3 {
                            prop_assert!((tangent[i][j][k][l] - numeric[(i, j)]).abs() < 1e-6 * SCALE, "{law:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn discrete_stress_does_the_work_of_the_step_and_keeps_its_moment(
        f0 in deformation(),
        step in proptest::array::uniform9(-1.0..1.0),
        size in prop_oneof![Just(1e-1), Just(1e-3), Just(1e-5), Just(1e-7), Just(0.0)],
    ) {
        let change = Mat3::from_row_slice(&step) * size;
        let f1 = f0 + change;
        for law in laws() {
            let stress = law.discrete_stress(&f0, &f1);
            let work = law.energy(&f1) - law.energy(&f0);
            prop_assert!((stress.dot(&change) - work).abs() < 1e-12 * SCALE, "{law:?}");
            let middle = (f0 + f1) * 0.5;
            prop_assert!((stress - law.stress(&middle)).norm() < SCALE * (1e-9 + 10.0 * size * size), "{law:?}");
            if law.is_objective() {
                let moment = stress * middle.transpose();
                prop_assert!((moment - moment.transpose()).norm() < 1e-11 * SCALE, "{law:?}");
            }
        }
    }

    #[test]
    fn a_rotation_of_the_body_turns_the_stress_and_keeps_the_energy(
        f in deformation(),
        q in proptest::array::uniform3(-2.0..2.0),
    ) {
        let q = rotation(q);
        for law in laws().into_iter().filter(|law| law.is_objective()) {
            prop_assert!((law.energy(&(q * f)) - law.energy(&f)).abs() < 1e-12 * SCALE, "{law:?}");
            prop_assert!((law.stress(&(q * f)) - q * law.stress(&f)).norm() < 1e-11 * SCALE, "{law:?}");
        }
    }

    #[test]
    fn an_isotropic_law_does_not_see_how_the_reference_is_turned(
        f in deformation(),
        q in proptest::array::uniform3(-2.0..2.0),
    ) {
        let q = rotation(q);
        for law in laws().into_iter().filter(|law| law.is_objective()) {
            prop_assert!((law.energy(&(f * q)) - law.energy(&f)).abs() < 1e-12 * SCALE, "{law:?}");
        }
    }
}

proptest! {
    /// Symptom guarded against: a mean stretch by eigenvectors lost digits near the reference, and 3D runs did not converge.
    #[test]
    fn discrete_stress_of_a_step_that_goes_nowhere_is_the_stress(
        e in proptest::array::uniform9(-1.0..1.0),
        exponent in -8.0..-1.0,
    ) {
        let f = Mat3::identity() + Mat3::from_row_slice(&e) * 10_f64.powf(exponent);
        for law in laws() {
            let error = (law.discrete_stress(&f, &f) - law.stress(&f)).norm();
            prop_assert!(error < 1e-14 * SCALE, "{law:?}: {error:e}");
        }
    }
}

#[test]
fn the_reference_is_free_of_energy_and_stress() {
    for law in laws() {
        assert!(law.energy(&Mat3::identity()).abs() < 1e-15);
        assert!(law.stress(&Mat3::identity()).norm() < 1e-12);
    }
}

/// Small uniaxial strain: P-wave modulus λ + 2μ = E(1−ν)/((1+ν)(1−2ν)).
#[test]
fn all_laws_agree_with_linear_elasticity_at_small_strain() {
    let strain = 1e-6;
    let modulus = 2700.0 * (1.0 - 0.33) / ((1.0 + 0.33) * (1.0 - 2.0 * 0.33));
    let mut f = Mat3::identity();
    f[(0, 0)] += strain;
    for law in laws() {
        assert!((law.stress(&f)[(0, 0)] / strain / modulus - 1.0).abs() < 1e-5, "{law:?}");
    }
}
