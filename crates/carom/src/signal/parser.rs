//! From text to formula, by recursive descent: one function per level of precedence.

use std::fmt;

use super::formula::{Node, Operator};
use super::function::Function;

/// Formulas nested deeper than this are refused, so that no text can exhaust the stack.
const MAX_DEPTH: usize = 64;

/// Why a text is no formula, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpressionError {
    /// The text.
    pub text: String,
    /// Where in it, in characters from 0; its length for the end.
    pub position: usize,
    /// What is wrong there.
    pub reason: String,
}

impl fmt::Display for ExpressionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // One line, whatever the text holds.
        let (reason, text) = (shortened(&self.reason, 100), shortened(&self.text, 60));
        write!(f, "{reason} at column {} of {text:?}", self.position + 1)
    }
}

/// The beginning of a text that is longer than `most` characters.
fn shortened(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_string();
    }
    text.chars().take(most - 1).chain(['…']).collect()
}

impl std::error::Error for ExpressionError {}

/// Reads a whole text as a formula of the variables of these names.
pub(super) fn parse(text: &str, variables: &[&str]) -> Result<Node, ExpressionError> {
    let mut parser = Parser { text, variables, characters: text.chars().collect(), position: 0, depth: 0 };
    let root = parser.comparison()?;
    match parser.peek() {
        None => Ok(root),
        Some(')') => Err(parser.error("\")\" closes nothing")),
        Some(c) if c.is_alphanumeric() || "(.".contains(c) => Err(parser.error("expected an operator")),
        Some(c) => Err(parser.error(format!("unexpected {:?}", c.to_string()))),
    }
}

struct Parser<'a> {
    text: &'a str,
    variables: &'a [&'a str],
    characters: Vec<char>,
    position: usize,
    depth: usize,
}

impl Parser<'_> {
    fn error_at(&self, position: usize, reason: impl Into<String>) -> ExpressionError {
        ExpressionError { text: self.text.to_string(), position, reason: reason.into() }
    }

    fn error(&self, reason: impl Into<String>) -> ExpressionError {
        self.error_at(self.position, reason)
    }

    /// The next character that is not a space.
    fn peek(&mut self) -> Option<char> {
        while self.characters.get(self.position).is_some_and(|c| c.is_whitespace()) {
            self.position += 1;
        }
        self.characters.get(self.position).copied()
    }

    /// Whether `symbol` comes next; it is taken if so.
    fn take(&mut self, symbol: &str) -> bool {
        self.peek();
        let found =
            symbol.chars().enumerate().all(|(i, c)| self.characters.get(self.position + i) == Some(&c));
        if found {
            self.position += symbol.len();
        }
        found
    }

    /// The first of the `operators` that comes next, taken.
    fn operator(&mut self, operators: &[(&str, Operator)]) -> Option<Operator> {
        operators.iter().find(|(symbol, _)| self.take(symbol)).map(|&(_, operator)| operator)
    }

    fn comparison(&mut self) -> Result<Node, ExpressionError> {
        let left = self.sum()?;
        let operators = [
            ("<=", Operator::LessOrEqual),
            (">=", Operator::GreaterOrEqual),
            ("<", Operator::Less),
            (">", Operator::Greater),
        ];
        match self.operator(&operators) {
            Some(operator) => Ok(Node::Binary(operator, Box::new(left), Box::new(self.sum()?))),
            None => Ok(left),
        }
    }

    fn sum(&mut self) -> Result<Node, ExpressionError> {
        let operators = [("+", Operator::Add), ("-", Operator::Subtract)];
        let mut left = self.product()?;
        while let Some(operator) = self.operator(&operators) {
            left = Node::Binary(operator, Box::new(left), Box::new(self.product()?));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Node, ExpressionError> {
        let operators = [("*", Operator::Multiply), ("/", Operator::Divide)];
        let mut left = self.signed()?;
        while let Some(operator) = self.operator(&operators) {
            left = Node::Binary(operator, Box::new(left), Box::new(self.signed()?));
        }
        Ok(left)
    }

    /// Every way to nest passes here.
    fn signed(&mut self) -> Result<Node, ExpressionError> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(self.error(format!("nested deeper than {MAX_DEPTH} levels")));
        }
        let node = if self.take("-") {
            Node::Negative(Box::new(self.signed()?))
        } else if self.take("+") {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(node)
    }

    fn power(&mut self) -> Result<Node, ExpressionError> {
        let base = self.atom()?;
        match self.operator(&[("^", Operator::Power), ("**", Operator::Power)]) {
            Some(operator) => Ok(Node::Binary(operator, Box::new(base), Box::new(self.signed()?))),
            None => Ok(base),
        }
    }

    fn atom(&mut self) -> Result<Node, ExpressionError> {
        match self.peek() {
            Some('(') => {
                self.position += 1;
                let inner = self.comparison()?;
                self.close()?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            _ => Err(self.error("expected a value")),
        }
    }

    fn close(&mut self) -> Result<(), ExpressionError> {
        if self.take(")") { Ok(()) } else { Err(self.error("expected \")\"")) }
    }

    fn number(&mut self) -> Result<Node, ExpressionError> {
        let start = self.position;
        let mut end = start;
        let at = |k: usize| self.characters.get(k).copied().unwrap_or(' ');
        while at(end).is_ascii_digit() || at(end) == '.' {
            end += 1;
        }
        // An exponent, unless the "e" is Euler's number or the start of a name.
        if matches!(at(end), 'e' | 'E') {
            let sign = usize::from(matches!(at(end + 1), '+' | '-'));
            if at(end + 1 + sign).is_ascii_digit() {
                end += 1 + sign;
                while at(end).is_ascii_digit() {
                    end += 1;
                }
            }
        }
        let digits: String = self.characters[start..end].iter().collect();
        self.position = end;
        match digits.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(Node::Number(value)),
            Ok(_) => Err(self.error_at(start, format!("{digits:?} is not a finite number"))),
            Err(_) => Err(self.error_at(start, format!("{digits:?} is not a number"))),
        }
    }

    fn name(&mut self) -> Result<Node, ExpressionError> {
        let start = self.position;
        while self.characters.get(self.position).is_some_and(|c| c.is_alphanumeric() || *c == '_') {
            self.position += 1;
        }
        let name: String = self.characters[start..self.position].iter().collect();
        if self.peek() == Some('(') {
            return self.call(start, &name);
        }
        if let Some(place) = self.variables.iter().position(|variable| *variable == name) {
            return Ok(Node::Variable(place));
        }
        let (variables, first) = (self.variables.join(", "), self.variables[0]);
        match name.as_str() {
            "pi" => Ok(Node::Number(std::f64::consts::PI)),
            "e" => Ok(Node::Number(std::f64::consts::E)),
            _ if Function::named(&name).is_some() => Err(self.error_at(
                start,
                format!("{name:?} is a function; give it an argument as in {name}({first})"),
            )),
            _ => Err(self.error_at(start, format!("unknown name {name:?}; known are {variables}, pi, e"))),
        }
    }

    fn call(&mut self, start: usize, name: &str) -> Result<Node, ExpressionError> {
        let Some(function) = Function::named(name) else {
            let known: Vec<&str> = Function::ALL.iter().map(|(name, _)| *name).collect();
            let reason = format!("unknown function {name:?}; known are {}", known.join(", "));
            return Err(self.error_at(start, reason));
        };
        self.position += 1;
        let mut arguments = vec![self.comparison()?];
        while self.take(",") {
            arguments.push(self.comparison()?);
        }
        self.close()?;
        let (least, most) = function.arguments();
        if arguments.len() < least || arguments.len() > most {
            let plural = if least == 1 { "" } else { "s" };
            let more = if most > least { " or more" } else { "" };
            let reason = format!("{name} takes {least} argument{plural}{more}, not {}", arguments.len());
            return Err(self.error_at(start, reason));
        }
        Ok(Node::Call(function, arguments))
    }
}
