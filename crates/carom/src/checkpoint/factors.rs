//! The factors that the bodies iterate with, and their compliance at the nodes of contacts.
//!
//! The same factor comes out of the same stiffness, so only where it was made is kept. Of the compliance the order of its nodes counts:
//! each block is computed from one of its two sides.

use crate::Method;
use crate::archive::{Archive, CheckpointError};
use crate::step::workspace::Workspace;

/// Records or replays what the factors of all bodies were made from.
pub(super) fn exchange<const D: usize>(
    archive: &mut Archive<'_>,
    method: &Method<D>,
    work: &mut Workspace<D>,
) -> Result<(), CheckpointError> {
    let compliances = &mut work.iterating.contacts.reduced.delassus.compliances;
    for (i, (body, compliance)) in work.iterating.bodies.iter_mut().zip(compliances).enumerate() {
        let name = format!("factors/{i}");
        if body.exchange(archive, &name, &|dt| method.scheme.step_map(dt))? {
            compliance.exchange(archive, &name, &mut **body)?;
        }
    }
    Ok(())
}
