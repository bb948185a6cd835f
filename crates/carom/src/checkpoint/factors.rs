//! The factors that the bodies iterate with, and their compliance at the nodes of contacts.
//!
//! The same factor comes out of the same stiffness, so only where it was made is kept. Of the compliance the order of its nodes counts:
//! each block is computed from one of its two sides.

use carom_fem::sparse::Precision;
use carom_mesh::{Matrix, Vector};

use crate::archive::{Archive, CheckpointError};
use crate::body::fe::operator::Origin;
use crate::step::workspace::Workspace;
use crate::{Method, Model};

/// Records or replays what the factors of all bodies were made from.
pub(super) fn exchange<const D: usize>(
    archive: &mut Archive<'_>,
    model: &Model<D>,
    method: &Method<D>,
    work: &mut Workspace<D>,
) -> Result<(), CheckpointError> {
    for (i, b) in model.bodies.iter().enumerate() {
        let (operator, compliance) = (&mut work.operators[i], &mut work.compliances[i]);
        let name = |of: &str| format!("factors/{i}/{of}");
        let mut has_factor = operator.origin().is_some();
        archive.flags(&name("has_factor"), [&mut has_factor])?;
        if !has_factor {
            operator.forget();
            continue;
        }
        let mut origin = operator.origin().cloned().unwrap_or_else(|| Origin {
            dt: 0.0,
            precision: Precision::Double,
            frame: Matrix::identity(),
            displacement: vec![Vector::zeros(); b.body.node_count()],
            history: b.body.virgin(),
        });
        let mut is_double = origin.precision == Precision::Double;
        let (nodes, mut near) = compliance.kept(operator);
        let mut nodes = nodes.to_vec();
        nodes.resize(archive.rows(&name("nodes"), nodes.len())?, 0);
        archive.numbers(&name("dt"), [&mut origin.dt])?;
        archive.flags(&name("is_double"), [&mut is_double])?;
        archive.numbers(&name("frame"), origin.frame.iter_mut())?;
        archive.vectors(&name("displacement"), &mut origin.displacement)?;
        archive.plastic(&name("plastic"), &mut origin.history)?;
        archive.integers(&name("nodes"), &mut nodes)?;
        archive.flags(&name("near"), [&mut near])?;
        if !archive.replays() {
            continue;
        }
        if nodes.iter().any(|&node| node as usize >= b.body.node_count()) {
            return Err(CheckpointError::new(&name("nodes"), "names a node that is not there"));
        }
        if origin.dt <= 0.0 {
            return Err(CheckpointError::new(&name("dt"), "is not positive"));
        }
        let precision = if is_double { Precision::Double } else { Precision::Single };
        let worked = b.body.after(&origin.history);
        let map = method.scheme.step_map(origin.dt);
        operator
            .factorize(&worked, &map, &origin.displacement, &origin.frame, precision)
            .map_err(|e| CheckpointError::new(&name("displacement"), e.to_string()))?;
        compliance.restore(&b.body, operator, &nodes, near);
    }
    Ok(())
}
