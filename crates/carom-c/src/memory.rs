//! Memory of the caller: read as slices, written from slices. Null, misaligned and too large are refused; that the memory is there the caller has to know.

use std::ffi::{CStr, c_char};
use std::slice;

use crate::status::Failure;

fn checked<T>(name: &str, pointer: *const T, count: usize) -> Result<(), Failure> {
    if count == 0 {
        return Ok(());
    }
    if pointer.is_null() {
        return Err(Failure::invalid(format!("{name} is a null pointer, and {count} are needed there")));
    }
    if !pointer.is_aligned() {
        return Err(Failure::invalid(format!("{name} is not aligned as its type needs")));
    }
    match count.checked_mul(size_of::<T>()) {
        Some(bytes) if isize::try_from(bytes).is_ok() => Ok(()),
        _ => Err(Failure::invalid(format!("{name} cannot have {count} entries; check the count"))),
    }
}

/// What a pointer to `count` things points to.
///
/// # Safety
/// If it is not null, they are there and stay as they are.
pub unsafe fn array<'a, T>(name: &str, pointer: *const T, count: usize) -> Result<&'a [T], Failure> {
    checked(name, pointer, count)?;
    // SAFETY: not null, aligned, and of a size that can be; the rest is the caller's promise.
    Ok(if count == 0 { &[] } else { unsafe { slice::from_raw_parts(pointer, count) } })
}

/// Numbers of the caller, all finite.
///
/// # Safety
/// As for [`array`].
pub unsafe fn numbers<'a>(name: &str, pointer: *const f64, count: usize) -> Result<&'a [f64], Failure> {
    // SAFETY: the caller's promise.
    let numbers = unsafe { array(name, pointer, count) }?;
    match numbers.iter().position(|x| !x.is_finite()) {
        Some(k) => Err(Failure::invalid(format!("{name}[{k}] = {}: must be finite", numbers[k]))),
        None => Ok(numbers),
    }
}

/// What a pointer to one thing points to.
///
/// # Safety
/// As for [`array`].
pub unsafe fn one<'a, T>(name: &str, pointer: *const T) -> Result<&'a T, Failure> {
    // SAFETY: the caller's promise.
    Ok(&unsafe { array(name, pointer, 1) }?[0])
}

/// A text that ends with a zero.
///
/// # Safety
/// If the pointer is not null, there is a zero behind it, and what is before stays as it is.
pub unsafe fn text<'a>(name: &str, pointer: *const c_char) -> Result<&'a str, Failure> {
    if pointer.is_null() {
        return Err(Failure::invalid(format!("{name} is a null pointer; give a text that ends with a zero")));
    }
    // SAFETY: the caller's promise.
    let text = unsafe { CStr::from_ptr(pointer) };
    text.to_str().map_err(|_| Failure::invalid(format!("{name} is no text in UTF-8")))
}

/// Writes values where the caller has room for `room` of them; there are to be as many.
///
/// # Safety
/// If the pointer is not null, there is that much room.
pub unsafe fn write<T: Copy>(name: &str, values: &[T], pointer: *mut T, room: usize) -> Result<(), Failure> {
    if room != values.len() {
        let message = format!(
            "{name} has room for {room} entries, and there are {}; ask for the count first",
            values.len()
        );
        return Err(Failure::invalid(message));
    }
    checked(name, pointer, room)?;
    if room > 0 {
        // SAFETY: not null, aligned, and as large as the caller says. Nothing of it is read, so it need not hold values before.
        unsafe { pointer.copy_from_nonoverlapping(values.as_ptr(), room) };
    }
    Ok(())
}

/// Writes one value.
///
/// # Safety
/// As for [`write`].
pub unsafe fn write_one<T: Copy>(name: &str, value: T, pointer: *mut T) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe { write(name, &[value], pointer, 1) }
}
