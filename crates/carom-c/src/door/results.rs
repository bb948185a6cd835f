//! What is known of the contacts of a step, and what the books say.

use std::ffi::c_char;

use super::books::{carom_ledger, carom_report, carom_work};
use super::carom_status;
use super::contact::carom_contact;
use crate::memory::{text, write, write_one};
use crate::steps::Steps;

/// Writes something of every contact.
unsafe fn tell<T: Copy>(
    contact: *const carom_contact,
    name: &str,
    (out, size): (*mut T, usize),
    of: impl FnOnce(&dyn Steps) -> Vec<T>,
) -> carom_status {
    // SAFETY: the caller's promise.
    unsafe { carom_contact::act(contact, |contact| write(name, &of(contact.evaluated()?), out, size)) }
}

/// Writes how many contacts take part in the step.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_count(
    contact: *const carom_contact,
    count: *mut usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { carom_contact::act(contact, |contact| write_one("count", contact.count()?, count)) }
}

/// Writes the gap of every contact along its normal [m], negative where there is penetration, where in time the condition is written; size is the count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_gaps(
    contact: *const carom_contact,
    gaps: *mut f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "gaps", (gaps, size), |steps| steps.gaps()) }
}

/// Writes the frame of every contact, shape [count][dimension][dimension]: rows normal, from target to source, and tangents.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_frames(
    contact: *const carom_contact,
    frames: *mut f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "frames", (frames, size), |steps| steps.frames()) }
}

/// Writes Coulomb's coefficient of every contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_friction(
    contact: *const carom_contact,
    friction: *mut f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "friction", (friction, size), |steps| steps.friction()) }
}

/// Writes what the motions of contacts have beside H^T d [m], shape [count][dimension]: what the condition makes of the gap, and prescribed motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_offsets(
    contact: *const carom_contact,
    offsets: *mut f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "offsets", (offsets, size), |steps| steps.offsets()) }
}

/// Writes the reactions as they are known [N], shape [count][dimension], component 0 normal.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_reactions(
    contact: *const carom_contact,
    reactions: *mut f64,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "reactions", (reactions, size), |steps| steps.reactions()) }
}

/// Writes the source node of every contact; -1 of contacts between nodes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_nodes(
    contact: *const carom_contact,
    nodes: *mut i32,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        let number = |node: Option<u32>| node.and_then(|n| i32::try_from(n).ok()).unwrap_or(-1);
        tell(contact, "nodes", (nodes, size), |steps| steps.nodes().into_iter().map(number).collect())
    }
}

/// Writes the number of the pair of every contact, see carom_contact_pair_names.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_pairs(
    contact: *const carom_contact,
    pairs: *mut usize,
    size: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { tell(contact, "pairs", (pairs, size), |steps| steps.pairs()) }
}

/// Writes the forces of the reactions on your unknowns, H r [N].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_force(
    contact: *const carom_contact,
    force: *mut f64,
    unknown_count: usize,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe { carom_contact::act(contact, |contact| write("force", contact.force()?, force, unknown_count)) }
}

/// Writes what the friction solver said of the reactions that were last solved for; zeros without contacts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_report(
    contact: *const carom_contact,
    report: *mut carom_report,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            write_one("report", contact.report()?.map(Into::into).unwrap_or_default(), report)
        })
    }
}

/// Writes the books since the start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_ledger(
    contact: *const carom_contact,
    ledger: *mut carom_ledger,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let books = &contact.books;
            let work = books.pairs.values().fold(carom_work::default(), carom_work::with);
            let (certificate, min_gap, steps) = (books.certificate, books.min_gap, books.steps);
            write_one(
                "ledger",
                carom_ledger { work, certificate, min_gap, time: contact.time(), steps },
                ledger,
            )
        })
    }
}

/// Writes the names of a pair by its number, see carom_contact_pairs. They are there as long as contact is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_pair_names(
    contact: *const carom_contact,
    pair: usize,
    first: *mut *const c_char,
    second: *mut *const c_char,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let [a, b] = contact.pair_names(pair)?;
            write_one("first", a.as_ptr(), first)?;
            write_one("second", b.as_ptr(), second)
        })
    }
}

/// Writes what the reactions between two surfaces, or a surface and an obstacle, did since the start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn carom_contact_pair_work(
    contact: *const carom_contact,
    first: *const c_char,
    second: *const c_char,
    work: *mut carom_work,
) -> carom_status {
    // SAFETY: the promises of the header.
    unsafe {
        carom_contact::act(contact, |contact| {
            let done = contact.pair_work([text("first", first)?, text("second", second)?])?;
            write_one("work", carom_work::default().with(&done), work)
        })
    }
}
