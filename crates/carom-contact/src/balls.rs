//! Contacts of balls, with obstacles without corners and with one another.

use carom_mesh::Vector;

use crate::ball::Ball;
use crate::frame::frame;
use crate::path::Positions;
use crate::{Candidate, Contact, ContactModel, Obstacle, Pair, Path, Proximity, Target};

/// The contact with an `obstacle` without corners.
fn before_obstacle<const D: usize>(
    ball: &Ball,
    obstacle: &Obstacle<D>,
    position: &Positions<'_, D>,
) -> Contact<D> {
    let (gap, normal) = obstacle.gap(&ball.centre(position), position);
    let sources = ball.touching(&normal, position);
    let stencil = sources.chain(obstacle.node.map(|node| (node, -1.0)));
    Contact::of_stencil(gap - ball.radius, frame(&normal), 0.0, stencil, D + 1)
}

/// The contact with another ball.
fn before_ball<const D: usize>(ball: &Ball, other: &Ball, position: &Positions<'_, D>) -> Contact<D> {
    let (distance, normal) = apart(&ball.centre(position), &other.centre(position));
    let back = -normal;
    let targets = other.touching(&back, position).map(|(node, weight)| (node, -weight));
    let stencil = ball.touching(&normal, position).chain(targets);
    let gap = distance - ball.radius - other.radius;
    Contact::of_stencil(gap, frame(&normal), 0.0, stencil, D + 1)
}

/// How far a point is from another [m], and in which direction. Two in the same place are pushed apart along the first axis.
pub(crate) fn apart<const D: usize>(from: &Vector<D>, other: &Vector<D>) -> (f64, Vector<D>) {
    let way = from - other;
    let distance = way.norm();
    let first = || Vector::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 });
    (distance, if distance > 0.0 { way / distance } else { first() })
}

impl<const D: usize> ContactModel<D> {
    /// The balls of a pair of bodies that are both round.
    pub(crate) fn balls(&self, pair: &Pair) -> Option<[&Ball; 2]> {
        let Target::Surface(target) = pair.target else { return None };
        Some([self.surfaces[pair.source].ball.as_ref()?, self.surfaces[target].ball.as_ref()?])
    }

    /// Adds to `out` a pair of balls that come near one another, once for both directions.
    pub(crate) fn detect_balls(&self, pair: usize, path: &Path<'_, D>, out: &mut Vec<Candidate>) {
        let Some([ball, other]) = self.balls(&self.pairs.get(pair)) else { return };
        if self.pairs.directions(pair).start != pair {
            return;
        }
        let near = |contact: Contact<D>| contact.gap <= path.margin;
        if near(before_ball(ball, other, path.start)) || near(before_ball(ball, other, path.end)) {
            out.push(Candidate::at_node(pair as u32, ball.node(), None));
        }
    }

    /// Adds to `out` a ball that comes near an obstacle without corners.
    pub(crate) fn detect_ball(
        &self,
        (pair, ball): (usize, &Ball),
        obstacle: &Obstacle<D>,
        path: &Path<'_, D>,
        out: &mut Vec<Candidate>,
    ) {
        let near = path.margin + ball.radius;
        if obstacle.is_near(&ball.centre(path.start), near, path.start)
            || obstacle.is_near(&ball.centre(path.end), near, path.end)
        {
            out.push(Candidate::at_node(pair as u32, ball.node(), None));
        }
    }

    /// The contact of a pair of balls.
    pub(crate) fn between_balls(&self, pair: usize, position: &Positions<'_, D>) -> Option<Contact<D>> {
        let [ball, other] = self.balls(&self.pairs.get(pair))?;
        Some(before_ball(ball, other, position))
    }

    /// How far a ball of a pair is from another, or from an obstacle without corners, wherever their meshes are; none where a mesh is what touches.
    #[must_use]
    pub fn round_proximity(&self, pair: &Pair, position: &Positions<'_, D>) -> Option<Proximity<D>> {
        let ball = self.surfaces[pair.source].ball.as_ref()?;
        let centre = ball.centre(position);
        let (gap, normal) = match pair.target {
            Target::Obstacle(o) => {
                let obstacle = &self.obstacles[o];
                if obstacle.has_corners() {
                    return None;
                }
                obstacle.gap(&centre, position)
            }
            Target::Surface(t) => {
                let other = self.surfaces[t].ball.as_ref()?;
                let (distance, normal) = apart(&centre, &other.centre(position));
                (distance - other.radius, normal)
            }
        };
        Some(Proximity { gap: gap - ball.radius, at: centre - normal * ball.radius })
    }

    /// The contact of a ball with an obstacle without corners.
    pub(crate) fn ball_before_obstacle(
        &self,
        pair: usize,
        obstacle: &Obstacle<D>,
        position: &Positions<'_, D>,
    ) -> Option<Contact<D>> {
        let ball = self.surfaces[self.pairs.get(pair).source].ball.as_ref()?;
        (!obstacle.has_corners()).then(|| before_obstacle(ball, obstacle, position))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Its lowest point moves as the rigid body there, whichever nodes it follows.
    #[test]
    fn the_point_that_touches_moves_with_the_body() {
        let nodes = [[1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [-0.6, 0.0, 0.8], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
        let place = |n: u32| Vector::<3>::from(nodes[n as usize]) + Vector::<3>::new(0.0, 0.0, 1.2);
        let centre = Vector::<3>::new(0.0, 0.0, 1.2);
        let ball = Ball::new(&centre, 1.0, &[0, 1, 2, 3, 4], &place).expect("they are not in a plane");
        let floor = Obstacle::plane(Vector::zeros(), Vector::<3>::new(0.0, 0.0, 1.0)).numbered(9, 10);
        let with_floor = |n: u32| if n == 9 { Vector::zeros() } else { place(n) };
        let contact = before_obstacle(&ball, &floor, &with_floor);
        assert!((contact.gap - 0.2).abs() < 1e-15);
        let (drift, spin) = (Vector::<3>::new(0.3, -0.2, 0.1), Vector::<3>::new(1.0, 2.0, -3.0));
        let velocity = |n: usize| match n {
            9 => Vector::zeros(),
            n => drift + spin.cross(&(place(n as u32) - centre)),
        };
        let exact = drift + spin.cross(&Vector::<3>::new(0.0, 0.0, -1.0));
        assert!((contact.frame.tr_mul(&contact.relative(velocity)) - exact).norm() < 1e-14);
    }

    #[test]
    fn nodes_in_a_plane_carry_no_ball() {
        let place = |n: u32| Vector::<3>::new(f64::from(n), f64::from(n * n), 0.0);
        assert!(Ball::new(&Vector::zeros(), 1.0, &[0, 1, 2, 3], &place).is_none());
    }
}
