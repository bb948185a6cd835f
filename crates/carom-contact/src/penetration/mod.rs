//! How deep bodies and obstacles are inside one another, and bodies inside themselves.
//!
//! Nothing here knows of candidates, contacts or conditions: it looks at whole boundaries, from both sides, and is what these are judged
//! by. The depth of a point is its distance from the boundary of what it is inside of. The nodes of every boundary and the corners of
//! obstacles are checked. So are the parts of every edge that run through the inside of another body, though its ends are outside, and edges
//! of second order along their curves.

mod curved;
mod deep;
mod feature;
mod in_obstacle;
mod itself;
mod round;
mod shell;
mod skin;
mod way;

use carom_mesh::parallel::{SURFACES, each_group};
use carom_mesh::{Surface, Vector};

use crate::aabb::Aabb;
use crate::neighbours::Neighbours;
use crate::path::Positions;
use crate::tolerances::MEASURE;
use crate::{ContactSurface, Obstacle};
use deep::Deep;
pub use feature::Feature;
use shell::Shell;
use skin::Skin;

/// A body or an obstacle, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Solid {
    /// A body.
    Body(usize),
    /// A rigid obstacle.
    Obstacle(usize),
}

impl Solid {
    /// The two in ascending order, bodies before obstacles: the same whoever is named first.
    #[must_use]
    pub fn pair(self, other: Self) -> [Self; 2] {
        [self.min(other), self.max(other)]
    }
}

/// The deepest place of two solids that are inside one another, or of a body that is inside itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penetration<const D: usize> {
    /// Distance from the boundary of the one that the place is inside of [m]; positive.
    pub depth: f64,
    /// The place [m].
    pub at: Vector<D>,
    /// The two, bodies before obstacles.
    pub between: [Solid; 2],
    /// What is smaller there [m]: the diameter of a facet, or how thick the wall behind it was first, or the obstacle is.
    pub cell: f64,
    /// How far the arcs that the facets there stand for are in front of them [m], those of both sides together; of a round obstacle how far it
    /// bulges into the facet. None where both are round and no facet stands for them.
    pub arcs: f64,
}

/// What of a body is inside another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Witness {
    /// The body that it is of.
    pub of: usize,
    /// The body that it is in.
    pub inside: usize,
    /// The node or edge.
    pub feature: Feature,
    /// How deep it is [m].
    pub depth: f64,
}

/// The boundaries of all bodies and obstacles, and what the measure keeps from one call to the next.
#[derive(Debug, Clone, Default)]
pub struct Boundaries<const D: usize> {
    shells: Vec<Shell<D>>,
    skins: Vec<Skin<D>>,
    /// Of the last measure.
    witnesses: Vec<Witness>,
    near: Neighbours,
    /// What each of the bodies is inside of.
    inside: Vec<Inside<D>>,
}

/// What of a body is inside something, as the last measure has found it.
#[derive(Debug, Clone)]
struct Inside<const D: usize> {
    /// The deepest place of the body in every other solid, or of an obstacle in the body, the inner one first.
    deepest: Vec<([Solid; 2], Deep<D>)>,
    witnesses: Vec<Witness>,
}

impl<const D: usize> Default for Inside<D> {
    fn default() -> Self {
        Self { deepest: Vec::new(), witnesses: Vec::new() }
    }
}

impl<const D: usize> Boundaries<D> {
    /// The boundaries of these bodies, each with the number of its first node, and of these obstacles, where the nodes are at `position`.
    #[must_use]
    pub fn new<'a>(
        bodies: impl Iterator<Item = (&'a Surface, u32)>,
        obstacles: &[Obstacle<D>],
        position: &Positions<'_, D>,
    ) -> Self {
        let mut shells: Vec<_> = bodies.map(|(surface, first)| Shell::new(surface, first)).collect();
        for shell in &mut shells {
            shell.place(position);
            shell.size_up();
        }
        let skins = obstacles.iter().map(|o| Skin::of(&o.shape)).collect();
        Self { shells, skins, ..Self::default() }
    }

    /// The same, of bodies that are round where these `surfaces` of theirs are.
    #[must_use]
    pub fn round_as(mut self, surfaces: &[ContactSurface]) -> Self {
        for (shell, surface) in self.shells.iter_mut().zip(surfaces) {
            shell.ball = surface.ball.clone().map(|ball| (ball, Vector::zeros()));
        }
        self
    }

    /// Diameter of the smallest facet of a body where it was first [m]; infinite without facets.
    #[must_use]
    pub fn least_cell(&self, body: usize) -> f64 {
        self.shells[body].least_cell
    }

    /// Diameter of the largest facet of a body where it was first [m].
    #[must_use]
    pub fn largest_cell(&self, body: usize) -> f64 {
        self.shells[body].largest_cell
    }

    /// The nodes of the boundary of a body, ascending.
    pub fn nodes(&self, body: usize) -> impl Iterator<Item = u32> + Clone {
        self.shells[body].nodes.iter().map(|(node, _)| *node)
    }

    /// How far the largest arc that a facet of a body stands for is in front of it where it was first [m].
    #[must_use]
    pub fn largest_arc(&self, body: usize) -> f64 {
        self.shells[body].largest_arc()
    }

    /// What the last measure found of bodies inside one another by more than round-off, relative to the smaller of the facets there.
    #[must_use]
    pub fn witnesses(&self) -> &[Witness] {
        &self.witnesses
    }

    /// Tells `found` the deepest place of every pair that `counts`, a body with itself among them, where the nodes are at `position`.
    pub fn measure(
        &mut self,
        obstacles: &[Obstacle<D>],
        counts: impl Fn([Solid; 2]) -> bool + Sync,
        position: &Positions<'_, D>,
        mut found: impl FnMut(Penetration<D>),
    ) {
        each_group(&mut self.shells, SURFACES, |_, shells| {
            shells.iter_mut().for_each(|shell| shell.place(position));
        });
        self.near.find(self.shells.len(), 0.0, |i| self.shells[i].bounds());
        self.fit_those_that_meet(obstacles, &counts, position);
        self.look(obstacles, &counts, position);
        let Self { shells, skins, witnesses, inside, .. } = self;
        witnesses.clear();
        for Inside { deepest, witnesses: own } in &inside[..shells.len()] {
            witnesses.extend_from_slice(own);
            for &(between, Deep { depth, at, facet, other }) in deepest {
                let there = between.iter().zip([facet, other]);
                let bodies = there.filter_map(|(solid, facet)| match (solid, facet) {
                    (Solid::Body(i), Some(facet)) => Some((*i, facet)),
                    _ => None,
                });
                let diameters = bodies.clone().map(|(i, f)| shells[i].diameter(f));
                let mut cell = diameters.fold(f64::INFINITY, f64::min);
                if depth > MEASURE.witnessed * cell {
                    cell = bodies.clone().map(|(i, f)| shells[i].wall(f)).fold(cell, f64::min);
                    cell = between.iter().fold(cell, |cell, solid| match solid {
                        Solid::Obstacle(o) => cell.min(skins[*o].thickness),
                        Solid::Body(_) => cell,
                    });
                }
                let is_round = between.iter().all(|solid| match solid {
                    Solid::Body(i) => shells[*i].ball.is_some(),
                    Solid::Obstacle(o) => !obstacles[*o].has_corners(),
                });
                let facets = bodies.map(|(i, f)| (&shells[i], f));
                let bulge = between.iter().map(|solid| match solid {
                    Solid::Obstacle(o) => obstacles[*o].shape.bulge(cell),
                    Solid::Body(_) => 0.0,
                });
                let arcs = facets.map(|(shell, f)| shell.arc(f)).chain(bulge);
                let arcs = if is_round { 0.0 } else { arcs.sum() };
                let [inner, outer] = between;
                found(Penetration { depth, at, between: inner.pair(outer), cell, arcs });
            }
        }
    }

    /// Looks at every body for what is inside what.
    fn look(
        &mut self,
        obstacles: &[Obstacle<D>],
        counts: &(impl Fn([Solid; 2]) -> bool + Sync),
        position: &Positions<'_, D>,
    ) {
        let Self { shells, skins, near, inside, .. } = self;
        inside.resize_with(inside.len().max(shells.len()), Inside::default);
        let look = |i: usize, Inside { deepest, witnesses }: &mut Inside<D>| {
            deepest.clear();
            witnesses.clear();
            let (me, shell) = (Solid::Body(i), &shells[i]);
            let mut note = |between: [Solid; 2], deep: Deep<D>| {
                if deep.depth != 0.0 {
                    deepest.push((between, deep));
                }
            };
            if counts([me, me]) {
                note([me, me], shell.in_itself());
            }
            for j in near.of(i).filter(|&j| counts([me, Solid::Body(j)])) {
                let witness = |feature, depth| witnesses.push(Witness { of: i, inside: j, feature, depth });
                let round = shell.round_inside_of(&shells[j]);
                note([me, Solid::Body(j)], round.unwrap_or_else(|| shell.inside_of(&shells[j], witness)));
            }
            for (o, (skin, obstacle)) in skins.iter().zip(obstacles).enumerate() {
                let other = Solid::Obstacle(o);
                if counts([me, other]) {
                    if let Some(round) = shell.round_inside_of_obstacle(obstacle, position) {
                        note([me, other], round);
                        continue;
                    }
                    let shift = obstacle.shift(position);
                    note([me, other], shell.inside_of_obstacle(&obstacle.shape, &shift));
                    note([other, me], shell.deepest_of(skin, &shift));
                }
            }
        };
        each_group(&mut inside[..shells.len()], SURFACES, |first, inside| {
            (first..).zip(inside).for_each(|(i, inside)| look(i, inside));
        });
    }

    /// Fits the boxes of the facets that somebody will ask for.
    fn fit_those_that_meet(
        &mut self,
        obstacles: &[Obstacle<D>],
        counts: &(impl Fn([Solid; 2]) -> bool + Sync),
        position: &Positions<'_, D>,
    ) {
        let Self { shells, skins, near, .. } = self;
        let is_asked = |i: usize, bounds: &Aabb<D>| {
            let me = Solid::Body(i);
            counts([me, me])
                || near.of(i).any(|j| counts([me, Solid::Body(j)]))
                || skins.iter().zip(obstacles).enumerate().any(|(o, (skin, obstacle))| {
                    let shift = obstacle.shift(position);
                    let mut points = skin.corners.iter().copied().chain(skin.ball.map(|(centre, _)| centre));
                    let comes_near = points.any(|x| bounds.contains(&(x + shift)))
                        || skin.edges.iter().any(|ends| bounds.overlaps(&Aabb::of(ends.map(|x| x + shift))));
                    comes_near && counts([me, Solid::Obstacle(o)])
                })
        };
        each_group(shells, SURFACES, |first, shells| {
            (first..)
                .zip(shells)
                .filter(|(i, shell)| is_asked(*i, shell.bounds()))
                .for_each(|(_, shell)| shell.fit());
        });
    }
}
