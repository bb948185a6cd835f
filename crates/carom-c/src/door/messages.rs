//! What calls have to say.

use std::ffi::c_char;

/// The version of carom, as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn carom_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// What the last call of this thread that returns a status has to say: what is wrong, with place and value, and what to do. Empty after CAROM_STATUS_OK. It is there until
/// the next such call of this thread.
#[unsafe(no_mangle)]
pub extern "C" fn carom_last_error() -> *const c_char {
    crate::status::last_error()
}
