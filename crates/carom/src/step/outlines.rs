//! Outlines of bodies that place their nodes at the end of a step alone, and where nothing is near by fewer numbers than it takes.

use carom_contact::{Boundaries, Positions};
use carom_mesh::Vector;

use super::control::WAKING;
use super::iterating::Iterating;
use super::whereabouts::Whereabouts;
use super::workspace::Workspace;
use crate::body::Ball;
use crate::model::given::Given;
use crate::model::state::State;

/// Lets bodies place those nodes of their outlines that no iteration asks for.
pub(super) fn place_outlines<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) {
    let Workspace { iterating: Iterating { bodies, motion, .. }, boundaries, whereabouts, .. } = work;
    let Whereabouts { balls, boxes, near } = whereabouts;
    let assembly = given.assembly;
    for (i, (body, balls)) in bodies.iter_mut().zip(&mut *balls).enumerate() {
        balls.clear();
        body.balls(&next.displacement[assembly.nodes(i)], balls);
    }
    let is_asked = balls.iter().any(|balls| !balls.is_empty());
    for (i, (room, balls)) in boxes.iter_mut().zip(&*balls).enumerate().filter(|_| is_asked) {
        let position = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
        *room = if balls.is_empty() { way_of(boundaries, i, &position, motion) } else { around(balls) };
    }
    for i in 0..bodies.len() {
        near.clear();
        if !balls[i].is_empty() {
            near.extend((0..bodies.len()).filter(|&j| j != i && overlap(&boxes[i], &boxes[j])));
        }
        // Where it may have gone through itself all of it is looked at.
        let is_due = bodies[i].wandered().is_some_and(|w| w > WAKING.unseen * boundaries.least_cell(i));
        let (places, obstacles) = next.displacement.split_at_mut(assembly.node_count());
        let (motions, of_obstacles) = motion.split_at_mut(assembly.node_count());
        let half_way = |n: u32| {
            let k = n as usize - assembly.node_count();
            assembly.reference[n as usize] + obstacles[k] - of_obstacles[k] * 0.5
        };
        let is_near = |k: usize| {
            let ball = &balls[i][k];
            let meets_obstacle = || {
                assembly.contact.obstacles.iter().any(|obstacle| {
                    let way = obstacle
                        .node
                        .map_or(0.0, |n| of_obstacles[n as usize - assembly.node_count()].norm());
                    obstacle.gap(&ball.centre, &half_way).0 <= ball.radius + 0.5 * way
                })
            };
            let meets_body = |&j: &usize| match &balls[j][..] {
                [] => distance(&boxes[j], &ball.centre) <= ball.radius,
                others => others
                    .iter()
                    .any(|other| (other.centre - ball.centre).norm() <= ball.radius + other.radius),
            };
            is_due || meets_obstacle() || near.iter().any(meets_body)
        };
        let nodes = assembly.nodes(i);
        bodies[i].complete([&mut places[nodes.clone()], &mut motions[nodes]], &is_near);
    }
}

/// The box that a body is in all the way to `position` by these motions [m].
fn way_of<const D: usize>(
    boundaries: &Boundaries<D>,
    body: usize,
    position: &Positions<'_, D>,
    motion: &[Vector<D>],
) -> [Vector<D>; 2] {
    let empty = [Vector::<D>::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)];
    let [low, high] = boundaries.nodes(body).fold(empty, |[low, high], n| {
        let (end, d) = (position(n), motion[n as usize]);
        let start = end - d;
        [low.inf(&end).inf(&start), high.sup(&end).sup(&start)]
    });
    // Facets of second order go beyond their nodes.
    let beyond = boundaries.largest_cell(body);
    [low.add_scalar(-beyond), high.add_scalar(beyond)]
}

/// The box around balls.
fn around<const D: usize>(balls: &[Ball<D>]) -> [Vector<D>; 2] {
    let empty = [Vector::<D>::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY)];
    balls.iter().fold(empty, |[low, high], ball| {
        [low.inf(&ball.centre.add_scalar(-ball.radius)), high.sup(&ball.centre.add_scalar(ball.radius))]
    })
}

fn overlap<const D: usize>([low, high]: &[Vector<D>; 2], other: &[Vector<D>; 2]) -> bool {
    (0..D).all(|i| low[i] <= other[1][i] && other[0][i] <= high[i])
}

/// Distance of a point from a box [m], zero inside.
fn distance<const D: usize>([low, high]: &[Vector<D>; 2], x: &Vector<D>) -> f64 {
    Vector::<D>::from_fn(|i, _| (low[i] - x[i]).max(x[i] - high[i]).max(0.0)).norm()
}
