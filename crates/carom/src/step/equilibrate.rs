//! Newton's iterations of a load step: see [`super::newton::load_step`].

use carom_fem::FemError;
use carom_mesh::{Vector, nodal};

use super::correction::{begin_solves, correct, end_solves, residuals};
use super::hold::{driven_least, left_alone, not_held};
use super::iterating::Iterating;
use super::newton::control::LOAD_STEP;
use super::newton::holding::Holding;
use super::newton::load_step::{LoadStep, Verdict};
use super::stability::{self, about_to_give_way, is_in_question};
use crate::body::{Body, Guess, Tangent};
use crate::contact::stiffened::{OfReactions, Stiffened};
use crate::contact::{Accuracy, Contacts};
use crate::error::StepError;
use crate::model::given::Given;

/// Iterates for some `bodies` until they are in equilibrium, all that are in contact or one that is not, and returns how often.
///
/// # Errors
/// If that does not end, with what nothing holds where that is the reason.
pub(super) fn equilibrate<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<usize, StepError> {
    match approach(bodies, given.method.newton.max_iterations, given, reached, work) {
        Ok(iterations) => {
            let is_in_question = bodies.iter().any(|&i| is_in_question(i, work));
            if is_in_question {
                stability::check(bodies, given, reached, work)?;
            }
            let are_in_question = work.contacts.are_in_question(bodies);
            if is_in_question || are_in_question {
                linearise(bodies, given, reached, work)?;
            }
            if are_in_question {
                stability::check_together(given, work)?;
            }
            Ok(iterations)
        }
        Err(error @ (StepError::Newton { .. } | StepError::Runaway { .. })) => {
            if let Some((not_held, is_caught)) = not_held(bodies, given, reached, work) {
                work.newton.caught = is_caught.then_some(error);
                return Err(not_held);
            }
            Err(about_to_give_way(bodies, given, work).unwrap_or(error))
        }
        Err(
            error @ (StepError::Friction { .. } | StepError::Unstable { .. } | StepError::Restless { .. }),
        ) => {
            let is_unsolvable = matches!(error, StepError::Friction { .. });
            let indefinite = if is_unsolvable { stability::indefinite(given, work) } else { None };
            let together =
                indefinite.map(|undecided| stability::check_together(given, work).err().unwrap_or(undecided));
            Err(about_to_give_way(bodies, given, work).or(together).unwrap_or(error))
        }
        Err(error) => Err(error),
    }
}

/// Goes on with the iterations of a step in time of some `bodies`, which has made so many, as with those of a load step, from the present guess: a K̄
/// that was made elsewhere, or has no springs where the tangent is indefinite, brings it no nearer. Returns how many there were in all.
///
/// # Errors
/// If that does not end.
pub(super) fn go_on<const D: usize>(
    bodies: &[usize],
    made: usize,
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<usize, StepError> {
    let Iterating { contacts, newton, motion, bodies: all, .. } = work;
    contacts.soften(bodies);
    bodies.iter().for_each(|&i| newton.holding[i] = Holding::default());
    if bodies.iter().any(|&i| contacts.active.touched[i]) {
        contacts.evaluate(given, motion, None, bodies, all);
    }
    linearise(bodies, given, reached, work)?;
    let allowed = given.method.newton.max_iterations - made;
    Ok(made + approach(bodies, allowed, given, reached, work)?)
}

/// [`equilibrate`] in no more iterations than are `allowed`, with whatever error comes first.
fn approach<const D: usize>(
    bodies: &[usize],
    allowed: usize,
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<usize, StepError> {
    let rule = &given.method.newton;
    let (is_static, is_load_step) = (given.interval.map.is_static(), given.interval.is_load_step);
    // What a step in time moves is what its books are about.
    let entered = if is_load_step { &given.state.displacement[..given.assembly.node_count()] } else { &[] };
    let farthest = nodal::largest(entered);
    let worth = bodies.iter().map(|&i| work.bodies[i].tangent_worth()).max().unwrap_or(1);
    let mut load_step = LoadStep::new(rule.tolerance, allowed, worth, farthest);
    work.newton.keep_guess(bodies, given.assembly, &work.motion, &work.contacts.active);
    work.newton.left_alone.clear();
    for iteration in 1.. {
        let late = (iteration > LOAD_STEP.late).then_some(load_step.last);
        let moved = bodies.iter().map(|&i| given.assembly.largest(i, &work.motion));
        let motion = moved.fold(0.0, f64::max);
        let solved = solve(bodies, late, given, reached, work);
        let (correction, left, reason) = match solved {
            Ok(left) => {
                work.newton.leave_out();
                (work.newton.largest_correction(bodies, given.assembly), left, None)
            }
            Err(reason @ (StepError::Friction { .. } | StepError::NotFinite(_))) => {
                (f64::INFINITY, 0.0, Some(reason))
            }
            Err(reason) => return Err(reason),
        };
        let verdict =
            load_step.judge(iteration, correction, motion, left.max(round_off(bodies, given, work)));
        let is_unsolvable = matches!(reason, Some(StepError::Friction { .. }));
        let verdict = verdict.map_err(|error| reason.unwrap_or(error))?;
        if verdict == Verdict::Refused {
            if is_unsolvable {
                // With the stiffness of reactions a compliance may be indefinite.
                work.contacts.reduced.delassus.stiffened.of_reactions = OfReactions::None;
            }
            work.newton.return_to_guess(bodies, given.assembly, &mut work.motion, &mut work.contacts.active);
            follow(bodies, given, reached, work);
            bodies.iter().for_each(|&i| work.newton.holding[i].raise());
            linearise(bodies, given, reached, work)?;
            continue;
        }
        work.newton.keep_guess(bodies, given.assembly, &work.motion, &work.contacts.active);
        correct(bodies, given, reached, work);
        if verdict == Verdict::Last {
            if !work.newton.left_alone.is_empty() {
                work.newton.free_motion = driven_least(bodies, given, reached, work)?;
            }
            return Ok(iteration);
        }
        let size = given.assembly.size;
        if is_static && motion.max(correction) > LOAD_STEP.runaway * size {
            return Err(StepError::Runaway { motion: motion.max(correction), size });
        }
        if is_static
            && load_step.has_stalled()
            && let Some(motion) = left_alone(bodies, given, reached, work)
        {
            // No iteration comes to an end in what nothing resists. What is left out is small where inertia resists it.
            bodies.iter().for_each(|&i| work.newton.holding[i].raise_to(LOAD_STEP.left_alone));
            work.newton.left_alone.push(motion);
            load_step.has_other_corrections();
        }
        if verdict == Verdict::Renewed {
            if load_step.is_held_back(iteration) && work.newton.left_alone.is_empty() {
                bodies.iter().for_each(|&i| work.newton.holding[i].loosen());
            }
            if load_step.is_linear(iteration) {
                let is_definite = |&i: &usize| !work.newton.holding[i].was_indefinite;
                let is_nearly_over = load_step.has_stalled() && load_step.is_near();
                let stiffened = &mut work.contacts.reduced.delassus.stiffened;
                stiffened.have_more(bodies, is_nearly_over && bodies.iter().all(is_definite));
            }
            if load_step.is_shrinking() {
                bodies.iter().for_each(|&i| work.newton.holding[i].lower());
            }
            linearise(bodies, given, reached, work)?;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Solves for a correction at the present guess, and for the reactions there; `late` in the iterations the last correction [m] is known. Returns
/// what the tolerance of the contact problem leaves of motions [m].
fn solve<const D: usize>(
    bodies: &[usize],
    late: Option<f64>,
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<f64, StepError> {
    let touched = bodies.iter().any(|&i| work.contacts.active.touched[i]);
    if touched {
        work.contacts.evaluate(given, &work.motion, late, bodies, &mut work.bodies);
    }
    residuals(bodies, 1, given, reached, work);
    let reacts = touched && work.contacts.react(given.assembly);
    if bodies.iter().any(|&i| !nodal::is_finite(&work.newton.residual[given.assembly.nodes(i)])) {
        return Err(StepError::NotFinite("internal force"));
    }
    if reacts {
        let Iterating { contacts, motion, bodies, newton, .. } = work;
        contacts.stiffen(given, motion, bodies, &mut newton.residual);
    }
    begin_solves(bodies, given, reacts, work);
    let mut left = 0.0;
    if reacts {
        left = work.contacts.solve(given, &work.motion, Accuracy::Last(f64::INFINITY), &mut work.bodies)?;
    }
    end_solves(bodies, given, work)?;
    Ok(left)
}

/// Writes the displacements [m] of the present guess.
pub(super) fn follow<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) {
    for nodes in bodies.iter().map(|&i| given.assembly.nodes(i)) {
        let from = [&given.state.displacement[nodes.clone()], &work.motion[nodes.clone()]];
        nodal::each(&mut reached[nodes], from, |u1, [u0, d]| *u1 = u0 + d);
    }
}

/// Makes the tangents at the present guess.
fn linearise<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    let Iterating { bodies: all, contacts, motion, .. } = work;
    let Contacts { active, reduced, .. } = contacts;
    reduced.delassus.stiffened.spring_from_guess(given.assembly, reached, active, all);
    if given.interval.map.is_static() {
        reduced.expect_more(all);
    }
    for &i in bodies {
        let guess = given.guess(i, motion, reached);
        let holding = &mut work.newton.holding[i];
        let stiffened = &mut reduced.delassus.stiffened;
        let held = hold(&mut *all[i], &guess, false, holding, (stiffened, i));
        work.factorisations += held.map_err(|error| unstable(error, given, i))?;
    }
    Ok(())
}

/// Makes the tangents at the start of a load step, and lets the bodies follow what is prescribed of them.
pub(super) fn set_out<const D: usize>(
    given: &Given<'_, D>,
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    let Iterating { bodies, contacts, newton, motion, .. } = work;
    contacts.reduced.expect_those_of(given.state, given.assembly, bodies);
    let stiffened = &mut contacts.reduced.delassus.stiffened;
    stiffened.let_go(&given.assembly.everyone);
    stiffened.spring_from_start(given.assembly, given.state, bodies);
    stiffened.of_reactions = OfReactions::None;
    newton.holding.fill(Holding::default());
    (newton.caught, newton.giving_way) = (None, None);
    for (i, body) in bodies.iter_mut().enumerate() {
        let nodes = given.assembly.nodes(i);
        // Nothing has moved yet, whatever will.
        newton.correction[nodes.clone()].fill(Vector::zeros());
        let guess = Guess {
            motion: &newton.correction[nodes.clone()],
            displacement: &given.state.displacement[nodes.clone()],
            ..given.guess(i, motion, &given.state.displacement)
        };
        let held = hold(&mut **body, &guess, true, &mut newton.holding[i], (stiffened, i));
        work.factorisations += held.map_err(|error| unstable(error, given, i))?;
        body.follow(given.interval, &given.start(i), &mut motion[nodes]);
    }
    Ok(())
}

/// What it says of a body that its tangent has no inverse whatever holds it back.
fn unstable<const D: usize>(error: StepError, given: &Given<'_, D>, body: usize) -> StepError {
    match error {
        StepError::Matrix(FemError::NotPositiveDefinite) if given.interval.map.is_static() => {
            let body = given.assembly.name(body).to_string();
            let motion = String::new();
            // Where there is a bridge, this is said only if it leads nowhere.
            if given.method.bridges {
                StepError::Restless { body, motion }
            } else {
                StepError::Unstable { body, motion }
            }
        }
        error => error,
    }
}

/// Makes the tangent of a body at a guess, with the springs of its contacts where it has no inverse without, and held back by as much as
/// it takes; returns how often it was tried.
fn hold<const D: usize>(
    body: &mut dyn Body<D>,
    guess: &Guess<'_, D>,
    is_first: bool,
    holding: &mut Holding,
    (stiffened, number): (&mut Stiffened<D>, usize),
) -> Result<u64, StepError> {
    for tries in 1.. {
        let (springs, softest_spring) = stiffened.support(number);
        let tangent = Tangent {
            held_back: holding.share,
            grip: holding.grip,
            springs: &springs,
            softest_spring,
            is_first,
        };
        let Err(error) = body.linearise(guess, &tangent) else { return Ok(tries) };
        if error.is_of_memory() {
            return Err(error);
        }
        if stiffened.support_more(number) {
            continue;
        }
        holding.raise_for_good();
        if holding.share > LOAD_STEP.largest {
            return Err(error);
        }
    }
    unreachable!("the share grows beyond its largest")
}

/// What round-off leaves of the motion [m]. Where that is much, the tangent is as good as singular, and says nothing of it.
fn round_off<const D: usize>(bodies: &[usize], given: &Given<'_, D>, work: &Iterating<D>) -> f64 {
    let of_bodies = bodies.iter().map(|&i| work.bodies[i].round_off());
    of_bodies.fold(given.assembly.round_off(), f64::max).min(LOAD_STEP.trusted * given.assembly.size)
}
