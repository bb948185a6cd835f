//! Numbers at the ends of what numbers can be, and units of any size.

use super::{assert_law, problem};
use crate::binary::power_of_two;
use crate::{
    BlockMatrix, ContactProblem, Criterion, GlobalMethod, GlobalProblem, Matrix, SolveReport, SolveStatus,
    SolverKind, SparseColMat, StoppingRule, Triplet, Vector, measure,
};

fn entries() -> Vec<f64> {
    (0..67).map(|k| (f64::from(k) * 1.9).sin()).collect()
}

fn times<const D: usize>(problem: &ContactProblem<D>, w: [f64; 2], q: [f64; 2]) -> ContactProblem<D> {
    let mut scaled = BlockMatrix::default();
    for i in 0..problem.len() {
        scaled.push_row(problem.w.row(i).map(|(j, block)| (j, block * w[0] * w[1])));
    }
    let q = problem.q.iter().map(|x| x * q[0] * q[1]).collect();
    ContactProblem { w: scaled, q, mu: problem.mu.clone() }
}

fn solve<const D: usize>(
    kind: SolverKind,
    problem: &ContactProblem<D>,
    rule: &StoppingRule,
) -> (SolveReport, Vec<Vector<D>>) {
    let mut r = vec![Vector::zeros(); problem.len()];
    (kind.solver().solve(problem, &mut r, rule), r)
}

/// Symptom guarded against: with forces below 1e-162 squares vanished, and w_n < 0 without reactions passed for solved.
#[test]
fn tiny_and_huge_problems_are_solved_as_others_are() {
    let plain = problem::<3>(4, 9, &entries(), 0.5, 0.3);
    let rule = StoppingRule { tolerance: 1e-10, ..Default::default() };
    for kind in SolverKind::ALL {
        let (report, expected) = solve(kind, &plain, &rule);
        assert!(report.is_solved());
        for (w, q) in [
            ([1.0, 1.0], [1e-163, 1.0]),
            ([1.0, 1.0], [1e-200, 1.0]),
            ([1.0, 1.0], [1e-300, 1.0]),
            ([1.0, 1.0], [1e300, 1.0]),
            ([1e-300, 1.0], [1.0, 1.0]),
            ([1e300, 1.0], [1.0, 1.0]),
            ([1e-300, 1.0], [1e-300, 1.0]),
            ([1e-300, 1.0], [1e-300, 1e-8]),
            ([1e300, 1.0], [1e300, 1.0]),
        ] {
            let (report, r) = solve(kind, &times(&plain, w, q), &rule);
            assert!(report.is_solved(), "{kind:?} {w:?} {q:?}: {report:?}");
            let unit = q[0] / w[0] * (q[1] / w[1]);
            for (r, e) in r.iter().zip(&expected) {
                assert!((r / unit - e).norm() < 1e-6, "{kind:?} {w:?} {q:?}: {r} for {e}");
            }
        }
    }
}

/// Reactions that are no numbers, or all zero, in the units of the problem are no solution.
#[test]
fn answers_that_no_number_can_hold_are_not_solved() {
    let plain = problem::<2>(3, 9, &entries(), 0.5, 0.3);
    for kind in SolverKind::ALL {
        for (w, q) in [(1e300, 1e-300), (1e-300, 1e300), (1e-200, 1e200), (1e200, 1e-200)] {
            let (report, r) = solve(kind, &times(&plain, [w, 1.0], [q, 1.0]), &StoppingRule::default());
            let expected = if w > q { SolveStatus::Stalled } else { SolveStatus::Diverged };
            assert_eq!(report.status, expected, "{kind:?} {w:e} {q:e}: {r:?}");
        }
    }
}

/// What is not above round-off in subnormal numbers is right, or not called so.
#[test]
fn subnormal_numbers_are_solved_or_not_called_so() {
    let plain = problem::<3>(3, 9, &entries(), 0.5, 0.3);
    for kind in SolverKind::ALL {
        for k in [1030, 1040, 1060, 1072, 1080] {
            for (w, q) in [
                ([1.0, 1.0], [power_of_two(-1000), power_of_two(1000 - k)]),
                (
                    [power_of_two(-1000), power_of_two(1000 - k)],
                    [power_of_two(-1000), power_of_two(1000 - k)],
                ),
            ] {
                let tiny = times(&plain, w, q);
                let (report, r) = solve(kind, &tiny, &StoppingRule::default());
                if report.is_solved() {
                    // But for a few of the smallest numbers there are.
                    let unit = tiny.q.iter().map(Vector::amax).fold(0.0, f64::max);
                    let closed = (0..3).map(|i| tiny.motion(i, &r)[0]).fold(0.0, f64::min);
                    assert!(-closed <= 1e-6 * unit + 1e-322, "{kind:?} 2^-{k}: {closed:e} of {unit:e}");
                }
            }
        }
    }
}

/// Contacts that differ by 200 decades in compliance, in motion or in both.
#[test]
fn mixed_scales_are_never_given_a_wrong_word() {
    let one = Matrix::<2>::identity();
    for (soft, q, expected) in [
        (1e-200, -1.0, None),
        (1.0, -1e-200, Some(SolveStatus::Solved)),
        (1e-200, -1e-200, Some(SolveStatus::Solved)),
        (1e-16, -1.0, None),
        (1e-300, 1.0, Some(SolveStatus::Solved)),
    ] {
        let mut w = BlockMatrix::default();
        w.push_row([(0, one), (1, Matrix::zeros())]);
        w.push_row([(0, Matrix::zeros()), (1, one * soft)]);
        let q = vec![Vector::<2>::new(-1.0, 0.1), Vector::<2>::new(q, 0.0)];
        let problem = ContactProblem { w, q, mu: vec![0.3; 2] };
        for kind in SolverKind::ALL {
            let rule = StoppingRule { max_iterations: 2000, ..Default::default() };
            let (report, r) = solve(kind, &problem, &rule);
            // W is positive definite: there is a solution, though reactions of 1e200 N beside others of 1 N may not be found.
            assert_ne!(report.status, SolveStatus::Inconsistent, "{kind:?} {soft:e}");
            if let Some(expected) = expected {
                assert_eq!(report.status, expected, "{kind:?} {soft:e} {r:?}");
            }
            if report.is_solved() {
                assert_law(&problem, &r, 1e-7);
            }
        }
    }
}

#[test]
fn without_motions_there_are_no_reactions_whatever_the_guess() {
    let mut still = problem::<3>(3, 9, &entries(), 0.5, 0.3);
    still.q.fill(Vector::zeros());
    for kind in SolverKind::ALL {
        for size in [0.0, 1e-310, 1e-200, 1.0, 1e200] {
            let mut r = vec![Vector::<3>::new(size, 0.1 * size, 0.0); 3];
            let report = kind.solver().solve(&still, &mut r, &StoppingRule::default());
            assert_eq!((report.status, report.iterations), (SolveStatus::Solved, 0), "{kind:?} {size:e}");
            assert_eq!(r, vec![Vector::<3>::zeros(); 3], "{kind:?} {size:e}");
        }
    }
}

/// Symptom guarded against: where a guess had no square, Newton's iterations had no first one, and were begun again for ever.
#[test]
fn a_guess_of_any_size_ends_in_the_answer() {
    let plain = problem::<3>(3, 9, &entries(), 0.5, 0.3);
    let rule = StoppingRule { tolerance: 1e-10, ..Default::default() };
    for kind in SolverKind::ALL {
        let (report, expected) = solve(kind, &plain, &rule);
        assert!(report.is_solved());
        for size in [1e160, 1e300, f64::INFINITY, f64::NAN] {
            let mut r = vec![Vector::<3>::new(size, 0.1 * size, 0.0); 3];
            assert!(kind.solver().solve(&plain, &mut r, &rule).is_solved(), "{kind:?} {size:e}");
            for (r, expected) in r.iter().zip(&expected) {
                assert!((r - expected).norm() < 1e-6 * expected.norm().max(1.0), "{kind:?} {size:e}");
            }
        }
    }
}

/// Symptom guarded against: sweeps over contacts that yield against their reactions, as those of bodies that give way, ended in forces of 1e153 N,
/// from which Newton's iterations never came back.
#[test]
fn contacts_that_yield_against_their_reactions_end_all_the_same() {
    let entries = entries();
    for count in [2, 5, 10] {
        let mut yielding = problem::<2>(count, 7, &entries, 0.5, 0.0);
        let mut w = BlockMatrix::default();
        for i in 0..count {
            let sign = if i % 3 == 1 { -9.0 } else { 1.0 };
            w.push_row(yielding.w.row(i).map(|(j, block)| (j, if i == j { block * sign } else { *block })));
        }
        yielding.w = w;
        for kind in SolverKind::ALL {
            let (report, r) = solve(kind, &yielding, &StoppingRule::default());
            assert!(report.is_solved() || report.status != SolveStatus::Solved, "{kind:?}");
            assert!(r.iter().all(|r| r.iter().all(|x| x.is_finite())), "{kind:?}");
        }
    }
}

/// A body wedged between two walls that just touch it: any thrust of the one on the other is an answer, and so is that of the guess.
#[test]
fn a_guess_that_is_an_answer_is_kept_where_nothing_moves() {
    let mut w = BlockMatrix::default();
    w.push_row([(0, Matrix::<1>::new(1.0)), (1, Matrix::<1>::new(-1.0))]);
    w.push_row([(0, Matrix::<1>::new(-1.0)), (1, Matrix::<1>::new(1.0))]);
    let wedged = ContactProblem { w, q: vec![Vector::<1>::zeros(); 2], mu: vec![0.0; 2] };
    for kind in SolverKind::ALL {
        let mut r = vec![Vector::<1>::new(3.0); 2];
        assert!(kind.solver().solve(&wedged, &mut r, &StoppingRule::default()).is_solved(), "{kind:?}");
        assert_eq!(r, vec![Vector::<1>::new(3.0); 2], "{kind:?}");
    }
}

#[test]
fn nothing_that_can_move_is_solved_only_where_nothing_overlaps() {
    for size in [1e-310, 1e-200, 1.0, 1e300] {
        for kind in SolverKind::ALL {
            let mut w = BlockMatrix::default();
            w.push_row([(0, Matrix::<2>::zeros())]);
            let mut fixed = ContactProblem { w, q: vec![Vector::<2>::new(size, size)], mu: vec![0.5] };
            assert!(solve(kind, &fixed, &StoppingRule::default()).0.is_solved(), "{kind:?} {size:e}");
            fixed.q[0][0] = -size;
            let rule = StoppingRule { max_iterations: 1000, ..Default::default() };
            assert!(!solve(kind, &fixed, &rule).0.is_solved(), "{kind:?} {size:e}");
        }
    }
}

#[test]
fn friction_next_to_none_and_next_to_all_is_solved() {
    for mu in [0.0, 1e-300, 1e-12, 1e6] {
        let any = problem::<3>(3, 9, &entries(), 1.0, mu);
        for kind in [SolverKind::Auto, SolverKind::GaussSeidelEnumerative, SolverKind::Proximal] {
            let (report, r) = solve(kind, &any, &StoppingRule { tolerance: 1e-10, ..Default::default() });
            assert!(report.is_solved(), "{kind:?} with {mu:e}: {report:?}");
            let thrust = |r: &Vector<3>| r[1].hypot(r[2]) <= mu * r[0] * (1.0 + 1e-12);
            assert!(r.iter().all(thrust), "{kind:?} with {mu:e}: {r:?}");
        }
    }
}

/// W = Q diag(1 … 1/condition) Qᵀ with a Q of reflections.
fn ill_conditioned<const D: usize>(n: usize, condition: f64, seed: usize) -> ContactProblem<D> {
    let size = n * D;
    let noise = |k: usize| (12.9898 * (k + 977 * seed) as f64 + 4.1).sin();
    let mut w = nalgebra::DMatrix::from_fn(size, size, |i, j| {
        if i == j { condition.powf(-(i as f64) / (size - 1) as f64) } else { 0.0 }
    });
    for reflection in 0..3 {
        let v = nalgebra::DVector::from_fn(size, |i, _| noise(100 * reflection + i)).normalize();
        let reflect = nalgebra::DMatrix::identity(size, size) - &v * v.transpose() * 2.0;
        w = &reflect * w * &reflect;
    }
    let mut blocks = BlockMatrix::default();
    for i in 0..n {
        let entry = |j: usize, a, b| 0.5 * (w[(i * D + a, j * D + b)] + w[(j * D + b, i * D + a)]);
        blocks.push_row((0..n).map(|j| (j, Matrix::from_fn(|a, b| entry(j, a, b)))));
    }
    let q = (0..n).map(|i| Vector::from_fn(|k, _| noise(500 + 3 * i + k))).collect();
    ContactProblem { w: blocks, q, mu: vec![0.3; n] }
}

/// Symptom guarded against: `inconsistent` for 4 of 43 problems whose W is positive definite, which always have a solution.
#[test]
fn positive_definite_problems_are_never_inconsistent() {
    fn check<const D: usize>(n: usize, condition: f64, seed: usize) {
        let problem = ill_conditioned::<D>(n, condition, seed);
        for kind in [SolverKind::Auto, SolverKind::Proximal, SolverKind::NewtonNaturalMap] {
            let rule = StoppingRule { max_iterations: 3000, ..Default::default() };
            let (report, _) = solve(kind, &problem, &rule);
            assert_ne!(report.status, SolveStatus::Inconsistent, "{kind:?} {D} {n} {condition:e} {seed}");
        }
    }
    for condition in [1e10, 1e12, 1e14, 2e14] {
        for seed in 0..12 {
            check::<1>(2 + seed % 7, condition, seed);
            check::<2>(2 + seed % 5, condition, seed);
            check::<3>(2 + seed % 4, condition, seed);
        }
    }
}

/// Five contacts on two modes with rounded numbers, pressed together along the null space of W.
#[test]
fn contradictions_are_recognised_though_w_is_rounded_and_in_any_units() {
    let rows: [[f64; 2]; 4] = [[1.0, 0.3], [-1.0, 0.1], [-0.7, -0.9], [0.3, 1.7]];
    let rest = [0.0, 1.0].map(|k| rows.iter().map(|r| r[k as usize]).sum::<f64>());
    let mut normals = rows.to_vec();
    // Together they push nothing: Σ z_i n_i = 0 with z = (1, 1, 1, 1, 1).
    normals.push([-rest[0], -rest[1]]);
    for unit in [1.0, 1e-7, 1e-200, 1e200] {
        let mut w = BlockMatrix::<1>::default();
        for a in &normals {
            let product = |b: &[f64; 2]| Matrix::<1>::new((a[0] * b[0] / 3.0 + a[1] * b[1] / 7.0) * unit);
            w.push_row(normals.iter().enumerate().map(|(j, b)| (j, product(b))).collect::<Vec<_>>());
        }
        // Where the body is, all gaps are as wide as `opening`.
        let gaps =
            |opening: f64| normals.iter().map(move |a| Vector::<1>::new(opening + 0.3 * a[0] - 0.2 * a[1]));
        let problem = ContactProblem { w, q: gaps(-0.01).collect(), mu: vec![0.0; 5] };
        for kind in [SolverKind::Auto, SolverKind::Proximal] {
            let (report, _) = solve(kind, &problem, &StoppingRule::default());
            assert_eq!(report.status, SolveStatus::Inconsistent, "{kind:?} {unit:e}");
        }
        // Where there is room for the body they are solved.
        let apart = ContactProblem { q: gaps(0.01).collect(), ..problem };
        assert!(solve(SolverKind::Auto, &apart, &StoppingRule::default()).0.is_solved(), "{unit:e}");
    }
}

fn natural() -> StoppingRule {
    StoppingRule { tolerance: 1e-11, criterion: Criterion::Natural, ..Default::default() }
}

/// Powers of two for motions and of four for compliances change the exponents of the answer and not a bit else.
#[test]
fn other_units_give_the_same_answer_to_the_last_bit() {
    let plain = problem::<3>(4, 9, &entries(), 0.5, 0.3);
    for kind in SolverKind::ALL {
        let (report, expected) = solve(kind, &plain, &natural());
        assert!(report.is_solved(), "{kind:?}");
        for (w, q) in [(0, 1), (0, -7), (2, 0), (-40, 33), (6, 300), (-600, 0), (400, -500), (-300, -1000)] {
            let other = times(&plain, [power_of_two(w), 1.0], [power_of_two(q), 1.0]);
            let (other_report, r) = solve(kind, &other, &natural());
            assert_eq!(other_report.status, report.status);
            assert_eq!(other_report.iterations, report.iterations, "{kind:?} 2^{w} 2^{q}");
            assert_eq!(other_report.measure.natural_residual, report.measure.natural_residual);
            let unit = power_of_two(q - w);
            for (r, e) in r.iter().zip(&expected) {
                assert_eq!(*r, e * unit, "{kind:?} 2^{w} 2^{q}");
            }
        }
    }
}

/// Any other units, another order of the contacts and another frame change round-off alone.
#[test]
fn units_order_and_frame_do_not_change_the_answer() {
    let plain = problem::<3>(4, 9, &entries(), 0.7, 0.2);
    let rule = StoppingRule { tolerance: 1e-14, ..natural() };
    let order = [2, 0, 3, 1];
    let turns: Vec<Matrix<3>> = (0..4)
        .map(|i| {
            let (s, c) = (0.4 + 0.9 * f64::from(i)).sin_cos();
            Matrix::<3>::new(1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c)
        })
        .collect();
    let mut permuted = BlockMatrix::default();
    let mut turned = BlockMatrix::default();
    for i in 0..4 {
        permuted.push_row((0..4).map(|j| (j, *plain.w.block(order[i], order[j]).expect("dense"))));
        turned.push_row(plain.w.row(i).map(|(j, block)| (j, turns[i] * block * turns[j].transpose())));
    }
    let permuted =
        ContactProblem { w: permuted, q: order.map(|i| plain.q[i]).to_vec(), mu: plain.mu.clone() };
    let q = plain.q.iter().zip(&turns).map(|(q, turn)| turn * q).collect();
    let turned = ContactProblem { w: turned, q, mu: plain.mu.clone() };
    for kind in SolverKind::ALL {
        let answer = |problem: &ContactProblem<3>| {
            let (report, r) = solve(kind, problem, &rule);
            // The last digits may not be reached: then the best that there is has to do.
            assert!(report.measure.natural_residual < 1e-13, "{kind:?}: {report:?}");
            r
        };
        let expected = answer(&plain);
        let near = |r: &Vector<3>, e: &Vector<3>| assert!((r - e).norm() < 1e-12, "{kind:?}: {r} for {e}");
        for (w, q) in [(3.0, 1.0), (1e-3, 7.0), (1.7e5, 1e-4), (3e-200, 1e-190)] {
            let r = answer(&times(&plain, [w, 1.0], [q, 1.0]));
            r.iter().zip(&expected).for_each(|(r, e)| near(&(r * (w / q)), e));
        }
        answer(&permuted).iter().zip(order).for_each(|(r, i)| near(r, &expected[i]));
        answer(&turned).iter().zip(&turns).zip(&expected).for_each(|((r, turn), e)| near(&turn.tr_mul(r), e));
    }
}

/// Two masses on a spring, the first on a plane, with M, H and loads of any size.
#[test]
fn extreme_global_problems_are_solved_as_others_are() {
    let build = |m: f64, h: f64, f: f64| {
        let entries = [(0, 0, 1.0), (1, 1, 2.0), (1, 3, -1.0), (2, 2, 1.0), (3, 1, -1.0), (3, 3, 2.0)];
        let triplets = entries.map(|(i, j, x)| Triplet::new(i, j, x * m));
        let pull = [0, 1].map(|k| Triplet::new(k, k, h));
        GlobalProblem::<2> {
            m: SparseColMat::try_new_from_triplets(4, 4, &triplets).expect("inside"),
            h: SparseColMat::try_new_from_triplets(4, 2, &pull).expect("inside"),
            f: vec![-f, 2.0 * f, 0.0, 0.0],
            b: vec![Vector::zeros()],
            mu: vec![0.5],
        }
    };
    for (m, h, f) in [
        (1.0, 1.0, 1e-200),
        (1.0, 1.0, 1e-300),
        (1e-200, 1.0, 1e-200),
        (1e200, 1e100, 1e-80),
        (1e-30, 1e30, 1e200),
    ] {
        for method in GlobalMethod::ALL {
            let mut r = vec![Vector::zeros()];
            let answer = build(m, h, f)
                .solve(&mut r, method, SolverKind::default(), &StoppingRule::default())
                .expect("regular");
            assert!(answer.report.is_solved(), "{method:?} {m:e} {h:e} {f:e}: {:?}", answer.report);
            // It slips: r = f/h (1, −1/2), and the second mass follows with half of the first.
            let expected = Vector::<2>::new(1.0, -0.5);
            assert!((r[0] * (h / f) - expected).norm() < 1e-6, "{method:?} {m:e} {h:e} {f:e}: {}", r[0]);
            assert!((answer.velocities[1] * (m / f) - 1.0).abs() < 1e-6, "{:?}", answer.velocities);
            assert!((answer.motions[0][1] / h * (m / f) - 1.0).abs() < 1e-6, "{:?}", answer.motions);
        }
    }
    let mut r = vec![Vector::zeros()];
    let lost = build(1.0, 1e200, 1e-200)
        .solve(&mut r, GlobalMethod::Auto, SolverKind::default(), &StoppingRule::default())
        .expect("regular");
    assert_eq!(lost.report.status, SolveStatus::Stalled, "reactions of 1e-400 are zero");
}

/// The residual is an error over the size of the problem, whatever the size is: r = 0 leaves all of q.
#[test]
fn residuals_are_relative_to_the_largest_of_reactions_and_motions() {
    let mut w = BlockMatrix::default();
    w.push_row([(0, Matrix::<2>::identity() * 4.0)]);
    let problem = ContactProblem { w, q: vec![Vector::<2>::new(-8.0, 0.0)], mu: vec![0.0] };
    // ρ = 1/4. Without reactions w = q and the fixed point is ρ 8 n = 2 n; q counts ρ 8 = 2.
    let none = measure(&problem, &[Vector::zeros()]);
    assert_eq!((none.residual, none.natural_residual), (1.0, 1.0));
    // r = n leaves w = −4 n: the natural error is 1 of max(‖r‖, ρ‖q‖, ρ‖w‖) = 2, in the problem's units 4 of 8.
    let half = measure(&problem, &[Vector::<2>::new(1.0, 0.0)]);
    assert_eq!((half.residual, half.natural_residual, half.certificate), (0.5, 0.5, 4.0));
    // r = 16 n: w = 56 n, and the fixed point is proj(16 − 14) = 2 n: 14 of 16; with ρ = 1 it is 0: 16 of 56.
    let far = measure(&problem, &[Vector::<2>::new(16.0, 0.0)]);
    assert_eq!((far.residual, far.natural_residual, far.certificate), (16.0 / 56.0, 14.0 / 16.0, 896.0));
    // r = 4000 n is more than 10³ ρ‖q‖ = 2000 N: it counts as that, but ρ w = 3998 counts in full.
    let huge = measure(&problem, &[Vector::<2>::new(4000.0, 0.0)]);
    assert!((huge.natural_residual - 1.0).abs() < 1e-15, "{huge:?}");
    for k in [-1000, -500, 500, 1000] {
        let unit = power_of_two(k);
        let scaled = times(&problem, [1.0, 1.0], [unit, 1.0]);
        assert_eq!(measure(&scaled, &[Vector::<2>::new(16.0 * unit, 0.0)]).natural_residual, 14.0 / 16.0);
    }
}
