//! Cook's membrane near incompressibility (Cook 1974; in plane strain with ν = 0.4999 by many authors since): a tapered panel of
//! E = 250 Pa and 1 m thick, clamped on the left and sheared by a force on the right. The law is one of large strain, under a
//! force of 1 N that makes them small.
//!
//! The reference is our own solution on a fine quad9 mesh, with which that on fine tri6 meshes agrees.

use carom_fem::material::{ElasticConstants, LawSpec};
use carom_fem::{Body, BodySpec, Formulation};
use carom_mesh::{CellKind, Surface, Vector};

use crate::common::{equilibrium, grid, spec};

/// On the right side, upward [N].
const FORCE: f64 = 1.0;
const CONSTANTS: ElasticConstants = ElasticConstants { young: 250.0, poisson: 0.4999 };

/// Deflection [m] of the upper right corner on a mesh of `divisions`² quadrilaterals, or twice as many triangles.
fn deflection(kind: CellKind, divisions: usize, formulation: Formulation) -> f64 {
    // From the unit square to (0, 0), (48, 44), (48, 60), (0, 44).
    let tapered = |x: Vector<2>| {
        Vector::<2>::new(48.0 * x[0], 44.0 * x[0] + x[1] * (44.0 * (1.0 - x[0]) + 16.0 * x[0]))
    };
    let body = BodySpec { formulation, ..spec(LawSpec::NeoHookean(CONSTANTS)) };
    let body = Body::new(grid::<2>(kind, divisions, tapered), &body).expect("valid");
    let nodes = body.mesh().nodes();
    let mut load = vec![Vector::<2>::zeros(); nodes.len()];
    for facet in Surface::of(body.mesh()).facets() {
        if facet.nodes.iter().all(|&n| nodes[n as usize][0] > 48.0 - 1e-9) {
            let shares: &[f64] =
                if facet.nodes.len() == 2 { &[0.5; 2] } else { &[1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0] };
            for (&n, share) in facet.nodes.iter().zip(shares) {
                load[n as usize][1] += share * FORCE / divisions as f64;
            }
        }
    }
    let mut u = vec![Vector::zeros(); nodes.len()];
    equilibrium(&body, &load, |n, _| nodes[n][0] < 1e-9, &mut u);
    let corner =
        nodes.iter().position(|x| (x - Vector::<2>::new(48.0, 60.0)).norm() < 1e-9).expect("a corner");
    println!("{:>6} {divisions:>3} {formulation:?}: {:.6} m", kind.reference().name, u[corner][1]);
    u[corner][1]
}

#[test]
fn cooks_membrane_locks_in_bilinear_cells_only() {
    let standard = Formulation::Standard;
    let reference = deflection(CellKind::Quad9, 32, standard);
    assert!((deflection(CellKind::Tri6, 32, standard) / reference - 1.0).abs() < 2e-3);
    let error =
        |kind, divisions, formulation| (deflection(kind, divisions, formulation) / reference - 1.0).abs();
    assert!(error(CellKind::Quad4, 16, standard) > 0.3);
    let [coarse, fine] = [8, 16].map(|n| error(CellKind::Quad4, n, Formulation::MeanDilatation));
    assert!(fine < 0.02 && fine < 0.5 * coarse, "{coarse} {fine}");
    for kind in [CellKind::Tri6, CellKind::Quad8, CellKind::Quad9] {
        let [coarse, fine] = [8, 16].map(|n| error(kind, n, standard));
        assert!(fine < 0.025 && fine < 0.6 * coarse, "{kind:?}: {coarse} {fine}");
    }
}
