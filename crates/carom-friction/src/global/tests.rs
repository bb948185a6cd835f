//! Global problems against dense algebra.

use faer::sparse::{SparseColMat, Triplet};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;

use super::compliance::Compliance;
use crate::clock::Clock;
use crate::contract::assert_law;
use crate::{
    ContactProblem, GlobalMethod, GlobalProblem, SolveStatus, SolverKind, StoppingRule, Vector, measure,
};

fn sparse(dense: &DMatrix<f64>) -> SparseColMat<usize, f64> {
    let mut triplets = Vec::new();
    for j in 0..dense.ncols() {
        for i in 0..dense.nrows() {
            if dense[(i, j)] != 0.0 {
                triplets.push(Triplet::new(i, j, dense[(i, j)]));
            }
        }
    }
    SparseColMat::try_new_from_triplets(dense.nrows(), dense.ncols(), &triplets).expect("inside")
}

fn dense(sparse: &SparseColMat<usize, f64>) -> DMatrix<f64> {
    let mut dense = DMatrix::zeros(sparse.nrows(), sparse.ncols());
    for entry in sparse.triplet_iter() {
        dense[(entry.row, entry.col)] = *entry.val;
    }
    dense
}

/// A number between −1 and 1 for an index.
fn noise(k: usize) -> f64 {
    (12.9898 * k as f64 + 4.1).sin()
}

/// Bodies of `size` unknowns in a row, each held to the next by one contact and the last to the ground. M has symmetric
/// positive definite blocks on the diagonal, with `skew` of an unsymmetric part.
fn bodies<const D: usize>(count: usize, size: usize, skew: f64) -> GlobalProblem<D> {
    let n = count * size;
    let mut m = DMatrix::zeros(n, n);
    for body in 0..count {
        let first = body * size;
        let a = DMatrix::from_fn(size, size, |i, j| noise(31 * (first + i) + 7 * j));
        let b = DMatrix::from_fn(size, size, |i, j| noise(17 * (first + i) + 5 * j));
        let block = &a * a.transpose() + DMatrix::identity(size, size) + (&b - b.transpose()) * skew;
        m.view_mut((first, first), (size, size)).copy_from(&block);
    }
    let mut h = DMatrix::zeros(n, count * D);
    for contact in 0..count {
        for k in 0..D {
            for body in contact..(contact + 2).min(count) {
                for i in 0..size.min(3) {
                    h[(body * size + i, contact * D + k)] = noise(13 * contact + 3 * k + 11 * body + i);
                }
            }
        }
    }
    GlobalProblem {
        m: sparse(&m),
        h: sparse(&h),
        f: (0..n).map(|k| noise(3 * k + 1)).collect(),
        b: (0..count).map(|i| Vector::from_fn(|k, _| noise(19 * i + k))).collect(),
        mu: (0..count).map(|i| [0.4, 0.0, 0.7][i % 3]).collect(),
    }
}

/// Largest difference between (W, q) and what dense algebra gives, relative to the largest entry.
fn distance_from_dense<const D: usize>(global: &GlobalProblem<D>, local: &ContactProblem<D>) -> f64 {
    let h = dense(&global.h);
    let inverse = dense(&global.m).try_inverse().expect("regular");
    let w = h.transpose() * &inverse * &h;
    let q = h.transpose() * &inverse * DVector::from_column_slice(&global.f);
    let mut stored = DMatrix::zeros(w.nrows(), w.ncols());
    for i in 0..local.len() {
        for (j, block) in local.w.row(i) {
            stored.view_mut((i * D, j * D), (D, D)).copy_from(block);
        }
    }
    let q = (0..local.len())
        .map(|i| local.q[i] - global.b[i] - Vector::<D>::from_fn(|k, _| q[i * D + k]))
        .fold(0.0, |worst: f64, e| worst.max(e.amax()));
    ((w.clone() - stored).amax() / w.amax()).max(q)
}

proptest! {
    #[test]
    fn condensed_problem_is_that_of_dense_algebra(
        count in 1usize..6,
        size in prop_oneof![1usize..8, 13usize..30],
        skew in prop_oneof![Just(0.0), Just(0.5)],
    ) {
        fn check<const D: usize>(count: usize, size: usize, skew: f64) {
            let global = bodies::<D>(count, size, skew);
            let local = global.condense().expect("regular");
            assert!(distance_from_dense(&global, &local) < 1e-11);
            assert_eq!(local.mu, global.mu);
        }
        check::<1>(count, size, skew);
        check::<2>(count, size, skew);
        check::<3>(count, size, skew);
    }
}

/// Each contact in the row meets the two next to it, whatever the size of the bodies.
#[test]
fn contacts_of_separate_bodies_are_not_coupled() {
    for size in [3, 20] {
        let local = bodies::<3>(10, size, 0.0).condense().expect("regular");
        for i in 0..10usize {
            let columns: Vec<usize> = local.w.row(i).map(|(j, _)| j).collect();
            assert_eq!(columns, (i.saturating_sub(1)..(i + 2).min(10)).collect::<Vec<_>>());
        }
    }
}

/// With diagonal M contacts are coupled through single unknowns: a frame along the axes couples nothing across.
#[test]
fn diagonal_mass_couples_contacts_through_shared_unknowns_alone() {
    let triplets = [0, 1, 2, 3].map(|k| Triplet::new(k, k, 2.0 + k as f64));
    let pull = [(0, 0), (1, 1), (1, 2), (3, 3)].map(|(dof, column)| Triplet::new(dof, column, 1.0));
    let global = GlobalProblem::<2> {
        m: SparseColMat::try_new_from_triplets(4, 4, &triplets).expect("inside"),
        h: SparseColMat::try_new_from_triplets(4, 4, &pull).expect("inside"),
        f: vec![0.0, 0.0, 1.0, 1.0],
        b: vec![Vector::<2>::new(-1.0, 0.5); 2],
        mu: vec![0.3; 2],
    };
    let local = global.condense().expect("regular");
    assert!(distance_from_dense(&global, &local) < 1e-15);
    assert_eq!(local.w.row(0).len(), 2);
    let alone =
        GlobalProblem { h: SparseColMat::try_new_from_triplets(4, 4, &pull[..2]).expect("inside"), ..global };
    let local = alone.condense().expect("regular");
    assert_eq!(local.w.row(0).len(), 1);
    assert_eq!(local.w.diagonal(1).amax(), 0.0, "nothing holds the second contact");
}

/// For symmetric M, W is symmetric to the last bit, however badly scaled M is.
#[test]
fn condensed_operator_is_exactly_symmetric() {
    let mut global = bodies::<3>(6, 20, 0.0);
    let scale = |k: usize| 10f64.powi((k % 7) as i32 - 3);
    let m = dense(&global.m);
    global.m =
        sparse(&DMatrix::from_fn(120, 120, |i, j| 0.5 * (m[(i, j)] + m[(j, i)]) * scale(i) * scale(j)));
    let local = global.condense().expect("regular");
    for i in 0..6 {
        for (j, block) in local.w.row(i) {
            let mirrored = local.w.row(j).find(|&(k, _)| k == i).expect("symmetric pattern").1.transpose();
            assert_eq!(*block, mirrored);
        }
    }
}

/// A chain of springs that nothing holds has no unique velocities; round-off gives it pivots all the same.
#[test]
fn singular_matrix_is_refused_and_the_unknown_named() {
    for n in [2, 5, 12, 13, 40, 333] {
        let mut m = DMatrix::identity(n + 20, n + 20);
        m.view_mut((20, 20), (n, n)).fill(0.0);
        for k in 0..n - 1 {
            let spring = 0.1 + noise(k).abs();
            for (i, j, sign) in [(k, k, 1.0), (k + 1, k + 1, 1.0), (k, k + 1, -1.0), (k + 1, k, -1.0)] {
                m[(20 + i, 20 + j)] += sign * spring;
            }
        }
        let mut global = bodies::<2>(1, 3, 0.0);
        (global.m, global.f) = (sparse(&m), vec![0.0; n + 20]);
        global.h =
            SparseColMat::try_new_from_triplets(n + 20, 2, &[Triplet::new(20, 0, 1.0)]).expect("inside");
        let error = global.condense().expect_err("floating");
        assert!((20..n + 20).contains(&error.dof), "{n}: {error}");
        // Held at one end, however softly, it is regular.
        m[(20, 20)] += 1e-6;
        global.m = sparse(&m);
        assert!(global.condense().is_ok(), "{n} springs");
        // An unknown without any entry.
        m.row_mut(7).fill(0.0);
        m.column_mut(7).fill(0.0);
        global.m = sparse(&m);
        assert_eq!(global.condense().expect_err("empty row").dof, 7);
    }
}

/// A membrane of `side` × `side` nodes, each pressed against the ground and pushed along it: M is sparse and W is full.
fn membrane(side: usize) -> GlobalProblem<3> {
    let n = side * side;
    let (mut triplets, mut pull) = (Vec::new(), Vec::new());
    let mut add = |i: usize, j: usize, value: f64| {
        triplets.extend((0..3).map(|k| Triplet::new(3 * i + k, 3 * j + k, value)));
    };
    for node in 0..n {
        let (x, y) = (node % side, node / side);
        add(node, node, 4.2);
        for (other, is_there) in [(node + 1, x + 1 < side), (node + side, y + 1 < side)] {
            if is_there {
                add(node, other, -1.0);
                add(other, node, -1.0);
            }
        }
        pull.extend((0..3).map(|k| Triplet::new(3 * node + k, 3 * node + k, 1.0)));
    }
    GlobalProblem {
        m: SparseColMat::try_new_from_triplets(3 * n, 3 * n, &triplets).expect("inside"),
        h: SparseColMat::try_new_from_triplets(3 * n, 3 * n, &pull).expect("inside"),
        f: (0..3 * n).map(|k| noise(k) - if k % 3 == 0 { 0.4 } else { 0.0 }).collect(),
        b: vec![Vector::zeros(); n],
        mu: (0..n).map(|i| [0.3, 0.6, 0.0][i % 3]).collect(),
    }
}

/// M v = H r + f, relative to the largest entry.
fn imbalance<const D: usize>(global: &GlobalProblem<D>, r: &[Vector<D>], v: &[f64]) -> f64 {
    let r = DVector::from_iterator(r.len() * D, r.iter().flat_map(|r| r.iter().copied()));
    let forces = dense(&global.h) * r + DVector::from_column_slice(&global.f);
    (dense(&global.m) * DVector::from_column_slice(v) - &forces).amax() / forces.amax()
}

proptest! {
    /// By either method, the laws hold one by one, v balances the forces, and w is that of the condensed problem.
    #[test]
    fn answers_obey_the_laws_with_and_without_w(
        count in 1usize..7,
        size in prop_oneof![3usize..8, 13usize..20],
        skew in prop_oneof![Just(0.0), Just(0.5)],
    ) {
        fn check<const D: usize>(count: usize, size: usize, skew: f64) {
            let global = bodies::<D>(count, size, skew);
            let local = global.condense().expect("regular");
            let rule = StoppingRule { tolerance: 1e-10, ..Default::default() };
            for method in GlobalMethod::ALL {
                let mut r = vec![Vector::zeros(); count];
                let answer = global.solve(&mut r, method, SolverKind::default(), &rule).expect("regular");
                assert_eq!(answer.report.status, SolveStatus::Solved, "{method:?} on {global:?}");
                assert_law(&local, &r, 1e-7);
                assert!(imbalance(&global, &r, &answer.velocities) < 1e-12);
                for (i, w) in answer.motions.iter().enumerate() {
                    assert!((w - local.motion(i, &r)).amax() < 1e-9);
                }
            }
        }
        check::<1>(count, size, skew);
        check::<2>(count, size, skew);
        check::<3>(count, size, skew);
    }
}

#[test]
fn every_solver_solves_the_condensed_problem() {
    let global = bodies::<3>(5, 6, 0.0);
    for kind in SolverKind::ALL {
        let mut r = vec![Vector::zeros(); 5];
        let answer =
            global.solve(&mut r, GlobalMethod::Condense, kind, &StoppingRule::default()).expect("regular");
        assert!(answer.report.is_solved(), "{kind:?}");
        assert_eq!(answer.method, GlobalMethod::Condense);
    }
}

/// W is full where all contacts are on one body, and cheap where every body has a few.
#[test]
fn w_is_written_out_where_that_is_cheaper() {
    let rule = StoppingRule::default();
    let (rigid, elastic) = (bodies::<3>(40, 6, 0.0), membrane(12));
    let mut r = vec![Vector::zeros(); 40];
    let answer = rigid.solve(&mut r, GlobalMethod::Auto, SolverKind::default(), &rule).expect("regular");
    assert_eq!((answer.method, answer.report.status), (GlobalMethod::Condense, SolveStatus::Solved));
    let mut r = vec![Vector::zeros(); 144];
    let answer = elastic.solve(&mut r, GlobalMethod::Auto, SolverKind::default(), &rule).expect("regular");
    assert_eq!((answer.method, answer.report.status), (GlobalMethod::Admm, SolveStatus::Solved));
    assert_eq!(answer.report.solver, SolverKind::Admm);
    // The answer found without W is one of the problem with W, measured by another meter.
    let local = elastic.condense().expect("regular");
    let measured = measure(&local, &r);
    assert!(measured.residual <= 1e-8 && measured.natural_residual <= 1e-8, "{measured:?}");
    // A solver asked for by name is the one that solves it.
    let mut r = vec![Vector::zeros(); 144];
    let answer = elastic.solve(&mut r, GlobalMethod::Auto, SolverKind::Proximal, &rule).expect("regular");
    assert_eq!((answer.method, answer.report.solver), (GlobalMethod::Condense, SolverKind::Proximal));
}

/// Column by column for few contacts, by random probes for many, and then within the error that it states.
#[test]
fn trace_is_exact_for_few_contacts_and_close_for_many() {
    for side in [4, 5, 10] {
        let global = membrane(side);
        let compliance = Compliance::new(&global).expect("regular");
        let local = compliance.condense(Clock::new(None)).expect("no limit");
        let trace = compliance.trace();
        let exact: f64 = (0..local.len()).map(|i| local.w.diagonal(i).trace()).sum();
        // One part for each direction: each has as many columns as there are nodes, three times.
        let is_exact = side * side * 3 <= 48;
        assert_eq!(trace.uncertainty == 0.0, is_exact, "{side}");
        let allowed = if is_exact { 1e-13 } else { trace.uncertainty };
        assert!((trace.value / exact - 1.0).abs() <= allowed, "{trace:?} for {exact}");
        assert!(trace.uncertainty < 0.1);
    }
}

#[test]
fn limits_hold_whatever_the_method_and_nothing_is_solved_by_nan() {
    let mut global = membrane(6);
    let rule = StoppingRule { max_iterations: 2, tolerance: 1e-14, ..Default::default() };
    for method in GlobalMethod::ALL {
        let mut r = vec![Vector::zeros(); 36];
        let answer = global.solve(&mut r, method, SolverKind::Admm, &rule).expect("regular");
        assert_eq!((answer.report.status, answer.report.iterations), (SolveStatus::IterationLimit, 2));
    }
    global.f[5] = f64::NAN;
    for method in GlobalMethod::ALL {
        let mut r = vec![Vector::zeros(); 36];
        let answer = global.solve(&mut r, method, SolverKind::Admm, &rule).expect("regular");
        assert_eq!(answer.report.status, SolveStatus::Diverged);
    }
    let mut values = global.m.val().to_vec();
    values[7] = f64::NAN;
    global.m = SparseColMat::new(global.m.symbolic().to_owned().expect("memory"), values);
    assert!(global.condense().is_err());
}

#[test]
fn bodies_without_contacts_move_freely() {
    let mut global = membrane(3);
    global.h = SparseColMat::try_new_from_triplets(27, 0, &[]).expect("empty");
    (global.b, global.mu) = (Vec::new(), Vec::new());
    for method in GlobalMethod::ALL {
        let answer =
            global.solve(&mut [], method, SolverKind::default(), &StoppingRule::default()).expect("regular");
        assert!(answer.report.is_solved());
        assert!(imbalance(&global, &[], &answer.velocities) < 1e-14);
    }
}
