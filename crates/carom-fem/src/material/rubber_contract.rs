//! Laws of rubber and foam against their closed forms in homogeneous deformation.

use super::{
    BlatzKo, ByInvariants, ByStretches, Hyperelastic, Mat3, Material, MooneyRivlin, Ogden, StrainLaw, Yeoh,
};

const STRETCHES: [f64; 5] = [0.6, 0.9, 1.3, 2.0, 3.0];

/// Nominal stress [Pa] along the axes of `free` = 0 that are stretched, with the others free of stress.
fn nominal_stress(law: &impl Material, stretch: f64, biaxial: bool) -> f64 {
    let f = |lateral: f64| {
        let second = if biaxial { stretch } else { lateral };
        Mat3::from_diagonal(&[stretch, second, lateral].into())
    };
    let (mut low, mut high) = (0.05, 5.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if law.stress(&f(middle))[(2, 2)] > 0.0 { high = middle } else { low = middle }
    }
    law.stress(&f(0.5 * (low + high)))[(0, 0)]
}

/// Treloar 1975: σ₁ − σ₃ of the incompressible laws, per reference area; bulk moduli of 10⁷ shear moduli are nearly so.
#[test]
fn nearly_incompressible_rubber_follows_the_closed_forms_of_uniaxial_and_equibiaxial_tension() {
    let bulk = 1e7;
    let (mu, alpha) = (vec![0.63, 0.0012, -0.01], vec![1.3, 5.0, -2.0]);
    let mooney = MooneyRivlin { c10: 0.4, c01: 0.1, bulk };
    let yeoh = Yeoh { c10: 0.5, c20: -0.01, c30: 0.002, bulk };
    let ogden = Ogden { mu: mu.clone(), alpha: alpha.clone(), bulk };
    let terms = || mu.iter().zip(&alpha);
    for l in STRETCHES {
        let yeoh_slope = |x: f64| 0.5 - 0.02 * x + 0.006 * x * x;
        let expected = [
            2.0 * (l - l.powi(-2)) * (0.4 + 0.1 / l),
            2.0 * (l - l.powi(-2)) * yeoh_slope(l * l + 2.0 / l - 3.0),
            terms().map(|(m, a)| m * (l.powf(a - 1.0) - l.powf(-0.5 * a - 1.0))).sum(),
            2.0 * (l - l.powi(-5)) * (0.4 + 0.1 * l * l),
            2.0 * (l - l.powi(-5)) * yeoh_slope(2.0 * l * l + l.powi(-4) - 3.0),
            terms().map(|(m, a)| m * (l.powf(a - 1.0) - l.powf(-2.0 * a - 1.0))).sum(),
        ];
        let both = |law: &dyn Fn(bool) -> f64| [law(false), law(true)];
        let [m, mb] = both(&|b| nominal_stress(&Hyperelastic(ByInvariants(mooney)), l, b));
        let [y, yb] = both(&|b| nominal_stress(&Hyperelastic(ByInvariants(yeoh)), l, b));
        let [o, ob] = both(&|b| nominal_stress(&Hyperelastic(ByStretches(ogden.clone())), l, b));
        for (stress, expected) in [m, y, o, mb, yb, ob].into_iter().zip(expected) {
            assert!(
                (stress - expected).abs() < 1e-5 * (1.0 + expected.abs()),
                "λ = {l}: {stress} {expected}"
            );
        }
    }
}

/// Blatz & Ko 1962: foam with ν = ¼ narrows as λ^(−1/4) and bears μ (λ^(−1/2) − λ⁻³).
#[test]
fn foam_follows_the_closed_form_of_uniaxial_tension() {
    let law = Hyperelastic(ByInvariants(BlatzKo { shear: 2.0, poisson: 0.25, fraction: 0.0 }));
    for l in STRETCHES {
        let expected = 2.0 * (l.powf(-0.5) - l.powi(-3));
        assert!((nominal_stress(&law, l, false) - expected).abs() < 1e-9 * (1.0 + expected.abs()));
    }
}

/// Ogden's law with exponents 2 and −2 is Mooney–Rivlin's, also where stretches coincide or nearly do.
#[test]
fn coinciding_stretches_are_handled_smoothly() {
    let ogden = ByStretches(Ogden { mu: vec![0.8, -0.2], alpha: vec![2.0, -2.0], bulk: 3.0 });
    let mooney = ByInvariants(MooneyRivlin { c10: 0.4, c01: 0.1, bulk: 3.0 });
    let turn = nalgebra::Rotation3::from_scaled_axis([0.3, -0.7, 0.4].into()).into_inner();
    for offset in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 5e-6, 2e-5, 1e-4, 1e-2] {
        for values in [
            [1.3, 1.3 * (1.0 + offset), 0.8],
            [1.0, 1.0 + offset, 1.0 - offset],
            [2.0, 2.0, 2.0],
            [0.3, 4.0, 0.3 + offset],
        ] {
            let strains = values.map(|c: f64| 0.5 * (c - 1.0));
            let e = turn * Mat3::from_diagonal(&strains.into()) * turn.transpose();
            assert!((ogden.energy(&e) - mooney.energy(&e)).abs() < 1e-14);
            let ((s, a), (s_exact, exact)) = (ogden.elasticity(&e), mooney.elasticity(&e));
            assert!((s - s_exact).norm() < 1e-14 * s.norm().max(1.0), "{offset:e}");
            for n in 0..81 {
                let [i, j, k, l] = [n / 27, n / 9 % 3, n / 3 % 3, n % 3];
                assert!((a[i][j][k][l] - exact[i][j][k][l]).abs() < 1e-9, "{offset:e}");
            }
        }
    }
}

#[test]
fn constants_out_of_range_are_refused_by_name() {
    let name = |error: crate::FemError| error.to_string().split(' ').next().unwrap_or_default().to_string();
    let mooney = MooneyRivlin { c10: 1.0, c01: -1.5, bulk: 1.0 };
    assert_eq!(name(mooney.checked().expect_err("μ < 0")), "c01");
    let yeoh = Yeoh { c10: 1.0, c20: 0.0, c30: 0.0, bulk: 0.0 };
    assert_eq!(name(yeoh.checked().expect_err("κ = 0")), "bulk");
    for (mu, alpha) in [(vec![], vec![]), (vec![1.0], vec![]), (vec![1.0], vec![0.0])] {
        assert_eq!(name(Ogden { mu, alpha, bulk: 1.0 }.checked().expect_err("terms")), "alpha");
    }
    let soft = Ogden { mu: vec![-1.0], alpha: vec![2.0], bulk: 1.0 };
    assert_eq!(name(soft.checked().expect_err("μ < 0")), "mu");
    let foam = BlatzKo { shear: 1.0, poisson: 0.5, fraction: 0.0 };
    assert_eq!(name(foam.checked().expect_err("ν = ½")), "poisson");
    let foam = BlatzKo { shear: 1.0, poisson: 0.25, fraction: 1.5 };
    assert_eq!(name(foam.checked().expect_err("f > 1")), "fraction");
}
