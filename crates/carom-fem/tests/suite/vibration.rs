//! Velocities as a rigid motion and what vibrates.

use carom_fem::material::LawSpec;
use carom_fem::{Body, BodySpec, HeldDof, Momenta, Vibration};
use carom_mesh::{CellKind, Mesh, Vector, nodal};

use crate::common::{PLANE, SPATIAL, distortion, elastic, grid, shaken, spec};

fn body<const D: usize>(mesh: Mesh<D>, massless_contact: bool) -> Body<D> {
    let spec = BodySpec { massless_contact, ..spec(LawSpec::SaintVenantKirchhoff(elastic())) };
    Body::new(mesh, &spec).expect("valid")
}

/// M v [kg m/s] of all nodes.
fn momentum_density<const D: usize>(body: &Body<D>, v: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut mv = vec![Vector::zeros(); v.len()];
    body.multiply_mass(v, &mut mv);
    mv
}

fn momenta<const D: usize>(body: &Body<D>, u: &[Vector<D>], v: &[Vector<D>]) -> Momenta<D> {
    body.momenta(u, v, 0.5 * nodal::dot(v, &momentum_density(body, v)))
}

/// What vibrates has no momenta, and with the rigid motion makes up all the energy there is.
fn check<const D: usize>(kind: CellKind, massless_contact: bool) {
    let body = body(grid::<D>(kind, 3, distortion), massless_contact);
    let nodes = body.node_count();
    let (u, v) = (shaken::<D>(nodes, 0.05, 0.3), shaken::<D>(nodes, 2.0, 0.7));
    let mut vibration = Vibration::<D>::default();
    let energy = vibration.measure(&body, &u, &v);
    let own = momenta(&body, &u, &v);
    let mv = momentum_density(&body, &v);
    assert!((own.momentum - nodal::total(&mv)).norm() < 1e-13 * own.momentum.norm(), "{kind:?}");
    let about_origin = body.angular_momentum(&u, &mv);
    let bound = 1e-13 * Vector::from(about_origin).norm();
    assert!((0..3).all(|i| (own.angular_momentum[i] - about_origin[i]).abs() < bound), "{kind:?}");
    assert!(energy > 0.01 * own.kinetic.translation, "{kind:?}: nothing vibrates");
    assert!((energy - own.kinetic.vibration).abs() < 1e-13 * energy, "{kind:?}");
    let rest = momenta(&body, &u, &vibration.field);
    let size: f64 = vibration.momentum.iter().map(|p| p.norm()).sum();
    let reach = body.mesh().diameter();
    assert!(rest.momentum.norm() < 1e-14 * size, "{kind:?}: {:e}", rest.momentum.norm() / size);
    assert!(rest.angular_momentum.iter().all(|l| l.abs() < 1e-13 * size * reach), "{kind:?}");
    assert!(body.massless().iter().all(|&n| vibration.field[n as usize] == Vector::<D>::zeros()));
}

#[test]
fn what_vibrates_has_no_momentum_and_no_angular_momentum() {
    for massless in [false, true] {
        PLANE.iter().for_each(|&kind| check::<2>(kind, massless));
        SPATIAL.iter().for_each(|&kind| check::<3>(kind, massless));
    }
}

/// A wall takes what comes its way; along it the body goes on as it did.
#[test]
fn of_a_held_body_only_what_supports_leave_free_is_no_vibration() {
    let mut body = body(grid::<2>(CellKind::Quad4, 4, distortion), false);
    body.hold([HeldDof { node: 0, component: 1 }]);
    let nodes = body.node_count();
    let (u, mut v) = (vec![Vector::<2>::zeros(); nodes], shaken::<2>(nodes, 2.0, 0.7));
    v[0][1] = 0.0;
    let mut vibration = Vibration::<2>::default();
    let energy = vibration.measure(&body, &u, &v);
    let along = nodal::total(&vibration.momentum)[0];
    assert!(along.abs() < 1e-14 * body.total_mass());
    assert_eq!(vibration.field[0][1], 0.0);
    let whole = momenta(&body, &u, &v);
    let all = whole.kinetic.translation + whole.kinetic.rotation + whole.kinetic.vibration;
    let drift = 0.5 * whole.momentum[0].powi(2) / body.total_mass();
    assert!((energy + drift - all).abs() < 1e-13 * all);
    v[0][1] = 1.0;
    assert_eq!(vibration.measure(&body, &u, &v), 0.0, "a support that moves does work");
    // Nothing is left of what vibrated before the support moved: a share of it would be energy from nowhere.
    assert!(vibration.field.iter().all(|w| *w == Vector::<2>::zeros()));
    assert!(vibration.momentum.iter().all(|p| *p == Vector::<2>::zeros()));
}
