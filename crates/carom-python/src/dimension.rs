//! What a run knows in the plane or in space is asked for in one way.

/// The same thing, in the dimension of space that was given.
pub enum Dimension<P, S> {
    Plane(P),
    Space(S),
}

/// Evaluates an expression of what is inside, whatever its dimension; without threads in a forked process.
macro_rules! with {
    ($either:expr, $inner:ident => $value:expr) => {{
        $crate::threads::mind_forks();
        match $either {
            $crate::dimension::Dimension::Plane($inner) => $value,
            $crate::dimension::Dimension::Space($inner) => $value,
        }
    }};
}

pub(crate) use with;
