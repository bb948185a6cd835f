//! Bodies of revolution: what they weigh, and exact solutions in them.

use std::f64::consts::PI;

use carom_fem::material::LawSpec;
use carom_fem::{Body, BodySpec, FemError, Formulation, Hypothesis, MassKind};
use carom_mesh::{CellKind, Surface, Vector};

use crate::common::{PLANE, distortion, elastic, equilibrium, grid, spec};

fn of_revolution(law: LawSpec) -> BodySpec {
    BodySpec { hypothesis: Hypothesis::Axisymmetric, thickness: 7.0, ..spec(law) }
}

/// A cylinder of radius 1 and height 1; the thickness is not used.
#[test]
fn volume_mass_and_areas_are_those_of_the_whole_cylinder() {
    for kind in PLANE {
        for mass in [MassKind::Consistent, MassKind::Lumped] {
            let spec = BodySpec { mass, ..of_revolution(LawSpec::NeoHookean(elastic())) };
            let body = Body::new(grid::<2>(kind, 2, |x| x), &spec).expect("valid");
            assert!((body.volume() - PI).abs() < 1e-14, "{kind:?}");
            assert!((body.total_mass() - 1.5 * PI).abs() < 1e-14, "{kind:?}");
            let light = body.nodal_mass().iter().any(|&m| m <= 0.0);
            assert!(mass == MassKind::Consistent || !light, "{kind:?}");
            let area: f64 = body.surface().facets().iter().map(|f| body.facet_area(f)).sum();
            // The side, both ends, and nothing along the axis.
            assert!((area - 4.0 * PI).abs() < 1e-13, "{kind:?}: {area}");
            let centre = body.centre(&vec![Vector::zeros(); body.node_count()]);
            let lumped = mass == MassKind::Lumped && kind.is_quadratic();
            assert!(lumped || (centre - Vector::<2>::new(0.0, 0.5)).norm() < 1e-14, "{kind:?}: {centre}");
            assert_eq!(body.axis_nodes().len(), if kind.is_quadratic() { 5 } else { 3 });
        }
    }
}

/// u = εX is the same stretch in all directions, also on the axis: a hydrostatic state without forces inside.
#[test]
fn a_swollen_cylinder_is_in_equilibrium_and_under_the_same_stress_everywhere() {
    for kind in PLANE {
        for formulation in [Formulation::Standard, Formulation::MeanDilatation] {
            if formulation == Formulation::MeanDilatation && kind != CellKind::Quad4 {
                continue;
            }
            let spec = BodySpec { formulation, ..of_revolution(LawSpec::NeoHookean(elastic())) };
            let body = Body::new(grid::<2>(kind, 3, distortion), &spec).expect("valid");
            let u: Vec<Vector<2>> = body.mesh().nodes().iter().map(|x| x * 0.1).collect();
            let mut f = vec![Vector::zeros(); u.len()];
            body.internal_force(&u, &mut f);
            for (f, x) in f.iter().zip(body.mesh().nodes()) {
                let inside = x[0] < 1.0 - 1e-9 && x[1] > 1e-9 && x[1] < 1.0 - 1e-9;
                assert!(!inside || f.norm() < 1e-11, "{kind:?} {formulation:?} at {x}: {f}");
            }
            let (lambda, mu) = elastic().lame().expect("valid");
            let j = 1.1_f64.powi(3);
            let pressure = (mu * (1.21 - 1.0) + lambda * j.ln()) / j;
            for state in body.cell_states(&u) {
                assert!((state.stress - nalgebra::Matrix3::identity() * pressure).norm() < 1e-10, "{kind:?}");
            }
        }
    }
}

/// Lamé's thick-walled tube in plane strain: u(r) = (1 + ν)/E · p a²/(b² − a²) · [(1 − 2ν) r + b²/r] (Timoshenko & Goodier,
/// *Theory of Elasticity*, § 28).
#[test]
fn a_tube_under_pressure_swells_as_lame_found() {
    let (a, b, p, c) = (1.0, 2.0, 10.0, elastic());
    let exact = |r: f64| {
        (1.0 + c.poisson) / c.young * p * a * a / (b * b - a * a) * ((1.0 - 2.0 * c.poisson) * r + b * b / r)
    };
    for kind in PLANE {
        let error = |divisions: usize| {
            let mesh = grid::<2>(kind, divisions, |x| x + Vector::<2>::new(a, 0.0));
            let body = Body::new(mesh, &of_revolution(LawSpec::LinearElastic(c))).expect("valid");
            let nodes = body.mesh().nodes();
            let mut load = vec![Vector::<2>::zeros(); nodes.len()];
            for facet in Surface::of(body.mesh()).facets() {
                if facet.nodes.iter().all(|&n| nodes[n as usize][0] < a + 1e-9) {
                    let shares: &[f64] =
                        if facet.nodes.len() == 2 { &[0.5; 2] } else { &[1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0] };
                    for (&n, share) in facet.nodes.iter().zip(shares) {
                        load[n as usize][0] += share * p * body.facet_area(facet);
                    }
                }
            }
            let mut u = vec![Vector::zeros(); nodes.len()];
            equilibrium(&body, &load, |_, component| component == 1, &mut u);
            let errors = nodes.iter().zip(&u).map(|(x, u)| (u[0] / exact(x[0]) - 1.0).abs());
            errors.fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(8), error(16));
        let rate = (coarse / fine).log2();
        println!(
            "{:>6}: largest error of u_r {coarse:.2e}, {fine:.2e}, rate {rate:.2}",
            kind.reference().name
        );
        let (limit, least) = if kind.is_quadratic() { (1e-4, 2.8) } else { (4e-3, 1.6) };
        assert!(fine < limit && rate > least, "{kind:?}: {coarse} {fine}");
    }
}

#[test]
fn nodes_on_the_wrong_side_of_the_axis_are_named() {
    let mesh = grid::<2>(CellKind::Quad4, 2, |x| x - Vector::<2>::new(0.4, 0.0));
    let error =
        Body::new(mesh, &of_revolution(LawSpec::NeoHookean(elastic()))).expect_err("left of the axis");
    assert!(matches!(error, FemError::NegativeRadius { node: 0, .. }), "{error}");
    let cube = grid::<3>(CellKind::Hex8, 1, |x| x);
    let error = Body::new(cube, &of_revolution(LawSpec::NeoHookean(elastic()))).expect_err("in space");
    assert!(error.to_string().contains("axisymmetric"), "{error}");
}
