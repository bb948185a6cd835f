use std::sync::{Arc, Barrier, Mutex};

use super::*;
use crate::ranks::{RankSolver, Ranks};
use crate::sparse::NodeGraph;
use carom_mesh::generate;

/// A mass and a stiffness: springs along all pairs of neighbours, as stiff across them as `ratio` times the mass.
fn matrix(divisions: usize, ratio: f64) -> NodalMatrix<Matrix<3>> {
    let mesh = generate::grid([0.0; 3], [1.0; 3], [divisions; 3]).expect("valid");
    let graph = Arc::new(NodeGraph::of(&mesh));
    let mut a = NodalMatrix::filled(&graph, Matrix::<3>::zeros());
    for node in 0..graph.node_count() {
        let own = graph.entry(node as u32, node as u32);
        a.values[own] += Matrix::from_diagonal_element(1.0 + 0.5 * (node as f64).sin());
        for (entry, neighbour) in graph.row(node).filter(|&(_, m)| m != node) {
            let along = (mesh.nodes()[neighbour] - mesh.nodes()[node]).normalize();
            let spring = (along * along.transpose() + Matrix::from_diagonal_element(0.1)) * ratio;
            a.values[entry] -= spring;
            a.values[own] += spring;
        }
    }
    a
}

fn made(a: &NodalMatrix<Matrix<3>>) -> Chebyshev<3> {
    Chebyshev::of(a, None).expect("positive definite").expect("few terms")
}

fn rough(nodes: usize) -> Vec<Vector<3>> {
    (0..nodes).map(|n| Vector::from_fn(|i, _| ((3 * n + i) as f64 * 1.7).cos())).collect()
}

fn energy(a: &NodalMatrix<Matrix<3>>, x: &[Vector<3>]) -> f64 {
    let mut ax = x.to_vec();
    a.multiply(x, &mut ax);
    x.iter().zip(&ax).map(|(x, ax)| x.dot(ax)).sum()
}

/// In the norm of the matrix no polynomial is further from the solution than the bound for its spectrum; repeated on the
/// residual, as an iteration does, it converges.
#[test]
fn what_is_left_of_a_right_hand_side_is_bounded() {
    for ratio in [0.01, 0.1, 0.5] {
        let a = matrix(7, ratio);
        let exact = rough(512);
        let mut inverse = made(&a);
        let (mut x, mut residual) = (vec![Vector::zeros(); 512], vec![Vector::zeros(); 512]);
        for round in 1..=3 {
            a.multiply(&x, &mut residual);
            let mut b = residual.clone();
            a.multiply(&exact, &mut b);
            residual.iter_mut().zip(&b).for_each(|(r, b)| *r = b - *r);
            inverse.begin(&residual);
            let mut correction = residual.clone();
            inverse.end(&mut correction);
            x.iter_mut().zip(&correction).for_each(|(x, c)| *x += c);
            let error: Vec<Vector<3>> = x.iter().zip(&exact).map(|(x, e)| x - e).collect();
            let left = (energy(&a, &error) / energy(&a, &exact)).sqrt();
            assert!(left <= CONTROL.left.powi(round), "{ratio}: {left} after {round}");
        }
    }
}

#[test]
fn the_inverse_is_symmetric() {
    let a = matrix(7, 0.3);
    let mut inverse = made(&a);
    let (b, c) = (rough(512), rough(600).split_off(88));
    let mut solve = |b: &[Vector<3>]| {
        let mut x = b.to_vec();
        inverse.begin(b);
        inverse.end(&mut x);
        x
    };
    let dot = |a: &[Vector<3>], b: &[Vector<3>]| a.iter().zip(b).map(|(a, b)| a.dot(b)).sum::<f64>();
    let (x, y) = (solve(&b), solve(&c));
    let size = dot(&x, &b).abs().max(dot(&y, &c).abs());
    assert!((dot(&x, &c) - dot(&y, &b)).abs() < 1e-6 * size);
    assert!(dot(&x, &b) > 0.0 && dot(&y, &c) > 0.0);
}

/// What is added at some nodes, and the responses there to unit forces, are those of the whole inverse.
#[test]
fn what_happens_at_some_nodes_is_part_of_the_whole() {
    let a = matrix(9, 0.3);
    let n = a.graph().node_count();
    let mut inverse = made(&a);
    let b = rough(n);
    let (nodes, force) = ([3, 500, 501, 999], Vector::<3>::new(3.0, -40.0, 7.0));
    let mut sum = b.clone();
    nodes.iter().for_each(|&node| sum[node] += force * node as f64);
    let (mut whole, mut parts) = (b.clone(), b.clone());
    inverse.begin(&sum);
    inverse.end(&mut whole);
    for _ in 0..2 {
        inverse.set_reach(nodes.iter().copied());
        inverse.begin(&b);
        inverse.look();
        inverse.add(nodes.iter().map(|&node| (node, force * node as f64)));
        inverse.end(&mut parts);
        let scale = whole.iter().map(|x| x.amax()).fold(0.0, f64::max);
        whole.iter().zip(&parts).for_each(|(x, y)| assert!((x - y).norm() < 1e-5 * scale));
    }
    inverse.set_reach(nodes.iter().copied());
    inverse.respond(nodes[2..].iter().copied());
    let responses: Vec<Matrix<3>> = nodes.iter().map(|&a| inverse.response(0, a)).collect();
    for j in 0..3 {
        let mut unit = vec![Vector::<3>::zeros(); n];
        unit[nodes[2]][j] = 1.0;
        let mut x = unit.clone();
        inverse.begin(&unit);
        inverse.end(&mut x);
        for (&node, response) in nodes.iter().zip(&responses) {
            assert!((response.column(j) - x[node]).norm() < 1e-6 * responses[2].norm());
        }
    }
}

/// Processes as threads, that put down what they have and wait for one another.
#[derive(Debug)]
struct Threads {
    number: usize,
    parts: Arc<[Mutex<Vec<f64>>]>,
    barrier: Arc<Barrier>,
}

impl Ranks for Threads {
    fn is_first(&self) -> bool {
        self.number == 0
    }

    fn sum(&self, values: &mut [f64]) {
        *self.parts[self.number].lock().expect("whole") = values.to_vec();
        self.barrier.wait();
        for (k, value) in values.iter_mut().enumerate() {
            *value = self.parts.iter().map(|part| part.lock().expect("whole")[k]).sum();
        }
        self.barrier.wait();
    }

    fn sum_single(&self, values: &mut [f32]) {
        let mut sums: Vec<f64> = values.iter().map(|&x| f64::from(x)).collect();
        self.sum(&mut sums);
        values.iter_mut().zip(sums).for_each(|(value, sum)| *value = sum as f32);
    }

    fn solver(&self) -> Box<dyn RankSolver> {
        unreachable!("a polynomial solves")
    }
}

/// The solution, the same with forces added where it was looked at, and responses.
fn answers(a: &NodalMatrix<Matrix<3>>, sharing: Option<&Sharing>) -> Vec<Vector<3>> {
    let mut inverse = Chebyshev::of(a, sharing).expect("positive definite").expect("few terms");
    let n = a.graph().node_count();
    let nodes = [0, 7, n / 2, n / 2 + 1, n - 1];
    let (mut first, mut second) = (rough(n), rough(n));
    inverse.begin(&rough(n));
    inverse.end(&mut first);
    inverse.set_reach(nodes.into_iter());
    inverse.begin(&rough(n));
    inverse.look();
    let seen = nodes.map(|node| inverse.seen(node));
    inverse.add(nodes.iter().map(|&node| (node, Vector::<3>::new(1.0, -20.0, node as f64))));
    inverse.end(&mut second);
    inverse.respond(nodes[1..4].iter().copied());
    let columns = (0..3).flat_map(|k| nodes.map(|node| inverse.response(k, node)));
    let columns = columns.flat_map(|m| [0, 1, 2].map(|j| m.column(j).into_owned())).collect::<Vec<_>>();
    [first, second, seen.to_vec(), columns].concat()
}

/// Rows whose matrix has parts here and there, rows that one process has alone, and springs of the first one where it has no cells.
#[test]
fn processes_that_share_the_rows_have_the_inverse_of_their_sum() {
    let (a, spring) = (matrix(25, 0.3), Matrix::from_diagonal_element(0.2));
    let n = a.graph().node_count();
    let near = |node: usize| node + 3 > n;
    let mut whole = a.clone();
    let own = |node: usize| a.graph().entry(node as u32, node as u32);
    (0..n).filter(|&node| near(node)).for_each(|node| whole.values[own(node)] += spring);
    let one = answers(&whole, None);
    let size = one.iter().map(|x| x.amax()).fold(0.0, f64::max);
    for count in [2, 3] {
        // A row is of one, and every seventh of the next one, too.
        let part = |number: usize| {
            let share = |node: usize| match (node * count / n, node % 7) {
                (of, 0) if of == number => 0.25,
                (of, 0) if (of + 1) % count == number => 0.75,
                (of, 1..) if of == number => 1.0,
                _ => 0.0,
            };
            let mut part = a.clone();
            for node in 0..n {
                for (entry, other) in a.graph().row(node) {
                    part.values[entry] *= 0.5 * (share(node) + share(other));
                }
                if number == 0 && near(node) {
                    part.values[own(node)] += spring;
                }
            }
            part
        };
        let parts: Arc<[Mutex<Vec<f64>>]> = (0..count).map(|_| Mutex::default()).collect();
        let barrier = Arc::new(Barrier::new(count));
        let all: Vec<Vec<Vector<3>>> = std::thread::scope(|scope| {
            let start = |number| {
                let ranks =
                    Arc::new(Threads { number, parts: Arc::clone(&parts), barrier: Arc::clone(&barrier) });
                let sharing = Sharing { ranks, graph: Arc::clone(a.shared_graph()) };
                let part = part(number);
                scope.spawn(move || answers(&part, Some(&sharing)))
            };
            let running: Vec<_> = (0..count).map(start).collect();
            running.into_iter().map(|one| one.join().expect("ends")).collect()
        });
        for answer in &all {
            assert_eq!(answer, &all[0], "all have the same");
            let off = answer.iter().zip(&one).map(|(x, y)| (x - y).norm()).fold(0.0, f64::max);
            // Sixteen bits of each part, instead of sixteen of their sum.
            assert!(off < 1e-4 * size, "{off:e}");
        }
    }
}

#[test]
fn stiff_and_indefinite_matrices_are_left_to_others() {
    assert!(Chebyshev::of(&matrix(7, 100.0), None).expect("positive definite").is_none());
    let mut indefinite = matrix(7, 0.3);
    indefinite.values.iter_mut().for_each(|block| *block = -*block);
    assert!(Chebyshev::of(&indefinite, None).is_err());
    // Positive on the diagonal only.
    let mut indefinite = matrix(7, 0.3);
    for node in 0..512 {
        let own = indefinite.graph().entry(node, node);
        indefinite.values[own] *= 0.3;
    }
    assert!(Chebyshev::of(&indefinite, None).is_err());
    let mut none = matrix(7, 0.3);
    none.values[5][(0, 0)] = f64::NAN;
    assert!(Chebyshev::of(&none, None).is_err());
}

#[test]
fn solutions_do_not_depend_on_the_number_of_threads() {
    let a = matrix(25, 0.3);
    let mut inverse = made(&a);
    let b = rough(a.graph().node_count());
    let mut solve = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut x = b.clone();
        pool.install(|| {
            inverse.begin(&b);
            inverse.end(&mut x);
        });
        x
    };
    let one = solve(1);
    assert_eq!(solve(2), one);
    assert_eq!(solve(3), one);
    let nodes = [0, 700, 5000, 9000, 17_000];
    inverse.set_reach(nodes.into_iter());
    let mut respond = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| inverse.respond(nodes[..4].iter().copied()));
        inverse.responses.clone()
    };
    let one = respond(1);
    assert_eq!(one.len(), 20);
    assert_eq!(respond(2), one);
    assert_eq!(respond(3), one);
}
