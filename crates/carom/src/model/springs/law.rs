//! The force of a spring over its elongation.

/// A force that is piecewise linear in the elongation, and goes on beyond its first and last points as it does beside them.
#[derive(Debug, Clone, PartialEq)]
pub struct ForceLaw {
    /// Elongations [m], ascending, and the tension [N] at each; two at least.
    points: Vec<(f64, f64)>,
}

impl ForceLaw {
    /// A `stiffness` [N/m].
    #[must_use]
    pub fn linear(stiffness: f64) -> Self {
        Self { points: vec![(0.0, 0.0), (1.0, stiffness)] }
    }

    /// The law with these tensions [N] at these elongations [m].
    ///
    /// # Errors
    /// What is wrong, if there are fewer than two points, the lengths differ, elongations do not ascend, or a number is not finite.
    pub fn table(elongation: &[f64], force: &[f64]) -> Result<Self, String> {
        if elongation.len() < 2 || elongation.len() != force.len() {
            return Err(format!(
                "{} elongations and {} forces: give as many of one as of the other, 2 at least",
                elongation.len(),
                force.len()
            ));
        }
        if let Some(bad) = elongation.iter().chain(force).find(|x| !x.is_finite()) {
            return Err(format!("{bad}: elongations and forces must be finite numbers"));
        }
        if let Some(pair) = elongation.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(format!("elongation {} follows {}: elongations must ascend", pair[1], pair[0]));
        }
        Ok(Self { points: elongation.iter().copied().zip(force.iter().copied()).collect() })
    }

    /// The number of the piece that an elongation is on: that which begins there, of a point.
    fn piece(&self, elongation: f64) -> usize {
        let next = self.points.partition_point(|&(e, _)| e <= elongation);
        next.clamp(1, self.points.len() - 1)
    }

    fn on_piece(&self, piece: usize, elongation: f64) -> f64 {
        let (start, force) = self.points[piece - 1];
        force + (elongation - start) * self.slope_of(piece)
    }

    fn slope_of(&self, piece: usize) -> f64 {
        let ((e0, f0), (e1, f1)) = (self.points[piece - 1], self.points[piece]);
        (f1 - f0) / (e1 - e0)
    }

    /// The tension [N] at an elongation [m].
    #[must_use]
    pub fn force(&self, elongation: f64) -> f64 {
        self.on_piece(self.piece(elongation), elongation)
    }

    /// Its rate of change [N/m]; at a kink that of the piece that begins there.
    #[must_use]
    pub fn slope(&self, elongation: f64) -> f64 {
        self.slope_of(self.piece(elongation))
    }

    /// The energy [J] that it takes to get to an elongation [m] from none.
    #[must_use]
    pub fn energy(&self, elongation: f64) -> f64 {
        if elongation < 0.0 { -self.integral(elongation, 0.0) } else { self.integral(0.0, elongation) }
    }

    /// The mean tension [N] on the way from one elongation to another: their difference times this is that of the energies, to round-off of the
    /// difference itself.
    #[must_use]
    pub fn mean(&self, [from, to]: [f64; 2]) -> f64 {
        let [low, high] = [from.min(to), from.max(to)];
        if self.piece(low) == self.piece(high) {
            return 0.5 * (self.force(low) + self.force(high));
        }
        self.integral(low, high) / (high - low)
    }

    /// By how much [`Self::mean`] changes with the second elongation [N/m].
    #[must_use]
    pub fn mean_slope(&self, ends: [f64; 2]) -> f64 {
        if self.piece(ends[0]) == self.piece(ends[1]) {
            return 0.5 * self.slope(ends[1]);
        }
        (self.force(ends[1]) - self.mean(ends)) / (ends[1] - ends[0])
    }

    /// ∫ F de from `low` to `high`, which is no less, piece by piece.
    fn integral(&self, low: f64, high: f64) -> f64 {
        let (first, last) = (self.piece(low), self.piece(high));
        (first..=last)
            .map(|piece| {
                let from = if piece == first { low } else { self.points[piece - 1].0 };
                let to = if piece == last { high } else { self.points[piece].0 };
                0.5 * (self.on_piece(piece, from) + self.on_piece(piece, to)) * (to - from)
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rope: slack, then 100 N/m, then 300 N/m.
    fn rope() -> ForceLaw {
        ForceLaw::table(&[-1.0, 0.0, 0.1, 0.2], &[0.0, 0.0, 10.0, 40.0]).expect("valid")
    }

    #[test]
    fn a_table_of_what_is_no_number_is_none() {
        for (elongations, forces, bad) in
            [([0.0, f64::NAN], [0.0, 1.0], "NaN"), ([0.0, 1.0], [0.0, f64::INFINITY], "inf")]
        {
            let said = ForceLaw::table(&elongations, &forces).expect_err("no number");
            assert_eq!(said, format!("{bad}: elongations and forces must be finite numbers"));
        }
    }

    #[test]
    fn a_table_is_linear_between_its_points_and_goes_on_beyond_them() {
        for (elongation, force, slope, energy) in [
            (-7.0, 0.0, 0.0, 0.0),
            (0.0, 0.0, 100.0, 0.0),
            (0.05, 5.0, 100.0, 0.125),
            (0.15, 25.0, 300.0, 1.375),
            (0.3, 70.0, 300.0, 8.5),
        ] {
            let law = rope();
            assert!((law.force(elongation) - force).abs() < 1e-13, "{elongation}");
            assert!((law.slope(elongation) - slope).abs() < 1e-10, "{elongation}");
            assert!((law.energy(elongation) - energy).abs() < 1e-14, "{elongation}");
        }
        assert_eq!(ForceLaw::linear(8.0).energy(-0.5), 1.0);
    }

    #[test]
    fn the_mean_force_does_the_change_of_the_energy() {
        let law = rope();
        for ends in [[-0.3, 0.15], [0.3, -2.0], [0.05, 0.08], [0.0999999, 0.1000001], [0.1, 0.1]] {
            let work = law.mean(ends) * (ends[1] - ends[0]);
            let change = law.energy(ends[1]) - law.energy(ends[0]);
            assert!((work - change).abs() < 1e-14, "{ends:?}: {work} {change}");
        }
        assert!((law.mean([0.1 - 1e-12, 0.1 + 1e-12]) - 10.0).abs() < 1e-9, "no digits are lost at a kink");
    }

    #[test]
    fn the_slope_of_the_mean_is_its_difference_quotient() {
        let law = rope();
        for ends in [[-0.3, 0.15], [0.3, -2.0], [0.05, 0.08]] {
            let at = |step: f64| law.mean([ends[0], ends[1] + step]);
            let quotient = (at(1e-6) - at(-1e-6)) / 2e-6;
            assert!((law.mean_slope(ends) - quotient).abs() < 1e-4, "{ends:?}");
        }
    }

    #[test]
    fn tables_that_are_no_functions_are_refused() {
        for (elongation, force, fact) in [
            (&[0.0][..], &[1.0][..], "2 at least"),
            (&[0.0, 1.0], &[1.0], "2 elongations and 1 forces"),
            (&[0.0, 0.0], &[1.0, 2.0], "must ascend"),
            (&[0.0, f64::NAN], &[1.0, 2.0], "NaN"),
        ] {
            assert!(ForceLaw::table(elongation, force).expect_err("no function").contains(fact), "{fact}");
        }
    }
}
