use std::f64::consts::TAU;

use super::check::{check, check_size, is_length};
use super::lattice::{Block, Lattice, span};
use crate::{CellKind, Mesh, MeshError, Vector};

/// The plane between two circles of one centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Centre [m].
    pub centre: [f64; 2],
    /// Radius of the hole [m].
    pub inner_radius: f64,
    /// Radius of the outer circle [m].
    pub outer_radius: f64,
    /// Cells around and from the inside to the outside.
    pub divisions: [usize; 2],
}

impl Ring {
    /// The ring in these cells, with the sets inner and outer.
    ///
    /// # Errors
    /// If the radii are not positive and growing, the divisions too few or too many, or the cells are not of 2D.
    pub fn mesh(&self, kind: CellKind) -> Result<Mesh<2>, MeshError> {
        check_size(self.check(&self.divisions)?, &self.divisions)?;
        let mesh = self.lattice(span(kind)).mesh(kind)?;
        let on = |x: &Vector<2>, circle: f64| self.is_on((x - Vector::from(self.centre)).norm(), circle);
        Ok(mesh.with_facets_on(&[
            ("inner", &|x| on(x, self.inner_radius)),
            ("outer", &|x| on(x, self.outer_radius)),
        ]))
    }

    /// Whether a point at distance `r` is on this one of the two circles.
    pub(super) fn is_on(&self, r: f64, circle: f64) -> bool {
        (r - circle).abs() <= 1e-6 * (self.outer_radius - self.inner_radius)
    }

    /// How many cells the ring has, of which `divisions` is what the user gave.
    pub(super) fn check(&self, divisions: &[usize]) -> Result<f64, MeshError> {
        let (inner, outer) = (self.inner_radius, self.outer_radius);
        let remedy = "the inner radius must be greater than 0 m; a body without a hole is a disc or cylinder";
        check(is_length(inner), "inner_radius", &inner, remedy)?;
        let remedy = "the outer radius must be greater than the inner one";
        check(is_length(outer) && outer > inner, "outer_radius", &outer, remedy)?;
        let enough = !divisions.contains(&0) && self.divisions[0] >= 3;
        let remedy = "at least 3 cells around and 1 in every other direction are needed";
        check(enough, "divisions", &divisions, remedy)?;
        Ok(divisions.iter().map(|&d| d as f64).product())
    }

    /// The points of the ring for cells that span so many intervals.
    pub(super) fn lattice(&self, span: usize) -> Lattice<2> {
        let [around, across] = self.divisions.map(|d| d * span);
        let (centre, width) = (Vector::from(self.centre), self.outer_radius - self.inner_radius);
        let points = (0..=across)
            .flat_map(|i| {
                let radius = self.inner_radius + width * i as f64 / across as f64;
                (0..around).map(move |k| {
                    let angle = TAU * k as f64 / around as f64;
                    centre + Vector::from([angle.cos(), angle.sin()]) * radius
                })
            })
            .collect();
        let point = |[i, k]: [usize; 2]| (i * around + k % around) as u32;
        Lattice { points, blocks: vec![Block::new([across, around], point)] }
    }
}
