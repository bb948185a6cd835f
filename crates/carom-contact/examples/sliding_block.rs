//! A block that cannot turn slides to rest on a floor: contact by `carom-contact`, friction by `carom-friction`, in a time loop of its own.

use carom_contact::{ContactModel, ContactSurface, Discretisation, Obstacle, Pair, Path, Search, Target};
use carom_friction::{BlockMatrix, ContactProblem, Matrix, SolverKind, StoppingRule};
use carom_mesh::{Surface, Vector};

const MASS: f64 = 2.0;
const GRAVITY: f64 = 10.0;
const FRICTION: f64 = 0.25;
const STEP: f64 = 0.01;
const STEPS: usize = 20;

fn main() {
    // The block: its corners, its sides turned as they come, and a floor below it.
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vector::<2>::from);
    let sides = [[0, 1], [2, 1], [2, 3], [3, 0]].map(|side| side.to_vec());
    let outline = Surface::from_facets(&corners, &sides).expect("a surface");
    let pair = Pair {
        source: 0,
        target: Target::Obstacle(0),
        friction: FRICTION,
        discretisation: Discretisation::default(),
    };
    let model = ContactModel {
        surfaces: vec![ContactSurface::new(&outline, 0, &|n| corners[n as usize])],
        obstacles: vec![Obstacle::plane(Vector::zeros(), Vector::<2>::new(0.0, 1.0))],
        pairs: vec![pair].into(),
    };
    let (mut search, mut found, mut contacts) = (Search::default(), Vec::new(), Vec::new());
    let solver = SolverKind::default().solver::<2>();

    // The midpoint rule: (2m/Δt²) (d − Δt v) = m g + Hᵀ r for the shift d of a step, and v₊ = 2d/Δt − v.
    let stiffness = 2.0 * MASS / (STEP * STEP);
    let speed = FRICTION * GRAVITY * STEP * STEPS as f64;
    let (mut u, mut v) = (Vector::<2>::zeros(), Vector::<2>::new(speed, 0.0));
    let mut dissipated = 0.0;
    for _ in 0..STEPS {
        let free = v * STEP + Vector::<2>::new(0.0, -MASS * GRAVITY) / stiffness;
        let (start, end) = (|n: u32| corners[n as usize] + u, |n: u32| corners[n as usize] + u + free);
        model.detect(&Path { start: &start, end: &end, margin: 0.01 }, &mut search, &mut found);
        found.retain(|candidate| !candidate.redundant);
        model.evaluate_all(&found, &end, &mut search.mortar, &mut contacts);
        // Every node moves with the block: W is the same for all pairs of contacts in the frame of the floor.
        let mut w = BlockMatrix::default();
        for own in &contacts {
            let block = |other: &carom_contact::Contact<2>| own.frame * other.frame.transpose() / stiffness;
            w.push_row(contacts.iter().map(block).enumerate());
        }
        let problem = ContactProblem {
            w,
            // What the gap would be without reactions, and the slip.
            q: contacts.iter().map(|c| Vector::<2>::new(c.gap, c.relative(|_| free)[1])).collect(),
            mu: contacts.iter().map(|_| FRICTION).collect(),
        };
        let mut reactions = vec![Vector::<2>::zeros(); contacts.len()];
        let stopping = StoppingRule { tolerance: 1e-13, ..StoppingRule::default() };
        assert!(solver.solve(&problem, &mut reactions, &stopping).is_solved());
        let forces: Vector<2> = contacts.iter().zip(&reactions).map(|(c, r)| c.frame.tr_mul(r)).sum();
        let d = free + Matrix::<2>::from_diagonal_element(1.0 / stiffness) * forces;
        dissipated -= contacts.iter().zip(&reactions).map(|(c, r)| r[1] * c.relative(|_| d)[1]).sum::<f64>();
        u += d;
        v = d * (2.0 / STEP) - v;
    }
    let before = 0.5 * MASS * speed * speed;
    println!("the block has gone {:.4} m; friction took {dissipated:.4} J of {before:.4} J", u[0]);
    assert!(v.norm() < 1e-10 * speed, "{v}");
    assert!((dissipated - before).abs() < 1e-10 * before);
}

#[test]
fn the_block_comes_to_rest_as_coulomb_says() {
    main();
}
