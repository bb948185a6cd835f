//! Finite-strain plasticity against its definitions and closed forms.

use super::{ElasticConstants, Flow, J2Plasticity, Mat3, Material, PlasticState};

const YOUNG: f64 = 117e3;
const POISSON: f64 = 0.35;
const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));

fn metal() -> J2Plasticity {
    J2Plasticity {
        elastic: ElasticConstants { young: YOUNG, poisson: POISSON },
        yield_stress: 400.0,
        hardening: 100.0,
        saturation_stress: Some(550.0),
        saturation_rate: 12.0,
    }
}

fn law() -> Flow {
    metal().checked().expect("valid")
}

/// A deformation gradient from nine numbers.
fn gradient(size: f64, seed: usize) -> Mat3 {
    Mat3::identity() + Mat3::from_fn(|i, j| size * ((seed * 9 + 3 * i + j) as f64 * 1.7 + 0.3).sin())
}

/// A point that has flowed under several steps, and the deformation it stands at.
fn with_history(seed: usize) -> (PlasticState, Mat3) {
    let law = law();
    let mut state = PlasticState::default();
    let mut f = Mat3::identity();
    for step in 0..4 {
        f = gradient(0.15, seed + step);
        state = law.update(&state, &f).0;
    }
    (state, f)
}

/// √(3/2) |dev τ| of a law's stress at F.
fn equivalent_stress(law: &impl Material, f: &Mat3) -> f64 {
    let kirchhoff = law.stress(f) * f.transpose();
    let deviator = kirchhoff - Mat3::from_diagonal_element(kirchhoff.trace() / 3.0);
    1.5_f64.sqrt() * deviator.norm()
}

/// Steps from a with_history point: large flow, a small one, and elastic ones.
fn steps() -> Vec<(PlasticState, Mat3, Mat3)> {
    let mut all = Vec::new();
    for seed in 0..6 {
        let (state, f0) = with_history(seed);
        for size in [0.2, 1e-2, 1e-3, 1e-4] {
            all.push((state, f0, f0 + (gradient(size, seed + 11) - Mat3::identity())));
        }
    }
    all
}

#[test]
fn within_a_step_stress_and_tangent_are_derivatives_of_the_work_of_the_step() {
    let h = 1e-7;
    let (mut flowing, mut elastic) = (0, 0);
    for (state, _, f) in steps() {
        let law_of_step = law().after(&state);
        // Finite differences across the onset of flow mean nothing.
        let near = |f: &Mat3| law().update(&state, f).0.equivalent_strain > state.equivalent_strain;
        let nudged = |i, j, h| {
            let mut f = f;
            f[(i, j)] += h;
            f
        };
        let here = near(&f);
        if (0..9).any(|n| near(&nudged(n / 3, n % 3, h)) != here || near(&nudged(n / 3, n % 3, -h)) != here) {
            continue;
        }
        if here {
            flowing += 1
        } else {
            elastic += 1
        }
        let (stress, tangent) = law_of_step.stress_and_tangent(&f);
        for k in 0..3 {
            for l in 0..3 {
                let (plus, minus) = (nudged(k, l, h), nudged(k, l, -h));
                let slope = (law_of_step.energy(&plus) - law_of_step.energy(&minus)) / (2.0 * h);
                assert!((stress[(k, l)] - slope).abs() < 1e-7 * SHEAR, "{} {slope}", stress[(k, l)]);
                let slope = (law_of_step.stress(&plus) - law_of_step.stress(&minus)) / (2.0 * h);
                for i in 0..3 {
                    for j in 0..3 {
                        let a = tangent[i][j][k][l];
                        assert!((a - slope[(i, j)]).abs() < 2e-6 * SHEAR, "{a} {}", slope[(i, j)]);
                    }
                }
            }
        }
    }
    assert!(flowing >= 8 && elastic >= 3, "{flowing} {elastic}");
}

#[test]
fn the_discrete_stress_does_the_work_that_is_stored_or_dissipated() {
    for (state, f0, f1) in steps() {
        let law = law();
        let stress = law.after(&state).discrete_stress(&f0, &f1);
        let (next, plastic_work) = law.update(&state, &f1);
        // Nothing flows at the end of a step that has been taken.
        let stored = |state: &PlasticState, f: &Mat3| {
            assert!(law.update(state, f).1 == 0.0);
            law.after(state).energy(f)
        };
        let work = stored(&next, &f1) - stored(&state, &f0) + plastic_work;
        assert!(plastic_work >= 0.0);
        assert!((stress.dot(&(f1 - f0)) - work).abs() < 1e-10 * (work.abs() + 1.0));
        let moment = stress * (f0 + f1).transpose();
        assert!((moment - moment.transpose()).norm() < 1e-11 * SHEAR);
    }
}

#[test]
fn a_rotation_of_the_body_turns_the_stress_and_changes_nothing_that_is_remembered() {
    let turn = nalgebra::Rotation3::from_scaled_axis([0.8, -0.3, 1.1].into()).into_inner();
    for (state, _, f) in steps() {
        let (still, turned) = (law().update(&state, &f), law().update(&state, &(turn * f)));
        assert!((still.0.inverse_strain - turned.0.inverse_strain).norm() < 1e-12);
        assert!((still.1 - turned.1).abs() < 1e-9);
        let law = law().after(&state);
        assert!((law.stress(&(turn * f)) - turn * law.stress(&f)).norm() < 1e-10 * SHEAR);
    }
}

#[test]
fn flow_keeps_the_volume_and_ends_on_the_yield_surface() {
    for (state, _, f) in steps() {
        let (next, _) = law().update(&state, &f);
        assert!((next.inverse_strain.determinant() - 1.0).abs() < 1e-12);
        let (bearable, stress) =
            (law().yield_stress(next.equivalent_strain), equivalent_stress(&law().after(&state), &f));
        if next.equivalent_strain > state.equivalent_strain {
            assert!((stress / bearable - 1.0).abs() < 1e-10, "{stress} {bearable}");
        } else {
            assert!(stress <= bearable * (1.0 + 1e-12));
        }
    }
}

/// The lateral stretch at which a bar bears nothing across.
fn bar(law: &Flow, state: &PlasticState, stretch: f64) -> Mat3 {
    let f = |lateral: f64| Mat3::from_diagonal(&[stretch, lateral, lateral].into());
    let law = law.after(state);
    let (mut low, mut high) = (0.2, 3.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if law.stress(&f(middle))[(1, 1)] > 0.0 { high = middle } else { low = middle }
    }
    f(0.5 * (low + high))
}

/// In a bar under tension τ = E (ln λ − α) and, while it flows, τ = σ_y(α): whatever the steps, to 100 % strain.
#[test]
fn a_bar_in_tension_follows_its_hardening_curve_and_unloads_elastically() {
    let law = law();
    for steps in [1, 7, 40] {
        let mut state = PlasticState::default();
        let mut plastic_work = 0.0;
        let mut f = Mat3::identity();
        for step in 1..=steps {
            f = bar(&law, &state, (f64::from(step) / f64::from(steps)).exp());
            let (next, work) = law.update(&state, &f);
            state = next;
            plastic_work += work;
        }
        let alpha = state.equivalent_strain;
        let stress = law.yield_stress(alpha);
        assert!((alpha + stress / YOUNG - 1.0).abs() < 1e-9, "{alpha}");
        let axial = (law.after(&state).stress(&f) * f.transpose())[(0, 0)];
        assert!((axial / stress - 1.0).abs() < 1e-7, "{axial} {stress}");
        // ∫₀^α σ_y.
        let exact =
            400.0 * alpha + 50.0 * alpha * alpha + 150.0 * (alpha - (1.0 - (-12.0 * alpha).exp()) / 12.0);
        assert!((plastic_work / exact - 1.0).abs() < 1e-12);
        let unloaded = bar(&law, &state, alpha.exp());
        assert!(law.update(&state, &unloaded).1 == 0.0);
        assert!(law.after(&state).stress(&unloaded).norm() < 1e-6 * SHEAR);
    }
}

#[test]
fn what_stays_below_the_yield_stress_leaves_no_trace() {
    let mut state = PlasticState::default();
    for seed in 0..20 {
        let (next, work) = law().update(&state, &gradient(8e-4, seed));
        assert!(work == 0.0 && next == state);
        state = next;
    }
    assert!(law().after(&state).stress(&Mat3::identity()).norm() == 0.0);
}

#[test]
fn constants_that_would_soften_are_refused_by_name() {
    let name = |law: J2Plasticity| {
        law.checked().expect_err("out of range").to_string().split(' ').next().unwrap_or_default().to_string()
    };
    assert_eq!(name(J2Plasticity { yield_stress: 0.0, ..metal() }), "yield_stress");
    assert_eq!(name(J2Plasticity { hardening: -1.0, ..metal() }), "hardening");
    assert_eq!(name(J2Plasticity { saturation_stress: Some(300.0), ..metal() }), "saturation_stress");
    assert_eq!(name(J2Plasticity { saturation_rate: f64::NAN, ..metal() }), "saturation_rate");
    let elastic = ElasticConstants { young: -1.0, poisson: 0.3 };
    assert_eq!(name(J2Plasticity { elastic, ..metal() }), "young");
}
