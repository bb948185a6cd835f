use carom_mesh::Vector;

use crate::aabb::Aabb;
use crate::tolerances::SEARCH;

/// Where an edge is, from its first node at s = 0 to its second at s = 1: straight, or half of the parabola through three nodes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Line<const D: usize> {
    /// Its ends [m].
    pub ends: [Vector<D>; 2],
    /// Half of its second derivative by s [m]; zero where it is straight.
    pub bow: Vector<D>,
}

impl<const D: usize> Line<D> {
    /// The straight one between two points.
    pub fn straight(ends: [Vector<D>; 2]) -> Self {
        Self { ends, bow: Vector::zeros() }
    }

    /// Whether it has no bow.
    pub fn is_straight(&self) -> bool {
        self.bow == Vector::<D>::zeros()
    }

    /// From its first to its second end [m].
    pub fn chord(&self) -> Vector<D> {
        self.ends[1] - self.ends[0]
    }

    /// The point at s [m]; farther than [`SearchTolerances::beyond`](crate::tolerances::SearchTolerances::beyond) from its ends it goes straight on.
    pub fn at(&self, s: f64) -> Vector<D> {
        let (held, rest) = held(s);
        let on = if held < 0.5 {
            self.ends[0] + self.chord() * held
        } else {
            self.ends[1] + self.chord() * (held - 1.0)
        };
        on - self.bow * (held * (1.0 - held)) + self.slope(held) * rest
    }

    /// The first derivative at s [m].
    pub fn slope(&self, s: f64) -> Vector<D> {
        self.chord() - self.bow * (1.0 - 2.0 * held(s).0)
    }

    /// The second derivative at s [m].
    pub fn turn(&self, s: f64) -> Vector<D> {
        if held(s).1 == 0.0 { self.bow * 2.0 } else { Vector::zeros() }
    }

    /// The same line, farther out at its ends by these fractions of it.
    pub fn gone_on(&self, by: [f64; 2]) -> Self {
        let longer = 1.0 + by[0] + by[1];
        Self { ends: [self.at(-by[0]), self.at(1.0 + by[1])], bow: self.bow * (longer * longer) }
    }

    /// A box around it.
    pub fn bounds(&self) -> Aabb<D> {
        let [a, b] = self.ends;
        Aabb::of([a, b, (a + b - self.bow) * 0.5])
    }

    /// The least of `direction`·x over its points x [m].
    pub fn least_along(&self, direction: &Vector<D>) -> f64 {
        let [a, b] = self.ends.map(|x| direction.dot(&x));
        let bow = direction.dot(&self.bow);
        let lowest = 0.5 - 0.5 * (b - a) / bow;
        if bow > 0.0 && (0.0..=1.0).contains(&lowest) {
            a + (b - a) * lowest - bow * lowest * (1.0 - lowest)
        } else {
            a.min(b)
        }
    }
}

/// The part of s up to which a line is what its nodes say, and the rest.
pub(super) fn held(s: f64) -> (f64, f64) {
    let held = s.clamp(-SEARCH.beyond, 1.0 + SEARCH.beyond);
    (held, s - held)
}
