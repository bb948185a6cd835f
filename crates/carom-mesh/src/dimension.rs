//! Functions that are compiled for the plane and for space where they are written.
//!
//! Code that is generic in the dimension is compiled by every crate that uses it: by the wheel, by the library of C, by each program of tests. Where much
//! hangs on a function, [`compiled!`] names it by a pointer of the crate that it is in. All that hangs on it is compiled there, and others compile a call.

use std::any::Any;

/// The function that the dimension `$d` chooses from those compiled in the crate that this is written in: `compiled!(D, make as Make)`, where `make` is a
/// function of the dimension and `Make<const D: usize>` the type of pointers to it. Unit tests compile what they use.
#[macro_export]
macro_rules! compiled {
    ($d:ident, $function:path as $pointer:ident) => {{
        #[cfg(test)]
        let function: $pointer<$d> = $function;
        #[cfg(not(test))]
        let function: $pointer<$d> = {
            static PLANE: $pointer<2> = $function;
            static SPACE: $pointer<3> = $function;
            $crate::dimension::of_dimension(PLANE, SPACE)
        };
        function
    }};
}

/// Whichever of `plane` and `space`, of a type with dimension 2 and of one with dimension 3, has the type `T` with dimension D.
///
/// # Panics
/// If neither has, as where D is neither 2 nor 3.
pub fn of_dimension<P: 'static, S: 'static, T: 'static>(plane: P, space: S) -> T {
    same(plane).or_else(|| same(space)).expect("code of two or three dimensions")
}

/// The value, if its type `U` is the type `T`.
fn same<U: 'static, T: 'static>(value: U) -> Option<T> {
    let mut value = Some(value);
    (&mut value as &mut dyn Any).downcast_mut::<Option<T>>()?.take()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;

    fn zeros<const D: usize>() -> Vector<D> {
        of_dimension(Vector::<2>::zeros(), Vector::<3>::zeros())
    }

    #[test]
    fn the_dimension_chooses() {
        assert_eq!(zeros::<2>().len(), 2);
        assert_eq!(zeros::<3>().len(), 3);
    }

    #[test]
    #[should_panic(expected = "two or three")]
    fn there_is_no_other() {
        zeros::<4>();
    }
}
