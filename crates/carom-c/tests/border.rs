//! What C may do wrong is a status and a message: null pointers, wrong sizes, wrong values, wrong order.

use std::ffi::{CStr, c_int, c_void};
use std::ptr::{null, null_mut};

use carom_c::door::books::*;
use carom_c::door::carom_status;
use carom_c::door::contact::*;
use carom_c::door::friction::*;
use carom_c::door::messages::{carom_last_error, carom_version};
use carom_c::door::results::*;
use carom_c::door::setup::*;

const SQUARE: [f64; 8] = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
const EDGES: [i32; 8] = [0, 1, 1, 2, 2, 3, 3, 0];

fn said() -> String {
    // SAFETY: it is a text, and no call lies in between.
    unsafe { CStr::from_ptr(carom_last_error()) }.to_string_lossy().into_owned()
}

#[track_caller]
fn refused(status: carom_status, message: &str) {
    assert_eq!(status, carom_status::INVALID);
    assert_eq!(said(), message);
}

#[track_caller]
fn done(status: carom_status) {
    assert_eq!(status, carom_status::OK, "{}", said());
    assert_eq!(said(), "");
}

fn setup() -> *mut carom_setup {
    let mut setup = null_mut();
    // SAFETY: the arrays are there.
    unsafe {
        done(carom_setup_new(2, SQUARE.as_ptr(), 4, &mut setup));
        done(carom_setup_surface(setup, c"square".as_ptr(), EDGES.as_ptr(), 4, 2, 0));
        let (point, normal) = ([0.0, 0.0], [0.0, 1.0]);
        done(carom_setup_plane(setup, c"floor".as_ptr(), point.as_ptr(), normal.as_ptr()));
    }
    setup
}

fn contact(setup: *mut carom_setup) -> *mut carom_contact {
    let mut contact = null_mut();
    // SAFETY: the setup is there.
    unsafe { done(carom_setup_build(setup, &mut contact)) };
    contact
}

/// What a callback is given: the stiffness of all unknowns, and contact to misuse.
struct Context {
    stiffness: f64,
    code: c_int,
    contact: *mut carom_contact,
    inner: carom_status,
}

unsafe extern "C" fn scaled(
    context: *mut c_void,
    unknowns: usize,
    columns: usize,
    b: *const f64,
    x: *mut f64,
) -> c_int {
    // SAFETY: what carom promises.
    unsafe {
        let context = &mut *context.cast::<Context>();
        if !context.contact.is_null() {
            let mut count = 0;
            context.inner = carom_contact_count(context.contact, &mut count);
        }
        (0..unknowns * columns).for_each(|k| *x.add(k) = *b.add(k) / context.stiffness);
        context.code
    }
}

fn stiff(stiffness: f64) -> Context {
    Context { stiffness, code: 0, contact: null_mut(), inner: carom_status::OK }
}

#[test]
fn a_setup_refuses_what_cannot_be() {
    let mut none = null_mut();
    // SAFETY: the arrays are as large as said where anything is read.
    unsafe {
        refused(carom_setup_new(4, SQUARE.as_ptr(), 2, &mut none), "dimension is 4; must be 2 or 3");
        refused(carom_setup_new(2, null(), 4, &mut none), "points is a null pointer, and 8 are needed there");
        refused(
            carom_setup_new(2, SQUARE.as_ptr(), 0, &mut none),
            "there are no points; give the places of all nodes",
        );
        refused(
            carom_setup_new(2, SQUARE.as_ptr(), 4, null_mut()),
            "setup is a null pointer, and 1 are needed there",
        );
        refused(
            carom_setup_new(2, SQUARE.as_ptr(), usize::MAX / 2 + 1, &mut none),
            &format!("points cannot have {} × 2 entries; check the counts", usize::MAX / 2 + 1),
        );
        refused(
            carom_setup_new(2, SQUARE.as_ptr(), usize::MAX / 8, &mut none),
            &format!("points cannot have {} entries; check the count", usize::MAX / 8 * 2),
        );
        let odd = SQUARE.as_ptr().cast::<u8>().add(1).cast();
        refused(carom_setup_new(2, odd, 3, &mut none), "points is not aligned as its type needs");
        let nan = [0.0, f64::NAN];
        refused(carom_setup_new(2, nan.as_ptr(), 1, &mut none), "points[1] = NaN: must be finite");
        assert!(none.is_null());

        refused(carom_setup_build(null_mut(), null_mut()), "setup is a null pointer, and 1 are needed there");
        done(carom_setup_new(2, SQUARE.as_ptr(), 4, &mut none));
        let empty = none;
        let mut built = null_mut();
        refused(
            carom_setup_build(empty, &mut built),
            "there is no surface; give the boundary of one body at least",
        );
        carom_setup_free(empty);
        carom_setup_free(null_mut());
        carom_contact_free(null_mut());

        let setup = setup();
        let edges = EDGES.as_ptr();
        refused(
            carom_setup_surface(setup, null(), edges, 4, 2, 0),
            "name is a null pointer; give a text that ends with a zero",
        );
        refused(carom_setup_surface(setup, c"\xe9".as_ptr(), edges, 4, 2, 0), "name is no text in UTF-8");
        let name = c"other".as_ptr();
        for (count, width) in [(0, 2), (4, 0)] {
            let message = "surfaces.other.facets: there are none; give one at least";
            refused(carom_setup_surface(setup, name, edges, count, width, 0), message);
        }
        refused(
            carom_setup_surface(setup, name, [0, -3].as_ptr(), 1, 2, 0),
            "surfaces.other.facets: facet 0 has node -3; nodes are numbered from 0",
        );
        let twice = "\"floor\" is the name of two surfaces or obstacles";
        refused(carom_setup_surface(setup, c"floor".as_ptr(), edges, 4, 2, 0), twice);
        refused(carom_setup_box(setup, c"floor".as_ptr(), edges.cast(), edges.cast()), twice);
        refused(
            carom_setup_velocity(setup, name, SQUARE.as_ptr()),
            "there is no obstacle named \"other\"; add it first",
        );
        refused(
            carom_setup_sphere(setup, name, SQUARE.as_ptr(), f64::NAN, 0),
            "radius = NaN: must be finite",
        );
        let outside = [0, 1, 3];
        refused(
            carom_setup_triangles(setup, name, [0.0; 9].as_ptr(), 3, outside.as_ptr(), 1),
            "triangles: triangle 0 has vertex 3, and there are 3",
        );
        refused(
            carom_setup_unknowns(setup, EDGES.as_ptr(), 3, 8),
            "point_count is 3; there are 4 points, of which all are needed",
        );
        refused(
            carom_setup_unknowns(setup, EDGES.as_ptr(), 4, 3),
            "unknowns has 3, and there are 3; they are numbered from 0",
        );
        carom_setup_free(setup);
    }
}

#[test]
fn settings_are_known_by_the_names_of_the_case_file() {
    let setup = setup();
    // SAFETY: texts end with a zero.
    unsafe {
        refused(
            carom_setup_text(setup, c"condition".as_ptr(), c"gab".as_ptr()),
            "setting \"condition\": unknown variant `gab`, expected one of `gap`, `midpoint`, `endpoint`, `massless`",
        );
        refused(
            carom_setup_text(setup, c"speed".as_ptr(), c"gap".as_ptr()),
            "there is no setting \"speed\"; there are analysis, condition, discretisation, friction, max_iterations, solver, sources, targets, theta and tolerance",
        );
        refused(
            carom_setup_text(setup, c"analysis".as_ptr(), c"modal".as_ptr()),
            "analysis = \"modal\": must be \"dynamic\" or \"static\"",
        );
        refused(
            carom_setup_number(setup, c"max_iterations".as_ptr(), 1.5),
            "max_iterations = 1.5: must be a whole number",
        );
        refused(
            carom_setup_number(setup, c"friction".as_ptr(), f64::INFINITY),
            "friction = inf: must be finite",
        );
        let (square, floor) = (c"square".as_ptr(), c"floor".as_ptr());
        refused(
            carom_setup_pair_number(setup, square, c"wall".as_ptr(), c"friction".as_ptr(), 0.1),
            "there is no surface or obstacle named \"wall\"; add it before its pairs",
        );
        refused(
            carom_setup_pair_number(setup, square, floor, c"interference".as_ptr(), 0.1),
            "there is no setting \"interference\" of pairs; there are discretisation, enabled, friction and sources",
        );
        done(carom_setup_pair_text(setup, square, floor, c"sources".as_ptr(), c"first".as_ptr()));
        done(carom_setup_pair_number(setup, square, floor, c"enabled".as_ptr(), 1.0));
        done(carom_setup_number(setup, c"friction".as_ptr(), -0.1));
        let mut built = null_mut();
        refused(
            carom_setup_build(setup, &mut built),
            "contact.friction: -0.1: friction must be between 0 and 1000",
        );
        done(carom_setup_number(setup, c"friction".as_ptr(), 0.3));
        done(carom_setup_pair_number(setup, square, floor, c"friction".as_ptr(), 0.5));
        let contact = contact(setup);
        carom_setup_free(setup);
        let velocity = [0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0];
        done(carom_contact_search(contact, SQUARE.as_ptr(), velocity.as_ptr(), 4, 0.1, 0.0));
        done(carom_contact_evaluate(contact, SQUARE.as_ptr(), 4));
        let mut friction = [0.0; 2];
        done(carom_contact_friction(contact, friction.as_mut_ptr(), 2));
        assert_eq!(friction, [0.5; 2]);
        carom_contact_free(contact);
    }
}

/// The contact of a condition that rules velocities.
fn by_velocity() -> *mut carom_contact {
    let setup = setup();
    // SAFETY: both texts end with a zero.
    unsafe { done(carom_setup_text(setup, c"condition".as_ptr(), c"endpoint".as_ptr())) };
    contact(setup)
}

#[test]
fn a_step_refuses_what_does_not_fit_and_what_comes_too_early() {
    let setup = setup();
    let contact = contact(setup);
    let (at, mut count) = (SQUARE.as_ptr(), 0);
    let velocity = [0.0, -1.0, 0.0, -1.0, 0.0, -1.0, 0.0, -1.0];
    let mut step = carom_step::default();
    let mut motion = [0.0; 8];
    let mut context = stiff(1e3);
    let given = (&raw mut context).cast::<c_void>();
    // SAFETY: the arrays are as large as said where anything is read or written.
    unsafe {
        let too_early = "nothing was searched in this step: search first";
        refused(carom_contact_count(contact, &mut count), too_early);
        refused(carom_contact_evaluate(contact, at, 4), too_early);
        let none = "contact is a null pointer, and 1 are needed there";
        refused(carom_contact_evaluate(null_mut(), at, 4), none);
        refused(
            carom_contact_search(contact, at, velocity.as_ptr(), 3, 0.1, 0.0),
            "point_count is 3; there are 4 points, of which all are needed",
        );
        refused(
            carom_contact_search(contact, at, velocity.as_ptr(), 4, 0.0, 0.0),
            "time_step = 0: must be greater than 0",
        );
        refused(
            carom_contact_search(contact, at, velocity.as_ptr(), 4, 0.1, -1.0),
            "reach = -1: must be greater than 0, or 0 for as far as anything moves",
        );
        refused(
            carom_contact_search(contact, at, null(), 4, 0.1, 0.0),
            "velocity is a null pointer; give it, so that it is known how far to look, or give a reach",
        );
        done(carom_contact_search(contact, at, null(), 4, 0.1, 0.1));
        let ruled = by_velocity();
        refused(
            carom_contact_search(ruled, at, null(), 4, 0.1, 0.1),
            "velocity is a null pointer; give it, what the condition rules and where obstacles go depends on it",
        );
        carom_contact_free(ruled);
        done(carom_contact_search(contact, at, velocity.as_ptr(), 4, 0.1, 0.0));
        done(carom_contact_count(contact, &mut count));
        assert_eq!(count, 2);
        let mut gaps = [0.0; 2];
        let too_early = "nothing was evaluated in this step: search and evaluate first";
        refused(carom_contact_gaps(contact, gaps.as_mut_ptr(), 2), too_early);
        refused(
            carom_contact_solve(contact, motion.as_ptr(), 8, Some(scaled), given, motion.as_mut_ptr()),
            too_early,
        );
        let lower: Vec<f64> = SQUARE.iter().zip(velocity).map(|(x, v)| x + 0.1 * v).collect();
        done(carom_contact_evaluate(contact, lower.as_ptr(), 4));
        done(carom_contact_gaps(contact, gaps.as_mut_ptr(), 2));
        assert_eq!(gaps, [-0.1; 2]);
        refused(
            carom_contact_gaps(contact, gaps.as_mut_ptr(), 1),
            "gaps has room for 1 entries, and there are 2; ask for the count first",
        );
        refused(carom_contact_gaps(contact, null_mut(), 2), "gaps is a null pointer, and 2 are needed there");
        let unsolved = "the contacts have no reactions: solve first, or set them";
        refused(carom_contact_accept(contact, at, 4, &mut step), unsolved);
        refused(
            carom_contact_set_reactions(contact, motion.as_ptr(), 3),
            "reactions has 3 entries; the contacts have 4 components",
        );

        let free: Vec<f64> = velocity.iter().map(|v| 0.1 * v).collect();
        let (free, out) = (free.as_ptr(), motion.as_mut_ptr());
        refused(
            carom_contact_solve(contact, free, 7, Some(scaled), given, out),
            "unknown_count is 7; the unknowns were numbered up to 8",
        );
        refused(
            carom_contact_solve(contact, free, 8, Some(scaled), given, null_mut()),
            "motion is a null pointer; give room for every unknown",
        );
        refused(
            carom_contact_solve(contact, free, 8, None, given, out),
            "solver is a null pointer; give a function that solves with K",
        );
        context.code = 7;
        assert_eq!(
            carom_contact_solve(contact, free, 8, Some(scaled), given, out),
            carom_status::SOLVER_FAILED
        );
        assert_eq!(said(), "solver: the function that solves with K returned 7");
        (context.code, context.stiffness) = (0, 0.0);
        refused(
            carom_contact_solve(contact, free, 8, Some(scaled), given, out),
            "solver: its answer is NaN at unknown 0; K must be regular, so support what moves freely or give it mass",
        );
        context.stiffness = -1.0;
        refused(
            carom_contact_solve(contact, free, 8, Some(scaled), given, out),
            "solver: a force along the normal of contact 0 moves it by -1 m/N; K must be positive definite",
        );
        refused(carom_contact_accept(contact, at, 4, &mut step), unsolved);

        (context.stiffness, context.contact) = (1e3, contact);
        done(carom_contact_solve(contact, free, 8, Some(scaled), given, out));
        assert_eq!(context.inner, carom_status::BUSY, "the callback is kept from its own handle");
        assert_eq!(motion.map(|d| (1e12 * d).round() / 1e12), [0.0, 0.0, 0.0, 0.0, 0.0, -0.1, 0.0, -0.1]);
        let mut missed = 1;
        done(carom_contact_missed(contact, at, 4, &mut missed));
        assert_eq!(missed, 0);
        done(carom_contact_accept(contact, at, 4, &mut step));
        assert_eq!(step.pressing, 2);
        refused(carom_contact_evaluate(contact, at, 4), "nothing was searched in this step: search first");
        let (mut a, mut b) = (null(), null());
        refused(
            carom_contact_pair_names(contact, 1, &mut a, &mut b),
            "there is no pair of the number 1; carom_contact_pairs tells those of contacts",
        );
        done(carom_contact_pair_names(contact, 0, &mut a, &mut b));
        assert_eq!([CStr::from_ptr(a), CStr::from_ptr(b)], [c"square", c"floor"]);
        carom_contact_free(contact);
        carom_setup_free(setup);
    }
}

/// A unit mass is pressed down with 1 and pushed sideways with 2, friction 0.5: it slips (closed form).
#[test]
fn a_contact_problem_alone_has_its_answer() {
    let (w, q, mu) = ([1.0, 0.0, 0.0, 1.0], [-1.0, 2.0], [0.5]);
    let mut problem = carom_problem {
        dimension: 2,
        contact_count: 1,
        compliance: w.as_ptr(),
        motion: q.as_ptr(),
        friction: mu.as_ptr(),
    };
    let (mut r, mut report) = ([0.0; 2], carom_report::default());
    // SAFETY: the arrays are as large as said where anything is read or written.
    unsafe {
        done(carom_friction_solve(&problem, null(), r.as_mut_ptr(), &mut report));
        assert!((r[0] - 1.0).abs() < 1e-11 && (r[1] + 0.5).abs() < 1e-11, "{r:?}");
        assert!(report.residual < 1e-12 && report.certificate < 1e-11);
        let mut method = carom_method { solver: c"uzava".as_ptr(), tolerance: 0.0, max_iterations: 0 };
        refused(
            carom_friction_solve(&problem, &method, r.as_mut_ptr(), null_mut()),
            "there is no friction solver named \"uzava\"; there are auto, gauss-seidel, gauss-seidel-enumerative, gauss-seidel-alart-curnier, uzawa, projected-gradient, admm, proximal, newton-alart-curnier, newton-natural-map",
        );
        (method.solver, method.tolerance) = (null(), -1.0);
        refused(
            carom_friction_solve(&problem, &method, r.as_mut_ptr(), null_mut()),
            "tolerance = -1: must be greater than 0, or 0 for 1e-12",
        );
        (method.solver, method.tolerance, method.max_iterations) = (c"gauss-seidel".as_ptr(), 1e-15, 1);
        let coupled = [1.0, 0.9, 0.9, 1.0];
        problem.compliance = coupled.as_ptr();
        let kept = r;
        let status = carom_friction_solve(&problem, &method, r.as_mut_ptr(), null_mut());
        assert_eq!(status, carom_status::NOT_CONVERGED);
        assert!(said().starts_with("the contact problem of 1 contacts ended as "), "{}", said());
        assert_eq!(r, kept, "nothing is written then");
        let negative = [-0.5];
        problem.friction = negative.as_ptr();
        refused(
            carom_friction_solve(&problem, null(), r.as_mut_ptr(), null_mut()),
            "friction[0] = -0.5: must be at least 0",
        );
        problem.dimension = 4;
        let wide = [0.0; 16];
        (problem.compliance, problem.motion, problem.friction) =
            (wide.as_ptr(), wide.as_ptr(), wide.as_ptr());
        let mut r = [0.0; 4];
        refused(
            carom_friction_solve(&problem, null(), r.as_mut_ptr(), null_mut()),
            "dimension is 4; must be 1, 2 or 3",
        );
    }
}

/// Swaps the two unknowns and scales one of them: not symmetric.
unsafe extern "C" fn skew(_: *mut c_void, _: usize, columns: usize, b: *const f64, x: *mut f64) -> c_int {
    for k in 0..columns {
        // SAFETY: there are two unknowns.
        unsafe {
            *x.add(2 * k) = 2.0 * *b.add(2 * k + 1);
            *x.add(2 * k + 1) = *b.add(2 * k);
        }
    }
    0
}

#[test]
fn compliances_of_maps_are_condensed_and_checked() {
    // More columns than are solved for at once; an unknown stands there twice.
    let (starts, unknowns): (Vec<usize>, Vec<i32>) = ((0..=20).map(|k| 2 * k).collect(), vec![0; 40]);
    let values = [0.5; 40];
    let mut map = carom_map {
        unknown_count: 2,
        column_count: 20,
        starts: starts.as_ptr(),
        unknowns: unknowns.as_ptr(),
        values: values.as_ptr(),
    };
    let (mut context, mut w) = (stiff(4.0), [0.0; 400]);
    let given = (&raw mut context).cast::<c_void>();
    // SAFETY: the arrays are as large as said where anything is read or written.
    unsafe {
        done(carom_friction_condense(&map, Some(scaled), given, w.as_mut_ptr()));
        assert_eq!(w, [0.25; 400]);
        let (starts, unknowns, values) = ([0_usize, 1, 2], [0, 1], [1.0; 2]);
        (map.column_count, map.starts, map.unknowns, map.values) =
            (2, starts.as_ptr(), unknowns.as_ptr(), values.as_ptr());
        refused(
            carom_friction_condense(&map, Some(skew), null_mut(), w.as_mut_ptr()),
            "solver: W is asymmetric by 0.50 of its largest entry, at [1, 0], where 0.01 is allowed; give the solver of a symmetric K, and solve it more accurately if it iterates",
        );
        let backward = [0_usize, 2, 1];
        map.starts = backward.as_ptr();
        refused(
            carom_friction_condense(&map, Some(skew), null_mut(), w.as_mut_ptr()),
            "starts must begin with 0 and ascend",
        );
        let outside = [0, 2];
        (map.starts, map.unknowns) = (starts.as_ptr(), outside.as_ptr());
        refused(
            carom_friction_condense(&map, Some(skew), null_mut(), w.as_mut_ptr()),
            "unknowns[1] is 2, and there are 2; they are numbered from 0",
        );
    }
}

/// W = Hᵀ K⁻¹ H of the map that contact tells is that with which it solves: reactions found by both ways are the same, in space.
#[test]
fn contact_solved_by_hand_is_contact_solved_by_carom() {
    let corners: Vec<f64> = (0..8).flat_map(|n| [n & 1, n >> 1 & 1, n >> 2].map(f64::from)).collect();
    let sides = [0, 1, 3, 2, 4, 5, 7, 6, 0, 1, 5, 4, 2, 3, 7, 6, 0, 2, 6, 4, 1, 3, 7, 5];
    let velocity: Vec<f64> = (0..8).flat_map(|_| [1.0, 0.5, -1.0]).collect();
    let (mut setup, mut contact) = (null_mut(), null_mut());
    let free: Vec<f64> = velocity.iter().map(|v| 0.1 * v).collect();
    let lower: Vec<f64> = corners.iter().zip(&free).map(|(x, d)| x + d).collect();
    let mut context = stiff(200.0);
    let given = (&raw mut context).cast::<c_void>();
    // SAFETY: the arrays are as large as said.
    unsafe {
        done(carom_setup_new(3, corners.as_ptr(), 8, &mut setup));
        done(carom_setup_surface(setup, c"cube".as_ptr(), sides.as_ptr(), 6, 4, 0));
        let (origin, up) = ([0.0; 3], [0.0, 0.0, 1.0]);
        done(carom_setup_plane(setup, c"floor".as_ptr(), origin.as_ptr(), up.as_ptr()));
        done(carom_setup_number(setup, c"friction".as_ptr(), 0.25));
        done(carom_setup_build(setup, &mut contact));
        carom_setup_free(setup);
        done(carom_contact_search(contact, corners.as_ptr(), velocity.as_ptr(), 8, 0.1, 0.0));
        done(carom_contact_evaluate(contact, lower.as_ptr(), 8));
        let (mut count, mut entries) = (0, 0);
        done(carom_contact_count(contact, &mut count));
        done(carom_contact_map_size(contact, &mut entries));
        let columns = 3 * count;
        let (mut starts, mut unknowns, mut values) =
            (vec![0; columns + 1], vec![0; entries], vec![0.0; entries]);
        done(carom_contact_map(
            contact,
            starts.as_mut_ptr(),
            columns,
            unknowns.as_mut_ptr(),
            values.as_mut_ptr(),
            entries,
        ));
        let map = carom_map {
            unknown_count: 24,
            column_count: columns,
            starts: starts.as_ptr(),
            unknowns: unknowns.as_ptr(),
            values: values.as_ptr(),
        };
        let mut w = vec![0.0; columns * columns];
        done(carom_friction_condense(&map, Some(scaled), given, w.as_mut_ptr()));
        let (mut q, mut mu, mut r) = (vec![0.0; columns], vec![0.0; count], vec![0.0; columns]);
        done(carom_contact_offsets(contact, q.as_mut_ptr(), columns));
        done(carom_contact_friction(contact, mu.as_mut_ptr(), count));
        for j in 0..columns {
            (starts[j]..starts[j + 1]).for_each(|k| q[j] += values[k] * free[unknowns[k] as usize]);
        }
        let (compliance, motion, friction) = (w.as_ptr(), q.as_ptr(), mu.as_ptr());
        let problem = carom_problem { dimension: 3, contact_count: count, compliance, motion, friction };
        done(carom_friction_solve(&problem, null(), r.as_mut_ptr(), null_mut()));

        let mut moved = vec![0.0; 24];
        done(carom_contact_solve(contact, free.as_ptr(), 24, Some(scaled), given, moved.as_mut_ptr()));
        let (mut own, mut force) = (vec![0.0; columns], vec![0.0; 24]);
        done(carom_contact_reactions(contact, own.as_mut_ptr(), columns));
        done(carom_contact_force(contact, force.as_mut_ptr(), 24));
        let largest = own.iter().fold(0.0_f64, |a, x| a.max(x.abs()));
        assert!(largest > 15.0, "200 N/m times 0.1 m");
        assert!(own.iter().zip(&r).all(|(a, b)| (a - b).abs() < 1e-10 * largest));
        let by_force = free.iter().zip(&force).map(|(d, f)| d + f / 200.0);
        assert!(moved.iter().zip(by_force).all(|(a, b)| (a - b).abs() < 1e-14));

        let (mut nodes, mut pairs, mut frames) = (vec![0; count], vec![9; count], vec![0.0; 9 * count]);
        done(carom_contact_nodes(contact, nodes.as_mut_ptr(), count));
        done(carom_contact_pairs(contact, pairs.as_mut_ptr(), count));
        done(carom_contact_frames(contact, frames.as_mut_ptr(), 9 * count));
        assert_eq!((nodes, pairs), (vec![0, 1, 2, 3], vec![0; 4]));
        assert!(frames.chunks(9).all(|frame| frame[..3] == [0.0, 0.0, 1.0]), "the normal comes first");
        let end: Vec<f64> = corners.iter().zip(&moved).map(|(x, d)| x + d).collect();
        let (mut step, mut books, mut work) =
            (carom_step::default(), carom_ledger::default(), carom_work::default());
        done(carom_contact_accept(contact, end.as_ptr(), 8, &mut step));
        done(carom_contact_ledger(contact, &mut books));
        let (floor, cube) = (c"floor".as_ptr(), c"cube".as_ptr());
        done(carom_contact_pair_work(contact, floor, cube, &mut work));
        let nobody = "\"cube\" and \"cube\" are no surfaces or obstacles that may touch";
        refused(carom_contact_pair_work(contact, cube, cube, &mut work), nobody);
        assert!(step.work.friction > 0.0 && step.work == books.work && books.work == work);
        assert_eq!((books.steps, books.time), (1, 0.1));
        let mut report = carom_report::default();
        let unsolved = "the contacts have no reactions: solve first, or set them";
        refused(carom_contact_report(contact, &mut report), unsolved);
        carom_contact_free(contact);
        assert_eq!(CStr::from_ptr(carom_version()).to_str(), Ok(env!("CARGO_PKG_VERSION")));
    }
}
