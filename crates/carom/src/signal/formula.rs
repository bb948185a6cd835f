use super::dual::Dual;
use super::function::Function;

/// A part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Number(f64),
    Time,
    Negative(Box<Node>),
    Binary(Operator, Box<Node>, Box<Node>),
    Call(Function, Vec<Node>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Node {
    /// Value and rate where the time is `t`.
    pub fn at(&self, t: Dual) -> Dual {
        match self {
            Node::Number(value) => Dual::constant(*value),
            Node::Time => t,
            Node::Negative(x) => -x.at(t),
            Node::Binary(operator, a, b) => operator.apply(a.at(t), b.at(t)),
            Node::Call(function, arguments) => {
                let values: Vec<Dual> = arguments.iter().map(|a| a.at(t)).collect();
                function.apply(&values)
            }
        }
    }
}

impl Operator {
    fn apply(self, a: Dual, b: Dual) -> Dual {
        let truth = |holds: bool| Dual::constant(if holds { 1.0 } else { 0.0 });
        match self {
            Operator::Add => a + b,
            Operator::Subtract => a - b,
            Operator::Multiply => a * b,
            Operator::Divide => a / b,
            Operator::Power => a.power(b),
            Operator::Less => truth(a.value < b.value),
            Operator::LessOrEqual => truth(a.value <= b.value),
            Operator::Greater => truth(a.value > b.value),
            Operator::GreaterOrEqual => truth(a.value >= b.value),
        }
    }
}
