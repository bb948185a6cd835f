use super::dual::Dual;
use super::formula::Node;
use super::parser::{ExpressionError, parse};

/// A formula of the time t [s], such as `0.1*(1 - cos(pi*t))`, read once and evaluated with its exact rate.
///
/// Operators from weak to strong: comparisons `<` `<=` `>` `>=` (1 where true, 0 where not), `+` `-`, `*` `/`, sign, power `^` or
/// `**`. Constants are `pi` and `e`. Functions are abs, acos, asin, atan, cos, cosh, exp, log (natural), max, min, sign, sin,
/// sinh, sqrt, step(x) (1 from x = 0 on), tan, tanh, where(condition, a, b). Nothing else has a meaning.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    root: Node,
}

impl Expression {
    /// Reads a formula.
    ///
    /// # Errors
    /// If the text is none; the error says where.
    pub fn new(text: &str) -> Result<Self, ExpressionError> {
        Ok(Self { root: parse(text, &["t"])? })
    }

    /// Value and rate at time `t` [s].
    #[must_use]
    pub fn at(&self, t: f64) -> Dual {
        self.root.at(&[Dual::time(t)])
    }
}

/// A formula of what is not the time, by the rules of an [`Expression`].
#[derive(Debug, Clone, PartialEq)]
pub struct Formula<const N: usize> {
    root: Node,
}

impl<const N: usize> Formula<N> {
    /// Reads a formula of the variables of these names.
    ///
    /// # Errors
    /// If the text is none; the error says where.
    pub fn new(text: &str, variables: [&str; N]) -> Result<Self, ExpressionError> {
        Ok(Self { root: parse(text, &variables)? })
    }

    /// Its value.
    #[must_use]
    pub fn at(&self, variables: [f64; N]) -> f64 {
        self.root.at(&variables.map(Dual::constant)).value
    }

    /// Whether it depends on a variable, by its place among the names.
    #[must_use]
    pub fn uses(&self, variable: usize) -> bool {
        self.root.uses(variable)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{E, PI};

    fn value(text: &str, t: f64) -> f64 {
        Expression::new(text).expect(text).at(t).value
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        for (text, expected) in [
            ("1 + 2*3", 7.0),
            ("(1 + 2)*3", 9.0),
            ("8 - 4 - 2", 2.0),
            ("16/4/2", 2.0),
            ("-2^2", -4.0),
            ("2^3^2", 512.0),
            ("2**-1", 0.5),
            ("2*-3", -6.0),
            ("- -3", 3.0),
            ("+5", 5.0),
            ("1.5e-3 + .5", 0.5015),
            ("2e", 2.0 * E),
        ] {
            if text == "2e" {
                assert!(Expression::new(text).is_err(), "a product needs its sign");
            } else {
                assert_eq!(value(text, 0.0), expected, "{text}");
            }
        }
        assert_eq!(value("pi", 0.0), PI);
        assert_eq!(value("e", 0.0), E);
    }

    #[test]
    fn pieces_are_chosen_by_conditions() {
        assert_eq!(value("where(t < 1, 2, 3)", 0.5), 2.0);
        assert_eq!(value("where(t < 1, 2, 3)", 1.0), 3.0);
        assert_eq!(value("where(t >= 1, log(t), 0)", 0.0), 0.0);
        assert_eq!(value("step(t - 1)", 1.0), 1.0);
        assert_eq!(value("step(t - 1)", 0.999), 0.0);
        assert_eq!(value("max(1, t, 3)", 2.0), 3.0);
        assert_eq!(value("min(1, t)", 0.25), 0.25);
        assert_eq!(value("sign(t - 1)", 1.0), 0.0);
    }

    /// The rate against central differences, for every function and operator.
    #[test]
    fn rates_are_derivatives() {
        let h = 1e-6;
        for text in [
            "10*sin(3*t)",
            "0.1*(1 - cos(pi*t))",
            "t^3 - 2*t",
            "t^t",
            "2^t",
            "exp(-t)*cosh(t)",
            "sinh(t)/t",
            "log(t) + sqrt(t)",
            "tan(t)*tanh(t)",
            "atan(t)",
            "asin(t/3)",
            "acos(t/3)",
            "abs(t - 2)",
            "max(t, t^2)",
            "min(t, 3 - t)",
            "where(t > 1, t^2, 1)",
            "step(t) * t",
            "sign(t) * t",
            "-t/(1 + t)",
        ] {
            let expression = Expression::new(text).expect(text);
            for t in [0.37, 1.3] {
                let numeric = (expression.at(t + h).value - expression.at(t - h).value) / (2.0 * h);
                let rate = expression.at(t).rate;
                assert!(
                    (rate - numeric).abs() < 1e-8 * (1.0 + rate.abs()),
                    "{text} at {t}: {rate} or {numeric}"
                );
            }
        }
    }

    #[test]
    fn formulas_of_others_than_the_time_know_their_own_variables() {
        let formula = Formula::new("0.2 + max(0.1, v, 2, 3, 4)*s", ["v", "s"]).expect("valid");
        assert_eq!((formula.at([5.0, 0.5]), formula.at([0.0, 1.0])), (2.7, 4.2));
        assert_eq!((formula.uses(0), formula.uses(1)), (true, true));
        assert!(!Formula::new("exp(-s)", ["v", "s"]).expect("valid").uses(0));
        let error = Formula::new("0.1*t", ["v", "s"]).expect_err("no time");
        assert_eq!(error.reason, "unknown name \"t\"; known are v, s, pi, e");
    }

    #[test]
    fn rate_where_a_slope_is_infinite_but_nothing_moves_is_zero() {
        assert_eq!(Expression::new("sqrt(0) + t").expect("valid").at(1.0), Dual { value: 1.0, rate: 1.0 });
        assert_eq!(Expression::new("(-2)^2 + 0^2*t").expect("valid").at(1.0), Dual { value: 4.0, rate: 0.0 });
        assert_eq!(Expression::new("t^2").expect("valid").at(0.0), Dual { value: 0.0, rate: 0.0 });
    }

    #[test]
    fn errors_say_what_and_where() {
        for (text, column, reason) in [
            ("", 1, "expected a value"),
            ("sin(3*t", 8, "expected \")\""),
            ("2*(t + ", 8, "expected a value"),
            ("3 t", 3, "expected an operator"),
            ("t)", 2, "\")\" closes nothing"),
            ("4 $ t", 3, "unexpected \"$\""),
            ("siin(t)", 1, "unknown function \"siin\""),
            ("2*x", 3, "unknown name \"x\""),
            ("sin", 1, "is a function"),
            ("sin(t, 2)", 1, "sin takes 1 argument, not 2"),
            ("where(t, 2)", 1, "where takes 3 arguments, not 2"),
            ("max(1)", 1, "max takes 2 arguments or more, not 1"),
            ("1.2.3", 1, "\"1.2.3\" is not a number"),
            ("1e999", 1, "is not a finite number"),
            ("äh + t", 1, "unknown name \"äh\""),
            ("__import__('os')", 1, "unknown function"),
        ] {
            let error = Expression::new(text).expect_err(text);
            assert_eq!(error.position + 1, column, "{text}: {error}");
            assert!(error.reason.contains(reason), "{text}: {error}");
        }
        let shown = Expression::new("sin(3*t").expect_err("open").to_string();
        assert_eq!(shown, "expected \")\" at column 8 of \"sin(3*t\"");
        let long = Expression::new(&format!("t\n+ {}", "x".repeat(1000))).expect_err("x").to_string();
        assert!(long.len() < 250 && !long.contains('\n'), "{long}");
    }

    #[test]
    fn nesting_has_a_limit_and_no_text_crashes_the_reader() {
        let deep = format!("{}t{}", "(".repeat(100_000), ")".repeat(100_000));
        assert!(Expression::new(&deep).expect_err("too deep").reason.contains("nested"));
        assert!(Expression::new(&"-".repeat(100_000)).is_err());
        assert!(Expression::new(&"2^".repeat(100_000)).is_err());
    }
}
