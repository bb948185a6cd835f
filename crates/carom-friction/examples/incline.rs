//! A brick of 1 kg on an incline of 20°, held by friction or sliding: W, q and μ of its two corners, and the reactions.

use carom_friction::{BlockMatrix, ContactProblem, Matrix, SolverKind, StoppingRule, Vector};

/// The corners, along and above the surface as seen from the centre of mass [m], and the inertia [kg m²] about that.
const CORNERS: [[f64; 2]; 2] = [[-0.1, -0.05], [0.1, -0.05]];
const INERTIA: f64 = 0.0042;
const GRAVITY: f64 = 9.81;
const STEP: f64 = 1e-3;

/// The rows of Hᵀ of a corner: its velocities along the normal and down the slope by those of the brick (down, up, turn).
fn rows([x, y]: [f64; 2]) -> [[f64; 3]; 2] {
    [[0.0, 1.0, x], [1.0, 0.0, -y]]
}

fn problem(slope: f64, friction: f64) -> ContactProblem<2> {
    let yields = [1.0, 1.0, 1.0 / INERTIA];
    let velocity = [STEP * GRAVITY * slope.sin(), -STEP * GRAVITY * slope.cos(), 0.0];
    let product = |a: &[f64; 3], b: &[f64; 3]| (0..3).map(|i| a[i] * yields[i] * b[i]).sum::<f64>();
    let mut w = BlockMatrix::default();
    for own in CORNERS.map(rows) {
        let block = |of: [[f64; 3]; 2]| Matrix::<2>::from_fn(|i, j| product(&own[i], &of[j]));
        w.push_row(CORNERS.map(rows).into_iter().map(block).enumerate());
    }
    let motion =
        |own: [[f64; 3]; 2]| Vector::<2>::from_fn(|i, _| (0..3).map(|k| own[i][k] * velocity[k]).sum());
    ContactProblem { w, q: CORNERS.map(rows).map(motion).to_vec(), mu: vec![friction; 2] }
}

fn main() {
    let slope = 20.0_f64.to_radians();
    for friction in [0.5, 0.2] {
        let problem = problem(slope, friction);
        let mut reactions = vec![Vector::<2>::zeros(); 2];
        let report = SolverKind::default().solver().solve(&problem, &mut reactions, &StoppingRule::default());
        assert!(report.is_solved(), "{report:?}");
        let total: Vector<2> = reactions.iter().sum();
        let speed = problem.motion(0, &reactions)[1];
        println!(
            "μ = {friction}: slides at {:.3} mm/s, friction takes {:.4} of the load",
            1e3 * speed,
            -total[1] / total[0]
        );
        // It takes tan 20° to hold the brick, and no more than μ is there.
        assert!((-total[1] / total[0] - friction.min(slope.tan())).abs() < 1e-6);
        let expected = STEP * GRAVITY * (slope.sin() - friction * slope.cos()).max(0.0);
        assert!((speed - expected).abs() < 1e-9, "{speed} {expected}");
    }
}

#[test]
fn the_brick_holds_or_slides_as_coulomb_says() {
    main();
}
