use super::dual::Dual;

/// A piecewise linear function of time; before the first and after the last time it is constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    points: Vec<(f64, f64)>,
}

impl Table {
    /// The function with these values at these times [s].
    ///
    /// # Errors
    /// What is wrong, if there is no point, the lengths differ, times do not ascend, or a number is not finite.
    pub fn new(time: &[f64], value: &[f64]) -> Result<Self, String> {
        if time.is_empty() || time.len() != value.len() {
            return Err(format!(
                "{} times and {} values: give as many of one as of the other, 1 at least",
                time.len(),
                value.len()
            ));
        }
        if let Some(bad) = time.iter().chain(value).find(|x| !x.is_finite()) {
            return Err(format!("{bad}: times and values must be finite numbers"));
        }
        if let Some(pair) = time.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(format!("time {} follows {}: times must ascend", pair[1], pair[0]));
        }
        Ok(Self { points: time.iter().copied().zip(value.iter().copied()).collect() })
    }

    /// Value and rate at time `t` [s]; at a kink the rate of the piece that begins there.
    #[must_use]
    pub fn at(&self, t: f64) -> Dual {
        let next = self.points.partition_point(|&(time, _)| time <= t);
        if next == 0 || next == self.points.len() {
            let (_, value) = self.points[next.saturating_sub(1)];
            return Dual::constant(value);
        }
        let ((t0, x0), (t1, x1)) = (self.points[next - 1], self.points[next]);
        let rate = (x1 - x0) / (t1 - t0);
        Dual { value: x0 + (t - t0) * rate, rate }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_linear_between_its_points_and_constant_outside() {
        let table = Table::new(&[1.0, 2.0, 4.0], &[10.0, 20.0, 0.0]).expect("valid");
        for (t, value, rate) in [
            (0.0, 10.0, 0.0),
            (1.0, 10.0, 10.0),
            (1.5, 15.0, 10.0),
            (2.0, 20.0, -10.0),
            (3.0, 10.0, -10.0),
            (4.0, 0.0, 0.0),
            (9.0, 0.0, 0.0),
        ] {
            assert_eq!(table.at(t), Dual { value, rate }, "t = {t}");
        }
        assert_eq!(Table::new(&[3.0], &[7.0]).expect("valid").at(0.0), Dual::constant(7.0));
    }

    #[test]
    fn tables_that_are_no_functions_are_refused() {
        for (time, value, fact) in [
            (&[][..], &[][..], "0 times"),
            (&[0.0, 1.0], &[1.0], "2 times and 1 values"),
            (&[0.0, 0.0], &[1.0, 2.0], "must ascend"),
            (&[1.0, 0.0], &[1.0, 2.0], "0 follows 1"),
            (&[0.0, f64::NAN], &[1.0, 2.0], "NaN"),
        ] {
            assert!(Table::new(time, value).expect_err("no function").contains(fact), "{fact}");
        }
    }
}
