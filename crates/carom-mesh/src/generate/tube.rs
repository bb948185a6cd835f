use super::check::check_size;
use super::lattice::span;
use super::ring::Ring;
use super::upright::Axis;
use crate::{CellKind, Mesh, MeshError};

/// A tube: layers of a [`Ring`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tube {
    /// Where it is and how high.
    pub axis: Axis,
    /// Radius of the hole [m].
    pub inner_radius: f64,
    /// Radius of the outside [m].
    pub outer_radius: f64,
    /// Cells around, from the inside to the outside, and along the axis.
    pub divisions: [usize; 3],
}

impl Tube {
    /// The tube in these cells, with the sets inner, outer, bottom and top.
    ///
    /// # Errors
    /// If the lengths are not positive, the radii do not grow or the axis is zero. Also if the divisions are too few or
    /// too many, or the cells are not of 3D.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<3>, MeshError> {
        let Self { axis, inner_radius, outer_radius, divisions } = *self;
        axis.check()?;
        let [around, across, along] = divisions;
        let ring = Ring { centre: [0.0; 2], inner_radius, outer_radius, divisions: [around, across] };
        check_size(ring.check(&divisions)?, &divisions)?;
        let intervals = along * span(kind);
        let height = |k: usize| axis.height * k as f64 / intervals as f64;
        let mesh = ring.lattice(span(kind)).swept(intervals, height).mesh(kind)?;
        Ok(axis.place(mesh.with_facets_on(&[
            ("inner", &|x| ring.is_on(x[0].hypot(x[1]), inner_radius)),
            ("outer", &|x| ring.is_on(x[0].hypot(x[1]), outer_radius)),
            ("bottom", &|x| axis.at_bottom(x)),
            ("top", &|x| axis.at_top(x)),
        ])))
    }
}
