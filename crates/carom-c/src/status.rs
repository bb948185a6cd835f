//! How a call ended, and what it has to say.

use std::any::Any;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use carom::{InputError, StepError};

/// How a call ended. Of all but CAROM_STATUS_OK carom_last_error() says why, and nothing was written.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(non_camel_case_types)]
pub enum carom_status {
    /// It did what it was asked for.
    OK = 0,
    /// A null pointer, a size that does not fit, a value out of range, or a call out of order.
    INVALID = 2,
    /// No reactions were found, or contacts were missed again and again. The step may be tried again from its search on.
    NOT_CONVERGED = 3,
    /// The caller's solver said that it failed.
    SOLVER_FAILED = 4,
    /// The handle is in use: by another thread, or by the call that is calling back.
    BUSY = 5,
    /// A defect of carom. The handle is of no more use; free it.
    DEFECT = 6,
}

/// Why a call did not do what it was asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Failure {
    pub status: carom_status,
    pub message: String,
}

impl Failure {
    pub fn new(status: carom_status, message: impl Into<String>) -> Self {
        Self { status, message: message.into() }
    }

    /// What was given cannot be.
    pub fn invalid(message: impl Into<String>) -> Self {
        Self::new(carom_status::INVALID, message)
    }

    /// Something was given of another number of points than there are.
    pub fn not_all(point_count: usize, points: usize) -> Self {
        Self::invalid(format!(
            "point_count is {point_count}; there are {points} points, of which all are needed"
        ))
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::invalid(if error.key.is_empty() {
            error.message
        } else {
            format!("{}: {}", error.key, error.message)
        })
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        Self::new(carom_status::NOT_CONVERGED, error.to_string())
    }
}

thread_local! {
    static LAST_ERROR: RefCell<CString> = RefCell::default();
}

/// Makes a call, and keeps what it has to say. No panic leaves it.
pub fn guarded(call: impl FnOnce() -> Result<(), Failure>) -> carom_status {
    let outcome = catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(defect(panic.as_ref())));
    let (status, message) = match outcome {
        Ok(()) => (carom_status::OK, String::new()),
        Err(failure) => (failure.status, failure.message),
    };
    // A name that is quoted in a message ends where C ends it.
    let text = CString::new(message.replace('\0', " ")).unwrap_or_default();
    LAST_ERROR.set(text);
    status
}

fn defect(panic: &(dyn Any + Send)) -> Failure {
    let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
    let said = text.unwrap_or("no message");
    Failure::new(carom_status::DEFECT, format!("carom has a defect, please report it: {said}"))
}

/// What the last call of this thread has to say.
pub fn last_error() -> *const c_char {
    LAST_ERROR.with_borrow(|text| CStr::as_ptr(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_panic_crosses_the_border() {
        assert_eq!(guarded(|| panic!("deliberate {}", 1)), carom_status::DEFECT);
        let said = LAST_ERROR.with_borrow(|text| text.to_string_lossy().into_owned());
        assert_eq!(said, "carom has a defect, please report it: deliberate 1");
        assert_eq!(guarded(|| Ok(())), carom_status::OK);
        LAST_ERROR.with_borrow(|text| assert!(text.is_empty()));
    }
}
