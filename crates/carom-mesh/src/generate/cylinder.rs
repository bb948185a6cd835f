use super::check::{check, check_size};
use super::disc::{Disc, is_near};
use super::lattice::span;
use super::upright::Axis;
use crate::{CellKind, Mesh, MeshError};

/// A solid cylinder: layers of a [`Disc`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// Where it is and how high.
    pub axis: Axis,
    /// Radius [m].
    pub radius: f64,
    /// Cells along a side of the core; a quarter of the side has as many.
    pub divisions: usize,
    /// Rings of cells around the core; half of `divisions` if not given.
    pub rings: Option<usize>,
    /// Cells along the axis.
    pub layers: usize,
}

impl Cylinder {
    /// The cylinder in these cells, with the sets bottom, top and side.
    ///
    /// # Errors
    /// If a length is not positive, the axis is zero, the divisions do not suit a disc, or the cells are not of 3D.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<3>, MeshError> {
        let Self { axis, radius, divisions, rings, layers } = *self;
        axis.check()?;
        check(layers > 0, "layers", &layers, "at least 1 layer is needed")?;
        let disc = Disc { centre: [0.0; 2], radius, divisions, rings };
        let (_, cells) = disc.check()?;
        check_size(cells * layers as f64, &divisions)?;
        let intervals = layers * span(kind);
        let height = |k: usize| axis.height * k as f64 / intervals as f64;
        let mesh = disc.lattice(span(kind))?.swept(intervals, height).mesh(kind)?;
        Ok(axis.place(mesh.with_facets_on(&[
            ("bottom", &|x| axis.at_bottom(x)),
            ("top", &|x| axis.at_top(x)),
            ("side", &|x| is_near(x[0].hypot(x[1]), radius)),
        ])))
    }
}
