use carom_mesh::Vector;

/// What a place on a segment may be off by, relative to its length.
const ROUND_OFF: f64 = 1e-9;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Aabb<const D: usize> {
    low: Vector<D>,
    high: Vector<D>,
}

impl<const D: usize> Aabb<D> {
    /// The box around points; empty (and touching nothing) if there are none.
    pub fn of(points: impl IntoIterator<Item = Vector<D>>) -> Self {
        let empty = Self { low: Vector::repeat(f64::INFINITY), high: Vector::repeat(f64::NEG_INFINITY) };
        points.into_iter().fold(empty, |b, x| Self { low: b.low.inf(&x), high: b.high.sup(&x) })
    }

    /// The box around both.
    pub fn union(&self, other: &Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// The point in the middle.
    pub fn centre(&self) -> Vector<D> {
        (self.low + self.high) * 0.5
    }

    /// Where the box begins and ends along an axis.
    pub fn side(&self, axis: usize) -> [f64; 2] {
        [self.low[axis], self.high[axis]]
    }

    /// The box grown by `factor` of its own half sides.
    pub fn scaled(&self, factor: f64) -> Self {
        let grow = (self.high - self.low) * (0.5 * factor);
        Self { low: self.low - grow, high: self.high + grow }
    }

    /// The box grown by `margin` on all sides.
    pub fn inflated(&self, margin: f64) -> Self {
        Self { low: self.low.add_scalar(-margin), high: self.high.add_scalar(margin) }
    }

    /// The box `by` [m] away.
    pub fn moved(&self, by: &Vector<D>) -> Self {
        Self { low: self.low + by, high: self.high + by }
    }

    pub fn overlaps(&self, other: &Self) -> bool {
        (0..D).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }

    /// Whether the segment between two points goes through it, or touches it but for round-off.
    pub fn is_crossed(&self, ends: &[Vector<D>; 2]) -> bool {
        let (mut first, mut last) = (-ROUND_OFF, 1.0 + ROUND_OFF);
        for i in 0..D {
            let (start, way) = (ends[0][i], ends[1][i] - ends[0][i]);
            let [low, high] = self.side(i);
            if way == 0.0 {
                if start < low || start > high {
                    return false;
                }
                continue;
            }
            let (a, b) = ((low - start) / way, (high - start) / way);
            (first, last) = (f64::max(first, a.min(b) - ROUND_OFF), f64::min(last, a.max(b) + ROUND_OFF));
        }
        first <= last
    }

    pub fn contains(&self, x: &Vector<D>) -> bool {
        (0..D).all(|i| self.low[i] <= x[i] && x[i] <= self.high[i])
    }

    /// Distance of a point to the box, zero inside.
    pub fn distance(&self, x: &Vector<D>) -> f64 {
        (0..D).map(|i| (self.low[i] - x[i]).max(x[i] - self.high[i]).max(0.0).powi(2)).sum::<f64>().sqrt()
    }

    /// Distance between two boxes, zero where they overlap.
    pub fn gap(&self, other: &Self) -> f64 {
        let apart = |i: usize| (self.low[i] - other.high[i]).max(other.low[i] - self.high[i]).max(0.0);
        (0..D).map(|i| apart(i).powi(2)).sum::<f64>().sqrt()
    }

    /// The axis along which the box is longest.
    pub fn longest_axis(&self) -> usize {
        (self.high - self.low).imax()
    }

    /// Length of its shortest side.
    pub fn shortest_side(&self) -> f64 {
        (self.high - self.low).min()
    }

    /// How far from its centre it goes: half its diagonal, and a hundredth of that for round-off [m].
    pub fn reach(&self) -> f64 {
        0.505 * self.diameter()
    }

    /// Length of the diagonal.
    pub fn diameter(&self) -> f64 {
        (self.high - self.low).norm()
    }
}
