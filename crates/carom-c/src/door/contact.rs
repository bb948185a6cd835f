//! A step of the caller: search, evaluate, solve, missed, accept.

use std::ffi::{c_int, c_void};

use super::books::{carom_step, carom_work};
use super::{carom_solver, carom_status};
use crate::compliance::Compliance;
use crate::contact::Contact;
use crate::handle::{Handle, take};
use crate::memory::{numbers, one, write, write_one};
use crate::status::{Failure, guarded};

/// Contact in your time loop. It knows one step at a time: what it found, the reactions so far, and those of the step before, from which the next one starts.
#[allow(non_camel_case_types)]
pub struct carom_contact(Handle<Contact>);

impl carom_contact {
    pub(super) fn new(contact: Contact) -> Self {
        Self(Handle::new(contact))
    }

    /// Does something with contact, and says how that ended.
    pub(super) unsafe fn act(
        contact: *const Self,
        act: impl FnOnce(&mut Contact) -> Result<(), Failure>,
    ) -> carom_status {
        // SAFETY: the caller's promise.
        guarded(|| unsafe { one("contact", contact) }?.0.with("contact", act))
    }
}

/// Where all points are.
unsafe fn places<'a>(
    contact: &Contact,
    points: *const f64,
    point_count: usize,
) -> Result<&'a [f64], Failure> {
    // SAFETY: the caller's promise.
    unsafe { numbers("points", points, contact.size_of(point_count)?) }
}

/// Frees contact. Null is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_free(contact: *mut carom_contact) {
    // SAFETY: the promises of the header.
    unsafe { take(contact) }
}

/// Starts a step of length time_step [s], and finds what may touch in it. points [m] and velocity [m/s] have shape [point_count][dimension]: where all nodes are at the start, and how fast.
/// reach [m] is how far around their way things are looked for; 0 is twice as far as anything moves. With a reach velocity may be null if nothing else needs it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_search(
    contact: *mut carom_contact,
    points: *const f64,
    velocity: *const f64,
    point_count: usize,
    time_step: f64,
    reach: f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let at = places(contact, points, point_count)?;
            let size = contact.size_of(point_count)?;
            let velocity = match velocity.is_null() {
                true => None,
                false => Some(numbers("velocity", velocity, size)?),
            };
            contact.search(at, velocity, time_step, reach)
        })
    }
}

/// Evaluates what takes part in the step where the points are thought to be at its end [m].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_evaluate(
    contact: *mut carom_contact,
    points: *const f64,
    point_count: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let at = places(contact, points, point_count)?;
            contact.evaluate(at)
        })
    }
}

/// Solves for the reactions of the contacts that were evaluated last. free [m] is the motion d of your unknowns in the step without reactions, and motion [m] becomes that with them,
/// d = free + K^-1 H r; the two may be the same array. The solver solves with your K, and is given context.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_solve(
    contact: *mut carom_contact,
    free: *const f64,
    unknown_count: usize,
    solver: carom_solver,
    context: *mut c_void,
    motion: *mut f64,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            contact.refuse_unknowns(unknown_count)?;
            // The solver may change what is the caller's, and motion may be free.
            let free = numbers("free", free, unknown_count)?.to_vec();
            if motion.is_null() {
                return Err(Failure::invalid("motion is a null pointer; give room for every unknown"));
            }
            let found = contact.solve(&free, &Compliance::new(solver, context, unknown_count))?;
            write("motion", &found, motion, unknown_count)
        })
    }
}

/// Takes reactions [N] that you have solved for yourself, for the contacts that were evaluated last: size numbers, dimension for each contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_set_reactions(
    contact: *mut carom_contact,
    reactions: *const f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let needed = contact.map()?.count();
            if size != needed {
                return Err(Failure::invalid(format!(
                    "reactions has {size} entries; the contacts have {needed} components"
                )));
            }
            contact.set_reactions(numbers("reactions", reactions, size)?)
        })
    }
}

/// Writes 1 to missed if something went through its target that was not foreseen, where the points end up [m], and 0 if not. Ask in a step that has converged. After 1 it takes part:
/// evaluate, and iterate on.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_missed(
    contact: *mut carom_contact,
    points: *const f64,
    point_count: usize,
    missed: *mut c_int,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let at = places(contact, points, point_count)?;
            write_one("missed", 0, missed)?;
            write_one("missed", c_int::from(contact.missed(at)?), missed)
        })
    }
}

/// Ends the step where the points are [m]: keeps its reactions for the next one, and books what they did.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_accept(
    contact: *mut carom_contact,
    points: *const f64,
    point_count: usize,
    step: *mut carom_step,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let at = places(contact, points, point_count)?;
            write_one("step", carom_step::default(), step)?;
            let done = contact.accept(at)?;
            let work = done.pairs.values().fold(carom_work::default(), carom_work::with);
            let (certificate, min_gap, pressing) = (done.certificate, done.min_gap, done.pressing);
            write_one("step", carom_step { work, certificate, min_gap, pressing }, step)
        })
    }
}

/// How many entries H has that are not trivially zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_map_size(
    contact: *const carom_contact,
    entries: *mut usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| write_one("entries", contact.map()?.values.len(), entries))
    }
}

/// Writes H, the map from reactions to the forces on your unknowns, by columns, dimension for each contact: starts [column_count + 1], and the unknowns and values of its entries.
/// An unknown may be there several times in a column; its values add up. The motion of a contact is H^T d + offset.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_map(
    contact: *const carom_contact,
    starts: *mut usize,
    column_count: usize,
    unknowns: *mut i32,
    values: *mut f64,
    entries: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let map = contact.map()?;
            let numbers: Vec<i32> = map.unknowns.iter().map(|&u| u as i32).collect();
            write("starts", &map.starts, starts, column_count.saturating_add(1))?;
            write("unknowns", &numbers, unknowns, entries)?;
            write("values", &map.values, values, entries)
        })
    }
}
