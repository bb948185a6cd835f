//! What a run knows in the plane or in space is asked for in one way.

/// The same thing, in the dimension of space that was given.
pub enum Dimension<P, S> {
    Plane(P),
    Space(S),
}

/// Evaluates an expression of what is inside, whatever its dimension.
macro_rules! with {
    ($either:expr, $inner:ident => $value:expr) => {
        match $either {
            $crate::dimension::Dimension::Plane($inner) => $value,
            $crate::dimension::Dimension::Space($inner) => $value,
        }
    };
}

pub(crate) use with;
