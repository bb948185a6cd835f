//! Edges of bodies in space against one another: what nodes against facets can see of it.

use crate::common::{body, parse, scenario};
use carom::{Meshes, Simulation};
use carom_mesh::{Matrix, Mesh, Vector, generate};
use serde_json::json;

/// A cube with one edge down, along y, at the height `bottom`; `upside_down` one with an edge up, along x.
fn on_edge(cells: usize, bottom: f64, upside_down: bool) -> Mesh<3> {
    let grid = generate::grid([-0.5; 3], [1.0; 3], [cells; 3]).expect("valid");
    let c = std::f64::consts::FRAC_1_SQRT_2;
    let turn = if upside_down {
        Matrix::<3>::new(1.0, 0.0, 0.0, 0.0, c, -c, 0.0, c, c)
    } else {
        Matrix::<3>::new(c, 0.0, c, 0.0, 1.0, 0.0, -c, 0.0, c)
    };
    let up = Vector::<3>::new(0.0, 0.0, if upside_down { -c } else { c } + bottom);
    let nodes = grid.nodes().iter().map(|x| turn * x + up).collect();
    Mesh::new(nodes, grid.blocks().to_vec()).expect("turned")
}

/// Two cubes that meet with crossed edges, half a cell from any node: no node faces a facet of the other until one has come into the
/// other by the slope of its faces. They do not fall through one another, and what contact does to the energy is in the books.
#[test]
fn crossed_edges_sink_in_by_less_than_a_cell_and_bounce() {
    let cells = 3;
    let mut bodies =
        ["low", "high"].map(|name| body(name, json!({"kind": "file", "file": name}), [0.0, 0.0]));
    for (b, speed) in bodies.iter_mut().zip([0.5, -0.5]) {
        b["velocity"] = json!([0.0, 0.0, speed]);
        b["spin"] = json!([0.0, 0.0, 0.0]);
    }
    let mut case = scenario(0.7, 2e-3, &bodies, &[]);
    case["dimension"] = json!(3);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-10);
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["sources"] = json!("both");
    let meshes: Meshes<3> =
        [("low".to_string(), on_edge(cells, -0.01, true)), ("high".to_string(), on_edge(cells, 0.0, false))]
            .into();
    let mut simulation = Simulation::<3>::with_meshes(&parse(&case), meshes).expect("a valid case");
    let height = |simulation: &Simulation<3>, b: usize| {
        let b = &simulation.model().bodies[b];
        b.body.mean(b.body.mesh().nodes())[2] + b.body.mean(&simulation.state().displacement[b.nodes()])[2]
    };
    let mut closest = f64::INFINITY;
    for k in 1..=70 {
        simulation.advance(0.01 * f64::from(k), || false).expect("converges");
        closest = closest.min(height(&simulation, 1) - height(&simulation, 0));
    }
    let model = simulation.model();
    let rising =
        [0, 1].map(|b| model.bodies[b].body.mean(&simulation.state().velocity[model.bodies[b].nodes()])[2]);
    println!("centres come as close as {closest}; velocities after {rising:?}");
    assert!(rising[0] < -0.2 && rising[1] > 0.2, "{rising:?}");
    // Undeformed cubes whose edges touch are √2 apart.
    let sunk = 2.0_f64.sqrt() - closest;
    assert!(sunk < 1.0 / cells as f64, "{sunk}");
    let energy = simulation.summary().energy;
    assert!(energy.max_drift < 1e-9 * energy.initial, "{:e}", energy.max_drift);
}
