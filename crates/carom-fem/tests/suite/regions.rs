//! Bodies of several materials: their regions share nodes, and each has its own law, density and damping.

use carom_fem::material::{ElasticConstants, J2Plasticity, LawSpec, Viscosity};
use carom_fem::{Body, BodySpec, FemError, RayleighDamping, RegionSpec};
use carom_mesh::{CellKind, Matrix, Mesh, Vector};

use crate::common::{PLANE, SPATIAL, distortion, grid, spec};

const SOFT: ElasticConstants = ElasticConstants { young: 2700.0, poisson: 0.33 };
const STIFF: ElasticConstants = ElasticConstants { young: 9100.0, poisson: 0.21 };

/// λ + 2μ and μ [Pa].
fn moduli(constants: ElasticConstants) -> [f64; 2] {
    let ElasticConstants { young, poisson } = constants;
    let shear = 0.5 * young / (1.0 + poisson);
    [young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), shear]
}

/// Distorted cells that meet at x = ½.
fn halves<const D: usize>(kind: CellKind) -> Mesh<D> {
    grid::<D>(kind, 4, |x| if (x[0] - 0.5).abs() < 1e-9 { x } else { distortion(x) })
}

/// The cells whose nodes are at x ≥ ½.
fn right<const D: usize>(mesh: &Mesh<D>) -> Vec<u32> {
    let cells = mesh.blocks().iter().flat_map(|block| block.cells());
    let beyond = |cell: &[u32]| cell.iter().all(|&n| mesh.nodes()[n as usize][0] > 0.5 - 1e-9);
    (0..).zip(cells).filter(|(_, cell)| beyond(cell)).map(|(number, _)| number).collect()
}

fn region(cells: Vec<u32>, law: LawSpec, density: f64) -> RegionSpec {
    let (damping, viscosity) = (RayleighDamping::default(), Viscosity::default());
    RegionSpec { cells, law, density, damping, viscosity }
}

fn two<const D: usize>(mesh: &Mesh<D>, law: fn(ElasticConstants) -> LawSpec) -> BodySpec {
    BodySpec { regions: vec![region(right(mesh), law(STIFF), 7.0)], ..spec(law(SOFT)) }
}

/// Stretched and sheared along x, each material by as much as has the stresses of the other: all inner nodes are in balance, those
/// between the two as well.
#[test]
fn every_cell_passes_the_patch_test_through_two_materials() {
    fn check<const D: usize>(kind: CellKind, law: fn(ElasticConstants) -> LawSpec, gradients: [[f64; 2]; 2]) {
        let mesh = halves::<D>(kind);
        let is_right: Vec<u32> = right(&mesh);
        let body = Body::new(mesh.clone(), &two(&mesh, law)).expect("valid");
        let move_of = |x: &Vector<D>| {
            let [stretch, shear] = gradients[usize::from(x[0] > 0.5)];
            let mut u = Vector::<D>::zeros();
            (u[0], u[1]) = (stretch * (x[0] - 0.5), shear * (x[0] - 0.5));
            u
        };
        let u: Vec<Vector<D>> = body.mesh().nodes().iter().map(move_of).collect();
        let mut f = vec![Vector::zeros(); u.len()];
        body.internal_force(&u, &mut f);
        let scale = moduli(SOFT)[0] * gradients[0][0];
        for (force, x) in f.iter().zip(body.mesh().nodes()) {
            if x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9) {
                assert!(force.norm() < 1e-13 * scale, "{kind:?}: {} of {scale} N", force.norm());
            }
        }
        let states = body.cell_states(&u);
        for (cell, state) in states.iter().enumerate() {
            let [stretch, shear] = gradients[usize::from(is_right.contains(&(cell as u32)))];
            let strain = stretch + 0.5 * (stretch * stretch + shear * shear);
            assert!((state.strain[(0, 0)] - strain).abs() < 1e-12, "{kind:?}: cell {cell}");
            assert!((state.stress[(0, 0)] - states[0].stress[(0, 0)]).abs() < 1e-10 * scale, "{kind:?}");
        }
    }
    let ([soft, soft_shear], [stiff, stiff_shear]) = (moduli(SOFT), moduli(STIFF));
    let small = [[0.02, 0.03], [0.02 * soft / stiff, 0.03 * soft_shear / stiff_shear]];
    // P = M (e + e²/2)(1 + e) in uniaxial strain.
    let stress = |e: f64| (e + 0.5 * e * e) * (1.0 + e);
    let mut stretch: f64 = 0.1;
    for _ in 0..50 {
        let slope = (1.0 + stretch).powi(2) + stretch + 0.5 * stretch * stretch;
        stretch -= (stress(stretch) - stress(0.1) * soft / stiff) / slope;
    }
    let large = [[0.1, 0.0], [stretch, 0.0]];
    for kind in PLANE {
        check::<2>(kind, LawSpec::LinearElastic, small);
        check::<2>(kind, LawSpec::SaintVenantKirchhoff, large);
    }
    for kind in SPATIAL {
        check::<3>(kind, LawSpec::LinearElastic, small);
        check::<3>(kind, LawSpec::SaintVenantKirchhoff, large);
    }
}

#[test]
fn each_material_has_its_volume_its_mass_and_its_waves() {
    let mesh = halves::<2>(CellKind::Tri3);
    let body = Body::new(mesh.clone(), &two(&mesh, LawSpec::SaintVenantKirchhoff)).expect("valid");
    assert!((body.volume() - 1.0).abs() < 1e-14);
    assert!((body.total_mass() - (0.5 * 1.5 + 0.5 * 7.0)).abs() < 1e-14);
    let [soft, stiff] = body.materials() else { panic!("two materials") };
    assert_eq!([soft.cells, stiff.cells], [16, 16]);
    assert!((soft.volume - 0.5).abs() < 1e-14 && (stiff.mass - 3.5).abs() < 1e-14);
    assert!((soft.wave_speed - (moduli(SOFT)[0] / 1.5).sqrt()).abs() < 1e-12 * soft.wave_speed);
    assert!((stiff.shear_wave_speed - (moduli(STIFF)[1] / 7.0).sqrt()).abs() < 1e-12 * stiff.wave_speed);
    assert_eq!(body.wave_speed(), stiff.wave_speed.min(soft.wave_speed));
    let numbers = body.material_of_cells();
    assert!(right(&mesh).iter().all(|&cell| numbers[cell as usize] == 1));
    assert_eq!(numbers.iter().sum::<usize>(), 16);
}

/// β K₀ of each is the stiffness of a material whose modulus is β times as large.
#[test]
fn each_material_is_damped_by_its_own_stiffness() {
    let mesh = halves::<3>(CellKind::Hex8);
    let mut damped = two(&mesh, LawSpec::LinearElastic);
    damped.damping.stiffness = 3e-3;
    damped.regions[0].damping.stiffness = 5e-4;
    let times = |constants: ElasticConstants, beta: f64| {
        LawSpec::LinearElastic(ElasticConstants { young: beta * constants.young, ..constants })
    };
    let as_stiff =
        BodySpec { regions: vec![region(right(&mesh), times(STIFF, 5e-4), 7.0)], ..spec(times(SOFT, 3e-3)) };
    let (damped, as_stiff) =
        (Body::new(mesh.clone(), &damped).expect("valid"), Body::new(mesh, &as_stiff).expect("valid"));
    let v = crate::common::shaken::<3>(damped.node_count(), 1.0, 0.3);
    let (mut force, mut expected) = (vec![Vector::zeros(); v.len()], vec![Vector::zeros(); v.len()]);
    let mut scratch = expected.clone();
    damped.damping_force(&Matrix::identity(), &v, &mut force, &mut scratch);
    as_stiff.internal_force(&v, &mut expected);
    let largest = expected.iter().map(|f| f.norm()).fold(0.0, f64::max);
    assert!(force.iter().zip(&expected).all(|(f, e)| (f - e).norm() < 1e-13 * largest));
}

#[test]
fn only_the_region_that_flows_remembers_a_plastic_strain() {
    let mesh = halves::<2>(CellKind::Quad4);
    let metal = J2Plasticity {
        elastic: SOFT,
        yield_stress: 10.0,
        hardening: 0.0,
        saturation_stress: None,
        saturation_rate: 0.0,
    };
    let spec = BodySpec {
        regions: vec![region(right(&mesh), LawSpec::J2Plasticity(metal), 7.0)],
        ..spec(LawSpec::SaintVenantKirchhoff(SOFT))
    };
    let body = Body::new(mesh.clone(), &spec).expect("valid");
    let history = body.virgin();
    let u: Vec<Vector<2>> = body.mesh().nodes().iter().map(|x| Vector::<2>::new(0.05 * x[0], 0.0)).collect();
    let mut next = history.clone();
    let work = body.after(&history).update(&u, &mut next);
    assert!(work > 0.0);
    let plastic = right(&mesh);
    for (cell, state) in body.after(&next).cell_states(&u).iter().enumerate() {
        assert_eq!(state.plastic_strain > 0.0, plastic.contains(&(cell as u32)), "cell {cell}");
    }
}

#[test]
fn materials_that_one_body_cannot_be_of_are_refused() {
    let mesh = halves::<2>(CellKind::Quad4);
    let mut mixed = two(&mesh, LawSpec::SaintVenantKirchhoff);
    mixed.regions[0].law = LawSpec::LinearElastic(STIFF);
    let mut braked = two(&mesh, LawSpec::SaintVenantKirchhoff);
    braked.regions[0].damping.mass = 0.1;
    for (spec, word) in [(mixed, "linear-elastic"), (braked, "damping.mass")] {
        let error = Body::new(mesh.clone(), &spec).expect_err("refused");
        assert!(matches!(error, FemError::Mixed { .. }) && error.to_string().contains(word), "{error}");
    }
    let mut light = two(&mesh, LawSpec::SaintVenantKirchhoff);
    light.regions[0].density = 0.0;
    let message = Body::new(mesh, &light).expect_err("refused").to_string();
    assert!(message.contains("density"), "{message}");
}
