/// How a global problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlobalMethod {
    /// The cheaper of the two by the count of operations; condensed where ADMM does not get there soon.
    #[default]
    Auto,
    /// W is written out and the problem in reactions solved.
    Condense,
    /// ADMM with a factor of M + H ρ Hᵀ and without W, for many contacts on elastic bodies.
    Admm,
}

impl GlobalMethod {
    /// Every method.
    pub const ALL: [GlobalMethod; 3] = [GlobalMethod::Auto, GlobalMethod::Condense, GlobalMethod::Admm];

    /// The name, as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            GlobalMethod::Auto => "auto",
            GlobalMethod::Condense => "condense",
            GlobalMethod::Admm => "admm",
        }
    }

    /// The method of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}
