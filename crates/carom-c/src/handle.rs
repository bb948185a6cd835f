//! What the caller holds without knowing what is in it.

use std::sync::{Mutex, TryLockError};

use crate::memory;
use crate::status::{Failure, carom_status};

/// Something that one call at a time may use. A second one, from another thread or out of a callback, is refused and not undefined.
pub struct Handle<T>(Mutex<T>);

impl<T> Handle<T> {
    pub fn new(inner: T) -> Self {
        Self(Mutex::new(inner))
    }

    /// Does something with what is held.
    pub fn with<R>(&self, name: &str, act: impl FnOnce(&mut T) -> Result<R, Failure>) -> Result<R, Failure> {
        match self.0.try_lock() {
            Ok(mut inner) => act(&mut inner),
            Err(TryLockError::WouldBlock) => Err(Failure::new(
                carom_status::BUSY,
                format!("{name} is in use by another thread, or by the call that called back; wait for it"),
            )),
            Err(TryLockError::Poisoned(_)) => Err(Failure::new(
                carom_status::DEFECT,
                format!("{name} was left by a defect of carom in the middle of a call; free it"),
            )),
        }
    }
}

/// Writes where something is that is the caller's from then on.
///
/// # Safety
/// If `out` is not null, there is room for a pointer.
pub unsafe fn give<T>(name: &str, thing: T, out: *mut *mut T) -> Result<(), Failure> {
    let thing = Box::into_raw(Box::new(thing));
    // SAFETY: the caller's promise; what could not be handed over is taken back.
    unsafe { memory::write_one(name, thing, out).inspect_err(|_| drop(Box::from_raw(thing))) }
}

/// Takes something back; null is nothing.
///
/// # Safety
/// It is null, or was given and not yet taken back, and no call uses it.
pub unsafe fn take<T>(thing: *mut T) {
    if !thing.is_null() {
        // SAFETY: the caller's promise.
        drop(unsafe { Box::from_raw(thing) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_handle_serves_one_call_at_a_time_and_none_after_a_defect() {
        let handle = Handle::new(1);
        let inside = handle.with("contact", |_| handle.with("contact", |_| Ok(())));
        let busy = "contact is in use by another thread, or by the call that called back; wait for it";
        assert_eq!(inside, Err(Failure::new(carom_status::BUSY, busy)));
        assert_eq!(handle.with("contact", |one| Ok(*one)), Ok(1));
        let status = crate::status::guarded(|| handle.with("contact", |_| panic!("deliberate")));
        assert_eq!(status, carom_status::DEFECT);
        let left = "contact was left by a defect of carom in the middle of a call; free it";
        assert_eq!(handle.with("contact", |_| Ok(())), Err(Failure::new(carom_status::DEFECT, left)));
    }
}
