use super::dual::Dual;

/// The functions that an expression may call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Function {
    Abs,
    Acos,
    Asin,
    Atan,
    Cos,
    Cosh,
    Exp,
    Log,
    Max,
    Min,
    Sign,
    Sin,
    Sinh,
    Sqrt,
    Step,
    Tan,
    Tanh,
    Where,
}

impl Function {
    /// Every function with its name.
    pub const ALL: [(&'static str, Self); 18] = [
        ("abs", Self::Abs),
        ("acos", Self::Acos),
        ("asin", Self::Asin),
        ("atan", Self::Atan),
        ("cos", Self::Cos),
        ("cosh", Self::Cosh),
        ("exp", Self::Exp),
        ("log", Self::Log),
        ("max", Self::Max),
        ("min", Self::Min),
        ("sign", Self::Sign),
        ("sin", Self::Sin),
        ("sinh", Self::Sinh),
        ("sqrt", Self::Sqrt),
        ("step", Self::Step),
        ("tan", Self::Tan),
        ("tanh", Self::Tanh),
        ("where", Self::Where),
    ];

    /// The function of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|(known, _)| *known == name).map(|&(_, function)| function)
    }

    /// How many arguments it takes, least and most.
    pub fn arguments(self) -> (usize, usize) {
        match self {
            Self::Max | Self::Min => (2, usize::MAX),
            Self::Where => (3, 3),
            _ => (1, 1),
        }
    }

    /// Its value for arguments of the right number.
    pub fn apply(self, arguments: &[Dual]) -> Dual {
        let x = arguments[0];
        let v = x.value;
        match self {
            Self::Abs => x.chain(v.abs(), sign(v)),
            Self::Acos => x.chain(v.acos(), -1.0 / (1.0 - v * v).sqrt()),
            Self::Asin => x.chain(v.asin(), 1.0 / (1.0 - v * v).sqrt()),
            Self::Atan => x.chain(v.atan(), 1.0 / (1.0 + v * v)),
            Self::Cos => x.chain(v.cos(), -v.sin()),
            Self::Cosh => x.chain(v.cosh(), v.sinh()),
            Self::Exp => x.chain(v.exp(), v.exp()),
            Self::Log => x.chain(v.ln(), 1.0 / v),
            Self::Max => pick(arguments, |a, b| a > b),
            Self::Min => pick(arguments, |a, b| a < b),
            Self::Sign => Dual::constant(sign(v)),
            Self::Sin => x.chain(v.sin(), v.cos()),
            Self::Sinh => x.chain(v.sinh(), v.cosh()),
            Self::Sqrt => x.chain(v.sqrt(), 0.5 / v.sqrt()),
            Self::Step => Dual::constant(if v >= 0.0 { 1.0 } else { 0.0 }),
            Self::Tan => x.chain(v.tan(), 1.0 + v.tan() * v.tan()),
            Self::Tanh => x.chain(v.tanh(), 1.0 - v.tanh() * v.tanh()),
            Self::Where => arguments[if v == 0.0 { 2 } else { 1 }],
        }
    }
}

/// −1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// The argument that stands before all others. Of equal ones the one that will: a table of rates decides kinks to the right.
fn pick(arguments: &[Dual], before: impl Fn(f64, f64) -> bool) -> Dual {
    arguments.iter().copied().fold(arguments[0], |best, x| {
        let ahead = before(x.value, best.value) || (x.value == best.value && before(x.rate, best.rate));
        if ahead { x } else { best }
    })
}
