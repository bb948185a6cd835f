use super::dual::Dual;
use super::function::Function;

/// So many arguments a function is called with without room of their own.
const FEW: usize = 4;

/// A part of a formula.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Node {
    Number(f64),
    /// What the formula is of, by its place among the names of the variables.
    Variable(usize),
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
    /// Value and rate where the variables are these.
    pub fn at(&self, variables: &[Dual]) -> Dual {
        match self {
            Node::Number(value) => Dual::constant(*value),
            Node::Variable(i) => variables[*i],
            Node::Negative(x) => -x.at(variables),
            Node::Binary(operator, a, b) => operator.apply(a.at(variables), b.at(variables)),
            Node::Call(function, arguments) => {
                let mut values = [Dual::constant(0.0); FEW];
                if arguments.len() > FEW {
                    let values: Vec<Dual> = arguments.iter().map(|a| a.at(variables)).collect();
                    return function.apply(&values);
                }
                for (value, argument) in values.iter_mut().zip(arguments) {
                    *value = argument.at(variables);
                }
                function.apply(&values[..arguments.len()])
            }
        }
    }

    /// Whether it depends on a variable.
    pub fn uses(&self, variable: usize) -> bool {
        match self {
            Node::Number(_) => false,
            Node::Variable(i) => *i == variable,
            Node::Negative(x) => x.uses(variable),
            Node::Binary(_, a, b) => a.uses(variable) || b.uses(variable),
            Node::Call(_, arguments) => arguments.iter().any(|a| a.uses(variable)),
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
