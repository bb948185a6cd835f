//! How deep bodies and obstacles are inside one another, and bodies inside themselves.
//!
//! Nothing here knows of candidates, contacts or conditions: it looks at whole boundaries, from both sides, and is what these are judged
//! by. The depth of a point is its distance from the boundary of what it is inside of. The nodes of every boundary and the corners of
//! obstacles are checked. So are the parts of every edge that run through the inside of another body, though its ends are outside.

mod in_obstacle;
mod itself;
mod shell;
mod skin;

use carom_mesh::{Surface, Vector};

use crate::Obstacle;
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

/// The deepest place of two solids that are inside one another, or of a body that is inside itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Penetration<const D: usize> {
    /// Distance from the boundary of the one that the place is inside of [m]; positive.
    pub depth: f64,
    /// The place [m].
    pub at: Vector<D>,
    /// Who is inside whom.
    pub between: [Solid; 2],
    /// Diameter of the smaller facet that is there [m].
    pub cell: f64,
}

/// A place inside a solid: its depth [m], where it is, and the diameter of the facet that is there [m].
#[derive(Debug, Clone, Copy)]
struct Deep<const D: usize> {
    depth: f64,
    at: Vector<D>,
    cell: f64,
}

impl<const D: usize> Deep<D> {
    /// Nowhere inside.
    fn none() -> Self {
        Self { depth: 0.0, at: Vector::zeros(), cell: f64::INFINITY }
    }

    fn deeper(self, other: Self) -> Self {
        if other.depth > self.depth { other } else { self }
    }
}

/// The boundaries of all bodies and obstacles, and what the measure keeps from one call to the next.
#[derive(Debug, Clone)]
pub struct Boundaries<const D: usize> {
    shells: Vec<Shell<D>>,
    skins: Vec<Skin<D>>,
}

impl<const D: usize> Boundaries<D> {
    /// The boundaries of these bodies, each with the number of its first node, and of these obstacles.
    #[must_use]
    pub fn new<'a>(bodies: impl Iterator<Item = (&'a Surface, u32)>, obstacles: &[Obstacle<D>]) -> Self {
        Self {
            shells: bodies.map(|(surface, first)| Shell::new(surface, first)).collect(),
            skins: obstacles.iter().map(|o| Skin::of(&o.shape)).collect(),
        }
    }

    /// Tells `found` the deepest place of every pair that `counts`, a body with itself among them, where the nodes are at `position`.
    pub fn measure(
        &mut self,
        obstacles: &[Obstacle<D>],
        counts: impl Fn([Solid; 2]) -> bool,
        position: &impl Fn(u32) -> Vector<D>,
        mut found: impl FnMut(Penetration<D>),
    ) {
        self.shells.iter_mut().for_each(|shell| shell.place(position));
        let mut tell = |between: [Solid; 2], deep: Deep<D>| {
            if deep.depth > 0.0 {
                found(Penetration { depth: deep.depth, at: deep.at, between, cell: deep.cell });
            }
        };
        for (i, shell) in self.shells.iter().enumerate() {
            let me = Solid::Body(i);
            if counts([me, me]) {
                tell([me, me], shell.in_itself());
            }
            for (j, other) in self.shells.iter().enumerate() {
                let between = [me, Solid::Body(j)];
                if i != j && counts(between) && shell.bounds().overlaps(other.bounds()) {
                    tell(between, shell.inside_of(other));
                }
            }
            for (o, (skin, obstacle)) in self.skins.iter().zip(obstacles).enumerate() {
                let other = Solid::Obstacle(o);
                if counts([me, other]) {
                    let shift = position(obstacle.node);
                    tell([me, other], shell.inside_of_obstacle(&obstacle.shape, &shift));
                    tell([other, me], shell.deepest_of(skin, &shift));
                }
            }
        }
    }
}
